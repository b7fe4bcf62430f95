//! The keep-outs and the margin around them.

use egui::{Align2, Color32, Mesh, Painter, Pos2, Rect, Shape, Stroke, pos2, vec2};

use super::{
    geometry::{Dome, dashed, hatch},
    scene::KeepOutMark,
};
use crate::{
    astro::{Angle, AzEl, Zone},
    ui::{
        text::{self, Weight},
        tokens::Tokens,
    },
};

/// Distance between the sampled points of an edge.
const STEP: Angle = Angle::from_degrees(1.0);
/// Spacing of the hatch of the margin, points.
const HATCH: f32 = 5.0;
/// Height of the strips that fill an area, points.
const STRIP: f32 = 1.0;
/// Padding around the name, points.
const PADDING: f32 = 3.0;

/// Paints the keep-outs without their names.
pub(in crate::ui) fn paint(painter: &Painter, dome: Dome, marks: &[KeepOutMark<'_>], t: &Tokens) {
    for mark in marks {
        let area = outline(dome, mark.zone);
        let points = margin(dome, mark.zone, mark.margin);
        if area.len() < 3 {
            continue;
        }
        if points.len() > 2 {
            // With the even-odd rule, the area inside both outlines stays empty.
            let closed = points.iter().chain(points.first());
            let both_outlines: Vec<Pos2> =
                closed.chain(&area).chain(area.first()).copied().collect();
            let thin = Stroke::new(0.75, t.bad);
            let lines = hatch(&both_outlines, HATCH, true).into_iter();
            painter.extend(lines.map(|line| Shape::line_segment(line, thin)));
            let ring: Vec<Pos2> = points.iter().chain(points.first()).copied().collect();
            painter.extend(dashed(&ring, 4.0, 3.0, Stroke::new(1.25, t.bad)));
        }
        painter.add(filled(&area, t.keep));
        painter.add(Shape::closed_line(area.clone(), Stroke::new(1.5, t.bad)));
    }
}

/// Paints the names of the keep-outs. Returns their boxes.
pub(in crate::ui) fn words(
    painter: &Painter,
    dome: Dome,
    marks: &[KeepOutMark<'_>],
    t: &Tokens,
) -> Vec<Rect> {
    let areas = marks.iter().map(|mark| (mark, outline(dome, mark.zone)));
    let visible = areas.filter(|(_, area)| area.len() > 2);
    visible.map(|(mark, area)| label(painter, dome, &area, mark.name, t)).collect()
}

/// Returns the area of a zone above the horizon.
pub(in crate::ui) fn outline(dome: Dome, zone: &Zone) -> Vec<Pos2> {
    above_horizon(dome, zone.edges_sampled(STEP))
}

/// Returns the line around a zone at the distance `margin`, above the horizon.
fn margin(dome: Dome, zone: &Zone, margin: Angle) -> Vec<Pos2> {
    above_horizon(dome, zone.margin_sampled(margin, STEP))
}

/// Returns the points of `directions`. Points below the horizon move to the rim. Empty if all are
/// below the horizon.
fn above_horizon(dome: Dome, directions: impl IntoIterator<Item = AzEl>) -> Vec<Pos2> {
    let mut is_seen = false;
    let raised = directions.into_iter().filter_map(|direction| {
        is_seen |= direction.elevation_deg() > 0.0;
        let elevation = Angle::from_radians(direction.elevation.radians().max(0.0));
        dome.point(AzEl { elevation, ..direction })
    });
    let mut points: Vec<Pos2> = raised.collect();
    points.dedup();
    if is_seen { points } else { Vec::new() }
}

/// Returns a filled area of any shape, made of strips. An outline covers the rough edges.
pub(in crate::ui) fn filled(outline: &[Pos2], colour: Color32) -> Mesh {
    let mut mesh = Mesh::default();
    let (low, high) = outline.iter().fold((f32::MAX, f32::MIN), |(low, high), position| {
        (low.min(position.y), high.max(position.y))
    });
    let mut y = low.floor();
    while y < high {
        let middle = y + STRIP / 2.0;
        let edges = outline.iter().zip(outline.iter().cycle().skip(1));
        let crossings = edges.filter_map(|(start, end)| {
            let (a, b) = (start.y - middle, end.y - middle);
            ((a < 0.0) != (b < 0.0)).then(|| start.lerp(*end, a / (a - b)).x)
        });
        let mut crossings: Vec<f32> = crossings.collect();
        crossings.sort_by(f32::total_cmp);
        for [left, right] in crossings.as_chunks::<2>().0 {
            let strip = Rect::from_min_max(pos2(*left, y), pos2(*right, y + STRIP));
            mesh.add_colored_rect(strip, colour);
        }
        y += STRIP;
    }
    mesh
}

/// Paints the name of a keep-out: inside if it fits, otherwise next to the area towards the zenith.
fn label(painter: &Painter, dome: Dome, area: &[Pos2], name: &str, t: &Tokens) -> Rect {
    let bounds = Rect::from_points(area);
    let head = painter.layout_no_wrap("KEEP-OUT".to_owned(), text::sized(11.0, Weight::Bold), t.t1);
    let below = painter.layout_no_wrap(name.to_owned(), text::caption(), t.t1);
    let size = vec2(head.size().x.max(below.size().x), head.size().y + below.size().y)
        + vec2(2.0 * PADDING, 2.0 * PADDING);
    let inner = Rect::from_center_size(bounds.center(), size);
    let fits = bounds.width() > size.x * 0.8 && bounds.height() > size.y * 0.8;
    let rect = if fits {
        inner
    } else {
        let direction = (dome.centre - bounds.center()).normalized();
        let outward = (bounds.size() + size) / 2.0;
        let step = (outward.x * direction.x.abs()).max(outward.y * direction.y.abs()) + 4.0;
        inner.translate(direction * step)
    };
    let ground = if fits { t.keep } else { t.sky };
    if let Some(corners) = dome.clipped(rect) {
        painter.add(Shape::convex_polygon(corners, ground, Stroke::NONE));
    }
    let position = |y: f32, size: egui::Vec2| {
        Align2::CENTER_TOP.align_size_within_rect(size, rect.with_min_y(y)).min
    };
    let (first, second) = (rect.top() + PADDING, rect.top() + PADDING + head.size().y);
    painter.galley(position(first, head.size()), head, t.t1);
    painter.galley(position(second, below.size()), below, t.t1);
    rect
}

#[cfg(test)]
mod tests {
    use super::*;

    const DOME: Dome = Dome { centre: pos2(0.0, 0.0), radius: 270.0 };

    fn zone(corners: &[(f64, f64)]) -> Zone {
        Zone::new(corners.iter().map(|(az, el)| AzEl::from_degrees(*az, *el)).collect()).unwrap()
    }

    #[test]
    fn a_zone_reaches_from_the_rim_to_its_top() {
        let mast = zone(&[(80.0, -5.0), (80.0, 30.0), (100.0, 30.0), (100.0, -5.0)]);
        let bounds = Rect::from_points(&outline(DOME, &mast));
        // East is at the right; 30 degrees are 90 points from the rim.
        assert!((bounds.right() - 270.0).abs() < 0.5, "{bounds}");
        assert!((bounds.left() - 177.3).abs() < 0.5, "{bounds}");
        let outer = Rect::from_points(&margin(DOME, &mast, Angle::from_degrees(2.0)));
        assert!(outer.left() < bounds.left() - 5.0 && outer.right() < 270.5, "{outer}");
    }

    #[test]
    fn what_lies_below_the_horizon_is_not_drawn() {
        let below = zone(&[(80.0, -25.0), (80.0, -5.0), (100.0, -5.0), (100.0, -25.0)]);
        assert_eq!(outline(DOME, &below), []);
    }

    #[test]
    fn a_bent_area_is_filled_where_it_is() {
        let bent = [
            pos2(0.0, 0.0),
            pos2(30.0, 0.0),
            pos2(30.0, 30.0),
            pos2(20.0, 30.0),
            pos2(20.0, 10.0),
            pos2(0.0, 10.0),
        ];
        let mesh = filled(&bent, Color32::PLACEHOLDER);
        let area: f32 = mesh
            .vertices
            .as_chunks::<4>()
            .0
            .iter()
            .map(|[a, .., d]| (d.pos.x - a.pos.x) * (d.pos.y - a.pos.y))
            .sum();
        assert!((area - 500.0).abs() < 1.0, "{area}");
    }
}
