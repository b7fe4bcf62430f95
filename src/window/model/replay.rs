//! The record shown again.

use jiff::Timestamp;

use crate::{
    astro::time::{add_seconds, seconds_between},
    contract::record::{PassTimes, RecordedPass},
    station::AntennaId,
};

/// A replay of a pass shows so much before and after it, seconds.
const BEFORE_S: f64 = 30.0;
const AFTER_S: f64 = 60.0;

/// A replay ends by itself this long before an antenna is to track a pass, seconds.
pub const ENDS_BEFORE_PASS_S: f64 = 120.0;

/// A stretch of the record that is shown again.
#[derive(Debug, Clone, PartialEq)]
pub struct Stretch {
    /// Subject, such as the name of a satellite.
    pub name: String,
    /// Pass that the stretch is of, if any.
    pub pass: Option<StretchPass>,
    pub start: Timestamp,
    pub end: Timestamp,
}

/// A pass of the record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StretchPass {
    /// Number in the record.
    pub id: i64,
    /// Catalog number of the satellite.
    pub satellite: u32,
    /// The antenna that tracked it.
    pub antenna: AntennaId,
}

impl Stretch {
    /// A pass, from shortly before its track to shortly after its LOS.
    pub fn new(pass: &RecordedPass) -> Self {
        let report = &pass.report;
        Self {
            name: report.elements.short_name().to_owned(),
            pass: Some(StretchPass {
                id: pass.id,
                satellite: report.elements.catalog_number(),
                antenna: pass.antenna,
            }),
            start: add_seconds(report.start.min(report.track.begun), -BEFORE_S),
            end: add_seconds(report.end, AFTER_S),
        }
    }

    /// The same stretch, or one as long around `time` where that is outside.
    #[must_use]
    pub fn around_time(self, time: Timestamp) -> Self {
        if (self.start..=self.end).contains(&time) {
            return self;
        }
        let half_s = seconds_between(self.start, self.end) / 2.0;
        Self {
            name: "the record".to_owned(),
            pass: None,
            start: add_seconds(time, -half_s),
            end: add_seconds(time, half_s),
        }
    }
}

/// Operator's command to a running replay.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ReplayCommand {
    PlayOrPause,
    /// Play at this speed, in multiples of real time; below zero backward.
    Speed(i32),
    /// Show the next recorded pass, or the one before.
    Pass {
        is_next: bool,
    },
    /// Stand at the next recorded event, or at the one before.
    Event {
        is_next: bool,
    },
    /// Go to this moment.
    To(Timestamp),
}

/// Speeds of a replay, forward or backward, in multiples of real time.
pub const SPEEDS: [i32; 5] = [1, 5, 10, 20, 60];

/// How a replay stands.
#[derive(Debug, Clone, PartialEq)]
pub struct Replayed {
    pub stretch: Stretch,
    /// The moment that is shown.
    pub time: Timestamp,
    /// In multiples of real time; below zero backward.
    pub speed: i32,
    pub plays: bool,
    /// The passes in the stretch.
    pub passes: Vec<PassTimes>,
    /// Outcome of the last jump besides the moment that is shown.
    pub news: Option<JumpNews>,
    /// Why this moment is not shown.
    pub problem: Option<ReplayProblem>,
}

/// Outcome of a jump to an event or to a pass besides the moment that is shown.
#[derive(Debug, Clone, PartialEq)]
pub enum JumpNews {
    /// There is no film of this stretch, which was passed over.
    Skipped { start: Timestamp, end: Timestamp },
    /// There is no event on this side.
    NoEvent { is_next: bool },
    /// There is no pass on this side.
    NoPass { is_next: bool },
    /// The record cannot be read.
    Failed(String),
}

/// Why a moment cannot be shown again.
#[derive(Debug, Clone, PartialEq)]
pub enum ReplayProblem {
    /// Nothing was recorded before it.
    NothingYet,
    /// There is no film of it, between two runs. What was shown last stands there.
    NoFilm {
        start: Timestamp,
        end: Timestamp,
    },
    Failed(String),
    /// The thread that reads the film cannot be started or broke off, for this reason. From then on
    /// nothing is read.
    NotRead(String),
}

/// Why a replay ended by itself.
#[derive(Debug, Clone, PartialEq)]
pub enum ReplayEnd {
    Stop,
    /// An alarm of the first priority came.
    Alarm,
    /// An antenna is to track a satellite from then on.
    Pass {
        antenna: String,
        satellite: String,
        start: Timestamp,
    },
}

impl Replayed {
    /// A replay that begins to play.
    pub fn begin(stretch: Stretch, time: Timestamp) -> Self {
        Self { stretch, time, speed: 1, plays: true, passes: Vec::new(), news: None, problem: None }
    }

    /// Returns `true` if playing would not move it on.
    pub fn is_at_end(&self) -> bool {
        self.time == if self.speed < 0 { self.stretch.start } else { self.stretch.end }
    }
}
