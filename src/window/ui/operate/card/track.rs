//! Tracked and selected satellite, and the holds before tracking.

use egui::{Align2, Rect, Ui, pos2, vec2};

use super::{
    Card, CardState, Cursor,
    follow::{self, follow_into_sun},
    modes, show_remark,
};
use crate::{
    astro::time::seconds_between,
    contract::{
        self,
        antenna::AntennaModel,
        driver::{Command, Intent},
        passes::PredictedPass,
    },
    model::{Model, UiCommand},
    plan::pass_report::Explained,
    ui::{
        format,
        icons::Icon,
        operate::passes,
        state_sentence::short,
        text, theme,
        widgets::{
            button::{self, Button},
            hold_button::{self, HoldState},
            paint,
        },
        words,
    },
};

/// Min width of the satellite on the left, points.
const MIN_CURRENT_WIDTH: f32 = 88.0;

/// Open questions about the track.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct TrackState {
    asks_park: bool,
    /// Flag: the operator chose the Sun, which still takes a hold.
    asks_sun: bool,
    question_hold: HoldState,
    track_hold: HoldState,
}

/// Request that takes a hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Question {
    Park,
    Sun,
}

impl TrackState {
    /// Opens the question about parking, or drops the open questions.
    pub(super) fn ask_to_park(&mut self, parking: bool) {
        (self.asks_park, self.asks_sun, self.question_hold) =
            (parking, false, HoldState::default());
    }

    /// Returns the note on the open question: the park position, or following the Sun.
    pub(super) fn question_note(&self, card: &Card<'_>) -> Option<String> {
        match self.question(card)? {
            Question::Park => Some(words::parks_at(card.antenna)),
            Question::Sun => sun_avoidance(card),
        }
    }

    fn question(&self, card: &Card<'_>) -> Option<Question> {
        if !offers_track(card.antenna) {
            return None;
        }
        let sun = (self.asks_sun && sun_avoidance(card).is_some()).then_some(Question::Sun);
        self.asks_park.then_some(Question::Park).or(sun)
    }
}

fn offers_track(antenna: &AntennaModel) -> bool {
    modes::offers(antenna.variant().capabilities, Intent::Track)
}

/// Returns `true` if the operator may request a program track.
fn can_follow(card: &Card<'_>) -> bool {
    card.antenna.variant().capabilities.takes_positions && card.locks.track.is_none()
}

/// Returns a sentence about the Sun avoidance that following the Sun lifts.
fn sun_avoidance(card: &Card<'_>) -> Option<String> {
    let sun = card.model.station.sun_avoidance.filter(|_| can_follow(card))?;
    Some(words::sun_lifted(&card.antenna.config.name, sun.radius_deg))
}

/// Tracks the selected pass. With `is_agreed`, tracks it although the unit would miss it.
pub(super) fn track_selected(card: &mut Card<'_>, is_agreed: bool) {
    let antenna = card.antenna.id();
    let pass = card.model.selected_pass().map(PredictedPass::key);
    let track = |pass| contract::Command::Track { antenna, pass, is_agreed };
    card.commands.extend(pass.map(track).map(UiCommand::Station));
}

/// Shows the tracked and the selected satellite, or a question in their place.
pub(super) fn show_row(ui: &Ui, cursor: &mut Cursor, card: &mut Card<'_>, state: &mut CardState) {
    if !offers_track(card.antenna) {
        return;
    }
    cursor.skip(8.0);
    let mut row = cursor.take(button::HEIGHT);
    if let Some(question) = state.track.question(card) {
        return show_question(ui, row, question, card, &mut state.track);
    }
    let key = row.with_min_x(row.right() - follow::WIDTH);
    let can_follow = can_follow(card);
    if can_follow {
        row.max.x -= follow::WIDTH + 4.0;
    }
    show_satellites(ui, row, card, &mut state.track.track_hold);
    if can_follow {
        let go_to_target = state.drive.go_to.previewed();
        follow::show(ui, key, card, go_to_target, &mut state.track.asks_sun);
    }
}

/// Shows the notes on tracking, and the switch for automatic starting. Leaves out a refusal that
/// already appears above as the lock of the jog.
pub(super) fn show_notes(ui: &Ui, cursor: &mut Cursor, card: &mut Card<'_>, state: &TrackState) {
    let (model, antenna) = (card.model, card.antenna);
    // Show no notes during a question, which has another subject.
    if !offers_track(antenna) || state.question(card).is_some() {
        return;
    }
    if let Some(refusal) = card.locks.track {
        if card.locks.jog != Some(refusal) {
            show_caution(ui, cursor, "track refusal", refusal);
        }
    } else {
        let cautions = [
            ("nothing left", passes::nothing_left(model, antenna)),
            ("misses", miss_warning(model, antenna)),
            ("track note", track_note(model, antenna)),
        ];
        for (salt, words) in cautions {
            if let Some(words) = words {
                show_caution(ui, cursor, salt, &words);
            }
        }
    }
    let program = antenna.snapshot.state.program.filter(|_| antenna.snapshot.link.is_open());
    if let Some(is_on) = program.and_then(|program| program.auto) {
        cursor.skip(4.0);
        let row = cursor.take(button::SMALL_HEIGHT);
        show_auto_track(ui, row, is_on, card);
    }
}

/// Returns the reason why the unit would miss the selected satellite.
fn miss_warning(model: &Model, antenna: &AntennaModel) -> Option<String> {
    let (miss, selected) = (antenna.misses()?, model.selected_pass()?);
    let name = selected.satellite.short_name();
    let reason = words::would_miss(name, miss, model.now, model.appearance.distances);
    Some(format!("{reason} Follow it from here instead."))
}

/// Returns a further note on how the unit tracks.
fn track_note(model: &Model, antenna: &AntennaModel) -> Option<String> {
    if antenna.snapshot.sun_lifted {
        return Some(words::SUN_IS_LIFTED.to_owned());
    }
    let half_beam_deg = antenna.config.beam_width_deg / 2.0;
    let off_deg = antenna.error().map(|error| error.off_beam.degrees());
    // The search for a cause covers minutes, so it may report an error that is over.
    let is_over = |explained: &&Explained| {
        explained.error_deg > half_beam_deg && off_deg.is_some_and(|deg| deg <= half_beam_deg)
    };
    let explained = antenna.explained.as_ref().filter(|explained| !is_over(explained));
    let explained = explained.and_then(|explained| words::record::explained(explained, model.now));
    let Some(found) = antenna.supervision() else { return explained };
    let lowest_deg = antenna.config.limits.minimum_elevation_deg;
    let lower = found.lower_minimum_deg.map(|deg| words::lower_minimum(deg, lowest_deg));
    // Beside a larger error, the small known error would look like its cause.
    let is_off = off_deg.is_some_and(|deg| deg > half_beam_deg);
    let small_error = words::within_beam(found, model.appearance.distances);
    let small_error = small_error.filter(|_| found.is_within_beam && !is_off);
    let sentences =
        explained.into_iter().chain(small_error).chain(lower).chain(words::not_known(found));
    let sentences: Vec<String> = sentences.collect();
    (!sentences.is_empty()).then(|| sentences.join(" "))
}

fn show_question(
    ui: &Ui,
    row: Rect,
    question: Question,
    card: &mut Card<'_>,
    state: &mut TrackState,
) {
    let words = match question {
        Question::Park => "Hold 1 s to park",
        Question::Sun => "Hold 1 s to follow the Sun",
    };
    let words = match card.antenna.tracked_name() {
        Some(name) => format!("{words}, ending {}", short(name)),
        None => words.to_owned(),
    };
    let cancel = Button::quiet("Cancel");
    let split = row.right() - cancel.width(ui);
    let hold = row.with_max_x(split - 8.0);
    if hold_button::show(ui, hold, &words, &mut state.question_hold) {
        match question {
            Question::Park => card.queue(Command::Park),
            Question::Sun => follow_into_sun(card),
        }
        *state = TrackState::default();
    }
    if cancel.show(ui, "cancel question", row.with_min_x(split)).clicked() {
        *state = TrackState::default();
    }
}

/// Shows the unit's satellite on the left. Shows the selected satellite, or the button to track it,
/// on the right.
fn show_satellites(ui: &Ui, row: Rect, card: &mut Card<'_>, hold: &mut HoldState) {
    let (model, antenna) = (card.model, card.antenna);
    let is_locked = card.locks.track.is_some();
    let chosen = model.selected_pass().map(|predicted| predicted.satellite.short_name());
    let misses = antenna.misses().is_some() && chosen.is_some() && !is_locked;
    let (current_name, tracks_selected) = current_satellite(model, antenna);
    let selected = chosen.filter(|_| !tracks_selected);
    let words = selected.map(|selected| format!("Track {selected}")).unwrap_or_default();
    let is_useless = passes::nothing_left(model, antenna).is_some();
    let button = if is_useless { Button::normal } else { Button::primary };
    let button = button(&words).locked(is_locked);
    let current_width = match selected {
        // The text on the hold button is long.
        Some(_) if misses => 0.36 * row.width(),
        Some(_) => (row.width() - button.width(ui)).clamp(MIN_CURRENT_WIDTH, 0.45 * row.width()),
        None => 0.45 * row.width(),
    };
    let current_rect = row.with_max_x(row.left() + current_width - 8.0);
    let head = current_caption(model, antenna);
    show_two_lines(ui, "held", current_rect, Align2::LEFT_CENTER, &head, current_name);
    let rest = row.with_min_x(current_rect.right() + 8.0);
    let Some(selected) = selected else {
        let name = chosen.unwrap_or("none");
        let head = if chosen.is_some() { "Selected and tracked" } else { "Selected" };
        show_two_lines(ui, "selected", rest, Align2::RIGHT_CENTER, head, name);
        return;
    };
    if misses {
        if hold_button::show(ui, rest, "Hold 1 s to track anyway", hold) {
            track_selected(card, true);
        }
        return;
    }
    let full_width = button.width(ui);
    let width = full_width.min(rest.width());
    let mut response = button.show(ui, "track", row.with_min_x(row.right() - width));
    if width < full_width {
        response = response.on_hover_text(selected);
    }
    if response.clicked() {
        track_selected(card, false);
    }
}

/// Returns the caption of the satellite on the left: its source, and the age of its reading if the
/// unit does not report it now.
fn current_caption(model: &Model, antenna: &AntennaModel) -> String {
    let snapshot = &antenna.snapshot;
    if snapshot.program_track.is_some() || !antenna.variant().capabilities.has_program {
        return "Azel follows".to_owned();
    }
    let state = &snapshot.state;
    let is_read = state.on_board.satellite.is_some();
    let last = state.last_satellite.as_ref().filter(|_| state.unreadable.is_none());
    match last {
        Some(last) if !(is_read && antenna.answers(model.steady).is_current()) => {
            let age_s = seconds_between(last.read_at, model.now).max(0.0);
            format!("On the unit {} ago", format::age(age_s))
        }
        Some(_) | None => "On the unit".to_owned(),
    }
}

/// Returns the satellite whose elements the unit holds, the target of the program track, or a
/// placeholder. Also returns `true` if the antenna tracks the selected satellite now.
fn current_satellite<'a>(model: &Model, antenna: &'a AntennaModel) -> (&'a str, bool) {
    let state = &antenna.snapshot.state;
    let selected = model.selected_pass().map(PredictedPass::number);
    let is_selected = |number: Option<u32>| number.is_some() && number == selected;
    let followed = antenna.snapshot.program_track.as_ref();
    if followed.is_some() || !antenna.variant().capabilities.has_program {
        let name = followed.map_or("nothing", |followed| short(&followed.name));
        return (name, is_selected(followed.and_then(|followed| followed.catalog_number)));
    }
    // Ignore an unreadable reply, which might look like a name.
    let is_readable = state.unreadable.is_none();
    let on_board = state.on_board.satellite.as_ref().filter(|_| is_readable);
    let last = state.last_satellite.as_ref().filter(|_| is_readable);
    let name = match on_board.map(|on_board| &on_board.name).or(last.map(|last| &last.name)) {
        None => "not read yet",
        Some(name) if name.is_empty() => "no satellite",
        Some(name) => short(name),
    };
    let number = on_board.map(|on_board| on_board.catalog_number);
    (name, is_selected(number) && is_selected(antenna.tracked_number()))
}

/// Shows a small caption over a name.
fn show_two_lines(ui: &Ui, salt: &str, room: Rect, anchor: Align2, head: &str, name: &str) {
    let t = theme::tokens(ui);
    let up = room.translate(vec2(0.0, -8.0));
    paint::text_in(ui, up, anchor, head, text::caption(), t.t3);
    let down = room.translate(vec2(0.0, 8.0));
    paint::name_in(ui, down, anchor, name, text::body_medium(), t.t1);
    let words = format!("{head}: {name}");
    let named = paint::name_text(ui, salt, room, &words);
    let fits = |words: &str, font| paint::fits(ui, words, font, room);
    if !fits(head, text::caption()) || !fits(name, text::body_medium()) {
        named.on_hover_text(words);
    }
}

/// Shows a refusal or a note.
fn show_caution(ui: &Ui, cursor: &mut Cursor, salt: &str, words: &str) {
    cursor.skip(2.0);
    show_remark(ui, cursor, salt, Icon::Warning, theme::tokens(ui).warn, words);
}

fn show_auto_track(ui: &Ui, row: Rect, is_on: bool, card: &mut Card<'_>) {
    let (t, is_locked) = (theme::tokens(ui), card.model.replay.is_some());
    let (state, word) =
        if is_on { ("Auto-track: on", "Switch off") } else { ("Auto-track: off", "Switch on…") };
    paint::text(ui, row.left_center(), Align2::LEFT_CENTER, state, text::small(), t.t2);
    let button = Button::normal(word).locked(is_locked);
    let place = row.with_min_x(row.right() - button.width(ui));
    let state_rect = Rect::from_min_max(row.min, pos2(place.left() - 8.0, row.bottom()));
    paint::name_text(ui, "auto-track state", state_rect, state);
    let response = button.show(ui, "auto-track", place);
    let name = format!("Auto-track: {}", if is_on { "switch off" } else { "switch on" });
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, !is_locked, &name));
    if response.clicked() {
        card.queue(Command::AutoTrack(!is_on));
    }
}
