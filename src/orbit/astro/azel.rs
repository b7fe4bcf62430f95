//! A direction in the sky of a site.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::Angle;

const ZENITH: Angle = Angle::from_degrees(90.0);

/// A direction: azimuth from true north through east, elevation from the horizon.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AzEl {
    /// Angle from true north through east.
    pub azimuth: Angle,
    /// Angle upwards from the geometric horizon.
    pub elevation: Angle,
}

impl AzEl {
    pub const fn from_degrees(azimuth_deg: f64, elevation_deg: f64) -> Self {
        Self {
            azimuth: Angle::from_degrees(azimuth_deg),
            elevation: Angle::from_degrees(elevation_deg),
        }
    }

    /// Returns the direction in which an elevation-over-azimuth mount points at these axis
    /// positions. An elevation beyond 90 degrees points over the zenith to the opposite side.
    pub fn of_axes(azimuth: Angle, elevation: Angle) -> Self {
        let axes = Self { azimuth: azimuth.wrapped_360(), elevation };
        if elevation > ZENITH { axes.flipped() } else { axes }
    }

    /// Returns the other pair of axis positions that points in the same direction.
    #[must_use]
    pub fn flipped(self) -> Self {
        let half_turn = Angle::from_degrees(180.0);
        Self {
            azimuth: (self.azimuth + half_turn).wrapped_360(),
            elevation: half_turn - self.elevation,
        }
    }

    /// Returns the azimuth from 0 up to, not including, 360 degrees.
    pub fn azimuth_deg(self) -> f64 {
        self.azimuth.wrapped_360().degrees()
    }

    pub fn elevation_deg(self) -> f64 {
        self.elevation.degrees()
    }

    /// Returns the direction as a unit vector (east, north, up).
    pub fn to_enu(self) -> DVec3 {
        let (sin_az, cos_az) = self.azimuth.radians().sin_cos();
        let (sin_el, cos_el) = self.elevation.radians().sin_cos();
        DVec3::new(cos_el * sin_az, cos_el * cos_az, sin_el)
    }

    /// Returns the direction of an (east, north, up) vector of any length but zero. Straight up has
    /// azimuth 0.
    pub fn from_enu(enu: DVec3) -> Self {
        let horizontal = enu.x.hypot(enu.y);
        let azimuth = if horizontal == 0.0 { 0.0 } else { enu.x.atan2(enu.y) };
        Self {
            azimuth: Angle::from_radians(azimuth).wrapped_360(),
            elevation: Angle::from_radians(enu.z.atan2(horizontal)),
        }
    }

    /// Returns the direction `distance_deg` away along the great circle that leaves at
    /// `bearing_deg`. A bearing of 0 leads towards the zenith, 90 leads clockwise.
    #[must_use]
    pub fn displaced(self, bearing_deg: f64, distance_deg: f64) -> Self {
        let (sin_az, cos_az) = self.azimuth.radians().sin_cos();
        let start = self.to_enu();
        let clockwise = DVec3::new(cos_az, -sin_az, 0.0);
        let up = clockwise.cross(start);
        let (sin, cos) = bearing_deg.to_radians().sin_cos();
        let (far, near) = distance_deg.to_radians().sin_cos();
        Self::from_enu(start * near + (up * cos + clockwise * sin) * far)
    }

    /// Returns the angle between two directions, 0 to 180 degrees.
    pub fn separation(self, other: Self) -> Angle {
        let (a, b) = (self.to_enu(), other.to_enu());
        // The arc cosine is less precise near zero, where a beam is judged.
        Angle::from_radians(a.cross(b).length().atan2(a.dot(b)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_direction_survives_the_way_over_its_vector() {
        for az in (0..360).step_by(15) {
            for el in (-85..90).step_by(5) {
                let direction = AzEl::from_degrees(f64::from(az), f64::from(el));
                let back = AzEl::from_enu(direction.to_enu());
                assert!(direction.separation(back).degrees() < 1e-9);
            }
        }
    }

    #[test]
    fn flipped_axes_point_to_the_same_direction() {
        for az in (0..360).step_by(15) {
            for el in (0..90).step_by(5) {
                let plain = AzEl::from_degrees(f64::from(az), f64::from(el));
                let flipped = plain.flipped();
                assert!((90.0..=180.0).contains(&flipped.elevation_deg()));
                let restored = AzEl::of_axes(flipped.azimuth, flipped.elevation);
                assert!(plain.separation(restored).degrees() < 1e-9);
                assert!((restored.elevation_deg() - plain.elevation_deg()).abs() < 1e-9);
                assert!(plain.separation(flipped).degrees() < 1e-9, "also as they count");
                assert_eq!(AzEl::of_axes(plain.azimuth, plain.elevation), plain);
            }
        }
    }

    #[test]
    fn a_bearing_leads_up_and_clockwise_and_so_far() {
        let start = AzEl::from_degrees(120.0, 40.0);
        assert!(
            start.displaced(0.0, 10.0).separation(AzEl::from_degrees(120.0, 50.0)).degrees() < 1e-9
        );
        assert!(
            start.displaced(180.0, 10.0).separation(AzEl::from_degrees(120.0, 30.0)).degrees()
                < 1e-9
        );
        let clockwise = start.displaced(90.0, 10.0);
        assert!(clockwise.azimuth_deg() > 130.0 && clockwise.elevation_deg() < 40.0);
        for bearing in (0..360).step_by(20) {
            let distance = start.separation(start.displaced(f64::from(bearing), 7.0));
            assert!((distance.degrees() - 7.0).abs() < 1e-9);
        }
    }

    #[test]
    fn small_separations_are_exact() {
        let a = AzEl::from_degrees(359.999, 45.0);
        let b = AzEl::from_degrees(0.001, 45.0);
        assert!((a.separation(b).degrees() - 0.002 * 45f64.to_radians().cos()).abs() < 1e-9);
    }
}
