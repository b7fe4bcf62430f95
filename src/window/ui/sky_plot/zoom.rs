//! The part of the sky that the plot shows.

use egui::{Pos2, Vec2};

use super::geometry::Dome;

/// Max magnification.
const MAX_ZOOM: f32 = 8.0;
/// Distance that the wheel turns for a magnification by e, points.
const POINTS: f32 = 250.0;
/// Factor by which a key press magnifies.
const STEP: f32 = 1.5;

/// Magnification and position of the disc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Zoom {
    factor: f32,
    /// Offset of the zenith from the middle of the plot, in radii of the whole disc.
    shift: Vec2,
}

impl Default for Zoom {
    fn default() -> Self {
        Self { factor: 1.0, shift: Vec2::ZERO }
    }
}

impl Zoom {
    /// Returns `true` if the plot shows the whole disc.
    pub(super) fn is_whole(self) -> bool {
        self.factor <= 1.0
    }

    /// Returns the magnified disc; `whole` is the disc at magnification 1.
    pub(super) fn disc(self, whole: Dome) -> Dome {
        let centre = whole.centre + self.shift * whole.radius;
        Dome { centre, radius: whole.radius * self.factor }
    }

    /// Zooms by a turn of the wheel, `points`. The place under `position` does not move.
    pub(super) fn turn(&mut self, points: f32, position: Pos2, whole: Dome) {
        self.magnify((points / POINTS).exp(), position, whole);
    }

    /// Magnifies by the factor `step` around `position`.
    pub(super) fn magnify(&mut self, step: f32, position: Pos2, whole: Dome) {
        if !step.is_finite() {
            return;
        }
        let offset = (position - whole.centre) / whole.radius;
        let of_sky = (offset - self.shift) / self.factor;
        self.factor = (self.factor * step).clamp(1.0, MAX_ZOOM);
        self.shift = offset - of_sky * self.factor;
        self.keep_in_place();
    }

    /// Zooms in or out around the middle of the plot.
    pub fn step(&mut self, is_closer: bool) {
        let amount = if is_closer { STEP } else { 1.0 / STEP };
        let factor = (self.factor * amount).clamp(1.0, MAX_ZOOM);
        self.shift *= factor / self.factor;
        self.factor = factor;
        self.keep_in_place();
    }

    /// Moves the disc by a drag of `delta` points.
    pub(super) fn drag(&mut self, delta: Vec2, whole: Dome) {
        self.shift += delta / whole.radius;
        self.keep_in_place();
    }

    /// Shows the whole disc again.
    pub fn reset(&mut self) {
        *self = Self::default();
    }

    /// Limits the shift, so that the disc always covers the place of the whole disc.
    fn keep_in_place(&mut self) {
        let max = self.factor - 1.0;
        let length = self.shift.length();
        if length > max {
            self.shift *= max / length;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::{pos2, vec2};

    const WHOLE: Dome = Dome { centre: Pos2::new(300.0, 300.0), radius: 200.0 };

    #[test]
    fn the_place_under_the_pointer_stays_there() {
        let position = pos2(380.0, 250.0);
        let mut zoom = Zoom::default();
        let before = zoom.disc(WHOLE).direction(position).unwrap();
        zoom.turn(200.0, position, WHOLE);
        let dome = zoom.disc(WHOLE);
        assert!(dome.radius > 400.0, "{dome:?}");
        assert!(dome.direction(position).unwrap().separation(before).degrees() < 1e-3);
    }

    #[test]
    fn it_ends_at_the_whole_disc_and_at_eight_times_of_it() {
        let mut zoom = Zoom::default();
        for _ in 0..50 {
            zoom.turn(120.0, pos2(450.0, 300.0), WHOLE);
        }
        assert!((zoom.disc(WHOLE).radius - 1600.0).abs() < 0.1);
        zoom.drag(vec2(9000.0, 0.0), WHOLE);
        // The rim of the disc reaches the rim of the whole disc and no further.
        let dome = zoom.disc(WHOLE);
        assert!((dome.centre.x - dome.radius - 100.0).abs() < 0.1, "{dome:?}");
        for _ in 0..50 {
            zoom.turn(-120.0, pos2(10.0, 20.0), WHOLE);
        }
        assert_eq!(zoom.disc(WHOLE), WHOLE);
        assert!(zoom.is_whole());
        zoom.magnify(f32::NAN, WHOLE.centre, WHOLE);
        assert_eq!(zoom, Zoom::default());
    }
}
