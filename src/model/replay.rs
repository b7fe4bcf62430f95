//! The record shown again.

use jiff::Timestamp;

use crate::astro::time::{add_seconds, seconds_between};

/// A stretch of the record that is shown again.
#[derive(Debug, Clone, PartialEq)]
pub struct Stretch {
    /// What it is of, such as the name of a satellite.
    pub name: String,
    /// Catalog number of the satellite, if it is of one.
    pub satellite: Option<u32>,
    pub from: Timestamp,
    pub until: Timestamp,
}

impl Stretch {
    /// The same stretch, or one as long around `at` where that is outside.
    #[must_use]
    pub fn around(self, at: Timestamp) -> Self {
        if (self.from..=self.until).contains(&at) {
            return self;
        }
        let half_s = seconds_between(self.from, self.until) / 2.0;
        Self { from: add_seconds(at, -half_s), until: add_seconds(at, half_s), ..self }
    }
}

/// What the operator wants of a replay.
#[derive(Debug, Clone, PartialEq)]
pub enum ReplayCommand {
    /// Show a stretch of the record again, from this moment on.
    Begin(Stretch, Timestamp),
    PlayOrPause,
    /// Play at this speed, in multiples of real time; below zero backward.
    Speed(i32),
    /// Stand at the next recorded event, or at the one before.
    Event {
        is_next: bool,
    },
    /// Go to this moment.
    To(Timestamp),
    /// Show the present again.
    Leave,
}

/// Speeds of a replay, forward or backward, in multiples of real time.
pub const SPEEDS: [i32; 6] = [1, 2, 5, 10, 30, 60];

/// How a replay stands.
#[derive(Debug, Clone, PartialEq)]
pub struct Replayed {
    pub stretch: Stretch,
    /// The moment that is shown.
    pub at: Timestamp,
    /// In multiples of real time; below zero backward.
    pub speed: i32,
    pub plays: bool,
    /// Why this moment is not shown.
    pub problem: Option<ReplayProblem>,
}

/// Why a moment cannot be shown again.
#[derive(Debug, Clone, PartialEq)]
pub enum ReplayProblem {
    /// Nothing was recorded before it.
    NothingYet,
    Failed(String),
}

/// Why a replay ended by itself.
#[derive(Debug, Clone, PartialEq)]
pub enum ReplayEnd {
    Stop,
    /// An alarm of the first priority came.
    Alarm,
    /// The station will track this satellite from then on.
    Pass {
        name: String,
        from: Timestamp,
    },
}

impl Replayed {
    /// Whether it would not move on if it played.
    pub fn is_at_end(&self) -> bool {
        self.at == if self.speed < 0 { self.stretch.from } else { self.stretch.until }
    }
}
