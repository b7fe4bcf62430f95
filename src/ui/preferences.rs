//! Settings of the station: site, satellites and antennas, in a plain form.

mod antenna_fields;
mod appearance;
mod connection_fields;
pub(super) mod draft;
pub(super) mod fields;
pub(super) mod form;
mod horizon;
mod notices;
pub(super) mod station_fields;

use egui::{
    Align2, Color32, Rect, RichText, Role, ScrollArea, Ui, UiBuilder, WidgetInfo, pos2, vec2,
};
use jiff::Timestamp;

use super::{
    format, text, theme,
    widgets::{
        button::{Button, HEIGHT},
        hold_button::{self, HoldState},
        paint,
        segmented::{self, Segment},
    },
    words,
};
use crate::{
    astro::MaskForm,
    engine::{self, antenna::AntennaModel},
    model::{MaskNews, Model, UiCommand},
    station::{Entered, Station},
};
use draft::Draft;
use horizon::HorizonState;

/// Width of the form from which there are two columns.
const TWO_COLUMNS_FROM: f32 = 1100.0;
/// Height of the bar below the form.
const FOOTER: f32 = 56.0;
const PADDING: f32 = 16.0;
/// Width from which the pages are listed at the left.
const LIST_FROM: f32 = 1240.0;
const LIST: f32 = 232.0;
/// Height of the strip of pages above the form.
const STRIP: f32 = 40.0;
/// Width of the button that the operator must hold.
const HOLD: f32 = 150.0;

/// Edited settings, and the result of the last saving.
#[derive(Default)]
pub struct PreferencesState {
    draft: Option<(Station, Draft)>,
    outcome: Option<Result<Timestamp, String>>,
    section: Section,
    horizon: HorizonState,
    confirming: HoldState,
}

/// A page of the settings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Section {
    /// Site, satellites and antennas.
    #[default]
    Station,
    /// Obstructions of the sky, and zones that antennas must not point at.
    Horizon,
    /// Notifications, sounds and reminders.
    Notices,
    /// Theme and scale.
    Appearance,
}

impl Section {
    const ALL: [(&'static str, Self); 4] = [
        ("Station and antennas", Self::Station),
        ("Horizon and keep-outs", Self::Horizon),
        ("Alarms and sounds", Self::Notices),
        ("Appearance", Self::Appearance),
    ];
}

impl PreferencesState {
    /// Whether something typed is not saved.
    pub fn is_edited(&self) -> bool {
        self.draft.as_ref().is_some_and(|(station, draft)| *draft != Draft::of(station))
    }

    /// Drops the draft, because the station has changed elsewhere. Callers ask the operator
    /// first if something is typed.
    pub fn forget(&mut self) {
        self.draft = None;
        self.horizon.forget();
    }

    /// Takes the result of reading or writing a horizon mask.
    pub fn mask_news(&mut self, news: MaskNews) {
        self.horizon.exchanged(match news {
            MaskNews::Read(mask, form) => {
                let points = mask.points_deg().len();
                if let Some((_, draft)) = &mut self.draft {
                    draft.skies.mask = mask.to_string();
                }
                let form = match form {
                    MaskForm::Points => "plain numbers",
                    MaskForm::Table => "a table",
                    MaskForm::Keys => "keys and values",
                };
                Ok(format!("{points} points read from {form}. Save to use them."))
            }
            MaskNews::Written(path) => Ok(format!("Written to {}.", path.display())),
            MaskNews::Failed(why) => Err(format!("{}.", words::capitalised(&why))),
        });
    }

    /// Takes the time of saving the settings, or the failure.
    pub fn saved(&mut self, result: Result<Timestamp, String>) {
        if result.is_ok() {
            self.draft = None;
            self.horizon.forget();
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
    let (station, mut draft) = state.draft.take().unwrap_or_else(|| {
        let station = model.station_to_edit();
        let draft = Draft::of(&station);
        (station, draft)
    });
    let before = Draft::of(&station);
    let (body, footer) = rect.split_top_bottom_at_y(rect.bottom() - FOOTER);
    let page = sections(ui, body, state);
    let antennas = draft.antenna_names();
    match state.section {
        Section::Station => cards(ui, page, "Station settings", |ui, two_columns| {
            form::show(ui, model, &mut draft, two_columns, commands);
        }),
        Section::Notices => cards(ui, page, "Alarms and sounds", |ui, two_columns| {
            notices::show(ui, model, &mut draft, two_columns, commands);
        }),
        Section::Appearance => cards(ui, page, "Appearance", |ui, _| {
            appearance::show(ui, model, commands);
        }),
        Section::Horizon => {
            let (skies, horizon) = (&mut draft.skies, &mut state.horizon);
            horizon::show(ui, page, model, (&station, &antennas), skies, horizon, commands);
        }
    }

    ui.painter().rect_filled(footer, 0.0, t.bg1);
    ui.painter().hline(footer.x_range(), footer.top() + 0.5, (1.0, t.line));
    let read = draft.read();
    let edited = draft != before;
    let busy = read.as_ref().and_then(|after| busy(model, &station, after));
    let inside = read.as_ref().and_then(|after| inside(model, &station, after));
    let can_save = read.is_some() && (edited || model.demo) && busy.is_none();
    let save = Button::primary("Save and use").locked(!can_save);
    let revert = Button::normal("Revert").locked(!edited);
    let place = |right: f32, width: f32| {
        let min = pos2(right - width, footer.center().y - HEIGHT / 2.0);
        Rect::from_min_size(min, vec2(width, HEIGHT))
    };
    let holds = can_save && inside.is_some();
    let width = if holds { HOLD } else { save.width(ui) };
    let saving = place(footer.right() - PADDING, width);
    let reverting = place(saving.left() - 8.0, revert.width(ui));
    let room = footer.with_min_x(footer.left() + PADDING).with_max_x(reverting.left() - PADDING);
    let (words, colour) = match busy {
        Some(words) => (words, t.warn),
        None if let Some(words) = &inside => (words.clone(), t.warn),
        None => outcome(ui, model, (&draft, &before), read.is_some(), state),
    };
    paint::text_in(ui, room, Align2::LEFT_CENTER, &words, text::body(), colour);
    paint::name_text(ui, "outcome", room, &words).on_hover_text(&words);
    let reverted = revert.show(ui, "revert", reverting).clicked();
    let saved = if holds {
        hold_button::show(ui, saving, "Hold 1 s to save", &mut state.confirming)
    } else {
        save.show(ui, "save", saving).clicked()
    };
    if saved && let Some(station) = read {
        commands.push(UiCommand::Station(engine::Command::SaveStation(Box::new(station))));
    }
    if reverted {
        state.outcome = None;
        state.horizon.forget();
    } else {
        state.draft = Some((station, draft));
    }
}

/// Shows a page of cards, in two columns if there is room.
fn cards(ui: &mut Ui, page: Rect, title: &str, content: impl FnOnce(&mut Ui, bool)) {
    let inner = page.shrink2(vec2(PADDING, 0.0)).with_min_y(page.top() + PADDING);
    let builder = UiBuilder::new().id_salt(title).max_rect(inner);
    ui.scope_builder(builder, |ui| {
        ui.set_clip_rect(page);
        ui.label(RichText::new(title).font(text::title()));
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            content(ui, page.width() >= TWO_COLUMNS_FROM);
        });
    });
}

/// Shows the pages at the left, or above if there is no room. Returns the remaining space.
fn sections(ui: &Ui, body: Rect, state: &mut PreferencesState) -> Rect {
    let t = theme::tokens(ui);
    if body.width() < LIST_FROM {
        let (strip, page) = body.split_top_bottom_at_y(body.top() + STRIP);
        ui.painter().rect_filled(strip, 0.0, t.bg1);
        let segments = Section::ALL.map(|(word, of)| {
            (word, if of == state.section { Segment::Chosen } else { Segment::Free })
        });
        let place = strip.shrink2(vec2(PADDING, 6.0));
        let place = place.with_max_x(place.left() + 180.0 * Section::ALL.len() as f32);
        let clicked = segmented::show(ui, "preferences page", place, "Page", &segments);
        if let Some((_, section)) = clicked.and_then(|index| Section::ALL.get(index)) {
            state.section = *section;
        }
        return page;
    }
    let (list, page) = body.split_left_right_at_x(body.left() + LIST);
    ui.painter().rect_filled(list, 0.0, t.bg1);
    ui.painter().vline(list.right() - 0.5, list.y_range(), (1.0, t.line));
    let head = list.with_max_y(list.top() + FOOTER).shrink2(vec2(PADDING, 0.0));
    paint::text_in(ui, head, Align2::LEFT_CENTER, "Preferences", text::value(), t.t1);
    for (index, (word, section)) in Section::ALL.into_iter().enumerate() {
        let top = head.bottom() + 34.0 * index as f32;
        let row = Rect::from_min_size(pos2(list.left(), top), vec2(LIST, 34.0));
        let is_chosen = section == state.section;
        let response = paint::control(ui, ("page", index), row, Role::RadioButton, true, word);
        response.widget_info(|| WidgetInfo::selected(Role::RadioButton, true, is_chosen, word));
        if is_chosen {
            ui.painter().rect_filled(row, 0.0, t.bgsel);
            ui.painter().rect_filled(row.with_max_x(row.left() + 3.0), 0.0, t.sat);
        } else if response.hovered() {
            ui.painter().rect_filled(row, 0.0, t.bg3);
        }
        let room = row.shrink2(vec2(PADDING, 0.0));
        paint::text_in(ui, room, Align2::LEFT_CENTER, word, text::body(), t.t1);
        paint::focus_ring(ui, &response, 0);
        if response.clicked() {
            state.section = section;
        }
    }
    page
}

/// Reason why `after` has to wait: it would interrupt a motion by changing or removing an
/// antenna, or take away a keep-out while an antenna moves. A change that only tightens
/// never waits.
fn busy(model: &Model, before: &Station, after: &Station) -> Option<String> {
    // The simulators of the demonstration end with it.
    let mut antennas = model.antennas.iter().filter(|of| !model.demo && of.is_busy());
    let loosened = before.loosened_in(after);
    antennas.find_map(|antenna| {
        let name = &antenna.config.name;
        if !after.antennas.contains(&antenna.config) {
            return Some(format!("{name} moves or tracks. Stop it, then save."));
        }
        let loosened = loosened?;
        Some(format!("{name} moves or tracks. To loosen {loosened}, stop it, then save."))
    })
}

/// Warning for an antenna that is inside a keep-out of `after`, but was not in `before`.
fn inside(model: &Model, before: &Station, after: &Station) -> Option<String> {
    let holds_in = |station: &Station, antenna: &AntennaModel| {
        let direction = antenna.snapshot.state.measured?.direction()?;
        let half_beam = antenna.config.beam_width() * 0.5;
        let mut hold = station
            .keep_outs
            .iter()
            .filter(|of| of.entered != Entered::Warn && of.holds_for(&antenna.config.name));
        let found = hold.find(|of| of.zone.clearance(direction) < of.margin() + half_beam);
        found.map(|of| of.name.clone())
    };
    model.antennas.iter().find_map(|antenna| {
        let zone = holds_in(after, antenna)?;
        let is_new = holds_in(before, antenna).as_ref() != Some(&zone);
        let name = &antenna.config.name;
        is_new.then(|| {
            format!(
                "{name} stands inside \u{201c}{zone}\u{201d} now. It can be moved out by hand once \
                 you allow it."
            )
        })
    })
}

/// Message beside the buttons.
fn outcome(
    ui: &Ui,
    model: &Model,
    (draft, before): (&Draft, &Draft),
    usable: bool,
    state: &PreferencesState,
) -> (String, Color32) {
    let t = theme::tokens(ui);
    let edited = draft != before;
    let edits = draft.skies.edits(&before.skies);
    match (&state.outcome, edited) {
        _ if !usable => {
            let words = match &draft.skies.problems(&draft.antenna_names())[..] {
                [] => "Some fields cannot be used yet.".to_owned(),
                [only] => format!("1 field is not valid: {only}."),
                [first, others @ ..] => {
                    format!("{} fields are not valid: {first} and others.", others.len() + 1)
                }
            };
            (words, t.warn)
        }
        (Some(Err(why)), _) => (format!("Not saved: {why}."), t.bad),
        (_, true) if edits == 1 => ("1 change not saved yet.".to_owned(), t.sat),
        (_, true) if edits > 1 => (format!("{edits} changes not saved yet."), t.sat),
        (_, true) => ("Not saved yet.".to_owned(), t.sat),
        (Some(Ok(at)), _) => (format!("Saved {}.", format::time_z(*at)), t.ok),
        _ if model.demo => {
            ("Saving ends the demonstration and uses this station.".to_owned(), t.t2)
        }
        _ => ("Nothing to save.".to_owned(), t.t3),
    }
}
