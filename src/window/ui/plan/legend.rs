//! The legend of the lanes.

use egui::{Align2, Rect, Shape, Stroke, StrokeKind, Ui, Vec2, pos2, vec2};

use crate::ui::{
    pass_bar::{self, BarForm},
    text, theme,
    tokens::Tokens,
    widgets::paint,
};

const MARK: Vec2 = vec2(14.0, 10.0);
const MARK_GAP: f32 = 6.0;
const ENTRY_GAP: f32 = 16.0;

/// Function that paints the mark of an entry.
type Mark = fn(&Ui, Rect, &Tokens);

/// Entries of the legend from right to left. The legend leaves out the leftmost entries if space is
/// short.
const ENTRIES: [(Mark, &str); 6] = [
    (|ui, rect, _| pass_bar::paint(ui, rect, BarForm::Missed), "missed"),
    (|ui, rect, _| pass_bar::paint(ui, rect, BarForm::Done), "done"),
    (|ui, rect, _| pass_bar::paint(ui, rect, BarForm::Proved), "verified"),
    (|ui, rect, _| pass_bar::paint(ui, rect, BarForm::Sent), "sent"),
    (
        |ui, rect, t| {
            let line = [rect.left_center(), rect.right_center()];
            ui.painter().extend(Shape::dotted_line(&line, t.t3, 5.0, 0.75));
        },
        "waits",
    ),
    (
        |ui, rect, t| {
            let stroke = Stroke::new(1.0, t.cmd);
            ui.painter().rect_stroke(rect, 0.0, stroke, StrokeKind::Inside);
            ui.painter().line_segment([rect.left_bottom(), rect.right_top()], stroke);
        },
        "slew",
    ),
];

/// Shows the entries that fit at the right of `rect`.
pub(super) fn show(ui: &Ui, rect: Rect) {
    let t = theme::tokens(ui);
    let mut right = rect.right();
    for (mark, words) in ENTRIES {
        let left = right - MARK.x - MARK_GAP - paint::text_width(ui, words, text::small());
        if left < rect.left() {
            return;
        }
        let middle = pos2(left + MARK.x / 2.0, rect.center().y);
        mark(ui, Rect::from_center_size(middle, MARK), t);
        let position = pos2(left + MARK.x + MARK_GAP, rect.center().y);
        paint::text(ui, position, Align2::LEFT_CENTER, words, text::small(), t.t2);
        right = left - ENTRY_GAP;
    }
}
