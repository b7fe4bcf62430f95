//! The tracked and the selected satellite, and the holds before tracking.

use egui::{Align2, Rect, Ui, pos2, vec2};

use super::{
    CardAction, Cursor,
    follow::{self, FollowChoice, FollowModel},
};
use crate::{
    contract::driver::Intent,
    ui::{
        icons::{self, Icon},
        text, theme,
        widgets::{
            button::{self, Button},
            go_to::Target,
            hold_button::{self, HoldState},
            paint,
        },
    },
};

/// Content for a unit that can track.
#[derive(Debug, Clone, Copy, Default)]
pub struct TrackModel<'a> {
    /// Caption of the satellite on the left.
    pub head: &'a str,
    /// The satellite whose elements the unit holds, or what program track follows; or that there
    /// is none, or that it was not read yet.
    pub held: &'a str,
    /// The satellite that is selected in the window.
    pub selected: Option<&'a str>,
    /// The antenna tracks the selected satellite now.
    pub tracks_selected: bool,
    /// The reason why the selected satellite cannot be tracked.
    pub refusal: Option<&'a str>,
    /// The reason why the unit would miss the selected satellite; tracking then takes a hold.
    pub misses: Option<&'a str>,
    /// The reason why nothing of the selected pass is left for the antenna.
    pub nothing_left: Option<&'a str>,
    /// A further note on how the unit tracks.
    pub note: Option<&'a str>,
    /// The unit starts passes by itself; none if it cannot.
    pub auto_track: Option<bool>,
    /// Park position of the antenna in words.
    pub parks_at: &'a str,
    /// Target of the track that parking would end.
    pub ends: Option<&'a str>,
    /// Other targets for program track, if any.
    pub follow: Option<FollowModel<'a>>,
}

/// Minimum width of the satellite on the left.
const MIN_HELD: f32 = 88.0;

/// Open questions.
#[derive(Debug, Clone, Copy, Default)]
pub struct TrackState {
    parking: bool,
    /// The Sun was chosen and waits for a hold.
    asks_sun: bool,
    hold: HoldState,
    tracking: HoldState,
}

/// Requests a mode at once, except for Park, which takes a hold.
pub(super) fn mode_clicked(mode: Intent, state: &mut TrackState, actions: &mut Vec<CardAction>) {
    state.parking = mode == Intent::Park;
    state.asks_sun = false;
    state.hold = HoldState::default();
    if mode != Intent::Park {
        actions.push(CardAction::SetMode(mode));
    }
}

/// Shows the tracked and the selected satellite, or a question in their place.
pub(super) fn row(
    ui: &Ui,
    at: &mut Cursor,
    model: Option<&TrackModel<'_>>,
    typed: Option<Target>,
    state: &mut TrackState,
    actions: &mut Vec<CardAction>,
) {
    let Some(model) = model else { return };
    at.skip(8.0);
    let mut row = at.take(button::HEIGHT);
    if let Some(question) = state.question(model) {
        return question_row(ui, row, question, model.ends, state, actions);
    }
    let key = row.with_min_x(row.right() - follow::WIDTH);
    let follow = model.follow.as_ref().filter(|_| model.refusal.is_none());
    if follow.is_some() {
        row.max.x -= follow::WIDTH + 4.0;
    }
    satellite_row(ui, row, model, &mut state.tracking, actions);
    if let Some(follow) = follow {
        follow::show(ui, key, follow, typed, &mut state.asks_sun, actions);
    }
}

/// Shows the notes on tracking, and the switch for automatic starting, `is_locked` or not. A refusal
/// equal to `said` is left out, as it is shown above.
pub(super) fn notes(
    ui: &Ui,
    at: &mut Cursor,
    model: Option<&TrackModel<'_>>,
    said: Option<&str>,
    is_locked: bool,
    state: &TrackState,
    actions: &mut Vec<CardAction>,
) {
    // An open question is about something else.
    let Some(model) = model.filter(|model| state.question(model).is_none()) else { return };
    if let Some(refusal) = model.refusal.filter(|refusal| Some(*refusal) != said) {
        caution_row(ui, at, "track refusal", refusal);
    }
    let cautions = [
        ("nothing left", model.nothing_left),
        ("misses", model.misses),
        ("track note", model.note),
    ];
    for (salt, words) in cautions {
        if let Some(words) = words.filter(|_| model.refusal.is_none()) {
            caution_row(ui, at, salt, words);
        }
    }
    if let Some(on) = model.auto_track {
        at.skip(4.0);
        let row = at.take(button::SMALL_HEIGHT);
        auto_track_row(ui, row, on, is_locked, actions);
    }
}

/// A request that takes a hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Question {
    Park,
    Sun,
}

impl TrackModel<'_> {
    fn sun_avoidance(&self) -> Option<&str> {
        self.follow.as_ref().filter(|_| self.refusal.is_none())?.sun_avoidance
    }
}

impl TrackState {
    /// The note on the open question, if any: the park position, or following the Sun.
    pub(super) fn about_the_question<'a>(&self, model: &'a TrackModel<'_>) -> Option<&'a str> {
        match self.question(model)? {
            Question::Park => Some(model.parks_at),
            Question::Sun => model.sun_avoidance(),
        }
    }

    fn question(&self, model: &TrackModel<'_>) -> Option<Question> {
        let sun = (self.asks_sun && model.sun_avoidance().is_some()).then_some(Question::Sun);
        self.parking.then_some(Question::Park).or(sun)
    }
}

fn question_row(
    ui: &Ui,
    row: Rect,
    question: Question,
    ends: Option<&str>,
    state: &mut TrackState,
    actions: &mut Vec<CardAction>,
) {
    let (words, action) = match question {
        Question::Park => ("Hold 1 s to park", CardAction::SetMode(Intent::Park)),
        Question::Sun => ("Hold 1 s to follow the Sun", CardAction::Follow(FollowChoice::IntoSun)),
    };
    let words = match ends {
        Some(name) => format!("{words}, ending {name}"),
        None => words.to_owned(),
    };
    let cancel = Button::quiet("Cancel");
    let split = row.right() - cancel.width(ui);
    let hold = row.with_max_x(split - 8.0);
    if hold_button::show(ui, hold, &words, &mut state.hold) {
        actions.push(action);
        *state = TrackState::default();
    }
    if cancel.show(ui, "cancel question", row.with_min_x(split)).clicked() {
        *state = TrackState::default();
    }
}

/// Shows the unit's satellite on the left, and on the right the selected one or the button
/// to track it.
fn satellite_row(
    ui: &Ui,
    row: Rect,
    model: &TrackModel<'_>,
    hold: &mut HoldState,
    actions: &mut Vec<CardAction>,
) {
    let misses = model.misses.is_some() && model.refusal.is_none();
    let selected = model.selected.filter(|_| !model.tracks_selected);
    let words = selected.map(|selected| format!("Track {selected}")).unwrap_or_default();
    let button = if model.nothing_left.is_some() { Button::normal } else { Button::primary };
    let button = button(&words).locked(model.refusal.is_some());
    let held_width = match selected {
        // The text on the hold button is long.
        Some(_) if misses => 0.36 * row.width(),
        Some(_) => (row.width() - button.width(ui)).clamp(MIN_HELD, 0.45 * row.width()),
        None => 0.45 * row.width(),
    };
    let held = row.with_max_x(row.left() + held_width - 8.0);
    two_lines(ui, "held", held, Align2::LEFT_CENTER, model.head, model.held);
    let rest = row.with_min_x(held.right() + 8.0);
    let Some(selected) = selected else {
        let name = model.selected.unwrap_or("none");
        let head = if model.selected.is_some() { "Selected and tracked" } else { "Selected" };
        two_lines(ui, "selected", rest, Align2::RIGHT_CENTER, head, name);
        return;
    };
    if misses {
        if hold_button::show(ui, rest, "Hold 1 s to track anyway", hold) {
            actions.push(CardAction::TrackAnyway);
        }
        return;
    }
    let whole = button.width(ui);
    let width = whole.min(rest.width());
    let mut response = button.show(ui, "track", row.with_min_x(row.right() - width));
    if width < whole {
        response = response.on_hover_text(selected);
    }
    if response.clicked() {
        actions.push(CardAction::TrackSelected);
    }
}

/// Shows a small caption over a name.
fn two_lines(ui: &Ui, salt: &str, room: Rect, anchor: Align2, head: &str, name: &str) {
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
fn caution_row(ui: &Ui, at: &mut Cursor, salt: &str, words: &str) {
    let t = theme::tokens(ui);
    let start = at.at() + vec2(20.0, 2.0);
    let taken = paint::paragraph(ui, start, at.width() - 20.0, words, text::small(), t.warn);
    let glyph = paint::square(pos2(at.left + 7.0, taken.top() + 8.0), 13.0);
    icons::paint(ui.painter(), glyph, Icon::Warning, t.warn);
    paint::name_text(ui, salt, taken, words);
    at.y = taken.bottom();
}

fn auto_track_row(ui: &Ui, row: Rect, on: bool, is_locked: bool, actions: &mut Vec<CardAction>) {
    let t = theme::tokens(ui);
    let (state, word) =
        if on { ("Auto-track: on", "Switch off") } else { ("Auto-track: off", "Switch on…") };
    paint::text(ui, row.left_center(), Align2::LEFT_CENTER, state, text::small(), t.t2);
    let button = Button::normal(word).locked(is_locked);
    let place = row.with_min_x(row.right() - button.width(ui));
    let said = Rect::from_min_max(row.min, pos2(place.left() - 8.0, row.bottom()));
    paint::name_text(ui, "auto-track state", said, state);
    let response = button.show(ui, "auto-track", place);
    let said = format!("Auto-track: {}", if on { "switch off" } else { "switch on" });
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, !is_locked, &said));
    if response.clicked() {
        actions.push(CardAction::SetAutoTrack(!on));
    }
}
