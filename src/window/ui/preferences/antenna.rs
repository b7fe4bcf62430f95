//! The page of one antenna: its fields, and their effect on the predicted passes.

mod effect;
pub(super) mod peaks;
mod pointing;
mod reach;

use egui::{Align, Layout, Rect, Ui, vec2};

use super::{
    FormState,
    antenna_fields::{POINTING, WATCH},
    columns::{self, Part},
    connection_fields::ADDRESS,
    draft::Draft,
    findings, form,
    page::Page,
    preview,
};
use crate::{
    contract::{
        antenna::AntennaModel,
        driver::{AxisLessons, Command},
        passes::mount_limits,
    },
    model::{
        Model, UiCommand,
        effects::{DEBOUNCE, Effect, mounts},
    },
    station::{Antenna, AntennaId},
    ui::{
        widgets::{
            form::{LABEL, labelled},
            status_line::{self, Tone},
        },
        words,
    },
};

/// Width of the plot in the preview, points.
const PLOT: f32 = 224.0;

/// Shows the page of the antenna.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    id: AntennaId,
    (draft, before): (&mut Draft, &Draft),
    state: &mut FormState,
    commands: &mut Vec<UiCommand>,
) {
    let Some(index) = draft.index(id) else { return };
    let is_removed = draft.is_removed(index);
    let mut standings = draft.antenna_standings(index);
    let test = draft.test(index, model).filter(|_| !is_removed);
    if let (Tone::Good, words) = words::link_test_state(test)
        && let Some(address) = standings.get_mut(ADDRESS)
    {
        address.proved = Some(words::capitalised(&words));
    }
    let Some(antenna) = draft.antennas.get(index) else { return };
    let is_used = |(section, _): &(&str, usize)| {
        let mut fields = antenna.fields.iter().zip(&standings);
        fields.any(|(field, standing)| standing.is_used && field.section == *section)
    };
    let sections: Vec<_> = antenna.sections().into_iter().filter(is_used).collect();
    let rows: Vec<usize> = sections.iter().map(|(_, rows)| *rows).collect();
    let question = mounts::Question {
        antenna: id,
        before: mount_limits(antenna.before()),
        after: mount_limits(&antenna.read().0),
    };
    let is_edited = Page::Antenna(id).counts(draft, before).edited > 0;
    let is_new = antenna.is_new;
    columns::show(ui, rect, ("antenna", id.0), &rows, true, |ui, part| match part {
        Part::Card(card) => {
            let Some(antenna) = draft.antennas.get_mut(index) else { return };
            let Some((section, _)) = sections.get(card) else { return };
            let group = format!("antenna {}", id.0);
            let config = antenna.before().clone();
            let mut fit = None;
            let (form, focus_target) = ((antenna, &standings[..]), &mut state.focus_target);
            let peak = &mut state.peak;
            ui.add_enabled_ui(!is_removed, |ui| {
                form::section(ui, &group, form, section, focus_target, |ui| {
                    let model_antenna = model.antennas.iter().find(|owner| *owner.config == config);
                    if let Some(model_antenna) = model_antenna.filter(|_| *section == WATCH) {
                        let words = words::stopping_way(model_antenna.snapshot.stopping_way);
                        form::read_only_row(ui, "Coasting after STOP", &words);
                        learned_drives(ui, model_antenna, commands);
                    }
                    if *section == POINTING && !is_new {
                        fit = pointing::show(ui, model, id, &config, peak, commands);
                    }
                });
            });
            if let (Some(fit), Some(antenna)) = (fit, draft.antennas.get_mut(index)) {
                pointing::fill_in(antenna, &fit);
            }
        }
        Part::Preview { is_fold } => {
            let effect = model.mount_effects.effect.as_ref();
            let effect = effect.filter(|effect| effect.question.antenna == id);
            let value = effect.map_or_else(String::new, effect::in_short);
            let fold = is_fold.then_some(&mut state.preview_is_open);
            preview::card(ui, fold, &value, is_edited, |ui| {
                let antenna = draft.antennas.get(index);
                let antennas = antenna.map(|antenna| (antenna.before(), antenna.read().0));
                if let Some((was, new)) = &antennas {
                    reach_and_effect(ui, was, new, effect, is_new);
                }
            });
        }
        Part::Findings => {
            findings::show(ui, Page::Antenna(id), draft);
            if let Some(test) = test {
                form::card(ui, "Test of the link", |ui| {
                    for (tone, words) in words::link_test(test, model.demo, model.now) {
                        status_line::line(ui, tone, &words);
                    }
                });
            }
        }
    });
    if model.mount_effects.requested() != Some(&question) {
        ui.ctx().request_repaint_after_for(DEBOUNCE, egui::ViewportId::ROOT);
        commands.push(UiCommand::ShowTracked(Box::new(question)));
    }
}

/// Shows the learned parameters of each drive, and lets the operator reset them.
fn learned_drives(ui: &mut Ui, antenna: &AntennaModel, commands: &mut Vec<UiCommand>) {
    let can = antenna.config.connection.variant().capabilities;
    let axes = can.axes.iter().zip(&antenna.snapshot.learned).take(can.axis_count());
    for (name, lessons) in axes {
        form::read_only_row(ui, &format!("{name} drive"), &words::drive(lessons));
    }
    let is_known = antenna.snapshot.learned != <[AxisLessons; 2]>::default();
    labelled(ui, "", LABEL, |ui, _| {
        let forget = ui.add_enabled(is_known, egui::Button::new("Reset learned figures"));
        let forget = forget.on_hover_text(
            "After work on the drives, Azel would otherwise take a changed motion for that of \
             somebody else.",
        );
        if forget.clicked() {
            commands.push(UiCommand::antenna(antenna.id(), Command::ForgetDrives));
        }
    });
}

/// Shows the reach of an antenna, and the effect on the passes next to it.
fn reach_and_effect(
    ui: &mut Ui,
    was: &Antenna,
    new: &Antenna,
    effect: Option<&Effect<mounts::Question>>,
    is_new: bool,
) {
    ui.horizontal_top(|ui| {
        let plot = vec2(PLOT, 0.0);
        ui.allocate_ui_with_layout(plot, Layout::top_down(Align::Min), |ui| {
            ui.set_width(PLOT);
            reach::plot(ui, was, new);
        });
        ui.add_space(8.0);
        ui.vertical(|ui| effect::numbers(ui, effect, is_new));
    });
    ui.add_space(4.0);
    reach::words(ui, new);
    if let Some(effect) = effect {
        effect::words(ui, effect, is_new);
    }
}
