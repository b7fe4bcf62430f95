//! Direction from the view of the two axes, prepared for repeated evaluation.

use crate::astro::AzEl;

/// Elevation above which the azimuth may have to turn faster than it can, degrees.
const OVERHEAD_FROM_DEG: f64 = 60.0;

/// Returns `true` if the elevation compensates for an azimuth that does not keep up. Lower down,
/// the antenna would rise and fall while the azimuth turns, and still miss the target.
pub(super) fn is_overhead(direction: AzEl) -> bool {
    direction.elevation_deg() >= OVERHEAD_FROM_DEG
}

/// Sine and cosine of an angle.
pub(super) type SinCos = (f64, f64);

/// Returns the sine and cosine of an angle in degrees.
pub(super) fn sin_cos(deg: f64) -> SinCos {
    deg.to_radians().sin_cos()
}

#[derive(Debug, Clone, Copy)]
pub(super) struct ElevationEnds {
    deg: (f64, f64),
    sin_cos: [SinCos; 2],
}

impl ElevationEnds {
    pub(super) fn new(deg: (f64, f64)) -> Self {
        Self { deg, sin_cos: [deg.0, deg.1].map(sin_cos) }
    }
}

#[derive(Debug, Clone, Copy)]
pub(super) struct View {
    azimuth: SinCos,
    height: SinCos,
    elevation: Elevation,
}

/// Behaviour of the elevation axis while the azimuth does not keep up.
#[derive(Debug, Clone, Copy)]
enum Elevation {
    /// Compensation for the azimuth between the ends of the elevation axis.
    Helps([SinCos; 2]),
    Stays(SinCos),
}

/// Returns the position of the elevation axis without compensation for the azimuth, degrees.
fn nominal_deg(direction: AzEl, is_flipped: bool, ends: Option<ElevationEnds>) -> f64 {
    let elevation_deg = direction.elevation_deg();
    let side_deg = if is_flipped { 180.0 - elevation_deg } else { elevation_deg };
    let (from_deg, to_deg) = ends.map_or((-90.0, 90.0), |ends| ends.deg);
    side_deg.min(to_deg).max(from_deg)
}

impl View {
    /// Prepares `direction` for an elevation axis between `ends`, flipped or not.
    pub(super) fn new(direction: AzEl, is_flipped: bool, ends: Option<ElevationEnds>) -> Self {
        let helps = ends.filter(|_| is_overhead(direction));
        Self {
            azimuth: direction.azimuth.radians().sin_cos(),
            height: direction.elevation.radians().sin_cos(),
            elevation: helps.map_or_else(
                || Elevation::Stays(sin_cos(nominal_deg(direction, is_flipped, ends))),
                |ends| Elevation::Helps(ends.sin_cos),
            ),
        }
    }

    /// Returns the best position of the elevation axis for a position of the azimuth axis, in
    /// degrees.
    pub(super) fn elevation_deg(
        (direction, is_flipped): (AzEl, bool),
        ends: Option<ElevationEnds>,
        azimuth_deg: f64,
    ) -> f64 {
        let Some(ElevationEnds { deg: (from_deg, to_deg), .. }) =
            ends.filter(|_| is_overhead(direction))
        else {
            return nominal_deg(direction, is_flipped, ends);
        };
        let (up, along) = Self::new(direction, is_flipped, ends).in_plane(sin_cos(azimuth_deg));
        up.atan2(along).to_degrees().min(to_deg).max(from_deg)
    }

    /// Returns the cost of a position of both axes: grows with the square of a small error, up to 2
    /// for the opposite direction.
    pub(super) fn cost(&self, azimuth: SinCos, (sin, cos): SinCos) -> f64 {
        let (up, along) = self.in_plane(azimuth);
        1.0 - (up * sin + along * cos)
    }

    /// Returns the cost of a position of the azimuth axis with the best position of the elevation
    /// axis.
    pub(super) fn azimuth_cost(&self, azimuth: SinCos) -> f64 {
        let (up, along) = self.in_plane(azimuth);
        let projection = |(sin, cos): SinCos| up * sin + along * cos;
        let [start, end] = match self.elevation {
            Elevation::Helps(ends) => ends,
            Elevation::Stays(nominal) => return 1.0 - projection(nominal),
        };
        // The sign of the cross product shows on which side of an end the direction lies.
        let is_beyond = |(sin, cos): SinCos| up * cos - along * sin > 0.0;
        if is_beyond(end) {
            1.0 - projection(end)
        } else if is_beyond(start) {
            1.0 - (up * up + along * along).sqrt()
        } else {
            1.0 - projection(start)
        }
    }

    /// Projects the direction into the plane of the elevation axis: returns the component upwards,
    /// and the component towards the azimuth of the axis.
    fn in_plane(&self, (sin, cos): SinCos) -> (f64, f64) {
        let ((up, out), (to_sin, to_cos)) = (self.height, self.azimuth);
        (up, out * (cos * to_cos + sin * to_sin))
    }
}
