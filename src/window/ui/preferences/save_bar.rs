//! The bar below all pages: the conditions for saving, the changes and the buttons.

use egui::{Align2, Color32, Key, Modifiers, Rect, Ui, pos2, vec2};

use super::{PADDING, PreferencesState, checks::Checks, draft::Draft, page::Page};
use crate::{
    contract,
    model::{Model, UiCommand},
    station::Station,
    ui::{
        format,
        icons::{self, Icon},
        replay, text, theme,
        tokens::Tokens,
        widgets::{
            button::{self, Button},
            hold_button, paint,
            status_line::Tone,
        },
    },
};

const ENDS_THE_DEMO: &str = "Saving ends the demo and uses this station.";
const SAVE_IN_DEMO: &str = "Save and end the demo";
/// Height of a line, points.
const LINE: f32 = 20.0;
/// Max number of checks shown, one per line.
const LINES: usize = 3;
/// Min width of the outcome, points.
const MIN_WIDTH: f32 = 110.0;
/// Width of the button that the operator must hold, points.
const HOLD: f32 = 150.0;

pub(super) fn height(is_small: bool) -> f32 {
    if is_small { 48.0 } else { 84.0 }
}

/// Shows the bar. Returns `true` when the operator discards the edits.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    model: &Model,
    station: &Station,
    (draft, before): (&Draft, &Draft),
    state: &mut PreferencesState,
    commands: &mut Vec<UiCommand>,
) -> bool {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().hline(rect.x_range(), rect.top() + 0.5, (1.0, t.line));
    let read = draft.read();
    let is_edited = draft != before;
    let checks = Checks::new(model, station, read.as_ref(), (draft, before));
    // The operator can replace the demo station with the proposed settings, if the page edits the
    // station.
    let replaces_demo = model.demo && !state.page.is_used_at_once();
    let lock = replay::lock(model);
    let is_free = checks.busy.is_none() && lock.is_none();
    let can_save = read.is_some() && (is_edited || replaces_demo) && is_free;
    let holds = can_save && checks.barrier_problem.is_some();
    let save = if is_edited { Button::primary } else { Button::normal };
    let save = save(if model.demo { SAVE_IN_DEMO } else { "Save and use" })
        .locked(!can_save)
        .locked_by(lock);
    let revert = Button::normal("Revert").locked(!is_edited);
    // The button keeps its place when the demo ends.
    let width = if holds { HOLD } else { Button::primary(SAVE_IN_DEMO).width(ui) };
    let right = rect.right_center() - vec2(PADDING, 0.0);
    let [reverting, saving] = button::row(right, [revert.width(ui), width]);
    let room = rect.with_min_x(rect.left() + PADDING).with_max_x(reverting.left() - PADDING);
    let outcome_text = outcome(ui, model, (draft, before), state);
    lines(ui, room, &checks, outcome_text, can_save && !holds);

    let is_reverted = revert.show(ui, "revert", reverting).clicked();
    let is_pressed = if holds {
        hold_button::show(ui, saving, "Hold 1 s to save", &mut state.confirming)
    } else {
        let shown = save.show(ui, "save", saving);
        let shown = if lock.is_none() { shown.on_hover_text("Ctrl Enter") } else { shown };
        // Enter in a dialog belongs to the dialog.
        let is_free = ui.memory(|memory| memory.top_modal_layer().is_none());
        let enter = || ui.input_mut(|input| input.consume_key(Modifiers::COMMAND, Key::Enter));
        shown.clicked() || (is_free && enter() && can_save)
    };
    if is_pressed && let Some(station) = read {
        commands.push(UiCommand::Station(contract::Command::SaveStation(Box::new(station))));
    }
    is_reverted
}

/// Shows the checks at the left of `room` and the outcome at its right. A low bar shows only the
/// most severe check, or else the outcome.
fn lines(
    ui: &Ui,
    room: Rect,
    checks: &Checks,
    (spoken, colour): (String, Color32),
    can_save: bool,
) {
    let t = theme::tokens(ui);
    if room.height() < LINE * (LINES + 1) as f32 {
        // A passed check does not hide the effect of saving.
        let first = checks.lines.first();
        let gravest = first.filter(|(tone, _)| *tone != Tone::Good);
        let (tone, words) = gravest.map_or((Tone::Plain, &spoken), |(tone, words)| (*tone, words));
        let (mark, ink) = look(tone, t);
        let words_at = if mark.is_some() { room.with_min_x(room.left() + LINE) } else { room };
        if let Some(mark) = mark {
            let rect = paint::square(room.left_center() + vec2(7.0, 0.0), 13.0);
            icons::paint(ui.painter(), rect, mark, ink);
        }
        let ink = if mark.is_some() { ink } else { colour };
        paint::text_in(ui, words_at, Align2::LEFT_CENTER, words, text::small(), ink);
        let whole = first.map_or_else(|| spoken.clone(), |(_, first)| format!("{first} {spoken}"));
        paint::name_text(ui, "outcome", room, &whole).on_hover_text(&whole);
        return;
    }
    let width = paint::text_width(ui, &spoken, text::body_medium()).max(MIN_WIDTH);
    let (left, right) = room.split_left_right_at_x((room.right() - width).max(room.center().x));
    paint::text_in(ui, right, Align2::RIGHT_CENTER, &spoken, text::body_medium(), colour);
    if can_save {
        let below = right.translate(vec2(0.0, LINE));
        let words = "Ctrl Enter saves";
        paint::text_in(ui, below, Align2::RIGHT_CENTER, words, text::caption(), t.t3);
    }
    let named = paint::name_text(ui, "outcome", right, &spoken);
    if !paint::fits(ui, &spoken, text::body_medium(), right) {
        named.on_hover_text(&spoken);
    }
    if checks.lines.is_empty() {
        return;
    }
    let mut top = first_line(left, checks.lines.len().min(LINES));
    let mut row = || {
        let row = Rect::from_min_size(pos2(left.left(), top), vec2(left.width() - PADDING, LINE));
        top += LINE;
        row
    };
    let head = row();
    paint::text_in(ui, head, Align2::LEFT_CENTER, "Before saving", text::body_medium(), t.t1);
    for (index, (tone, words)) in checks.lines.iter().take(LINES).enumerate() {
        let row = row();
        let (mark, ink) = look(*tone, t);
        if let Some(mark) = mark {
            let rect = paint::square(row.left_center() + vec2(7.0, 0.0), 13.0);
            icons::paint(ui.painter(), rect, mark, ink);
        }
        let ink = if *tone == Tone::Good { t.t1 } else { ink };
        let place = row.with_min_x(row.left() + LINE);
        let (salt, left) = (("check", index), Align2::LEFT_CENTER);
        paint::named_text_in(ui, salt, place, left, words, text::small(), ink);
    }
}

/// Returns the top of `lines` lines below their head, centred in `room`.
fn first_line(room: Rect, lines: usize) -> f32 {
    room.center().y - LINE * (lines + 1) as f32 / 2.0
}

fn look(tone: Tone, t: &Tokens) -> (Option<Icon>, Color32) {
    match tone {
        Tone::Plain | Tone::Now => (None, t.t2),
        Tone::Good => (Some(Icon::Check), t.ok),
        Tone::Caution => (Some(Icon::Warning), t.warn),
        Tone::Bad => (Some(Icon::Cross), t.bad),
    }
}

/// Returns the changes, or the result of the last save.
fn outcome(
    ui: &Ui,
    model: &Model,
    (draft, before): (&Draft, &Draft),
    state: &PreferencesState,
) -> (String, Color32) {
    let t = theme::tokens(ui);
    match &state.outcome {
        Some(Err(reason)) => (format!("Not saved: {reason}."), t.bad),
        _ if draft != before && model.demo => {
            (format!("{}. {ENDS_THE_DEMO}", changes(draft, before)), t.t1)
        }
        _ if draft != before => (changes(draft, before), t.t1),
        _ if state.page.is_used_at_once() => {
            ("Changes on this page are applied at once.".to_owned(), t.t3)
        }
        Some(Ok(time)) => (format!("Saved {}.", format::moment(*time, model.now)), t.ok),
        None if model.demo => (ENDS_THE_DEMO.to_owned(), t.t2),
        None => ("Nothing to save.".to_owned(), t.t3),
    }
}

/// Returns the number of changes and the number of pages with changes.
fn changes(draft: &Draft, before: &Draft) -> String {
    let pages = Page::all(draft).into_iter();
    let counts: Vec<usize> =
        pages.map(|page| page.counts(draft, before).edited).filter(|edited| *edited > 0).collect();
    match (counts.iter().sum::<usize>(), counts.len()) {
        (0, _) => "Not saved yet".to_owned(),
        (1, _) => "1 change".to_owned(),
        (changes, 1) => format!("{changes} changes in 1 section"),
        (changes, sections) => format!("{changes} changes in {sections} sections"),
    }
}
