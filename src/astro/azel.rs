//! A direction in the sky of a site.

use glam::DVec3;

use super::Angle;

/// A direction: azimuth from true north over east, elevation from the horizon.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AzEl {
    /// From true north over east.
    pub azimuth: Angle,
    /// From the geometric horizon up.
    pub elevation: Angle,
}

impl AzEl {
    /// From degrees.
    pub const fn from_degrees(azimuth_deg: f64, elevation_deg: f64) -> Self {
        Self {
            azimuth: Angle::from_degrees(azimuth_deg),
            elevation: Angle::from_degrees(elevation_deg),
        }
    }

    /// Azimuth in degrees, 0 up to 360.
    pub fn azimuth_deg(self) -> f64 {
        self.azimuth.wrapped_360().degrees()
    }

    /// Elevation in degrees.
    pub fn elevation_deg(self) -> f64 {
        self.elevation.degrees()
    }

    /// The direction as a unit vector (east, north, up).
    pub fn to_enu(self) -> DVec3 {
        let (sin_az, cos_az) = self.azimuth.radians().sin_cos();
        let (sin_el, cos_el) = self.elevation.radians().sin_cos();
        DVec3::new(cos_el * sin_az, cos_el * cos_az, sin_el)
    }

    /// The direction of a vector (east, north, up) of any length but zero.
    /// Straight up has azimuth 0.
    pub fn from_enu(enu: DVec3) -> Self {
        let horizontal = enu.x.hypot(enu.y);
        let azimuth = if horizontal == 0.0 { 0.0 } else { enu.x.atan2(enu.y) };
        Self {
            azimuth: Angle::from_radians(azimuth).wrapped_360(),
            elevation: Angle::from_radians(enu.z.atan2(horizontal)),
        }
    }

    /// The angle between two directions, 0 to 180 degrees.
    pub fn separation(self, other: Self) -> Angle {
        let (a, b) = (self.to_enu(), other.to_enu());
        // Better than the arc cosine near zero, where a beam is judged.
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
                let given = AzEl::from_degrees(f64::from(az), f64::from(el));
                let back = AzEl::from_enu(given.to_enu());
                assert!(given.separation(back).degrees() < 1e-9);
            }
        }
    }

    #[test]
    fn small_separations_are_exact() {
        let a = AzEl::from_degrees(359.999, 45.0);
        let b = AzEl::from_degrees(0.001, 45.0);
        assert!((a.separation(b).degrees() - 0.002 * 45f64.to_radians().cos()).abs() < 1e-9);
    }
}
