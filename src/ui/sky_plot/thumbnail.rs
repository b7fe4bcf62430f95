//! The shape of a pass in a small square, for lists.

use egui::{Painter, Rect, Shape, Stroke, vec2};

use super::{geometry::Dome, marks};
use crate::{plan::Sample, ui::tokens::Tokens};

/// Paints the path of a pass into `rect`, 48 points square: the rim, the ring
/// of 45 degrees, the path with a dot at its rise and an arrow at its set.
pub fn thumbnail(painter: &Painter, rect: Rect, path: &[Sample], t: &Tokens) {
    let radius = rect.width().min(rect.height()) / 2.0 - 2.0;
    if !rect.is_finite() || radius <= 0.0 {
        return;
    }
    let dome = Dome { centre: rect.center(), radius };
    painter.circle_stroke(dome.centre, radius, Stroke::new(1.0, t.edge));
    let quiet = Stroke::new(1.0, t.grid);
    painter.circle_stroke(dome.centre, dome.ring(45.0), quiet);
    for arm in [vec2(radius, 0.0), vec2(0.0, radius)] {
        painter.line_segment([dome.centre - arm, dome.centre + arm], quiet);
    }
    let points = dome.path(path.iter().map(|sample| sample.direction));
    if let Some(start) = points.first() {
        painter.circle_filled(*start, 2.0, t.sat);
    }
    // The arrow points along the last stretch, not along the last short step.
    if let Some(tip) = points.last()
        && let Some(from) = points.iter().rev().find(|at| at.distance(*tip) > 4.0)
    {
        marks::arrow_head(painter, *tip, *from, 6.0, t.sat);
    }
    painter.add(Shape::line(points, Stroke::new(1.75, t.sat)));
}
