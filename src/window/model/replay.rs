//! Replay of the record.

use jiff::Timestamp;

use crate::{
    astro::time::{add_seconds, seconds_between},
    contract::record::{PassTimes, RecordedPass},
    station::AntennaId,
};

/// Time that a replay shows before and after a pass, seconds.
const BEFORE_S: f64 = 30.0;
const AFTER_S: f64 = 60.0;

/// Time before a tracked pass at which a replay ends automatically, seconds.
pub const ENDS_BEFORE_PASS_S: f64 = 120.0;

/// A stretch of the record for a replay.
#[derive(Debug, Clone, PartialEq)]
pub struct Stretch {
    /// Subject of the stretch, such as the name of a satellite.
    pub name: String,
    /// Pass in the stretch, if it shows one.
    pub pass: Option<StretchPass>,
    pub start: Timestamp,
    pub end: Timestamp,
}

/// A pass of the record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StretchPass {
    /// Id of the pass in the record.
    pub id: i64,
    /// Catalog number of the satellite.
    pub satellite: u32,
    /// The antenna that tracked the pass.
    pub antenna: AntennaId,
}

impl Stretch {
    /// Returns the stretch of a pass, from shortly before its track to shortly after its LOS.
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

    /// Returns the same stretch, or one of the same length around `time` if `time` is outside.
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

/// A command of the operator to the current replay.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ReplayCommand {
    PlayOrPause,
    /// Speed to play at, in multiples of real time; negative speeds play backward.
    Speed(i32),
    /// Jump to the next or previous recorded pass.
    Pass {
        is_next: bool,
    },
    /// Jump to the next or previous recorded event.
    Event {
        is_next: bool,
    },
    /// Jump to this time.
    To(Timestamp),
}

/// Speeds of a replay, forward or backward, in multiples of real time.
pub const SPEEDS: [i32; 5] = [1, 5, 10, 20, 60];

/// State of a replay.
#[derive(Debug, Clone, PartialEq)]
pub struct Replayed {
    pub stretch: Stretch,
    /// The time that the replay shows.
    pub time: Timestamp,
    /// Speed in multiples of real time; negative if the replay runs backward.
    pub speed: i32,
    pub plays: bool,
    /// The passes in the stretch.
    pub passes: Vec<PassTimes>,
    /// Outcome of the last jump besides the new time.
    pub news: Option<JumpNews>,
    /// Reason why the replay cannot show this time.
    pub problem: Option<ReplayProblem>,
}

/// Outcome of a jump to an event or to a pass besides the new time.
#[derive(Debug, Clone, PartialEq)]
pub enum JumpNews {
    /// A stretch without film, which the replay skipped.
    Skipped { start: Timestamp, end: Timestamp },
    /// No event in this direction.
    NoEvent { is_next: bool },
    /// No pass in this direction.
    NoPass { is_next: bool },
    /// Error while reading the record.
    Failed(String),
}

/// Reason why the replay cannot show a time.
#[derive(Debug, Clone, PartialEq)]
pub enum ReplayProblem {
    /// A time before the first record.
    NothingYet,
    /// A time between two runs, without film. The view keeps the last shown state.
    NoFilm {
        start: Timestamp,
        end: Timestamp,
    },
    Failed(String),
    /// Reason why the thread that reads the film could not start or has stopped. Azel reads no more
    /// film.
    NotRead(String),
}

/// Reason why a replay ended automatically.
#[derive(Debug, Clone, PartialEq)]
pub enum ReplayEnd {
    Stop,
    /// A new alarm of the first priority.
    Alarm,
    /// A pass that an antenna is about to track.
    Pass {
        antenna: String,
        satellite: String,
        start: Timestamp,
    },
}

impl Replayed {
    /// Returns a replay that starts to play.
    pub fn begin(stretch: Stretch, time: Timestamp) -> Self {
        Self { stretch, time, speed: 1, plays: true, passes: Vec::new(), news: None, problem: None }
    }

    /// Returns `true` if the replay is at the end towards which it plays.
    pub fn is_at_end(&self) -> bool {
        self.time == if self.speed < 0 { self.stretch.start } else { self.stretch.end }
    }
}
