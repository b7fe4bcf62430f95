//! Trackable part of a pass for an antenna.

mod az_el;
mod xy;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    astro::{Angle, AzEl, time::seconds_between},
    station::Mount,
};

/// Direction at a time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    pub time: Timestamp,
    pub direction: AzEl,
}

/// Tolerance, degrees: a pass that begins exactly at the minimum elevation counts as above it.
const SAME_DEG: f64 = 0.01;
/// Min elevation of a loss of the kind [`Loss::Overhead`], degrees.
const OVERHEAD_FROM_DEG: f64 = 60.0;

/// Travel and rate of a mount, and the beam that must contain the satellite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MountLimits {
    pub mount: Mount,
    /// Max rate of an axis, degrees per second.
    pub maximum_rate_deg_s: f64,
    /// Half the beam width.
    pub half_beam: Angle,
    /// `false` for a rotator without elevation.
    pub has_elevation: bool,
    /// Min elevation at which the antenna points.
    pub min_elevation: Angle,
}

/// Trackable part of a pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Trackability {
    Whole,
    /// Pass with a loss of some seconds.
    Loses {
        /// Time outside the beam, seconds.
        seconds: f64,
        /// Cause of the loss at its beginning.
        loss: Loss,
        /// First and last time outside the beam; in between, the satellite may be inside.
        start: Timestamp,
        end: Timestamp,
    },
    Nothing,
    /// Pass below the minimum elevation of the antenna.
    TooLow,
}

/// Place or cause of the loss of a satellite.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Loss {
    /// Keyhole near an end of the lower axis of an X/Y mount, at this azimuth.
    Keyhole(Angle),
    /// Overhead pass for which the azimuth axis would have to turn faster than possible.
    Overhead,
    /// Slew of a whole turn at an end of the azimuth axis.
    Slew,
    /// Direction beyond the end of the azimuth travel at this azimuth.
    BeyondAzimuth(Angle),
    /// Direction out of the travel of the elevation axis, or an axis that is still on its way.
    OutOfReach,
}

impl Loss {
    /// Returns the loss of a mount with an azimuth axis at `samples[index]`, the first lost sample.
    /// `is_slewing`: the axis slews a whole turn about that time.
    pub(super) fn at_sample(
        mount: Mount,
        samples: &[Sample],
        index: usize,
        is_slewing: bool,
    ) -> Self {
        let Some(sample) = samples.get(index) else { return Self::OutOfReach };
        // Beyond the travel, no rate of the axis would help.
        if !mount.reaches(sample.direction) {
            Self::beyond_travel(mount, samples, index)
        } else if is_slewing {
            Self::Slew
        } else if sample.direction.elevation_deg() >= OVERHEAD_FROM_DEG {
            Self::Overhead
        } else {
            Self::OutOfReach
        }
    }

    /// Returns the end of the azimuth travel through which the satellite leaves the travel before
    /// `samples[index]` or enters it afterwards. In the middle of the unreachable range, the nearer
    /// end is not meaningful.
    pub(super) fn beyond_travel(mount: Mount, samples: &[Sample], index: usize) -> Self {
        let end = |sample: &Sample| mount.azimuth_end_before(sample.direction);
        let Some((before, from_here)) = samples.split_at_checked(index) else {
            return Self::OutOfReach;
        };
        let outside = from_here.iter().map_while(end);
        let crossed = if before.is_empty() {
            let count = outside.clone().count();
            outside.last().filter(|_| count < from_here.len())
        } else {
            outside.into_iter().next()
        };
        crossed.map_or(Self::OutOfReach, Self::BeyondAzimuth)
    }
}

/// Returns the trackability of the pass along `samples`, which are a few seconds apart, oldest
/// first. Judges only the part above the antenna's own minimum elevation; the antenna waits where
/// that part begins.
pub fn trackability(samples: &[Sample], limits: MountLimits) -> Trackability {
    let is_high = |sample: &Sample| {
        sample.direction.elevation_deg() > limits.min_elevation.degrees() - SAME_DEG
    };
    let (first, last) = (samples.iter().position(is_high), samples.iter().rposition(is_high));
    let (Some(first), Some(last)) = (first, last) else { return Trackability::TooLow };
    let samples = samples.get(first..=last).unwrap_or_default();
    match limits.mount {
        Mount::Xy { .. } => xy::trackability(samples, limits),
        Mount::AzEl { .. } => az_el::trackability(samples, limits),
    }
}

impl Trackability {
    /// Returns the trackability of a pass of `whole_s` seconds that loses these stretches.
    fn new(lost: Outside, whole_s: f64, loss: Loss) -> Self {
        match (lost.first, lost.last) {
            (Some(start), Some(end)) if lost.seconds > 0.0 && lost.seconds < whole_s => {
                Self::Loses { seconds: lost.seconds, loss, start, end }
            }
            (Some(_), Some(_)) if lost.seconds > 0.0 => Self::Nothing,
            _ => Self::Whole,
        }
    }
}

/// Stretches of a pass outside the beam.
#[derive(Debug, Clone, Copy, Default)]
struct Outside {
    seconds: f64,
    first: Option<Timestamp>,
    last: Option<Timestamp>,
}

impl Outside {
    /// Adds the stretch between two times, which must follow the previous stretches.
    fn add(&mut self, start: Timestamp, end: Timestamp) {
        self.seconds += seconds_between(start, end);
        self.first = self.first.or(Some(start));
        self.last = Some(end);
    }
}
