//! The title and the legend of the strip.

use egui::{Align2, Color32, Rect, Shape, Stroke, StrokeKind, Ui, pos2};

use super::{MARGIN, State, TimelineModel};
use crate::{
    model::plan::Standing,
    ui::{
        text::{self, Weight},
        theme,
        widgets::paint,
    },
};

const MARK: f32 = 10.0;
const MARK_GAP: f32 = 8.0;
const ENTRY_GAP: f32 = 20.0;

#[derive(Debug, Clone, Copy)]
enum Mark {
    Filled,
    Done,
    Outline,
    Dashed,
    Triangle,
}

/// Entries from right to left; those without room beside the title are left out, from the
/// left.
fn legend(model: &TimelineModel<'_>) -> Vec<(Mark, &'static str)> {
    let lost = (Mark::Triangle, "seconds lost");
    if !model.is_planned {
        let filled = (Mark::Filled, "trackable, height = max elevation");
        return vec![lost, (Mark::Outline, "not possible"), filled];
    }
    let bars = || model.lanes.iter().flat_map(|lane| &lane.bars);
    let flown = |is_missed: bool| {
        bars().any(|bar| match bar.state {
            State::Plan(Standing::Flown(flown)) => flown.cause.is_some() == is_missed,
            _ => false,
        })
    };
    let missed = flown(true).then_some((Mark::Dashed, "missed"));
    let done = flown(false).then_some((Mark::Done, "done"));
    let always = [lost, (Mark::Outline, "left out")];
    let planned = (Mark::Filled, "planned, height = max elevation");
    always.into_iter().chain(missed).chain(done).chain([planned]).collect()
}

/// Shows the head line in `rect`.
pub(super) fn show(ui: &Ui, rect: Rect, title: &str, model: &TimelineModel<'_>) {
    let t = theme::tokens(ui);
    let at = pos2(rect.left() + MARGIN, rect.center().y);
    let font = text::sized(13.0, Weight::SemiBold);
    let title = paint::text(ui, at, Align2::LEFT_CENTER, title, font, t.t1);
    let mut right = rect.right() - MARGIN;
    for (mark, words) in legend(model) {
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
        Mark::Done => {
            ui.painter().rect_filled(rect, 0, t.t3);
        }
        Mark::Dashed => {
            paint::dashed_border(ui, rect, 0.0, Stroke::new(1.0, t.bad));
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
