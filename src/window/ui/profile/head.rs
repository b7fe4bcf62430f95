//! The line above the plots: title and legend.

use egui::{Align2, Color32, Pos2, Rect, Stroke, Ui, pos2};

use super::{curves::DOTS, dashes};
use crate::ui::{text, theme, widgets::paint};

/// Length of a sample line before its word, points.
const SAMPLE_LENGTH: f32 = 18.0;
/// Gap between a sample line and its word, points.
const SAMPLE_GAP: f32 = 6.0;
/// Gap between two entries, points.
const ENTRY_GAP: f32 = 16.0;

/// Shows the line. Cuts the title where the legend begins.
pub(super) fn show(ui: &Ui, rect: Rect, name: &str) {
    let t = theme::tokens(ui);
    let mut right = rect.right();
    // The loop draws the entries from right to left.
    for (word, colour, dotted) in
        [("error", t.ant, false), ("azimuth", t.t2, true), ("elevation", t.sat, false)]
    {
        right = entry(ui, pos2(right, rect.center().y), word, colour, dotted) - ENTRY_GAP;
    }
    let room = rect.with_max_x(right.max(rect.left()));
    paint::text_in(
        ui,
        room,
        Align2::LEFT_CENTER,
        &format!("{name} profile"),
        text::small_strong(),
        t.t1,
    );
}

/// Paints an entry that ends at `position`. Returns its left end.
fn entry(ui: &Ui, position: Pos2, word: &str, colour: Color32, dotted: bool) -> f32 {
    let t = theme::tokens(ui);
    let words = paint::text(ui, position, Align2::RIGHT_CENTER, word, text::caption(), t.t2);
    let end = words.left() - SAMPLE_GAP;
    let start = end - SAMPLE_LENGTH;
    let line = [pos2(start, position.y), pos2(end, position.y)];
    if dotted {
        let stroke = Stroke::new(1.5, colour);
        dashes::paint(ui.painter(), &line, stroke, DOTS);
    } else {
        ui.painter().line_segment(line, (2.0, colour));
    }
    start
}
