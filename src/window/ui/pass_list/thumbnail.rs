//! A small plot of the path of a pass over the sky.

use egui::{Pos2, Rect, Shape, Stroke, Ui, Vec2, pos2};

use crate::{astro::AzEl, plan::Sample, ui::theme};

/// Width and height, points.
pub(super) const SIDE: f32 = 48.0;

/// Min distance between points; closer points would only roughen the line, points.
const STEP: f32 = 0.75;
/// Room for the marks on the rim, points.
const MARGIN: f32 = 2.0;

/// Paints the path in the middle of `rect`. North is up and east is right. A dot marks the rise of
/// the satellite, and an arrow its setting.
pub(super) fn paint(ui: &Ui, rect: Rect, path: &[Sample]) {
    let t = theme::tokens(ui);
    let painter = ui.painter();
    let (centre, radius) = (rect.center(), SIDE / 2.0 - MARGIN);
    painter.circle_filled(centre, radius, t.sky);
    painter.hline(centre.x - radius..=centre.x + radius, centre.y, (1.0, t.line));
    painter.vline(centre.x, centre.y - radius..=centre.y + radius, (1.0, t.line));
    painter.circle_stroke(centre, radius / 2.0, (1.0, t.grid));
    painter.circle_stroke(centre, radius, (1.0, t.edge));

    let points = points(path, centre, radius);
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else { return };
    let before = points.iter().rev().nth(2).or(points.first()).copied().unwrap_or(first);
    painter.line(points, Stroke::new(1.75, t.sat));
    painter.circle_filled(first, 2.25, t.sat);
    if before.distance(last) > STEP {
        let along = (last - before).normalized();
        painter.add(arrow(last, along, Stroke::new(1.0, t.sat)));
    }
}

/// Returns a filled arrow head with its tip at `tip`.
fn arrow(tip: Pos2, along: Vec2, stroke: Stroke) -> Shape {
    let foot = tip - 4.5 * along;
    let side = 2.2 * along.rot90();
    Shape::convex_polygon(vec![tip, foot + side, foot - side], stroke.color, stroke)
}

/// Returns the path on the screen, without coinciding points.
fn points(path: &[Sample], centre: Pos2, radius: f32) -> Vec<Pos2> {
    let mut points: Vec<Pos2> = Vec::new();
    for sample in path {
        let Some(point) = project(sample.direction, centre, radius) else { continue };
        if points.last().is_none_or(|last| last.distance(point) >= STEP) {
            points.push(point);
        }
    }
    points
}

/// Returns the point of a direction; a direction below the horizon lies on the rim.
fn project(direction: AzEl, centre: Pos2, radius: f32) -> Option<Pos2> {
    let (azimuth, elevation_deg) = (direction.azimuth.radians(), direction.elevation_deg());
    if !azimuth.is_finite() || !elevation_deg.is_finite() {
        return None;
    }
    let out = radius * ((90.0 - elevation_deg.clamp(0.0, 90.0)) / 90.0) as f32;
    let (sin, cos) = (azimuth.sin() as f32, azimuth.cos() as f32);
    Some(pos2(centre.x + out * sin, centre.y - out * cos))
}

#[cfg(test)]
mod tests {
    use super::*;
    use jiff::Timestamp;

    fn sample(azimuth_deg: f64, elevation_deg: f64) -> Sample {
        let direction = AzEl::from_degrees(azimuth_deg, elevation_deg);
        Sample { time: Timestamp::UNIX_EPOCH, direction }
    }

    #[test]
    fn north_is_up_and_east_is_right() {
        let centre = pos2(100.0, 100.0);
        let place = |az, el| project(AzEl::from_degrees(az, el), centre, 20.0).unwrap();
        assert!(place(0.0, 0.0).distance(pos2(100.0, 80.0)) < 1e-3);
        assert!(place(90.0, 45.0).distance(pos2(110.0, 100.0)) < 1e-3);
        assert!(place(180.0, -3.0).distance(pos2(100.0, 120.0)) < 1e-3);
        assert!(place(77.0, 90.0).distance(centre) < 1e-3);
    }

    #[test]
    fn points_on_each_other_and_directions_without_a_value_are_left_out() {
        let path =
            [sample(0.0, 10.0), sample(0.1, 10.0), sample(f64::NAN, 10.0), sample(90.0, 10.0)];
        assert_eq!(points(&path, Pos2::ZERO, 20.0).len(), 2);
    }
}
