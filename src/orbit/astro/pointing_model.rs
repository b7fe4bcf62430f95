//! A pointing model: the difference between the readings of the axes of an az/el mount and the
//! direction of the beam.

use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

use super::{Angle, AzEl};

/// Number of iterations of the inverse of elevation scale and sag. Each iteration gains at least
/// two digits.
const ROUNDS: usize = 8;

/// Error of the mount or of its readings that the model corrects.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Term {
    AzimuthOffset,
    ElevationOffset,
    /// Lean of the azimuth axis to the north.
    TiltNorth,
    /// Lean of the azimuth axis to the east.
    TiltEast,
    /// Offset of the beam to the left of the direction in which the mount points.
    Collimation,
    /// Tilt of the elevation axis, with its right end higher.
    NonPerpendicularity,
    /// Growth of the reading for each degree of elevation.
    ElevationScale,
    /// Increase of the reading at the horizon. At an elevation, the increase is this value times
    /// the cosine of the elevation.
    Sag,
}

impl Term {
    pub const COUNT: usize = 8;
    /// Terms in order of precedence: if points cannot separate some of them, the fit keeps the
    /// first.
    pub const ALL: [Self; Self::COUNT] = [
        Self::AzimuthOffset,
        Self::ElevationOffset,
        Self::TiltNorth,
        Self::TiltEast,
        Self::Collimation,
        Self::NonPerpendicularity,
        Self::ElevationScale,
        Self::Sag,
    ];

    /// Returns the change of the two readings with this term at a direction, azimuth on the sky and
    /// elevation. The unit is degrees per degree; for the scale, degrees per unit.
    pub fn effect(self, direction: AzEl) -> [f64; 2] {
        let (sin_az, cos_az) = direction.azimuth.radians().sin_cos();
        let (sin_el, cos_el) = direction.elevation.radians().sin_cos();
        match self {
            Self::AzimuthOffset => [cos_el, 0.0],
            Self::ElevationOffset => [0.0, 1.0],
            Self::TiltNorth => [sin_el * sin_az, cos_az],
            Self::TiltEast => [-sin_el * cos_az, sin_az],
            Self::Collimation => [1.0, 0.0],
            Self::NonPerpendicularity => [sin_el, 0.0],
            Self::ElevationScale => [0.0, direction.elevation_deg()],
            Self::Sag => [0.0, cos_el],
        }
    }
}

/// Terms of an antenna in degrees, except for the scale.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct PointingModel {
    pub azimuth_offset_deg: f64,
    pub elevation_offset_deg: f64,
    pub tilt_north_deg: f64,
    pub tilt_east_deg: f64,
    pub collimation_deg: f64,
    pub non_perpendicularity_deg: f64,
    pub elevation_scale: f64,
    pub sag_deg: f64,
}

impl PointingModel {
    /// Returns `true` if all terms are zero, so the axes read the direction of the beam.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    pub fn term(&self, term: Term) -> f64 {
        let mut copy = *self;
        *copy.place(term)
    }

    pub fn place(&mut self, term: Term) -> &mut f64 {
        match term {
            Term::AzimuthOffset => &mut self.azimuth_offset_deg,
            Term::ElevationOffset => &mut self.elevation_offset_deg,
            Term::TiltNorth => &mut self.tilt_north_deg,
            Term::TiltEast => &mut self.tilt_east_deg,
            Term::Collimation => &mut self.collimation_deg,
            Term::NonPerpendicularity => &mut self.non_perpendicularity_deg,
            Term::ElevationScale => &mut self.elevation_scale,
            Term::Sag => &mut self.sag_deg,
        }
    }

    /// Returns the axis readings with which the beam points in `direction`. Returns `None` so near
    /// to the zenith that the beam cannot reach the direction.
    pub fn reading(&self, direction: AzEl) -> Option<AzEl> {
        let sky = direction.to_enu();
        let [east, north, up] = self.mount_axes();
        let mount = AzEl::from_enu(DVec3::new(sky.dot(east), sky.dot(north), sky.dot(up)));
        let (height, flat) = mount.elevation.radians().sin_cos();
        let (sin_p, cos_p) = self.non_perpendicularity_deg.to_radians().sin_cos();
        let (sin_c, _) = self.collimation_deg.to_radians().sin_cos();
        let lateral = (-sin_c - height * sin_p) / (flat * cos_p);
        if !(-1.0..=1.0).contains(&lateral) {
            return None;
        }
        let azimuth = mount.azimuth - Angle::from_radians(lateral.asin());
        let ahead = flat * (1.0 - lateral * lateral).sqrt();
        let across = height * cos_p - flat * lateral * sin_p;
        let elevation_deg = across.atan2(ahead).to_degrees();
        Some(AzEl {
            azimuth: (azimuth + Angle::from_degrees(self.azimuth_offset_deg)).wrapped_360(),
            elevation: Angle::from_degrees(self.elevation_reading_deg(elevation_deg)),
        })
    }

    /// Returns the direction of the beam for these axis readings: the inverse of [`Self::reading`].
    pub fn direction(&self, reading: AzEl) -> AzEl {
        let azimuth = reading.azimuth - Angle::from_degrees(self.azimuth_offset_deg);
        let read_deg = reading.elevation_deg();
        let mut elevation_deg = read_deg;
        for _ in 0..ROUNDS {
            elevation_deg += read_deg - self.elevation_reading_deg(elevation_deg);
        }
        let (sin_az, cos_az) = azimuth.radians().sin_cos();
        let (sin_el, cos_el) = elevation_deg.to_radians().sin_cos();
        let (sin_p, cos_p) = self.non_perpendicularity_deg.to_radians().sin_cos();
        let (sin_c, cos_c) = self.collimation_deg.to_radians().sin_cos();
        // The components are ahead of the mount, to its right, and up.
        let ahead = cos_c * cos_el;
        let right = -cos_c * sin_el * sin_p - sin_c * cos_p;
        let height = cos_c * sin_el * cos_p - sin_c * sin_p;
        let [east, north, up] = self.mount_axes();
        let sky = east * (ahead * sin_az + right * cos_az)
            + north * (ahead * cos_az - right * sin_az)
            + up * height;
        AzEl::from_enu(sky)
    }

    /// Returns an upper bound of the angle by which the beam turns for each degree of an axis.
    ///
    /// The terms other than scale and sag are rotations and an offset along each axis, so none of
    /// them lets the beam turn faster than an axis.
    pub fn max_beam_turn(&self) -> f64 {
        let min_reading = 1.0 - self.elevation_scale.abs() - self.sag_deg.abs().to_radians();
        // The ranges of the station file keep this value above three quarters.
        1.0 / min_reading.max(0.5)
    }

    fn elevation_reading_deg(&self, elevation_deg: f64) -> f64 {
        elevation_deg * (1.0 + self.elevation_scale)
            + self.elevation_offset_deg
            + self.sag_deg * elevation_deg.to_radians().cos()
    }

    /// Returns east, north and up of the leaning mount, in the axes of the site.
    fn mount_axes(&self) -> [DVec3; 3] {
        let lean = DVec3::new(self.tilt_east_deg, self.tilt_north_deg, 0.0);
        let angle = lean.length().to_radians();
        // The mount turns about the horizontal axis across the lean.
        let axis = lean.cross(DVec3::NEG_Z).normalize_or_zero();
        let turn = if angle > 0.0 { DMat3::from_axis_angle(axis, angle) } else { DMat3::IDENTITY };
        [turn.x_axis, turn.y_axis, turn.z_axis]
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// The test uses the terms that a station file may have. The positions include an axis that
        /// tips over the zenith.
        #[test]
        fn the_beam_turns_no_further_than_its_bound(
            terms in proptest::array::uniform8(-10.0..=10.0_f64),
            from_deg in (0.0..360.0, -90.0..180.0), turned_deg in (-2.0..2.0_f64, -2.0..2.0_f64),
        ) {
            let mut model = PointingModel::default();
            for (term, value) in Term::ALL.into_iter().zip(terms) {
                let unit = if term == Term::ElevationScale { 0.005 } else { 1.0 };
                *model.place(term) = value * unit;
            }
            let (azimuth_deg, elevation_deg) = from_deg;
            let to_deg = (azimuth_deg + turned_deg.0, elevation_deg + turned_deg.1);
            let beam = |(azimuth, elevation)| model.direction(AzEl::from_degrees(azimuth, elevation));
            let by_deg = beam(from_deg).separation(beam(to_deg)).degrees();
            let axes_deg = turned_deg.0.abs() + turned_deg.1.abs();
            prop_assert!(by_deg <= axes_deg * model.max_beam_turn() + 1e-6, "{model:?}: {by_deg}");
        }
    }

    #[test]
    fn the_beam_turns_further_than_an_axis_that_reads_too_little() {
        let model = PointingModel { elevation_scale: -0.05, sag_deg: 10.0, ..Default::default() };
        let beam = |elevation_deg| model.direction(AzEl::from_degrees(0.0, elevation_deg));
        let by_deg = beam(85.0).separation(beam(86.0)).degrees();
        assert!((1.28..=model.max_beam_turn()).contains(&by_deg), "{by_deg}");
    }
}
