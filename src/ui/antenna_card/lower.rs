//! What stands below the mode, and scrolls where there is no room: what is
//! tracked, moving by hand, the other antennas, and what the unit tells. In a
//! low window each part folds to one line with what matters most in it.

use egui::{Align2, Rect, Ui, pos2};

use super::{
    CardAction, CardModel, CardState, Cursor, drive, faults, more, others, readings, track,
};
use crate::ui::{
    text, theme,
    widgets::{
        axes_table,
        fold::{self, FoldModel},
        paint,
        travel_gauge::{self, TravelModel},
    },
};

/// Everything below the mode.
pub(super) fn show(
    ui: &mut Ui,
    card: Rect,
    at: &mut Cursor,
    model: &CardModel<'_>,
    state: &mut CardState,
    actions: &mut Vec<CardAction>,
    short: bool,
) {
    let typed = state.drive.go_to.previewed();
    track::show(ui, at, model.track.as_ref(), typed, &mut state.track, actions);
    at.skip(if short { 8.0 } else { 12.0 });
    drive::show(ui, at, &model.drive, &mut state.drive, actions, short);
    at.skip(4.0);
    let line =
        |y: f32| Rect::from_min_max(pos2(card.left(), y), pos2(card.right(), y + fold::HEIGHT));
    if short && !model.travel.is_empty() {
        let value = travel_in_words(model.travel);
        let travel_line = FoldModel { title: "Travel", value: &value, mark: None };
        fold::show(ui, line(at.y), &travel_line, &mut state.travel_open);
        at.skip(fold::HEIGHT);
        if state.travel_open {
            travel(ui, at, model.travel, false);
            at.skip(4.0);
        }
    }
    if let Some(checks) = &model.faults {
        if short {
            let (value, mark) = faults::in_words(ui, checks);
            let faults_line = FoldModel { title: "Faults", value: &value, mark: Some(mark) };
            fold::show(ui, line(at.y), &faults_line, &mut state.faults_open);
            at.skip(fold::HEIGHT);
        }
        if !short || state.faults_open {
            faults::show(ui, at, card, checks);
        }
    }
    others::show(ui, at, card, model.others, short, actions);
    let told = model.readings;
    if short && !told.is_empty() {
        let (value, mark) = readings::in_words(ui, told);
        let told_line = FoldModel { title: "Readings", value: &value, mark };
        fold::show(ui, line(at.y), &told_line, &mut state.readings_open);
        at.skip(fold::HEIGHT);
    }
    if !told.is_empty() && (!short || state.readings_open) {
        readings::show(ui, at, told, !short);
    }
    if !model.more.actions.is_empty() {
        let value = more::in_words(&model.more);
        let more_line = FoldModel { title: "More", value: &value, mark: None };
        fold::show(ui, line(at.y), &more_line, &mut state.more_open);
        at.skip(fold::HEIGHT);
        if state.more_open {
            more::show(ui, at, &model.more, &mut state.more, actions);
        }
    }
}

pub(super) fn travel(ui: &Ui, at: &mut Cursor, axes: &[TravelModel<'_>], with_head: bool) {
    let t = theme::tokens(ui);
    if with_head {
        let head = at.take(18.0);
        let words = "Travel, as the unit reports it";
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

/// The travel in words, if all axes have the same.
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
            let deg = axis.position_deg.map_or_else(
                || axes_table::UNKNOWN.to_owned(),
                |deg| format!("{deg:.1}°").replace('-', "−"),
            );
            let limit = if axis.lower_limit || axis.upper_limit { " limit" } else { "" };
            format!("{} {deg}{limit}", axis.name)
        })
        .collect();
    words.join("  ")
}
