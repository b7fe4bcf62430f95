//! Offsets of a track, which Azel adds to the computed position of the target.

use std::ops::Neg;

use glam::DVec3;
use jiff::{SignedDuration, Timestamp};
use serde::{Deserialize, Serialize};

use super::{Angle, AzEl, time::add_seconds};

/// Max offset of the time.
pub const MAX_TIME_OFFSET: SignedDuration = SignedDuration::from_secs(300);
/// Max offset of an angle.
pub const MAX_ANGLE_OFFSET: Angle = Angle::from_degrees(10.0);
/// Half of the interval from which the target's motion across the sky is computed, seconds.
const WAY_S: f64 = 0.5;

/// One of the five offsets of a track, with its amount.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Offset {
    /// Time offset: a positive value points where the target is predicted to be that much later.
    Time(SignedDuration),
    /// Offset along the target's path over the sky, positive ahead of the target.
    Along(Angle),
    /// Offset across that path, positive to the right as seen from the site.
    Across(Angle),
    Azimuth(Angle),
    Elevation(Angle),
}

impl Offset {
    pub fn is_zero(self) -> bool {
        match self {
            Self::Time(time) => time.is_zero(),
            Self::Along(angle)
            | Self::Across(angle)
            | Self::Azimuth(angle)
            | Self::Elevation(angle) => angle == Angle::ZERO,
        }
    }

    /// Returns an offset of the same kind, from thousandths of a second or of a degree.
    #[must_use]
    pub fn with_thousandths(self, thousandths: i32) -> Self {
        let angle = Angle::from_degrees(f64::from(thousandths) / 1000.0);
        match self {
            Self::Time(_) => Self::Time(SignedDuration::from_millis(thousandths.into())),
            Self::Along(_) => Self::Along(angle),
            Self::Across(_) => Self::Across(angle),
            Self::Azimuth(_) => Self::Azimuth(angle),
            Self::Elevation(_) => Self::Elevation(angle),
        }
    }
}

impl Neg for Offset {
    type Output = Self;

    fn neg(self) -> Self {
        match self {
            Self::Time(time) => Self::Time(-time),
            Self::Along(angle) => Self::Along(-angle),
            Self::Across(angle) => Self::Across(-angle),
            Self::Azimuth(angle) => Self::Azimuth(-angle),
            Self::Elevation(angle) => Self::Elevation(-angle),
        }
    }
}

/// All offsets of a track: the time in whole milliseconds, angles in thousandths of a degree.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(try_from = "WrittenOffsets", into = "WrittenOffsets")]
pub struct TrackOffsets {
    time: SignedDuration,
    along: Angle,
    across: Angle,
    azimuth: Angle,
    elevation: Angle,
}

impl TrackOffsets {
    pub const NONE: Self = Self {
        time: SignedDuration::ZERO,
        along: Angle::ZERO,
        across: Angle::ZERO,
        azimuth: Angle::ZERO,
        elevation: Angle::ZERO,
    };

    pub fn is_none(self) -> bool {
        self == Self::NONE
    }

    /// Returns each of the five offsets.
    pub fn components(self) -> [Offset; 5] {
        [
            Offset::Time(self.time),
            Offset::Along(self.along),
            Offset::Across(self.across),
            Offset::Azimuth(self.azimuth),
            Offset::Elevation(self.elevation),
        ]
    }

    /// Returns the offsets with one of them increased by `step`; `None` if that offset would be too
    /// large.
    #[must_use]
    pub fn plus(mut self, step: Offset) -> Option<Self> {
        let (angle, change) = match step {
            Offset::Time(change) => {
                let sum = self.time.checked_add(change)?;
                self.time = SignedDuration::from_millis(i64::try_from(sum.as_millis()).ok()?);
                return (self.time.abs() <= MAX_TIME_OFFSET).then_some(self);
            }
            Offset::Along(change) => (&mut self.along, change),
            Offset::Across(change) => (&mut self.across, change),
            Offset::Azimuth(change) => (&mut self.azimuth, change),
            Offset::Elevation(change) => (&mut self.elevation, change),
        };
        let thousandths = ((*angle + change).degrees() * 1000.0).round();
        // Rounding and adding zero avoid a negative zero and the residue of repeated steps.
        *angle = Angle::from_degrees(thousandths / 1000.0 + 0.0);
        (angle.abs() <= MAX_ANGLE_OFFSET).then_some(self)
    }

    pub fn azimuth(self) -> Angle {
        self.azimuth
    }

    pub fn elevation(self) -> Angle {
        self.elevation
    }

    /// Returns the sum of both; `None` if one offset would be too large.
    #[must_use]
    pub fn checked_add(self, other: Self) -> Option<Self> {
        other.components().into_iter().try_fold(self, Self::plus)
    }

    /// Returns the offsets without `other`; `None` if one offset would be too large.
    #[must_use]
    pub fn less(self, other: Self) -> Option<Self> {
        other.components().into_iter().try_fold(self, |rest, offset| rest.plus(-offset))
    }

    /// Returns the direction in which to point at `time` for a target with the directions `target`.
    /// Returns `None` if the target has no direction.
    pub fn demanded(
        self,
        time: Timestamp,
        target: impl Fn(Timestamp) -> Option<AzEl>,
    ) -> Option<AzEl> {
        let utc = self.time_of(time);
        let direction = target(utc)?;
        let way = || {
            let [before, after] =
                [-WAY_S, WAY_S].map(|beside_s| target(add_seconds(utc, beside_s)));
            Some(after?.to_enu() - before?.to_enu())
        };
        let way = if self.needs_motion() { way() } else { None };
        Some(self.added_to(direction, way))
    }

    /// Returns the time for which the target is computed.
    fn time_of(self, time: Timestamp) -> Timestamp {
        add_seconds(time, self.time.as_secs_f64())
    }

    /// Returns `true` if the offsets need the target's motion across the sky.
    fn needs_motion(self) -> bool {
        self.along != Angle::ZERO || self.across != Angle::ZERO
    }

    /// Returns the direction to point in for a target in `direction` that moves along `way`.
    /// Without a `way`, the offsets along and across do not apply.
    fn added_to(self, direction: AzEl, way: Option<DVec3>) -> AzEl {
        let shifted = self.shifted_beside_track(direction, way);
        if self.azimuth == Angle::ZERO && self.elevation == Angle::ZERO {
            return shifted;
        }
        AzEl::of_axes(shifted.azimuth + self.azimuth, shifted.elevation + self.elevation)
    }

    /// Returns the same offsets without azimuth and elevation. They give the direction of the beam
    /// on the sky if azimuth and elevation compensate an error of the mount.
    #[must_use]
    pub fn on_the_sky(self) -> Self {
        self.with_axes_of(Self::NONE)
    }

    /// Returns the offsets of azimuth and elevation alone.
    #[must_use]
    pub fn of_the_axes(self) -> Self {
        Self::NONE.with_axes_of(self)
    }

    /// Returns the same offsets with azimuth and elevation of `other`.
    #[must_use]
    pub fn with_axes_of(self, other: Self) -> Self {
        Self { azimuth: other.azimuth, elevation: other.elevation, ..self }
    }

    /// Returns the time offset alone. It gives the direction of the beam if the target is early or
    /// late.
    #[must_use]
    pub fn of_time(self) -> Self {
        Self { time: self.time, ..Self::NONE }
    }

    fn shifted_beside_track(self, direction: AzEl, way: Option<DVec3>) -> AzEl {
        let vector = direction.to_enu();
        let ahead = way.and_then(|way| way.reject_from_normalized(vector).try_normalize());
        let Some(ahead) = ahead.filter(|_| self.needs_motion()) else { return direction };
        let right = vector.cross(ahead);
        let (sin, cos) = self.along.radians().sin_cos();
        let along = vector * cos + ahead * sin;
        let (sin, cos) = self.across.radians().sin_cos();
        AzEl::from_enu(along * cos + right * sin)
    }
}

/// Form of the offsets in files and messages.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
#[serde(default)]
struct WrittenOffsets {
    #[serde(skip_serializing_if = "is_zero")]
    time_s: f64,
    #[serde(skip_serializing_if = "is_zero")]
    along_deg: f64,
    #[serde(skip_serializing_if = "is_zero")]
    across_deg: f64,
    #[serde(skip_serializing_if = "is_zero")]
    azimuth_deg: f64,
    #[serde(skip_serializing_if = "is_zero")]
    elevation_deg: f64,
}

// Serde requires this signature.
#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// Returns the angle in degrees, rounded to thousandths, so that files for operators have no
/// meaningless digits.
fn rounded_deg(angle: Angle) -> f64 {
    (angle.degrees() * 1000.0).round() / 1000.0
}

impl From<TrackOffsets> for WrittenOffsets {
    fn from(offsets: TrackOffsets) -> Self {
        Self {
            time_s: offsets.time.as_secs_f64(),
            along_deg: rounded_deg(offsets.along),
            across_deg: rounded_deg(offsets.across),
            azimuth_deg: rounded_deg(offsets.azimuth),
            elevation_deg: rounded_deg(offsets.elevation),
        }
    }
}

#[derive(Debug, thiserror::Error)]
#[error("an offset of the time is at most 300 s, one of an angle at most 10 degrees")]
struct TooLarge;

impl TryFrom<WrittenOffsets> for TrackOffsets {
    type Error = TooLarge;

    fn try_from(written: WrittenOffsets) -> Result<Self, TooLarge> {
        let time = SignedDuration::try_from_secs_f64(written.time_s).map_err(|_| TooLarge)?;
        let steps = [
            Offset::Time(time),
            Offset::Along(Angle::from_degrees(written.along_deg)),
            Offset::Across(Angle::from_degrees(written.across_deg)),
            Offset::Azimuth(Angle::from_degrees(written.azimuth_deg)),
            Offset::Elevation(Angle::from_degrees(written.elevation_deg)),
        ];
        steps.into_iter().try_fold(Self::NONE, Self::plus).ok_or(TooLarge)
    }
}

#[cfg(test)]
mod tests;
