//! The bar of a pass. The shape of a bar shows its state, so that it stays readable in one hue.

use egui::{Rect, Stroke, StrokeKind, Ui};

use super::{sky_plot::geometry::hatch, theme, widgets::paint};

/// Width of the border of a pass that Azel has sent to the unit, points.
const BORDER: f32 = 2.0;
/// Width of the dark line between the border and the fill, points.
const GAP: f32 = 1.0;
/// Max share of the bar width that border and gap take at each side.
const SHARE: f32 = 0.25;
const OUTLINE: f32 = 1.0;
/// Distance between the dark lines through a pass that is over, and their width, points.
const HATCH: f32 = 3.5;
const HATCH_WIDTH: f32 = 1.25;
/// Width of the frame of a current pass, points.
const FRAME: f32 = 1.5;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum BarForm {
    Planned,
    /// A pass sent to the unit and not yet read back; its border is dashed.
    Sent,
    /// A pass read back from the unit.
    Proved,
    Running,
    /// A pass that is over; dark lines cross its bar.
    Done,
    Missed,
    LeftOut,
}

/// Paints a bar on a `bg0` background.
pub(super) fn paint(ui: &Ui, rect: Rect, form: BarForm) {
    let t = theme::tokens(ui);
    let painter = ui.painter();
    // The outline separates bars that overlap.
    let ground = || painter.rect_filled(rect.expand(OUTLINE), 0.0, t.bg0);
    let line = BORDER.min(rect.width() * SHARE);
    let fill = || {
        let inner = rect.shrink((line + GAP).min(rect.width() * SHARE));
        painter.rect_filled(inner, 0.0, t.sat);
    };
    match form {
        BarForm::Planned => {
            ground();
            painter.rect_filled(rect, 0.0, t.sat);
        }
        BarForm::Sent => {
            ground();
            fill();
            paint::dashed_border(ui, rect, 0.0, Stroke::new(line, t.cmd));
        }
        BarForm::Proved => {
            ground();
            fill();
            painter.rect_stroke(rect, 0.0, Stroke::new(line, t.ok), StrokeKind::Inside);
        }
        BarForm::Running => {
            painter.rect_filled(rect, 0.0, t.sat);
            painter.rect_stroke(rect, 0.0, Stroke::new(FRAME, t.ant), StrokeKind::Outside);
        }
        BarForm::Done => {
            ground();
            painter.rect_filled(rect, 0.0, t.t3);
            let corners =
                [rect.left_top(), rect.right_top(), rect.right_bottom(), rect.left_bottom()];
            for line in hatch(&corners, HATCH, false) {
                painter.line_segment(line, Stroke::new(HATCH_WIDTH, t.bg0));
            }
        }
        BarForm::Missed => {
            paint::dashed_border(ui, rect, 0.0, Stroke::new(OUTLINE, t.bad));
        }
        BarForm::LeftOut => {
            let stroke = Stroke::new(OUTLINE, t.other);
            painter.rect_stroke(rect, 0.0, stroke, StrokeKind::Inside);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::widgets::testing::window;
    use egui::{Color32, Shape, pos2, vec2};

    /// Returns the shapes of a bar in a single hue, except for the background.
    fn in_one_hue(form: BarForm, size: egui::Vec2) -> Vec<String> {
        fn collect(shape: &Shape, ground: Color32, found: &mut Vec<String>) {
            let hue = |colour: Color32| match colour {
                Color32::TRANSPARENT => "none",
                colour if colour == ground => "ground",
                _ => "hue",
            };
            match shape {
                Shape::Vec(shapes) => {
                    for outline in shapes {
                        collect(outline, ground, found);
                    }
                }
                Shape::Rect(rect_shape) => found.push(format!(
                    "{:?} {} {} {}",
                    rect_shape.rect,
                    hue(rect_shape.fill),
                    rect_shape.stroke.width,
                    hue(rect_shape.stroke.color)
                )),
                Shape::LineSegment { points, stroke } => {
                    found.push(format!("{points:?} {} {}", stroke.width, hue(stroke.color)));
                }
                Shape::Mesh(mesh) => {
                    let places: Vec<_> = mesh
                        .vertices
                        .iter()
                        .map(|vertex| (vertex.pos, hue(vertex.color)))
                        .collect();
                    found.push(format!("{places:?}"));
                }
                other => found.push(format!("{:?}", other.visual_bounding_rect())),
            }
        }
        let mut harness = window([60.0, 60.0], (), move |ui, ()| {
            paint(ui, Rect::from_min_size(pos2(20.0, 20.0), size), form);
        });
        harness.run();
        let ground = theme::tokens(&harness.ctx).bg0;
        let mut found = Vec::new();
        for clipped in &harness.output().shapes {
            collect(&clipped.shape, ground, &mut found);
        }
        found
    }

    #[test]
    fn each_state_of_a_pass_has_a_form_of_its_own_in_one_hue() {
        let forms = [
            BarForm::Planned,
            BarForm::Sent,
            BarForm::Proved,
            BarForm::Running,
            BarForm::Done,
            BarForm::Missed,
            BarForm::LeftOut,
        ];
        for size in [vec2(22.0, 22.0), vec2(14.0, 10.0), vec2(4.0, 14.0)] {
            for (index, form) in forms.iter().enumerate() {
                for other in &forms[index + 1..] {
                    let [one, two] = [*form, *other].map(|bar_form| in_one_hue(bar_form, size));
                    assert_ne!(one, two, "{form:?} and {other:?} at {size:?}");
                }
            }
        }
    }
}
