//! A table with recent statistics of each link.

use egui::{Align2, Color32, Rect, Ui, vec2};

use super::{PADDING, tally::Tally};
use crate::ui::{format, text, theme, widgets::paint};

const ROW: f32 = 22.0;
/// Max number of antennas in the table.
const MAX: usize = 6;
/// Width of a column with a number, points.
const NUMBER: f32 = 58.0;

/// Returns the height of the table for this number of antennas, points.
pub(super) fn height(antennas: usize) -> f32 {
    (antennas.min(MAX) + 1) as f32 * ROW + 2.0 * PADDING
}

pub(super) fn show(ui: &Ui, rect: Rect, tallies: &[Tally]) {
    let t = theme::tokens(ui);
    ui.painter().rect_filled(rect, 0.0, t.bg1);
    ui.painter().hline(rect.x_range(), rect.top() + 0.5, (1.0, t.line));
    ui.painter().vline(rect.left() + 0.5, rect.y_range(), (1.0, t.line));
    let inner = rect.shrink(PADDING);
    let row = |index: usize| {
        let min = inner.left_top() + vec2(0.0, index as f32 * ROW);
        Rect::from_min_size(min, vec2(inner.width(), ROW))
    };
    let head = ["lines", "bad", "missing", "median"].map(|word| (word.to_owned(), t.t3));
    show_row(ui, row(0), ("Last 10 min", t.t3), &head);
    for (index, tally) in tallies.iter().take(MAX).enumerate() {
        let count = |count: usize| format::number(count as f64, 0);
        let at_worst = |number: usize, colour| if number > 0 { colour } else { t.t2 };
        let median = tally.median.map_or_else(
            || "\u{2013}".to_owned(),
            |median| format!("{} ms", format::number(median.as_secs_f64() * 1000.0, 0)),
        );
        let cells = [
            (count(tally.lines), t.t2),
            (count(tally.bad), at_worst(tally.bad, t.bad)),
            (count(tally.missing), at_worst(tally.missing, t.warn)),
            (median, t.t2),
        ];
        let words: Vec<&str> = cells.iter().map(|(words, _)| words.as_str()).collect();
        let place = row(index + 1);
        show_row(ui, place, (&tally.antenna, t.t1), &cells);
        let [lines, bad, missing, median] = words.as_slice() else { continue };
        let name = format!(
            "{}, last 10 min: {lines} lines, {bad} bad, {missing} missing, median {median}",
            tally.antenna
        );
        paint::name_text(ui, ("tally", index), place, &name);
    }
}

fn show_row(ui: &Ui, rect: Rect, (name, colour): (&str, Color32), cells: &[(String, Color32)]) {
    let numbers = rect.right() - NUMBER * cells.len() as f32;
    let room = rect.with_max_x(numbers);
    paint::text_in(ui, room, Align2::LEFT_CENTER, name, text::small(), colour);
    for (index, (words, colour)) in cells.iter().enumerate() {
        let right = numbers + NUMBER * (index + 1) as f32;
        let cell = rect.with_min_x(right - NUMBER).with_max_x(right);
        paint::text_in(ui, cell, Align2::RIGHT_CENTER, words, text::small(), *colour);
    }
}
