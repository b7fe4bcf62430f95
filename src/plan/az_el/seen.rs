//! A direction as seen by the two axes, prepared for repeated evaluation.

use crate::astro::AzEl;

/// Elevation from which the azimuth may have to turn faster than it can, degrees.
const OVERHEAD_FROM_DEG: f64 = 60.0;

/// Returns `true` if the elevation makes up for an azimuth that does not keep up. Lower down, the
/// antenna would rise and fall while the azimuth turns, and still point nowhere near the target.
pub(super) fn is_overhead(direction: AzEl) -> bool {
    direction.elevation_deg() >= OVERHEAD_FROM_DEG
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Seen {
    azimuth_rad: f64,
    /// Sine and cosine of the elevation.
    height: (f64, f64),
    /// Position of the elevation axis where it does not make up for the azimuth, degrees.
    default_deg: f64,
    usual: (f64, f64),
    /// Ends of the elevation axis where it makes up for the azimuth, degrees.
    ends_deg: Option<[f64; 2]>,
    ends: Option<[(f64, f64); 2]>,
}

impl Seen {
    /// Prepares `direction` for an elevation axis between `ends_deg`, flipped or not.
    pub(super) fn new(direction: AzEl, is_flipped: bool, ends_deg: Option<(f64, f64)>) -> Self {
        let elevation_deg = direction.elevation_deg();
        let side_deg = if is_flipped { 180.0 - elevation_deg } else { elevation_deg };
        let (from_deg, to_deg) = ends_deg.unwrap_or((-90.0, 90.0));
        let default_deg = side_deg.min(to_deg).max(from_deg);
        let helps = ends_deg.filter(|_| is_overhead(direction));
        let ends_deg = helps.map(|(from_deg, to_deg)| [from_deg, to_deg]);
        let turned = |deg: f64| deg.to_radians().sin_cos();
        Self {
            azimuth_rad: direction.azimuth.radians(),
            height: direction.elevation.radians().sin_cos(),
            default_deg,
            usual: turned(default_deg),
            ends_deg,
            ends: ends_deg.map(|ends_deg| ends_deg.map(turned)),
        }
    }

    /// The best position of the elevation axis for a position of the azimuth axis, in degrees.
    pub(super) fn elevation_deg(&self, azimuth_deg: f64) -> f64 {
        let Some([from_deg, to_deg]) = self.ends_deg else { return self.default_deg };
        let (up, along) = self.in_plane(azimuth_deg);
        up.atan2(along).to_degrees().min(to_deg).max(from_deg)
    }

    /// Cost of a position of both axes: grows with the square of a small error, up to 2 for the
    /// opposite direction.
    pub(super) fn cost(&self, azimuth_deg: f64, elevation_deg: f64) -> f64 {
        let (sin, cos) = elevation_deg.to_radians().sin_cos();
        let (up, along) = self.in_plane(azimuth_deg);
        1.0 - (up * sin + along * cos)
    }

    /// Cost of a position of the azimuth axis, with the elevation axis where it points best.
    pub(super) fn azimuth_cost(&self, azimuth_deg: f64) -> f64 {
        let (up, along) = self.in_plane(azimuth_deg);
        let towards = |(sin, cos): (f64, f64)| up * sin + along * cos;
        let Some([from, to]) = self.ends else { return 1.0 - towards(self.usual) };
        // The sign of the cross product tells on which side of an end the direction lies.
        let is_beyond = |(sin, cos): (f64, f64)| up * cos - along * sin > 0.0;
        if is_beyond(to) {
            1.0 - towards(to)
        } else if is_beyond(from) {
            1.0 - up.hypot(along)
        } else {
            1.0 - towards(from)
        }
    }

    /// The direction in the plane in which the elevation axis turns: its component upwards, and the
    /// one towards the azimuth of the axis.
    fn in_plane(&self, azimuth_deg: f64) -> (f64, f64) {
        let (up, out) = self.height;
        (up, out * (azimuth_deg.to_radians() - self.azimuth_rad).cos())
    }
}
