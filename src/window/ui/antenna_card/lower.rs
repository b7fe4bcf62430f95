//! The lower part of the card, which scrolls if there is no room: questions and notes, the other
//! antennas and the readings. In a low window each section folds to one
//! line with its most important content.

use egui::{Align2, Rect, Ui};

use super::{
    CardAction, CardModel, CardState, Cursor, LinkStatus, WayOutModel, drive, faults, holds, more,
    offsets, others, readings, released, track,
};
use crate::ui::{
    text, theme,
    widgets::{
        fold::{self, Fold, FoldModel},
        paint,
        travel_gauge::{self, TravelModel},
    },
    words,
};

/// Shows everything below the controls for moving by hand: what comes and goes, and what
/// unfolds.
pub(super) fn show(
    ui: &mut Ui,
    card: Rect,
    at: &mut Cursor,
    model: &CardModel<'_>,
    state: &mut CardState,
    actions: &mut Vec<CardAction>,
    short: bool,
) {
    if model.header.status == LinkStatus::NotConnected {
        released::about(ui, at, &model.header);
    }
    asked(ui, at, model, state, actions);
    drive::messages(ui, at, &model.drive, &state.drive);
    let said = model.drive.jog_locked;
    let is_replayed = model.header.is_replayed();
    track::notes(ui, at, model.track.as_ref(), said, is_replayed, &state.track, actions);
    if !short {
        at.skip(4.0);
    }
    if let Some(shown) = &model.offsets {
        let (value, mark) = offsets::in_words(ui, shown);
        let line = FoldModel { title: "Offsets", value: &value, mark };
        let opened = own_fold_line(ui, at, card, &line, &mut state.offsets.fold);
        if state.offsets.fold.is_open() {
            let top = at.y;
            offsets::show(ui, at, shown, &mut state.offsets, actions);
            state.offsets.fold.drawn(at.y - top);
        }
        bring_into_sight(ui, at, opened);
    }
    if short && !model.travel.is_empty() {
        let value = travel_in_words(model.travel);
        let travel_line = FoldModel { title: "Travel", value: &value, mark: None };
        let opened = fold_line(ui, at, card, &travel_line, &mut state.travel_open);
        if state.travel_open {
            travel(ui, at, model.travel, false);
            at.skip(4.0);
        }
        bring_into_sight(ui, at, opened);
    }
    if let Some(checks) = &model.faults {
        let mut opened = None;
        if short {
            let (value, mark) = faults::in_words(ui, checks);
            let faults_line = FoldModel { title: "Faults", value: &value, mark: Some(mark) };
            opened = fold_line(ui, at, card, &faults_line, &mut state.faults_open);
        }
        if !short || state.faults_open {
            faults::show(ui, at, card, checks);
        }
        bring_into_sight(ui, at, opened);
    }
    others::show(ui, at, card, model.others, short, actions);
    let told = model.readings;
    if !told.is_empty() {
        let mut opened = None;
        if short {
            let (value, mark) = readings::in_words(ui, told);
            let told_line = FoldModel { title: "Readings", value: &value, mark };
            opened = fold_line(ui, at, card, &told_line, &mut state.readings_open);
        }
        if !short || state.readings_open {
            readings::show(ui, at, told, !short);
        }
        bring_into_sight(ui, at, opened);
    }
    if !model.more.actions.is_empty() {
        let value = more::in_words(&model.more);
        let more_line = FoldModel { title: "More", value: &value, mark: None };
        let opened = own_fold_line(ui, at, card, &more_line, &mut state.more_fold);
        if state.more_fold.is_open() {
            let top = at.y;
            more::show(ui, at, &model.more, &mut state.more, actions);
            state.more_fold.drawn(at.y - top);
        }
        bring_into_sight(ui, at, opened);
    }
}

/// Opens what has room in the `free` points that are left in the card, and closes what has none.
/// Returns `true` if something changed.
pub(super) fn settle(model: &CardModel<'_>, state: &mut CardState, mut free: f32) -> bool {
    let offsets = model.offsets.is_some().then_some(&mut state.offsets.fold);
    let more = (!model.more.actions.is_empty()).then_some(&mut state.more_fold);
    let mut has_changed = false;
    for fold in offsets.into_iter().chain(more) {
        has_changed |= fold.settle(&mut free);
    }
    has_changed
}

/// Shows the hold buttons that the operator is asked to press.
fn asked(
    ui: &Ui,
    at: &mut Cursor,
    model: &CardModel<'_>,
    state: &mut CardState,
    actions: &mut Vec<CardAction>,
) {
    if let Some(words) =
        model.track.as_ref().and_then(|track| state.track.about_the_question(track))
    {
        holds::note(ui, at, words);
    }
    if let Some(why) = model.asks_standing
        && holds::show(ui, at, why, holds::SEEN_STANDING, &mut state.standing)
    {
        actions.push(CardAction::SeenStanding);
    }
    if let Some(WayOutModel { words, hold }) = model.way_out {
        match hold {
            None => holds::note(ui, at, words),
            Some(hold) if holds::show(ui, at, words, hold, &mut state.way_out) => {
                actions.push(CardAction::AllowWayOut);
            }
            Some(_) => {}
        }
    }
    if let Some(about) = model.asks_unseen
        && holds::show(ui, at, about, words::HOLD_UNSEEN, &mut state.unseen)
    {
        actions.push(CardAction::ActUnseen);
    }
    if let Some(why) = model.drive.unguarded
        && holds::show(ui, at, why, words::HOLD_UNGUARDED, &mut state.unguarded)
    {
        actions.push(CardAction::AllowUnguarded);
    }
}

/// Shows the line of a section. Returns its rectangle if the section was opened just now.
fn fold_line(
    ui: &Ui,
    at: &mut Cursor,
    card: Rect,
    model: &FoldModel<'_>,
    open: &mut bool,
) -> Option<Rect> {
    let line = at.take(fold::HEIGHT).with_min_x(card.left()).with_max_x(card.right());
    fold::show(ui, line, model, open).then_some(line)
}

/// [`fold_line`] of a section that is open where it has room.
fn own_fold_line(
    ui: &Ui,
    at: &mut Cursor,
    card: Rect,
    model: &FoldModel<'_>,
    fold: &mut Fold,
) -> Option<Rect> {
    let mut is_open = fold.is_open();
    let opened = fold_line(ui, at, card, model, &mut is_open);
    if is_open != fold.is_open() {
        fold.choose(is_open);
    }
    opened
}

/// Scrolls to an opened section, which may lie below the lower end of the card. Its line
/// stays in sight.
fn bring_into_sight(ui: &Ui, at: &Cursor, opened: Option<Rect>) {
    if let Some(line) = opened {
        let section = line.with_max_y(at.y);
        let has_room = section.height() <= ui.clip_rect().height();
        ui.scroll_to_rect(section, (!has_room).then_some(egui::Align::TOP));
    }
}

pub(super) fn travel(ui: &Ui, at: &mut Cursor, axes: &[TravelModel<'_>], with_head: bool) {
    let t = theme::tokens(ui);
    if with_head {
        let head = at.take(18.0);
        let words = "Axis travel";
        paint::text(ui, head.left_center(), Align2::LEFT_CENTER, words, text::caption(), t.t3);
        if let Some(range) = common_range(axes) {
            paint::text(
                ui,
                head.right_center(),
                Align2::RIGHT_CENTER,
                range,
                text::caption(),
                t.t3,
            );
        }
    }
    for axis in axes {
        travel_gauge::show(ui, at.take(travel_gauge::HEIGHT), axis);
    }
}

/// The travel in words, if it is the same for all axes.
fn common_range(axes: &[TravelModel<'_>]) -> Option<String> {
    let (low, high) = axes.first()?.travel_deg;
    let same = |deg: f64, other: f64| (deg - other).abs() < 0.05;
    let all = axes.iter().all(|axis| same(axis.travel_deg.0, low) && same(axis.travel_deg.1, high));
    all.then(|| format!("{low:.0}° to {high:.0}°").replace('-', "−"))
}

fn travel_in_words(axes: &[TravelModel<'_>]) -> String {
    let words: Vec<String> = axes
        .iter()
        .map(|axis| {
            let limit = if axis.lower_limit || axis.upper_limit { " limit" } else { "" };
            format!("{} {}{limit}", axis.name, axis.number())
        })
        .collect();
    words.join("  ")
}
