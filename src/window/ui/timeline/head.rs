//! The title and the legend of the strip.

use egui::{Align2, Color32, Rect, Shape, Stroke, Ui, pos2};

use super::{MARGIN, State, TimelineModel};
use crate::{
    model::plan::Standing,
    ui::{
        pass_bar::{self, BarForm},
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
    Bar(BarForm),
    Triangle,
}

/// Returns the legend entries from right to left. The strip leaves out the leftmost entries if
/// space is short.
fn legend(model: &TimelineModel<'_>) -> Vec<(Mark, &'static str)> {
    let lost = (Mark::Triangle, "part lost");
    if !model.is_planned {
        let filled = (Mark::Bar(BarForm::Planned), "trackable, height = max elevation");
        return vec![lost, (Mark::Bar(BarForm::LeftOut), "out of reach"), filled];
    }
    let bars = || model.lanes.iter().flat_map(|lane| &lane.bars);
    let flown = |is_missed: bool| {
        bars().any(|bar| match bar.state {
            State::Plan(Standing::Flown(flown)) => flown.cause.is_some() == is_missed,
            _ => false,
        })
    };
    let missed = flown(true).then_some((Mark::Bar(BarForm::Missed), "missed"));
    let done = flown(false).then_some((Mark::Bar(BarForm::Done), "done"));
    let always = [lost, (Mark::Bar(BarForm::LeftOut), "left out")];
    let planned = (Mark::Bar(BarForm::Planned), "planned, height = max elevation");
    always.into_iter().chain(missed).chain(done).chain([planned]).collect()
}

/// Shows the head line in `rect`.
pub(super) fn show(ui: &Ui, rect: Rect, title: &str, model: &TimelineModel<'_>) {
    let t = theme::tokens(ui);
    let position = pos2(rect.left() + MARGIN, rect.center().y);
    let font = text::sized(13.0, Weight::SemiBold);
    let title = paint::text(ui, position, Align2::LEFT_CENTER, title, font, t.t1);
    let mut right = rect.right() - MARGIN;
    for (mark, words) in legend(model) {
        let width = MARK + MARK_GAP + paint::text_width(ui, words, text::small());
        let left = right - width;
        if left < title.right() + ENTRY_GAP {
            return;
        }
        let middle = pos2(left + MARK / 2.0, rect.center().y);
        sign(ui, paint::square(middle, MARK), mark);
        let position = pos2(left + MARK + MARK_GAP, rect.center().y);
        paint::text(ui, position, Align2::LEFT_CENTER, words, text::small(), t.t2);
        right = left - ENTRY_GAP;
    }
}

fn sign(ui: &Ui, rect: Rect, mark: Mark) {
    match mark {
        Mark::Bar(form) => pass_bar::paint(ui, rect, form),
        Mark::Triangle => triangle(ui, rect, theme::tokens(ui).warn),
    }
}

/// Paints the sign for lost seconds: a triangle on the floor of `rect`.
pub(super) fn triangle(ui: &Ui, rect: Rect, colour: Color32) {
    let points = vec![rect.center_top(), rect.right_bottom(), rect.left_bottom()];
    ui.painter().add(Shape::convex_polygon(points, colour, Stroke::NONE));
}
