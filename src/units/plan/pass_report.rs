//! Report of a tracked pass: the direction of the antenna, compared with the direction of the
//! satellite.

mod breaks;
mod explain;
mod flown_offsets;
mod following;
mod losses;
mod stretches;
#[cfg(test)]
mod tests;

pub use breaks::Breaks;
pub use explain::{Axis, Cause, Evidence, Explained, Explanation, PathSource};
pub use flown_offsets::FlownOffsets;
pub use losses::{LossCause, LostStretch};
use stretches::{Stretch, StretchState};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::trackability::{MountLimits, Trackability};
use crate::{
    astro::{
        Angle, AzEl, Site,
        time::{add_seconds, seconds_between},
    },
    device::Pointing,
    orbit::Propagator,
};

/// Max gap between positions that still describe the time between them, seconds.
pub const APART_S: f64 = 2.0;
/// Time between the two directions that give the direction of motion, seconds.
const MOTION_S: f64 = 0.5;
/// Min share of a pass within half the beamwidth for a good pass.
const GOOD: f64 = 0.995;
/// Min share for a fair pass.
const FAIR: f64 = 0.95;
/// Factor on the computed loss of a mount that a report allows; the constant below adds seconds.
const MORE: f64 = 1.25;
const COMES_BACK_S: f64 = 3.0;
/// Max seconds of a pass without a position, unless it is poor.
const NOT_KNOWN_S: f64 = 10.0;

/// Pass of an antenna that needs a report.
#[derive(Debug, Clone, Copy)]
pub struct TrackedPass<'a> {
    pub propagator: &'a Propagator,
    pub site: Site,
    /// Start of the part of the pass that counts: the planned part for the antenna. Without a plan,
    /// this part lasts from AOS to LOS above the antenna's minimum elevation.
    pub start: Timestamp,
    pub end: Timestamp,
    pub limits: MountLimits,
    /// Trackable share of that part for the mount.
    pub trackability: Trackability,
    /// End of the program, if it came before the end of the pass.
    pub ended: Option<Timestamp>,
    pub breaks: &'a Breaks,
}

/// Direction that the unit reported at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredPosition {
    pub time: Timestamp,
    pub pointing: Pointing,
}

impl MeasuredPosition {
    /// Returns the direction; an antenna without an elevation axis has an elevation of zero.
    pub fn direction(self, has_elevation: bool) -> Option<AzEl> {
        let Pointing { azimuth, elevation } = self.pointing;
        let elevation = elevation.or((!has_elevation).then_some(Angle::ZERO))?;
        Some(AzEl { azimuth: azimuth?, elevation })
    }
}

/// Report of a pass: verdict, pointing errors and losses.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PassReport {
    pub verdict: PassVerdict,
    /// Duration of the part of the pass that counts, seconds.
    pub counted_s: f64,
    /// Counted seconds with positions while the pass was commanded.
    pub known_s: f64,
    /// Counted seconds within half the beamwidth.
    pub in_beam_s: f64,
    /// Root of the mean square over the judged positions, and the largest error; `None` without a
    /// judged position. Azel judges a position if the satellite was within reach of the mount and
    /// no other reason kept the antenna away.
    pub rms: Option<PointingError>,
    pub worst: Option<WorstError>,
    /// Stretches beyond half the beamwidth or without positions, in order.
    pub losses: Vec<LostStretch>,
}

impl PassReport {
    /// Returns the share of the pass within half the beamwidth.
    pub fn share(&self) -> f64 {
        if self.counted_s > 0.0 { self.in_beam_s / self.counted_s } else { 0.0 }
    }

    /// Returns `true` if the error at `time` comes from pointing or from the drives. `end`: end of
    /// the part of the pass that counts.
    pub fn judges(&self, time: Timestamp, end: Timestamp) -> bool {
        let is_there = |lost: &&LostStretch| (lost.start..=lost.end).contains(&time);
        self.losses.iter().filter(is_there).all(|lost| lost.is_judged(end))
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PassVerdict {
    /// Verdict for at least 99.5 % of the attainable time, and never beyond half the beamwidth for
    /// other reasons.
    Good,
    /// Verdict for at least 95 % of the attainable time.
    Fair,
    /// Verdict for less than 95 %, or for more than 10 s without information.
    Poor,
}

impl PassVerdict {
    /// Returns the word for lists and files.
    pub fn word(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Fair => "fair",
            Self::Poor => "poor",
        }
    }
}

/// Measured minus predicted direction, degrees.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PointingError {
    /// Angle between the beam axis and the satellite.
    pub off_deg: f64,
    /// Azimuth error by the shorter turn: large near the zenith.
    pub azimuth_deg: f64,
    pub elevation_deg: f64,
    /// Error along the satellite's path; positive if the antenna is ahead.
    pub along_deg: f64,
    /// Error across the satellite's path; positive to the right of the path as seen from the site.
    pub across_deg: f64,
}

/// Largest error of a pass.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct WorstError {
    #[serde(rename = "at")]
    pub time: Timestamp,
    pub error: PointingError,
}

/// Measured position, and the direction of the satellite at that time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TrackPoint {
    pub time: Timestamp,
    pub antenna: AzEl,
    pub satellite: AzEl,
    pub error: PointingError,
}

impl TrackPoint {
    /// Compares a position with the satellite. Returns `None` if the position has no direction, or
    /// if the elements yield none at its time. A mount without an elevation axis counts as pointed
    /// at the elevation of the satellite.
    pub fn new(
        propagator: &Propagator,
        site: Site,
        has_elevation: bool,
        flown: MeasuredPosition,
    ) -> Option<Self> {
        let direction = |time| propagator.look_from(site, time).ok().map(|look| look.direction);
        let satellite = direction(flown.time)?;
        let ahead = direction(add_seconds(flown.time, MOTION_S))?;
        let azimuth = flown.pointing.azimuth?;
        let elevation =
            flown.pointing.elevation.or((!has_elevation).then_some(satellite.elevation))?;
        let antenna = AzEl { azimuth, elevation };
        let deviation = flown.pointing.separation(satellite.into())?;
        let vector = satellite.to_enu();
        let error = antenna.to_enu() - vector;
        let way = (ahead.to_enu() - vector).reject_from_normalized(vector).normalize_or_zero();
        let along = Angle::from_radians(error.dot(way));
        let across = Angle::from_radians(error.dot(vector.cross(way)));
        let error = PointingError {
            off_deg: deviation.degrees(),
            azimuth_deg: (azimuth - satellite.azimuth).wrapped_180().degrees(),
            elevation_deg: (elevation - satellite.elevation).degrees(),
            along_deg: along.degrees(),
            across_deg: across.degrees(),
        };
        Some(Self { time: flown.time, antenna, satellite, error })
    }
}

impl TrackedPass<'_> {
    /// Returns the report by `flown`, the positions with this pass commanded, oldest first.
    /// Positions just before and after the pass show when the satellite entered and left the beam.
    pub fn report(&self, flown: &[MeasuredPosition]) -> PassReport {
        let counted_s = seconds_between(self.start, self.end).max(0.0);
        let near = add_seconds(self.start, -APART_S)..=add_seconds(self.end, APART_S);
        let near = flown.iter().filter(|flown| near.contains(&flown.time));
        let points: Vec<TrackPoint> = near.filter_map(|flown| self.compare(*flown)).collect();
        let stretches = self.stretches(&points);
        let seconds = |is_meant: fn(StretchState) -> bool| {
            let tracked_stretches = stretches.iter().filter(|stretch| is_meant(stretch.state));
            // An empty sum is a negative zero.
            tracked_stretches.map(Stretch::seconds).sum::<f64>().abs()
        };
        let known_s =
            seconds(|state| matches!(state, StretchState::InBeam | StretchState::Outside));
        let in_beam_s = seconds(|state| state == StretchState::InBeam);
        let losses = self.losses(&stretches, &points);
        let is_planned = |loss: &&LostStretch| loss.cause.is_of_mount();
        let planned_s: f64 = losses.iter().filter(is_planned).map(LostStretch::seconds).sum();
        let excused_s = if planned_s <= self.allowed_s() { planned_s } else { 0.0 };
        let could_not_be_had =
            losses.iter().all(|loss| is_planned(&loss)) && excused_s >= planned_s;
        let is_unknown = |loss: &&LostStretch| loss.cause.is_unknown();
        let not_known_s: f64 = losses.iter().filter(is_unknown).map(LostStretch::seconds).sum();
        let could_s = counted_s - excused_s;
        let share = if could_s > 0.0 { in_beam_s / could_s } else { 0.0 };
        let is_excused =
            |loss: &LostStretch| is_unknown(&loss) || is_planned(&loss) && excused_s >= planned_s;
        let stays_in_beam = losses.iter().all(is_excused);
        let verdict = if not_known_s > NOT_KNOWN_S || points.is_empty() {
            PassVerdict::Poor
        } else if share >= GOOD && stays_in_beam || could_not_be_had {
            PassVerdict::Good
        } else if share >= FAIR {
            PassVerdict::Fair
        } else {
            PassVerdict::Poor
        };
        let (rms, worst) = (None, None);
        let mut report = PassReport { verdict, counted_s, known_s, in_beam_s, rms, worst, losses };
        let judged: Vec<&TrackPoint> =
            points.iter().filter(|point| self.judges(&report, point)).collect();
        let worst = judged.iter().max_by(|a, b| a.error.off_deg.total_cmp(&b.error.off_deg));
        report.worst = worst.map(|worst| WorstError { time: worst.time, error: worst.error });
        report.rms = root_mean_square(&judged);
        report
    }

    /// Returns the measured directions behind the rms and worst error of `report`, which must be
    /// the report by `flown`.
    pub fn judged(
        &self,
        report: &PassReport,
        flown: &[MeasuredPosition],
    ) -> impl Iterator<Item = (Timestamp, AzEl)> {
        let points = flown.iter().filter_map(|flown| self.compare(*flown));
        let judged = points.filter(|point| self.judges(report, point));
        judged.map(|point| (point.time, point.antenna))
    }

    fn judges(&self, report: &PassReport, point: &TrackPoint) -> bool {
        (self.start..=self.end).contains(&point.time)
            && self.limits.mount.reaches(point.satellite)
            && report.judges(point.time, self.end)
    }

    /// Returns the seconds that this mount may lose, because an antenna needs time to return to its
    /// satellite.
    fn allowed_s(&self) -> f64 {
        match self.trackability {
            Trackability::Whole => 0.0,
            Trackability::Loses { seconds, .. } => MORE * seconds + COMES_BACK_S,
            Trackability::Nothing | Trackability::TooLow => f64::INFINITY,
        }
    }

    /// Returns `true` if the mount can point at the satellite at `time`.
    fn is_in_reach(&self, time: Timestamp) -> bool {
        let look = self.propagator.look_from(self.site, time);
        look.is_ok_and(|look| self.limits.mount.reaches(look.direction))
    }

    fn compare(&self, flown: MeasuredPosition) -> Option<TrackPoint> {
        TrackPoint::new(self.propagator, self.site, self.limits.has_elevation, flown)
    }

    fn is_in_beam(&self, point: &TrackPoint) -> bool {
        point.error.off_deg <= self.limits.half_beam.degrees()
    }
}

fn root_mean_square(compared: &[&TrackPoint]) -> Option<PointingError> {
    let count = compared.len();
    if count == 0 {
        return None;
    }
    let rms = |part: fn(&PointingError) -> f64| {
        let squares: f64 =
            compared.iter().map(|track_point| part(&track_point.error).powi(2)).sum();
        (squares / count as f64).sqrt()
    };
    Some(PointingError {
        off_deg: rms(|error| error.off_deg),
        azimuth_deg: rms(|error| error.azimuth_deg),
        elevation_deg: rms(|error| error.elevation_deg),
        along_deg: rms(|error| error.along_deg),
        across_deg: rms(|error| error.across_deg),
    })
}
