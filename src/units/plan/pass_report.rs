//! Report of a pass that an antenna tracked: where it pointed, beside where the satellite was.

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

/// Positions that are further apart tell nothing of the time between, seconds.
pub const APART_S: f64 = 2.0;
/// Time between the two directions that give the direction of motion, seconds.
const MOTION_S: f64 = 0.5;
/// Share of a pass within half the beamwidth from which it is good.
const GOOD: f64 = 0.995;
/// Share from which it is fair.
const FAIR: f64 = 0.95;
/// Factor on the computed loss of a mount that a report allows, and seconds that it adds to that.
const MORE: f64 = 1.25;
const COMES_BACK_S: f64 = 3.0;
/// More seconds of a pass without a position make it poor.
const NOT_KNOWN_S: f64 = 10.0;

/// A pass of an antenna, to be reported on.
#[derive(Debug, Clone, Copy)]
pub struct TrackedPass<'a> {
    pub propagator: &'a Propagator,
    pub site: Site,
    /// Part of the pass that counts: the planned part for the antenna, or without a plan all from
    /// AOS to LOS above the antenna's minimum elevation.
    pub start: Timestamp,
    pub end: Timestamp,
    pub limits: MountLimits,
    /// The share of that part that the mount can track.
    pub trackability: Trackability,
    /// When the program ended, if that was before the pass was over.
    pub ended: Option<Timestamp>,
    pub breaks: &'a Breaks,
}

/// A measured position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredPosition {
    pub time: Timestamp,
    pub pointing: Pointing,
}

impl MeasuredPosition {
    /// Its direction; an antenna without an elevation axis has an elevation of zero.
    pub fn direction(self, has_elevation: bool) -> Option<AzEl> {
        let Pointing { azimuth, elevation } = self.pointing;
        let elevation = elevation.or((!has_elevation).then_some(Angle::ZERO))?;
        Some(AzEl { azimuth: azimuth?, elevation })
    }
}

/// Report of a pass.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PassReport {
    pub verdict: PassVerdict,
    /// Seconds that count.
    pub counted_s: f64,
    /// Seconds of them with positions while the pass was commanded.
    pub known_s: f64,
    /// Seconds of them within half the beamwidth.
    pub in_beam_s: f64,
    /// Root of the mean square over the positions that are judged, and the largest of them; `None`
    /// without one. A position is judged if the satellite was within reach of the mount and the
    /// antenna had no other reason to be elsewhere.
    pub rms: Option<PointingError>,
    pub worst: Option<WorstError>,
    /// Stretches beyond half the beamwidth or without positions, in order.
    pub losses: Vec<LostStretch>,
}

impl PassReport {
    /// Share of the pass within half the beamwidth.
    pub fn share(&self) -> f64 {
        if self.counted_s > 0.0 { self.in_beam_s / self.counted_s } else { 0.0 }
    }

    /// Returns `true` if the error at a time is one of pointing or of the drives. `end`: of what
    /// counts of the pass.
    pub fn judges(&self, time: Timestamp, end: Timestamp) -> bool {
        let is_there = |lost: &&LostStretch| (lost.start..=lost.end).contains(&time);
        self.losses.iter().filter(is_there).all(|lost| lost.is_judged(end))
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PassVerdict {
    /// At least 99.5 % of what could be had, and never beyond half the beamwidth for other reasons.
    Good,
    /// At least 95 % of what could be had.
    Fair,
    /// Less, or more than 10 s are not known.
    Poor,
}

impl PassVerdict {
    /// Its word in lists and files.
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
    /// Azimuth error, the short way round: large near the zenith.
    pub azimuth_deg: f64,
    pub elevation_deg: f64,
    /// Along the satellite's way; positive where the antenna is ahead.
    pub along_deg: f64,
    /// Across it; positive to the right of the way as seen from the site.
    pub across_deg: f64,
}

/// The largest error of a pass.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct WorstError {
    #[serde(rename = "at")]
    pub time: Timestamp,
    pub error: PointingError,
}

/// A measured position beside where the satellite was.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TrackPoint {
    pub time: Timestamp,
    pub antenna: AzEl,
    pub satellite: AzEl,
    pub error: PointingError,
}

impl TrackPoint {
    /// `None` where the position has no direction, or the elements none at its time. A mount without
    /// an elevation axis counts as pointed at the elevation of the satellite.
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
    /// The report by `flown`, oldest first: the positions in which this pass was commanded. Those just
    /// before and after the pass tell when the satellite came into the beam and left it.
    pub fn report(&self, flown: &[MeasuredPosition]) -> PassReport {
        let counted_s = seconds_between(self.start, self.end).max(0.0);
        let near = add_seconds(self.start, -APART_S)..=add_seconds(self.end, APART_S);
        let near = flown.iter().filter(|flown| near.contains(&flown.time));
        let points: Vec<TrackPoint> = near.filter_map(|flown| self.compare(*flown)).collect();
        let stretches = self.stretches(&points);
        let seconds = |is_meant: fn(StretchState) -> bool| {
            let tracked_stretches = stretches.iter().filter(|stretch| is_meant(stretch.state));
            // The sum of nothing is a negative zero.
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

    /// The measured directions that rms and worst of `report`, the report by `flown`, come from.
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

    /// Seconds that this mount may lose: an antenna needs some to come back to its satellite.
    fn allowed_s(&self) -> f64 {
        match self.trackability {
            Trackability::Whole => 0.0,
            Trackability::Loses { seconds, .. } => MORE * seconds + COMES_BACK_S,
            Trackability::Nothing | Trackability::TooLow => f64::INFINITY,
        }
    }

    /// Returns `true` if the mount can point at the satellite then.
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
