//! Projection from the ground to points, and the section of the world that it shows.

use std::ops::RangeInclusive;

use egui::{Pos2, Rect, Vec2, pos2};

use crate::astro::{Angle, GroundPoint};

/// Magnifications of the zoom.
const STEPS: [f32; 3] = [1.0, 2.0, 4.0];

/// Section of the world that the map shows.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Zoom {
    step: usize,
    /// Longitude and latitude of the middle, degrees.
    middle_deg: (f32, f32),
    /// Turn of the wheel since the last zoom step, points.
    wheel: f32,
}

impl Zoom {
    pub(super) fn factor(self) -> f32 {
        STEPS.get(self.step).copied().unwrap_or(1.0)
    }

    /// Zooms one step in or out.
    pub(super) fn step(&mut self, is_closer: bool) {
        let step = if is_closer { self.step + 1 } else { self.step.saturating_sub(1) };
        self.step = step.min(STEPS.len() - 1);
        self.keep_inside();
    }

    /// Zooms by a turn of the wheel. The place under `position` stays where it is.
    pub(super) fn turn(&mut self, points: f32, position: Pos2, world: Rect) {
        /// Turn of the wheel for one zoom step, points.
        const STEP: f32 = 40.0;
        self.wheel = if self.wheel * points < 0.0 { points } else { self.wheel + points };
        if self.wheel.abs() < STEP {
            return;
        }
        let is_closer = self.wheel > 0.0;
        self.wheel = 0.0;
        let before = Projection::new(world, *self).degrees(position);
        self.step(is_closer);
        let after = Projection::new(world, *self).degrees(position);
        self.middle_deg.0 += before.0 - after.0;
        self.middle_deg.1 += before.1 - after.1;
        self.keep_inside();
    }

    /// Moves the map by `step` points.
    pub(super) fn drag(&mut self, step: Vec2, world: Rect) {
        let scale = Projection::new(world, *self).scale;
        self.middle_deg.0 -= step.x / scale;
        self.middle_deg.1 += step.y / scale;
        self.keep_inside();
    }

    fn keep_inside(&mut self) {
        let max = 90.0 - 90.0 / self.factor();
        let (longitude, latitude) = self.middle_deg;
        self.middle_deg =
            ((longitude + 180.0).rem_euclid(360.0) - 180.0, latitude.clamp(-max, max));
    }
}

/// Equirectangular projection: a degree of longitude and of latitude have the same length
/// everywhere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Projection {
    /// Rectangle of the map: twice as wide as high.
    pub(super) world: Rect,
    /// Length of a degree, points.
    pub(super) scale: f32,
    middle_deg: (f32, f32),
}

impl Projection {
    pub(super) fn new(world: Rect, zoom: Zoom) -> Self {
        let scale = world.width() / 360.0 * zoom.factor();
        Self { world, scale, middle_deg: zoom.middle_deg }
    }

    /// Returns the point of a longitude, of any turn, and a latitude.
    pub(super) fn point_at(&self, longitude_deg: f32, latitude_deg: f32) -> Pos2 {
        let (longitude, latitude) = self.middle_deg;
        let centre = self.world.center();
        pos2(
            centre.x + (longitude_deg - longitude) * self.scale,
            centre.y - (latitude_deg - latitude) * self.scale,
        )
    }

    /// Returns the point of a place, on the turn nearest to the middle.
    pub(super) fn point(&self, place: GroundPoint) -> Pos2 {
        let middle = Angle::from_degrees(f64::from(self.middle_deg.0));
        let longitude = (place.longitude - middle).wrapped_180() + middle;
        self.point_at(longitude.degrees() as f32, place.latitude.degrees() as f32)
    }

    /// Returns the longitude, of any turn, and latitude of a point.
    fn degrees(&self, position: Pos2) -> (f32, f32) {
        let from_centre = (position - self.world.center()) / self.scale;
        (self.middle_deg.0 + from_centre.x, self.middle_deg.1 - from_centre.y)
    }

    /// Returns the place at a point; `None` outside the map.
    pub(super) fn place(&self, position: Pos2) -> Option<GroundPoint> {
        let (longitude, latitude) = self.degrees(position);
        self.world
            .contains(position)
            .then(|| GroundPoint::from_degrees(f64::from(latitude), f64::from(longitude)))
    }

    /// Returns the turns, degrees, that bring an object between two longitudes onto the map.
    pub(super) fn turns(&self, from_deg: f32, to_deg: f32) -> impl Iterator<Item = f32> + use<> {
        // Leave out an object that only touches an edge: it is not visible.
        let [left, right] = self.longitudes();
        let (left, right) = (left + 0.001, right - 0.001);
        let first = ((left - to_deg) / 360.0).ceil() as i32;
        let last = ((right - from_deg) / 360.0).floor() as i32;
        (first..=last).map(|turn| turn as f32 * 360.0)
    }

    /// Returns the longitudes of the left and the right edge.
    pub(super) fn longitudes(&self) -> [f32; 2] {
        let half = self.world.width() / 2.0 / self.scale;
        [self.middle_deg.0 - half, self.middle_deg.0 + half]
    }

    /// Returns the latitudes of the map.
    pub(super) fn latitudes(&self) -> RangeInclusive<f32> {
        let half = self.world.height() / 2.0 / self.scale;
        self.middle_deg.1 - half..=self.middle_deg.1 + half
    }

    /// Returns a line on every visible turn. Its longitudes may cross the date line.
    pub(super) fn lines(&self, places: &[GroundPoint]) -> Vec<Vec<Pos2>> {
        let mut line: Vec<(f32, f32)> = Vec::with_capacity(places.len());
        for place in places {
            let longitude = place.longitude.degrees() as f32;
            let before = line.last().map_or(longitude, |(before, _)| *before);
            let longitude = before + wrapped(longitude - before);
            line.push((longitude, place.latitude.degrees() as f32));
        }
        self.copies(&line)
    }

    /// Returns a line of continuous longitudes and latitudes on every visible turn.
    pub(super) fn copies(&self, line: &[(f32, f32)]) -> Vec<Vec<Pos2>> {
        let longitudes = line.iter().map(|(longitude, _)| *longitude);
        let (low, high) = longitudes.fold((f32::MAX, f32::MIN), |(low, high), longitude| {
            (low.min(longitude), high.max(longitude))
        });
        if line.is_empty() {
            return Vec::new();
        }
        let on_turn = |turn: f32| {
            line.iter()
                .map(|(longitude, latitude)| self.point_at(longitude + turn, *latitude))
                .collect()
        };
        self.turns(low, high).map(on_turn).collect()
    }
}

/// Wraps a difference in longitude to -180 to 180 degrees.
fn wrapped(degrees: f32) -> f32 {
    (degrees + 180.0).rem_euclid(360.0) - 180.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::vec2;

    const WORLD: Rect = Rect { min: pos2(72.0, 112.0), max: pos2(1096.0, 624.0) };

    fn place(latitude_deg: f64, longitude_deg: f64) -> GroundPoint {
        GroundPoint::from_degrees(latitude_deg, longitude_deg)
    }

    #[test]
    fn the_world_fills_the_map() {
        let whole = Projection::new(WORLD, Zoom::default());
        assert!(whole.point(place(90.0, -180.0)).distance(WORLD.left_top()) < 1e-3);
        assert!(whole.point(place(0.0, 0.0)).distance(WORLD.center()) < 1e-3);
        assert!(whole.point(place(-90.0, 179.999)).distance(WORLD.right_bottom()) < 0.01);
        let back = whole.place(whole.point(place(41.0, 29.0))).unwrap();
        assert!(back.distance(place(41.0, 29.0)).degrees() < 1e-4);
        assert_eq!(whole.place(WORLD.left_top() - vec2(1.0, 0.0)), None);
    }

    #[test]
    fn a_line_across_the_date_line_leaves_at_one_edge_and_comes_in_at_the_other() {
        let whole = Projection::new(WORLD, Zoom::default());
        let lines = whole.lines(&[place(0.0, 170.0), place(10.0, -170.0)]);
        assert_eq!(lines.len(), 2);
        for line in &lines {
            assert!((line[1].x - line[0].x - 20.0 * whole.scale).abs() < 1e-2, "{line:?}");
        }
        assert!(lines.iter().any(|line| WORLD.contains(line[0])));
        assert!(lines.iter().any(|line| WORLD.contains(line[1])));
        assert_eq!(whole.lines(&[place(0.0, 10.0), place(0.0, 20.0)]).len(), 1);
        assert_eq!(whole.lines(&[]).len(), 0);
        // Twice around the world.
        let ground_points: Vec<_> =
            (0..=72).map(|step| place(0.0, f64::from(step) * 10.0)).collect();
        assert_eq!(whole.lines(&ground_points).len(), 3);
    }

    #[test]
    fn the_wheel_keeps_the_place_under_the_pointer() {
        let mut zoom = Zoom::default();
        let position = pos2(700.0, 200.0);
        let before = Projection::new(WORLD, zoom).place(position).unwrap();
        for wheel in [60.0, 25.0, 25.0] {
            zoom.turn(wheel, position, WORLD);
            let now = Projection::new(WORLD, zoom).place(position).unwrap();
            assert!(now.distance(before).degrees() < 0.01, "{now:?}");
        }
        assert!((zoom.factor() - 4.0).abs() < 1e-6);
        for _ in 0..5 {
            zoom.turn(-60.0, position, WORLD);
        }
        assert!((zoom.factor() - 1.0).abs() < 1e-6);
    }

    #[test]
    fn the_map_has_no_edge_in_the_east_and_one_at_the_poles() {
        let mut zoom = Zoom::default();
        zoom.drag(vec2(512.0, 300.0), WORLD);
        let moved = Projection::new(WORLD, zoom);
        assert!((moved.point(place(0.0, 180.0)).x - WORLD.center().x).abs() < 0.1);
        assert!(moved.point(place(90.0, 180.0)).distance(WORLD.center_top()) < 0.1);
        zoom.step(true);
        zoom.drag(vec2(0.0, 10_000.0), WORLD);
        let north = Projection::new(WORLD, zoom);
        assert!((north.point(place(90.0, 0.0)).y - WORLD.top()).abs() < 0.1);
    }
}
