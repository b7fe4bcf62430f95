//! Geometry of a mount with two crossed axes and a horizontal lower axis.
//!
//! The lower axis is fixed to the ground and points to the azimuth `lower_axis_azimuth`. The
//! keyholes lie on the horizon at its two ends. Both axis angles are zero at the zenith. Formulas:
//! Pisgah Astronomical Research Institute's `xymount` (lower axis north-south), turned by the
//! azimuth of the lower axis.

use super::{Angle, AzEl};

/// Angles of the two axes, zero at the zenith.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisAngles {
    /// Rotation about the lower axis.
    pub lower: Angle,
    /// Rotation about the upper axis.
    pub upper: Angle,
}

pub fn axes_from_azel(direction: AzEl, lower_axis_azimuth: Angle) -> AxisAngles {
    let turned =
        AzEl { azimuth: direction.azimuth - lower_axis_azimuth, elevation: direction.elevation };
    let enu = turned.to_enu();
    AxisAngles {
        lower: Angle::from_radians(enu.x.atan2(enu.z)),
        upper: Angle::from_radians(enu.y.clamp(-1.0, 1.0).asin()),
    }
}

pub fn azel_from_axes(axes: AxisAngles, lower_axis_azimuth: Angle) -> AzEl {
    let (sin_l, cos_l) = axes.lower.radians().sin_cos();
    let (sin_p, cos_p) = axes.upper.radians().sin_cos();
    let turned = AzEl::from_enu(glam::DVec3::new(sin_l * cos_p, sin_p, cos_l * cos_p));
    AzEl {
        azimuth: (turned.azimuth + lower_axis_azimuth).wrapped_360(),
        elevation: turned.elevation,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Azimuth, elevation, then the independently computed lower and upper angles with the lower
    /// axis north-south and east-west.
    const TABLE: [(f64, f64, f64, f64, f64, f64); 7] = [
        (0.0, 45.0, 0.0, 45.0, 45.0, 0.0),
        (90.0, 45.0, 45.0, 0.0, 0.0, 45.0),
        (270.0, 45.0, -45.0, 0.0, 0.0, -45.0),
        (45.0, 30.0, 50.77, 37.76, 50.77, 37.76),
        (225.0, 10.0, -76.00, -44.14, -76.00, -44.14),
        (125.1, 32.6, 51.99, -28.97, -41.96, 43.57),
        (299.49, 34.35, -51.86, 23.98, 35.76, -45.94),
    ];

    #[test]
    fn the_table_of_directions_holds_both_ways() {
        for (az, el, ns_lower, ns_upper, ew_lower, ew_upper) in TABLE {
            let direction = AzEl::from_degrees(az, el);
            let north = axes_from_azel(direction, Angle::ZERO);
            assert!((north.lower.degrees() - ns_lower).abs() < 0.006, "{az} {el}");
            assert!((north.upper.degrees() - ns_upper).abs() < 0.006, "{az} {el}");
            // A lower axis that points east turns in the opposite sense to the table, which counts
            // north as positive.
            let east = axes_from_azel(direction, Angle::from_degrees(90.0));
            assert!((east.lower.degrees() + ew_lower).abs() < 0.006, "{az} {el}");
            assert!((east.upper.degrees() - ew_upper).abs() < 0.006, "{az} {el}");
            for (axes, base) in [(north, 0.0), (east, 90.0)] {
                let back = azel_from_axes(axes, Angle::from_degrees(base));
                assert!(back.separation(direction).degrees() < 1e-9);
            }
        }
    }
}
