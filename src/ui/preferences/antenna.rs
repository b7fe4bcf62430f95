//! The page of one antenna: its fields, and what they change of the passes to come.

mod effect;
mod reach;

use egui::{Rect, Ui};

use super::{
    antenna_fields::WATCH,
    columns::{self, Part},
    draft::Draft,
    findings,
    form::{self, Sought},
    page::Page,
    preview,
};
use crate::{
    engine::passes::mount_limits,
    model::{
        Model, UiCommand,
        effects::{DEBOUNCE, mounts},
    },
    station::AntennaId,
    ui::{widgets::told, words},
};

/// Shows the page of the antenna. `is_open`: the fold of the preview, where it is one.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    id: AntennaId,
    (draft, before): (&mut Draft, &Draft),
    sought: &mut Sought,
    is_open: &mut bool,
    commands: &mut Vec<UiCommand>,
) {
    let Some(index) = draft.index(id) else { return };
    let is_removed = draft.is_removed(index);
    let standings = draft.antenna_standings(index);
    let Some(antenna) = draft.antennas.get(index) else { return };
    let sections = antenna.sections();
    let rows: Vec<usize> = sections.iter().map(|(_, rows)| *rows).collect();
    let question = mounts::Question {
        antenna: id,
        before: mount_limits(antenna.before()),
        after: mount_limits(&antenna.read().0),
    };
    let is_new = before.index(id).is_none();
    columns::show(ui, rect, ("antenna", id.0), &rows, true, |ui, part| match part {
        Part::Card(card) => {
            let Some(antenna) = draft.antennas.get_mut(index) else { return };
            let Some((section, _)) = sections.get(card) else { return };
            if is_removed {
                ui.disable();
            }
            let group = format!("antenna {}", id.0);
            let config = antenna.before().clone();
            form::section(ui, &group, (antenna, &standings), section, sought, |ui| {
                let known = model.antennas.iter().find(|of| of.config == config);
                if let Some(known) = known.filter(|_| *section == WATCH) {
                    let words = words::stopping_way(known.snapshot.stopping_way);
                    form::told(ui, "Way after STOP", &words);
                }
            });
        }
        Part::Preview { is_fold } => {
            let effect = model.mount_effects.effect.as_ref();
            let effect = effect.filter(|effect| effect.question.antenna == id);
            let value = effect.map_or_else(String::new, effect::in_short);
            let park = draft.antennas.get(index).map(|antenna| antenna.read().0);
            preview::card(ui, is_fold.then_some(&mut *is_open), &value, |ui| {
                if let Some(antenna) = &park {
                    reach::show(ui, antenna, is_fold);
                }
                effect::show(ui, effect, is_new);
            });
        }
        Part::Findings => {
            findings::show(ui, Page::Antenna(id), draft);
            let outcome = draft.test(index, model).filter(|_| !is_removed);
            if let Some(test) = outcome {
                form::card(ui, "Test of the link", |ui| {
                    for (tone, words) in words::link_test(test, model.demo) {
                        told::line(ui, tone, &words);
                    }
                });
            }
        }
    });
    if model.mount_effects.wanted() != Some(&question) {
        ui.ctx().request_repaint_after_for(DEBOUNCE, egui::ViewportId::ROOT);
        commands.push(UiCommand::ShowTracked(Box::new(question)));
    }
}
