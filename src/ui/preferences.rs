//! The station's settings: site, satellites and antennas, in a plain form.

mod draft;

use egui::{Frame, Margin, Rect, RichText, ScrollArea, Stroke, TextEdit, Ui, UiBuilder};
use jiff::Timestamp;

use super::{format, text, theme};
use crate::{
    app::{Model, UiCommand},
    station::Station,
};
use draft::{Draft, Field, Kind};

const LABEL: f32 = 200.0;
const FIELD: f32 = 240.0;
const COLUMN: f32 = 560.0;

/// What was typed, and what came of the last saving.
#[derive(Default)]
pub struct PreferencesState {
    draft: Option<(Station, Draft)>,
    outcome: Option<Result<Timestamp, String>>,
}

impl PreferencesState {
    /// The settings were saved at this time, or not, and why.
    pub fn saved(&mut self, result: Result<Timestamp, String>) {
        if result.is_ok() {
            self.draft = None;
        }
        self.outcome = Some(result);
    }
}

/// Draws the form.
pub fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    state: &mut PreferencesState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg0);
    let (station, mut draft) =
        state.draft.take().unwrap_or_else(|| (model.station.clone(), Draft::of(&model.station)));
    let mut revert = false;
    let builder = UiBuilder::new().id_salt("preferences").max_rect(rect.shrink(16.0));
    ui.scope_builder(builder, |ui| {
        ui.set_clip_rect(rect);
        ui.label(RichText::new("Station settings").font(text::title()));
        let footer = 48.0;
        let height = ui.available_height() - footer;
        ScrollArea::vertical().max_height(height).auto_shrink(false).show(ui, |ui| {
            card(ui, "Site and satellites", |ui| fields(ui, "station", &mut draft.station));
            let mut removed = None;
            for (index, antenna) in draft.antennas.iter_mut().enumerate() {
                card(ui, &format!("Antenna {}", index + 1), |ui| {
                    fields(ui, &format!("antenna {index}"), antenna);
                    if ui.button(format!("Remove antenna {}", index + 1)).clicked() {
                        removed = Some(index);
                    }
                });
            }
            if let Some(index) = removed {
                draft.antennas.remove(index);
            }
            if ui.button("Add a Satrak").clicked() {
                draft.add_antenna();
            }
        });
        ui.add_space(8.0);
        let read = draft.read();
        let edited = draft != Draft::of(&station);
        ui.horizontal(|ui| {
            let can_save = read.is_some() && (edited || model.demo);
            let save = ui.add_enabled(can_save, egui::Button::new("Save and use"));
            if save.clicked()
                && let Some(station) = &read
            {
                commands.push(UiCommand::SaveStation(Box::new(station.clone())));
            }
            revert = ui.add_enabled(edited, egui::Button::new("Revert")).clicked();
            let (words, colour) = match (&read, &state.outcome, edited) {
                (None, ..) => ("Some fields cannot be used yet.".to_owned(), t.warn),
                (_, Some(Err(why)), _) => (format!("Not saved: {why}."), t.bad),
                (_, _, true) => ("Not saved yet.".to_owned(), t.sat),
                (_, Some(Ok(at)), _) => (format!("Saved {}.", format::time_z(*at)), t.ok),
                _ if model.demo => {
                    ("Saving ends the demonstration and uses these antennas.".to_owned(), t.t2)
                }
                _ => ("Nothing to save.".to_owned(), t.t3),
            };
            ui.label(RichText::new(words).font(text::body()).color(colour));
        });
    });
    if revert {
        state.outcome = None;
    } else {
        state.draft = Some((station, draft));
    }
}

fn card(ui: &mut Ui, title: &str, content: impl FnOnce(&mut Ui)) {
    let t = theme::tokens(ui);
    Frame::new()
        .fill(t.bg1)
        .stroke(Stroke::new(1.0, t.line))
        .corner_radius(6)
        .inner_margin(Margin::same(16))
        .outer_margin(Margin::symmetric(0, 8))
        .show(ui, |ui| {
            ui.set_width(COLUMN.min(ui.available_width()));
            ui.label(RichText::new(title).font(text::value()));
            content(ui);
        });
}

fn fields(ui: &mut Ui, group: &str, fields: &mut [Field]) {
    let t = theme::tokens(ui);
    for field in fields {
        ui.horizontal(|ui| {
            let words = RichText::new(field.label).font(text::body()).color(t.t2);
            let left = egui::Layout::left_to_right(egui::Align::Center);
            let label = ui
                .allocate_ui_with_layout(egui::vec2(LABEL, 24.0), left, |ui| {
                    ui.set_min_width(LABEL);
                    ui.label(words).id
                })
                .inner;
            let problem = field.problem();
            ui.scope(|ui| {
                if problem.is_some() {
                    let widgets = &mut ui.visuals_mut().widgets;
                    for widget in [&mut widgets.inactive, &mut widgets.hovered] {
                        widget.bg_stroke = Stroke::new(2.0, t.bad);
                    }
                }
                let edit = TextEdit::singleline(&mut field.text)
                    .id_salt((group, field.label))
                    .desired_width(FIELD);
                ui.add(edit).labelled_by(label);
            });
            if let Kind::Range { unit, .. } = field.kind {
                ui.label(RichText::new(unit).font(text::body()).color(t.t3));
            }
        });
        if let Some(problem) = field.problem() {
            ui.horizontal(|ui| {
                ui.add_space(LABEL + 8.0);
                let words = format!("{} {problem}.", field.label);
                ui.label(RichText::new(words).font(text::small()).color(t.bad));
            });
        }
    }
}
