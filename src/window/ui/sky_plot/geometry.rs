//! The projection from directions to points; dashes and hatches.

use egui::{Pos2, Rect, Shape, Stroke, Vec2, pos2, vec2};

use crate::astro::{Angle, AzEl};

/// Room around the disc for the azimuth names, points.
const MARGIN: f32 = 26.0;
/// Max radius of the disc, points.
const MAX_RADIUS: f32 = 420.0;

/// The disc of the sky: zenith at the centre, horizon at the rim, north up and east right.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::ui) struct Dome {
    /// Centre of the disc, the zenith.
    pub(in crate::ui) centre: Pos2,
    /// Radius of the horizon, points.
    pub(in crate::ui) radius: f32,
}

impl Dome {
    /// Returns the largest disc that fits into `rect` with its rim labels.
    pub(in crate::ui) fn fitted(rect: Rect) -> Self {
        let radius = rect.width().min(rect.height()) / 2.0 - MARGIN;
        Self { centre: rect.center(), radius: radius.clamp(1.0, MAX_RADIUS) }
    }

    /// Returns the point of a direction; `None` if the direction is not finite. A direction below
    /// the horizon lies outside the rim.
    pub(in crate::ui) fn point(&self, direction: AzEl) -> Option<Pos2> {
        let finite = direction.azimuth.is_finite() && direction.elevation.is_finite();
        finite.then(|| {
            self.point_at(direction.azimuth.radians() as f32, direction.elevation_deg() as f32)
        })
    }

    /// Returns the direction at a point; `None` outside the rim.
    pub(in crate::ui) fn direction(&self, position: Pos2) -> Option<AzEl> {
        let offset = position - self.centre;
        let from_zenith = f64::from(offset.length() / self.radius);
        let azimuth_deg = f64::from(offset.x.atan2(-offset.y)).to_degrees().rem_euclid(360.0);
        (from_zenith <= 1.0).then(|| AzEl::from_degrees(azimuth_deg, 90.0 * (1.0 - from_zenith)))
    }

    /// Returns the point of a direction; `None` below the horizon.
    pub(in crate::ui) fn visible(&self, direction: AzEl) -> Option<Pos2> {
        self.point(direction).filter(|_| direction.elevation_deg() >= 0.0)
    }

    /// Returns the points of a path, without directions that are not finite or below the horizon.
    pub(in crate::ui) fn path(&self, directions: impl IntoIterator<Item = AzEl>) -> Vec<Pos2> {
        directions.into_iter().filter_map(|direction| self.visible(direction)).collect()
    }

    /// Returns the point at an azimuth in radians and an elevation in degrees.
    pub(in crate::ui) fn point_at(&self, azimuth_rad: f32, elevation_deg: f32) -> Pos2 {
        self.centre + outward(azimuth_rad) * self.ring(elevation_deg)
    }

    /// Returns the radius of the ring of an elevation, points.
    pub(in crate::ui) fn ring(&self, elevation_deg: f32) -> f32 {
        self.radius * (90.0 - elevation_deg) / 90.0
    }

    /// Returns the length of a small angle across the radius near the middle, points.
    pub(in crate::ui) fn length(&self, angle: Angle) -> f32 {
        self.radius * angle.degrees() as f32 / 90.0
    }

    /// Returns a rectangle with its corners pulled inside the rim; `None` if its centre lies
    /// outside.
    pub(in crate::ui) fn clipped(&self, rect: Rect) -> Option<Vec<Pos2>> {
        // The limit lies inside the line of the rim.
        let limit = self.radius - 1.0;
        let moved_inside = |point: Pos2| {
            let from_centre = point - self.centre;
            let length = from_centre.length();
            if length > limit { self.centre + from_centre * (limit / length) } else { point }
        };
        let corners = [rect.left_top(), rect.right_top(), rect.right_bottom(), rect.left_bottom()];
        (rect.center().distance(self.centre) < limit).then(|| corners.map(moved_inside).to_vec())
    }

    /// Returns `true` if a rectangle lies within the rim.
    pub(in crate::ui) fn holds(&self, rect: Rect) -> bool {
        let corners = [rect.left_top(), rect.right_top(), rect.right_bottom(), rect.left_bottom()];
        corners.iter().all(|corner| corner.distance(self.centre) < self.radius)
    }

    /// Returns `true` if a part of a rectangle lies within the rim or on its line.
    pub(in crate::ui) fn touches(&self, rect: Rect) -> bool {
        rect.clamp(self.centre).distance(self.centre) < self.radius + 1.0
    }

    /// Returns the circle of `radius` points around the zenith, as a closed path.
    pub(in crate::ui) fn circle(&self, radius: f32) -> Vec<Pos2> {
        circle(self.centre, radius)
    }
}

/// Returns the unit vector on the screen towards an azimuth.
pub(in crate::ui) fn outward(azimuth_rad: f32) -> Vec2 {
    vec2(azimuth_rad.sin(), -azimuth_rad.cos())
}

/// Returns a circle as a closed path with vertices at most 3 points apart.
pub(in crate::ui) fn circle(centre: Pos2, radius: f32) -> Vec<Pos2> {
    let steps = (std::f32::consts::TAU * radius / 3.0).ceil().clamp(24.0, 720.0) as u16;
    (0..=steps)
        .map(|step| {
            let turn = std::f32::consts::TAU * f32::from(step) / f32::from(steps);
            centre + outward(turn) * radius
        })
        .collect()
}

/// Returns dashes along the whole length of a path, each as a separate line. Both lengths are in
/// points and above zero.
pub(in crate::ui) fn dashes(path: &[Pos2], dash: f32, gap: f32) -> Vec<Vec<Pos2>> {
    let mut done = Vec::new();
    let mut current: Vec<Pos2> = path.first().copied().into_iter().collect();
    let (mut drawing, mut left) = (true, dash);
    for pair in path.windows(2) {
        let &[start, end] = pair else { continue };
        let length = start.distance(end);
        let mut walked = 0.0;
        while length - walked > left {
            walked += left;
            let position = start + (end - start) * (walked / length);
            if drawing {
                current.push(position);
                done.push(std::mem::take(&mut current));
            } else {
                current.push(position);
            }
            drawing = !drawing;
            left = if drawing { dash } else { gap };
        }
        left -= length - walked;
        if drawing {
            current.push(end);
        }
    }
    if current.len() > 1 {
        done.push(current);
    }
    done
}

/// Returns the dashes of a path as shapes.
pub(in crate::ui) fn dashed(
    path: &[Pos2],
    dash: f32,
    gap: f32,
    stroke: impl Into<Stroke>,
) -> Vec<Shape> {
    let stroke = stroke.into();
    dashes(path, dash, gap).into_iter().map(|piece| Shape::line(piece, stroke)).collect()
}

/// Returns parallel lines at 45°, clipped to a polygon of any shape. The lines rise to the right if
/// `rising`, otherwise they fall. `spacing` is in points, across the lines.
pub(in crate::ui) fn hatch(polygon: &[Pos2], spacing: f32, rising: bool) -> Vec<[Pos2; 2]> {
    let side = if rising { 1.0 } else { -1.0 };
    // The level is constant along each line of the hatch.
    let level = |point: Pos2| point.x + side * point.y;
    let step = spacing * std::f32::consts::SQRT_2;
    let levels = polygon.iter().map(|point| level(*point));
    let (low, high) = levels.fold((f32::MAX, f32::MIN), |(low, high), position| {
        (low.min(position), high.max(position))
    });
    let mut lines = Vec::new();
    let mut requested = (low / step).ceil() * step;
    while requested < high {
        let edges = polygon.iter().zip(polygon.iter().cycle().skip(1));
        let crossings = edges.filter_map(|(start, end)| {
            let (a, b) = (level(*start) - requested, level(*end) - requested);
            ((a < 0.0) != (b < 0.0)).then(|| start.lerp(*end, a / (a - b)))
        });
        let mut crossings: Vec<Pos2> = crossings.collect();
        crossings.sort_by(|a, b| a.x.total_cmp(&b.x));
        lines.extend(crossings.as_chunks::<2>().0);
        requested += step;
    }
    lines
}

/// Returns `true` if a rectangle can be painted.
pub(in crate::ui) fn usable(rect: Rect) -> bool {
    rect.is_finite() && rect.width() > 2.0 * MARGIN && rect.height() > 2.0 * MARGIN
}

/// Returns a point moved to the centre of its pixel, for sharp lines.
pub(in crate::ui) fn sharp(point: Pos2) -> Pos2 {
    pos2(point.x.floor() + 0.5, point.y.floor() + 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: Pos2, b: Pos2) -> bool {
        a.distance(b) < 1e-3
    }

    #[test]
    fn north_is_up_and_east_is_right() {
        let dome = Dome { centre: pos2(100.0, 200.0), radius: 90.0 };
        for (az, el, x, y) in [
            (0.0, 90.0, 100.0, 200.0),
            (0.0, 0.0, 100.0, 110.0),
            (90.0, 0.0, 190.0, 200.0),
            (180.0, 60.0, 100.0, 230.0),
            (270.0, 30.0, 40.0, 200.0),
            (-90.0, 30.0, 40.0, 200.0),
            // A flipped mount points at the other side.
            (90.0, 100.0, 90.0, 200.0),
        ] {
            let point = dome.point(AzEl::from_degrees(az, el)).unwrap();
            assert!(near(point, pos2(x, y)), "{az} {el} {point}");
        }
    }

    #[test]
    fn a_point_of_the_disc_has_the_direction_that_is_drawn_there() {
        let dome = Dome { centre: pos2(100.0, 200.0), radius: 90.0 };
        for (az, el) in [(0.0, 45.0), (121.3, 8.0), (270.0, 89.0), (359.5, 0.1)] {
            let direction = AzEl::from_degrees(az, el);
            let back = dome.direction(dome.point(direction).unwrap()).unwrap();
            assert!(back.separation(direction).degrees() < 0.01, "{az} {el} {back:?}");
            assert!((0.0..360.0).contains(&back.azimuth_deg()));
        }
        assert_eq!(dome.direction(pos2(191.0, 200.0)), None);
    }

    #[test]
    fn what_is_not_a_direction_has_no_point() {
        let dome = Dome { centre: Pos2::ZERO, radius: 90.0 };
        assert_eq!(dome.point(AzEl::from_degrees(f64::NAN, 10.0)), None);
        assert_eq!(dome.point(AzEl::from_degrees(10.0, f64::INFINITY)), None);
        assert_eq!(dome.visible(AzEl::from_degrees(10.0, -1.0)), None);
        assert_eq!(dome.path([AzEl::from_degrees(0.0, f64::NAN)]), []);
    }

    #[test]
    fn the_disc_leaves_room_for_the_rim_labels() {
        let dome = Dome::fitted(Rect::from_min_size(pos2(392.0, 112.0), vec2(704.0, 580.0)));
        assert!((dome.radius - 264.0).abs() < 1e-6);
        let huge = Dome::fitted(Rect::from_min_size(Pos2::ZERO, vec2(3000.0, 2000.0)));
        assert!((huge.radius - MAX_RADIUS).abs() < 1e-6);
    }

    #[test]
    fn the_ground_of_a_label_ends_at_the_rim() {
        let dome = Dome { centre: Pos2::ZERO, radius: 100.0 };
        let across = Rect::from_center_size(pos2(85.0, 0.0), vec2(40.0, 10.0));
        let ground = dome.clipped(across).unwrap();
        assert!(ground.iter().all(|point| point.to_vec2().length() < 99.01));
        assert!(near(ground[0], pos2(65.0, -5.0)));
        let further = across.translate(vec2(20.0, 0.0));
        assert_eq!(dome.clipped(further), None);
        assert!(dome.touches(further) && !dome.holds(further), "the rim still runs through it");
        assert!(!dome.touches(across.translate(vec2(40.0, 0.0))));
    }

    #[test]
    fn dashes_follow_the_length_and_not_the_segments() {
        let straight = [pos2(0.0, 0.0), pos2(30.0, 0.0)];
        let dense: Vec<Pos2> = (0..=60).map(|step| pos2(step as f32 * 0.5, 0.0)).collect();
        for path in [&straight[..], &dense[..]] {
            let pieces = dashes(path, 7.0, 5.0);
            let ends: Vec<(f32, f32)> = pieces
                .iter()
                .map(|piece| (piece.first().unwrap().x, piece.last().unwrap().x))
                .collect();
            let expected = [(0.0, 7.0), (12.0, 19.0), (24.0, 30.0)];
            assert_eq!(ends.len(), expected.len(), "{ends:?}");
            for (end, expected_end) in ends.iter().zip(expected) {
                assert!(
                    (end.0 - expected_end.0).abs() < 0.01 && (end.1 - expected_end.1).abs() < 0.01
                );
            }
        }
    }

    #[test]
    fn dashes_turn_corners() {
        let pieces = dashes(&[pos2(0.0, 0.0), pos2(4.0, 0.0), pos2(4.0, 10.0)], 6.0, 2.0);
        assert_eq!(pieces.first().unwrap().len(), 3);
        assert!(near(pieces.first().unwrap()[2], pos2(4.0, 2.0)));
        assert!(near(pieces[1][0], pos2(4.0, 4.0)));
        assert!(dashes(&[], 6.0, 2.0).is_empty());
        assert!(dashes(&[pos2(1.0, 1.0); 5], 6.0, 2.0).iter().all(|piece| piece.len() > 1));
    }

    #[test]
    fn hatches_stay_inside_their_polygon() {
        let square = [pos2(0.0, 0.0), pos2(40.0, 0.0), pos2(40.0, 40.0), pos2(0.0, 40.0)];
        let outer = Rect::from_min_max(pos2(0.0, 0.0), pos2(40.0, 40.0)).expand(0.01);
        assert!(hatch(&[], 5.0, true).is_empty());
        for rising in [false, true] {
            let lines = hatch(&square, 5.0, rising);
            // The diagonal is 56.6 points long.
            assert!((10..=12).contains(&lines.len()), "{}", lines.len());
            for [start, end] in lines {
                assert!(outer.contains(start) && outer.contains(end));
                assert!(((end.y - start.y).abs() - (end.x - start.x).abs()).abs() < 0.01);
                assert_eq!((end.y - start.y) * (end.x - start.x) < 0.0, rising);
            }
        }
    }
}
