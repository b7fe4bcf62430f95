//! Mount of an antenna: arrangement and travel of its axes.

use serde::Serialize;

use crate::astro::{
    Angle, AzEl,
    xy_mount::{self, AxisAngles},
};

/// Arrangement and travel of the axes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(tag = "type", rename_all = "lowercase")]
pub enum Mount {
    /// Two crossed axes (X/Y), the lower one horizontal; the keyholes lie at its ends.
    Xy {
        /// Azimuth to which the lower axis points, degrees, 0 to 180.
        lower_axis_azimuth_deg: f64,
        /// Lower end of the travel of both axes on the controller's scale (90 at the zenith),
        /// degrees.
        travel_from_deg: f64,
        /// Upper end of the travel of both axes, degrees.
        travel_to_deg: f64,
    },
    /// Elevation over azimuth. A rotator for the azimuth alone does not use the elevation.
    AzEl {
        /// Counter-clockwise end of the azimuth axis, degrees from north over
        /// east, -360 to 360.
        azimuth_from_deg: f64,
        /// Clockwise end of the azimuth axis, degrees; above 360 if it turns by more than one turn.
        azimuth_to_deg: f64,
        /// Lower end of the elevation axis, degrees.
        elevation_from_deg: f64,
        /// Upper end of the elevation axis, degrees; above 90, up to 180, if the mount can flip.
        elevation_to_deg: f64,
    },
}

impl Mount {
    /// Returns both ends of the travel of the two axes, degrees of the mount.
    pub fn travel_deg(&self) -> [(f64, f64); 2] {
        match *self {
            Self::Xy { travel_from_deg, travel_to_deg, .. } => {
                [(travel_from_deg, travel_to_deg); 2]
            }
            Self::AzEl {
                azimuth_from_deg,
                azimuth_to_deg,
                elevation_from_deg,
                elevation_to_deg,
            } => [(azimuth_from_deg, azimuth_to_deg), (elevation_from_deg, elevation_to_deg)],
        }
    }

    /// Returns the direction in which the axes point at `axes_deg`, degrees of the mount.
    pub fn direction(&self, axes_deg: [f64; 2]) -> AzEl {
        let [first, second] = axes_deg.map(Angle::from_degrees);
        match *self {
            Self::AzEl { .. } => AzEl::of_axes(first, second),
            Self::Xy { lower_axis_azimuth_deg, .. } => {
                let zenith = Angle::from_degrees(90.0);
                let axes = AxisAngles { lower: first - zenith, upper: second - zenith };
                xy_mount::azel_from_axes(axes, Angle::from_degrees(lower_axis_azimuth_deg))
            }
        }
    }

    /// Returns `true` if the axes reach `direction`, flipped or not. The result is always `true`
    /// for an X/Y mount, even in its keyholes.
    pub fn reaches(&self, direction: AzEl) -> bool {
        let Self::AzEl { azimuth_from_deg, azimuth_to_deg, .. } = *self else { return true };
        let [_, (lowest_deg, highest_deg)] = self.travel_deg();
        [direction, direction.flipped()].into_iter().any(|axes| {
            let azimuth_deg = self.axis_azimuth(axes.azimuth, None).degrees();
            (azimuth_from_deg..=azimuth_to_deg).contains(&azimuth_deg)
                && (lowest_deg..=highest_deg).contains(&axes.elevation_deg())
        })
    }

    /// Returns the nearer end of the azimuth travel beyond which `direction` lies, as an azimuth.
    /// `None` if the azimuth axis turns to it, flipped or not, and for an X/Y mount.
    pub fn azimuth_end_before(&self, direction: AzEl) -> Option<Angle> {
        let Self::AzEl { azimuth_from_deg: start, azimuth_to_deg: last, .. } = *self else {
            return None;
        };
        let is_within = |axes: AzEl| {
            let azimuth_deg = self.axis_azimuth(axes.azimuth, None).degrees();
            (start..=last).contains(&azimuth_deg)
        };
        if is_within(direction) || (self.can_flip() && is_within(direction.flipped())) {
            return None;
        }
        let [first, limit] = [start, last].map(|end| Angle::from_degrees(end).wrapped_360());
        let way = |end: Angle| (direction.azimuth - end).wrapped_180().abs();
        Some(if way(first) < way(limit) { first } else { limit })
    }

    /// Returns `true` if the elevation axis travels over the zenith to the other side.
    pub fn can_flip(&self) -> bool {
        matches!(self, Self::AzEl { elevation_to_deg, .. } if *elevation_to_deg > 90.0)
    }

    /// Returns `true` if an elevation axis at this angle is flipped.
    pub fn is_flipped(&self, elevation_axis_deg: Option<f64>) -> bool {
        self.can_flip() && elevation_axis_deg.is_some_and(|axis_deg| axis_deg > 90.0)
    }

    /// Returns this mount with its travel limited to the unit's own ends, degrees of the mount.
    /// Ignores ends that would leave an axis no travel, and all ends for an X/Y mount.
    #[must_use]
    pub fn clipped(self, ends_deg: [Option<(f64, f64)>; 2]) -> Self {
        if matches!(self, Self::Xy { .. }) {
            return self;
        }
        let mut ends = self.travel_deg();
        for (travel_deg, ends_deg) in ends.iter_mut().zip(ends_deg) {
            let (from_deg, to_deg) = ends_deg.unwrap_or(*travel_deg);
            let drawn_in = (travel_deg.0.max(from_deg), travel_deg.1.min(to_deg));
            if drawn_in.0 < drawn_in.1 {
                *travel_deg = drawn_in;
            }
        }
        let [(azimuth_from_deg, azimuth_to_deg), (elevation_from_deg, elevation_to_deg)] = ends;
        Self::AzEl { azimuth_from_deg, azimuth_to_deg, elevation_from_deg, elevation_to_deg }
    }

    /// Returns the position of the azimuth axis that points to `azimuth` and is nearest to
    /// `near_deg`. Returns `azimuth` if the axis has no such position, or if the mount has no such
    /// axis.
    pub fn axis_azimuth(&self, azimuth: Angle, near_deg: Option<f64>) -> Angle {
        let Self::AzEl { azimuth_from_deg: start, azimuth_to_deg: end, .. } = *self else {
            return azimuth;
        };
        let lowest = start + (azimuth.degrees() - start).rem_euclid(360.0);
        let turns = (0..).map(|turn: u32| lowest + 360.0 * f64::from(turn));
        let way = |axis_deg: &f64| near_deg.map_or(0.0, |near| (axis_deg - near).abs());
        turns
            .take_while(|axis_deg| *axis_deg <= end)
            .min_by(|a, b| way(a).total_cmp(&way(b)))
            .map_or(azimuth, Angle::from_degrees)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn azel(start: f64, end: f64) -> Mount {
        Mount::AzEl {
            azimuth_from_deg: start,
            azimuth_to_deg: end,
            elevation_from_deg: 0.0,
            elevation_to_deg: 90.0,
        }
    }

    fn axis(mount: &Mount, azimuth_deg: f64, near_deg: Option<f64>) -> f64 {
        mount.axis_azimuth(Angle::from_degrees(azimuth_deg), near_deg).degrees()
    }

    #[test]
    fn the_axis_turns_the_shorter_way_within_its_travel() {
        let wide = azel(-90.0, 450.0);
        for (azimuth_deg, near_deg, expected) in [
            (10.0, Some(350.0), 370.0),
            (10.0, Some(100.0), 10.0),
            (300.0, Some(0.0), -60.0),
            (300.0, Some(200.0), 300.0),
            (100.0, Some(440.0), 100.0),
            (90.0, Some(440.0), 450.0),
            (-60.0, None, -60.0),
        ] {
            let found = axis(&wide, azimuth_deg, near_deg);
            assert!((found - expected).abs() < 1e-9, "{azimuth_deg} near {near_deg:?}: {found}");
        }
        assert!((axis(&azel(180.0, 540.0), 90.0, None) - 450.0).abs() < 1e-9);
    }

    #[test]
    fn an_azimuth_without_a_position_stays_as_it_is() {
        assert!((axis(&azel(90.0, 270.0), 45.0, Some(100.0)) - 45.0).abs() < 1e-9);
        let xy =
            Mount::Xy { lower_axis_azimuth_deg: 0.0, travel_from_deg: 5.0, travel_to_deg: 175.0 };
        assert!((axis(&xy, 370.0, Some(0.0)) - 370.0).abs() < 1e-9);
    }

    #[test]
    fn a_mount_reaches_what_lies_between_its_ends() {
        let direction = AzEl::from_degrees;
        let sector = azel(90.0, 270.0);
        assert!(sector.reaches(direction(180.0, 45.0)));
        assert!(!sector.reaches(direction(20.0, 45.0)) && !sector.reaches(direction(180.0, -1.0)));
        assert!(azel(0.0, 450.0).reaches(direction(359.9, 89.0)));
    }

    #[test]
    fn over_the_zenith_a_sector_reaches_the_other_side() {
        let Mount::AzEl { azimuth_from_deg, azimuth_to_deg, elevation_from_deg, .. } =
            azel(90.0, 270.0)
        else {
            panic!("not crossed")
        };
        let elevation_to_deg = 150.0;
        let over_zenith =
            Mount::AzEl { azimuth_from_deg, azimuth_to_deg, elevation_from_deg, elevation_to_deg };
        assert!(over_zenith.can_flip() && !azel(90.0, 270.0).can_flip());
        assert!(over_zenith.reaches(AzEl::from_degrees(20.0, 45.0)));
        assert!(!over_zenith.reaches(AzEl::from_degrees(20.0, 25.0)), "beyond 150");
    }

    #[test]
    fn a_device_may_draw_the_ends_in_and_never_out() {
        let mount = azel(0.0, 450.0);
        assert_eq!(mount.clipped([None, None]), mount);
        assert_eq!(mount.clipped([Some((-90.0, 500.0)), Some((-10.0, 180.0))]), mount);
        let drawn_in = mount.clipped([Some((0.0, 359.0)), Some((5.0, 180.0))]);
        assert_eq!(drawn_in.travel_deg(), [(0.0, 359.0), (5.0, 90.0)]);
        assert_eq!(mount.clipped([Some((500.0, 600.0)), None]), mount);
    }

    #[test]
    fn both_axes_have_their_ends() {
        assert_eq!(azel(0.0, 450.0).travel_deg(), [(0.0, 450.0), (0.0, 90.0)]);
        let xy =
            Mount::Xy { lower_axis_azimuth_deg: 30.0, travel_from_deg: 5.0, travel_to_deg: 175.0 };
        assert_eq!(xy.travel_deg(), [(5.0, 175.0); 2]);
    }
}
