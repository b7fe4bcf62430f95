//! The station's settings: site, satellites and antennas, in a plain form.

mod antenna_fields;
mod connection_fields;
mod draft;
mod fields;
mod form;
mod points;
mod station_fields;

use egui::{Align2, Color32, Rect, RichText, ScrollArea, Ui, UiBuilder, pos2, vec2};
use jiff::Timestamp;

use super::{
    format, text, theme,
    widgets::{
        button::{Button, HEIGHT},
        paint,
    },
};
use crate::{
    app::{Model, UiCommand},
    station::Station,
};
use draft::Draft;

/// Below this width of the form there is one column.
const TWO_COLUMNS_FROM: f32 = 1100.0;
/// Height of the bar below the form.
const FOOTER: f32 = 56.0;
const PADDING: f32 = 16.0;

/// What was typed, and what came of the last saving.
#[derive(Default)]
pub struct PreferencesState {
    draft: Option<(Station, Draft)>,
    outcome: Option<Result<Timestamp, String>>,
}

impl PreferencesState {
    /// Something is typed that is not saved.
    pub fn is_edited(&self) -> bool {
        self.draft.as_ref().is_some_and(|(station, draft)| *draft != Draft::of(station))
    }

    /// The station has changed elsewhere. Whoever changes it asks first whether
    /// something is typed.
    pub fn forget(&mut self) {
        self.draft = None;
    }

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
    let before = Draft::of(&station);
    let (body, footer) = rect.split_top_bottom_at_y(rect.bottom() - FOOTER);
    let inner = body.shrink2(vec2(PADDING, 0.0)).with_min_y(body.top() + PADDING);
    let builder = UiBuilder::new().id_salt("preferences").max_rect(inner);
    ui.scope_builder(builder, |ui| {
        ui.set_clip_rect(body);
        ui.label(RichText::new("Station settings").font(text::title()));
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            form::show(ui, &mut draft, rect.width() >= TWO_COLUMNS_FROM);
        });
    });

    ui.painter().rect_filled(footer, 0.0, t.bg1);
    ui.painter().hline(footer.x_range(), footer.top() + 0.5, (1.0, t.line));
    let read = draft.read();
    let edited = draft != before;
    let busy = read.as_ref().and_then(|station| busy(model, station));
    let can_save = read.is_some() && (edited || model.demo) && busy.is_none();
    let save = Button::primary("Save and use").locked(!can_save);
    let revert = Button::normal("Revert").locked(!edited);
    let place = |right: f32, width: f32| {
        let min = pos2(right - width, footer.center().y - HEIGHT / 2.0);
        Rect::from_min_size(min, vec2(width, HEIGHT))
    };
    let saving = place(footer.right() - PADDING, save.width(ui));
    let reverting = place(saving.left() - 8.0, revert.width(ui));
    let room = footer.with_min_x(footer.left() + PADDING).with_max_x(reverting.left() - PADDING);
    let (words, colour) = match busy {
        Some(name) => (format!("{name} moves or tracks. Stop it, then save."), t.warn),
        None => outcome(ui, model, read.is_some(), edited, state),
    };
    paint::text_in(ui, room, Align2::LEFT_CENTER, &words, text::body(), colour);
    paint::name_text(ui, "outcome", room, &words).on_hover_text(&words);
    let reverted = revert.show(ui, "revert", reverting).clicked();
    if save.show(ui, "save", saving).clicked()
        && let Some(station) = read
    {
        commands.push(UiCommand::SaveStation(Box::new(station)));
    }
    if reverted {
        state.outcome = None;
    } else {
        state.draft = Some((station, draft));
    }
}

/// The antenna that would be let go in the middle of a motion, because it is
/// changed or left out in `station`.
fn busy<'a>(model: &'a Model, station: &Station) -> Option<&'a str> {
    // The simulators of the demonstration end with it.
    let mut antennas = model.antennas.iter().filter(|_| !model.demo);
    let busy =
        antennas.find(|antenna| antenna.is_busy() && !station.antennas.contains(&antenna.config));
    busy.map(|antenna| antenna.config.name.as_str())
}

/// What stands beside the buttons.
fn outcome(
    ui: &Ui,
    model: &Model,
    usable: bool,
    edited: bool,
    state: &PreferencesState,
) -> (String, Color32) {
    let t = theme::tokens(ui);
    match (&state.outcome, edited) {
        _ if !usable => ("Some fields cannot be used yet.".to_owned(), t.warn),
        (Some(Err(why)), _) => (format!("Not saved: {why}."), t.bad),
        (_, true) => ("Not saved yet.".to_owned(), t.sat),
        (Some(Ok(at)), _) => (format!("Saved {}.", format::time_z(*at)), t.ok),
        _ if model.demo => {
            ("Saving ends the demonstration and uses these antennas.".to_owned(), t.t2)
        }
        _ => ("Nothing to save.".to_owned(), t.t3),
    }
}
