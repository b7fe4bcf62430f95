//! The title and the legend of the strip.

use egui::{Align2, Color32, Rect, Shape, Stroke, StrokeKind, Ui, pos2};

use super::MARGIN;
use crate::ui::{
    text::{self, Weight},
    theme,
    widgets::paint,
};

const MARK: f32 = 10.0;
const MARK_GAP: f32 = 8.0;
const ENTRY_GAP: f32 = 20.0;

#[derive(Debug, Clone, Copy)]
enum Mark {
    Filled,
    Outline,
    Triangle,
}

/// Entries from right to left; those without room beside the title are left out, from the
/// left.
const LEGEND: [(Mark, &str); 3] = [
    (Mark::Triangle, "seconds lost"),
    (Mark::Outline, "not possible"),
    (Mark::Filled, "trackable, height = max elevation"),
];

/// Shows the head line in `rect`.
pub(super) fn show(ui: &Ui, rect: Rect, title: &str) {
    let t = theme::tokens(ui);
    let at = pos2(rect.left() + MARGIN, rect.center().y);
    let font = text::sized(13.0, Weight::SemiBold);
    let title = paint::text(ui, at, Align2::LEFT_CENTER, title, font, t.t1);
    let mut right = rect.right() - MARGIN;
    for (mark, words) in LEGEND {
        let width = MARK + MARK_GAP + paint::text_width(ui, words, text::small());
        let left = right - width;
        if left < title.right() + ENTRY_GAP {
            return;
        }
        let middle = pos2(left + MARK / 2.0, rect.center().y);
        sign(ui, paint::square(middle, MARK), mark);
        let at = pos2(left + MARK + MARK_GAP, rect.center().y);
        paint::text(ui, at, Align2::LEFT_CENTER, words, text::small(), t.t2);
        right = left - ENTRY_GAP;
    }
}

fn sign(ui: &Ui, rect: Rect, mark: Mark) {
    let t = theme::tokens(ui);
    match mark {
        Mark::Filled => {
            ui.painter().rect_filled(rect, 0, t.sat);
        }
        Mark::Outline => {
            ui.painter().rect_stroke(rect, 0, Stroke::new(1.0, t.other), StrokeKind::Inside);
        }
        Mark::Triangle => {
            triangle(ui, rect, t.warn);
        }
    }
}

/// Paints the sign for lost seconds: a triangle on the floor of `rect`.
pub(super) fn triangle(ui: &Ui, rect: Rect, colour: Color32) {
    let points = vec![rect.center_top(), rect.right_bottom(), rect.left_bottom()];
    ui.painter().add(Shape::convex_polygon(points, colour, Stroke::NONE));
}
