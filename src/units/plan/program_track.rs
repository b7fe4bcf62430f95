//! Program track: the positions to command for the smallest pointing error with few drive starts.
//! All functions are pure; positions and time are arguments.

mod axis;
mod chase;
mod drives;
mod path;
mod planner;
mod round;
mod slew_rate;
mod stats;
mod target;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

pub use axis::AxisNow;
pub use drives::{Drives, SetPoint};
pub use planner::{Next, OnPath, PathOrder, PlannedPath, Planner};
pub use stats::TrackStats;
pub use target::{Course, Target};

use crate::astro::{Site, TrackOffsets};

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ProgramTrack {
    pub target: Target,
    pub site: Site,
    /// AOS and LOS of the passes of the target, in order; empty for a target that is always up.
    pub passes: Vec<(Timestamp, Timestamp)>,
    /// Offsets with which each pass begins.
    #[serde(default)]
    pub offsets: TrackOffsets,
}

/// Phase of a target in its passes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum TrackPhase {
    /// Time before a pass: the antenna goes to the start of the pass and waits.
    Waiting { aos: Timestamp },
    /// Time during a pass.
    Tracking,
    /// Time after the last pass.
    Over,
}

impl TrackPhase {
    /// Returns the current time, or the next AOS while waiting.
    pub fn begins(self, now: Timestamp) -> Timestamp {
        match self {
            Self::Waiting { aos } => aos,
            Self::Tracking | Self::Over => now,
        }
    }
}

impl ProgramTrack {
    /// Creates a track without offsets.
    pub fn new(target: Target, site: Site, passes: Vec<(Timestamp, Timestamp)>) -> Self {
        Self { target, site, passes, offsets: TrackOffsets::NONE }
    }

    pub fn phase(&self, now: Timestamp) -> TrackPhase {
        if self.passes.is_empty() {
            return TrackPhase::Tracking;
        }
        match self.pass(now) {
            None => TrackPhase::Over,
            Some((aos, _)) if now < aos => TrackPhase::Waiting { aos },
            Some(_) => TrackPhase::Tracking,
        }
    }

    /// Returns AOS and LOS of the pass at `now`, or of the next one.
    pub fn pass(&self, now: Timestamp) -> Option<(Timestamp, Timestamp)> {
        self.passes.iter().copied().find(|(_, los)| now < *los)
    }

    /// Drops all passes after the pass at `now`, or after the next pass.
    #[must_use]
    pub fn one_pass(mut self, now: Timestamp) -> Self {
        let past_count = self.passes.iter().filter(|(_, los)| *los <= now).count();
        self.passes.truncate(past_count + 1);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn time(second: i64) -> Timestamp {
        Timestamp::from_second(second).unwrap()
    }

    fn track(passes: &[(i64, i64)]) -> ProgramTrack {
        ProgramTrack::new(
            Target::Sun,
            Site::new(41.0, 29.0, 100.0).unwrap(),
            passes.iter().map(|(aos, los)| (time(*aos), time(*los))).collect(),
        )
    }

    #[test]
    fn a_target_waits_is_followed_and_is_over() {
        let two_passes = track(&[(10, 20), (50, 60)]);
        assert_eq!(two_passes.phase(time(9)), TrackPhase::Waiting { aos: time(10) });
        assert_eq!(two_passes.phase(time(10)), TrackPhase::Tracking);
        assert_eq!(two_passes.phase(time(20)), TrackPhase::Waiting { aos: time(50) });
        assert_eq!(two_passes.phase(time(60)), TrackPhase::Over);
    }

    #[test]
    fn without_passes_a_target_is_always_followed() {
        assert_eq!(track(&[]).phase(time(9)), TrackPhase::Tracking);
        assert_eq!(track(&[]).one_pass(time(9)).phase(time(9)), TrackPhase::Tracking);
    }

    #[test]
    fn one_pass_is_the_one_under_way_or_the_next() {
        let passes = [(10, 20), (50, 60), (90, 99)];
        assert_eq!(track(&passes).one_pass(time(0)).phase(time(20)), TrackPhase::Over);
        assert_eq!(track(&passes).one_pass(time(20)).phase(time(59)), TrackPhase::Tracking);
        assert_eq!(track(&passes).one_pass(time(55)).phase(time(60)), TrackPhase::Over);
        assert_eq!(track(&passes).one_pass(time(99)).phase(time(99)), TrackPhase::Over);
    }
}
