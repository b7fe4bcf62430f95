//! Test for edges of a zone that cross each other.

use std::f64::consts::TAU;

use glam::DVec3;

use super::{
    SAME, ZoneError,
    edge::{Edge, Shape},
    is_same,
};

/// Refuses edges that share more than the corners between them.
pub(super) fn check(edges: &[Edge]) -> Result<(), ZoneError> {
    let numbered = || (1_usize..).zip(edges);
    for (first, one) in numbered() {
        for (second, other) in numbered().skip(first) {
            let is_next = second == first + 1 || (first == 1 && second == edges.len());
            let is_shared = |point: DVec3| {
                is_next
                    && [one.start, one.end].iter().any(|end| {
                        is_near(*end, point)
                            && (is_same(*end, other.start) || is_same(*end, other.end))
                    })
            };
            if common_points(one, other).into_iter().flatten().any(|point| !is_shared(point)) {
                let all = edges.iter().all(|edge| is_on_line_of(one, edge));
                return Err(if all {
                    ZoneError::NoArea
                } else {
                    ZoneError::Crossing { first, second }
                });
            }
        }
    }
    Ok(())
}

/// Returns `true` within a wider tolerance than for corners, because the point where edges meet at
/// a small angle is less certain.
fn is_near(a: DVec3, b: DVec3) -> bool {
    a.distance_squared(b) < (1e3 * SAME).powi(2)
}

/// Returns points that both edges share; for a shared stretch, its ends and its middle.
fn common_points(one: &Edge, other: &Edge) -> [Option<DVec3>; 4] {
    use Shape::{Arc, GreatCircle};
    match (one.shape, other.shape) {
        (GreatCircle { normal: a }, GreatCircle { normal: b }) => {
            let line = a.cross(b);
            if line.length() < SAME {
                return common_stretch(one, other);
            }
            let line = line.normalize();
            let on_both = |point: &DVec3| is_on(one, *point) && is_on(other, *point);
            [Some(line).filter(on_both), Some(-line).filter(on_both), None, None]
        }
        (GreatCircle { normal }, Arc { elevation }) => at_elevation(one, normal, other, elevation),
        (Arc { elevation }, GreatCircle { normal }) => at_elevation(other, normal, one, elevation),
        (Arc { elevation: a }, Arc { elevation: b }) if (a - b).abs() < SAME => {
            common_stretch(one, other)
        }
        (Arc { .. }, Arc { .. }) => [None; 4],
    }
}

/// Returns the common points of edges on one circle: every end that lies inside the other edge.
/// Without such ends, the result holds the shared ends, and the middle of each edge that lies
/// inside the other.
fn common_stretch(one: &Edge, other: &Edge) -> [Option<DVec3>; 4] {
    let on_edge = |edge: &Edge, point: DVec3| {
        Some(point).filter(|point| {
            is_on(edge, *point) && !is_same(*point, edge.start) && !is_same(*point, edge.end)
        })
    };
    let ends = [
        on_edge(other, one.start),
        on_edge(other, one.end),
        on_edge(one, other.start),
        on_edge(one, other.end),
    ];
    if ends.iter().any(Option::is_some) {
        return ends;
    }
    // If no end of an edge lies inside the other, the edges are the same stretch, touch at corners,
    // or are apart.
    let touching = [one.start, one.end]
        .map(|end| Some(end).filter(|end| is_same(*end, other.start) || is_same(*end, other.end)));
    [on_edge(other, one.point_at(0.5)), on_edge(one, other.point_at(0.5)), touching[0], touching[1]]
}

/// Returns the points of a great circle at an elevation that lie on both edges.
fn at_elevation(circle: &Edge, normal: DVec3, arc: &Edge, elevation: f64) -> [Option<DVec3>; 4] {
    let level = DVec3::Z.cross(normal);
    let sin = if level.length() > SAME {
        elevation.sin() / normal.cross(level.normalize()).z
    } else {
        f64::NAN
    };
    // Rounding must not lose a circle that only just reaches the elevation.
    if sin.is_nan() || sin.abs() > 1.0 + SAME * SAME {
        return [None; 4];
    }
    let sin = sin.clamp(-1.0, 1.0);
    let level = level.normalize();
    let cos = (1.0 - sin * sin).sqrt();
    let point_at = |cos: f64| {
        let point = level * cos + normal.cross(level) * sin;
        Some(point).filter(|point| is_on(circle, *point) && is_on(arc, *point))
    };
    [point_at(cos), point_at(-cos), None, None]
}

/// Returns `true` if `point`, which is on the circle of `edge`, lies between its ends or at an end.
fn is_on(edge: &Edge, point: DVec3) -> bool {
    is_same(point, edge.start)
        || is_same(point, edge.end)
        || match edge.shape {
            Shape::GreatCircle { normal } => edge.spans(point, normal),
            Shape::Arc { .. } => edge.turns_past(point.x.atan2(point.y)),
        }
}

/// Returns `true` if the whole `edge` lies on the circle of `line`.
fn is_on_line_of(line: &Edge, edge: &Edge) -> bool {
    let plane = |point: DVec3| match line.shape {
        Shape::GreatCircle { normal } => normal.dot(point),
        Shape::Arc { elevation } => point.z - elevation.sin(),
    };
    let is_full = line.turn().is_some_and(|turn| turn.abs() > TAU - SAME);
    !is_full && [0.0, 0.3, 0.6, 1.0].iter().all(|share| plane(edge.point_at(*share)).abs() < SAME)
}
