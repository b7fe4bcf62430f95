//! The watch: where each axis can be if nothing moves it but what Azel has commanded and the unit's
//! own program. Somebody else has moved an axis that is read elsewhere.
//!
//! It has no clock and no link, and its memory is bounded.

mod axis;
mod lead;
mod lessons;
mod range;

use std::time::Duration;

use crate::{
    clock::Instant,
    contract::driver::{AxisLessons, Evidence},
    device::{AxisMotion, Drive},
};
use axis::AxisWatch;
pub(super) use lead::Lead;

/// Two readings outside the interval, at least this far apart, make a verdict: one alone may be
/// misread.
const APART: Duration = Duration::from_millis(500);
/// A standing axis that a gust has pushed out swings back within this time.
const SWINGS_BACK: Duration = Duration::from_secs(9);

/// Properties of an axis that are known beforehand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AxisFigures {
    /// Step of the reported angle, degrees.
    pub(super) resolution_deg: f64,
    /// Largest difference between two angles of an axis that stands in the wind, degrees.
    pub(super) sway_deg: f64,
    /// The unit ends a motion to a position this near to it, degrees.
    pub(super) arrives_within_deg: f64,
    /// The reported angle jumps by a turn somewhere.
    pub(super) wraps: bool,
}

/// A reading of one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AxisReading {
    /// Degrees as the mount counts.
    pub(super) angle_deg: f64,
    pub(super) motion: AxisMotion,
    pub(super) drive: Drive,
    pub(super) asked: Instant,
    pub(super) received: Instant,
}

/// An axis that somebody else has moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Foreign {
    pub(super) axis: usize,
    pub(super) evidence: Evidence,
}

/// The watch over both axes of an antenna.
#[derive(Debug)]
pub(super) struct MotionWatch {
    axes: [AxisWatch; 2],
    /// Number of motions that were sent, and the newest that was answered.
    sent: u64,
    answered: u64,
}

impl MotionWatch {
    /// Begins with what was learned of each axis before.
    pub(super) fn new(figures: [AxisFigures; 2], lessons: &[AxisLessons; 2]) -> Self {
        let [first, second] = figures;
        let [first_lessons, second_lessons] = lessons;
        let axes = [AxisWatch::new(first, first_lessons), AxisWatch::new(second, second_lessons)];
        Self { axes, sent: 0, answered: 0 }
    }

    /// Returns what was learned of each axis.
    pub(super) fn lessons(&self) -> [AxisLessons; 2] {
        self.axes.each_ref().map(AxisWatch::lessons)
    }

    /// The drives have changed: what was learned no longer holds.
    pub(super) fn forget_lessons(&mut self) {
        for axis in &mut self.axes {
            axis.forget_lessons();
        }
    }

    /// A motion goes out that leads each axis there; an axis with `None` keeps what it has.
    pub(super) fn commanded(&mut self, leads: [Option<Lead>; 2], now: Instant) {
        self.sent += 1;
        for (axis, lead) in self.axes.iter_mut().zip(leads) {
            if let Some(lead) = lead {
                axis.commanded(lead, self.sent, now);
            }
        }
    }

    /// The unit accepted the oldest motion that was not answered: it ends those before.
    pub(super) fn accepted(&mut self, now: Instant) {
        self.answered = (self.answered + 1).min(self.sent);
        for axis in &mut self.axes {
            axis.accepted(self.answered, now);
        }
    }

    /// The oldest motion that was not answered was refused, or nobody knows what became of it.
    pub(super) fn not_accepted(&mut self) {
        self.answered = (self.answered + 1).min(self.sent);
    }

    /// The link is gone: no answer comes any more.
    pub(super) fn not_answered(&mut self) {
        self.answered = self.sent;
    }

    /// Both axes stand: a motion without a known end is over.
    pub(super) fn stands(&mut self) {
        for axis in &mut self.axes {
            axis.stands();
        }
    }

    /// Both axes were proved to stand after a halt: no motion leads on.
    pub(super) fn proved_still(&mut self, now: Instant) {
        self.answered = self.sent;
        for axis in &mut self.axes {
            axis.proved_still(now);
        }
    }

    /// Nobody has watched for a while: the next reading begins anew.
    pub(super) fn start_anew(&mut self) {
        for axis in &mut self.axes {
            axis.start_anew();
        }
    }

    /// The unit's own program may move both axes.
    pub(super) fn opened(&mut self, now: Instant) {
        for axis in &mut self.axes {
            axis.opened(now);
        }
    }

    /// Returns the measured sway of the standing axes, degrees, at most 1; `None` until all `axes` have
    /// been measured.
    pub(super) fn measured_sway_deg(&self, axes: usize) -> Option<f64> {
        let sways_deg = self.axes.iter().take(axes).map(AxisWatch::measured_sway_deg);
        sways_deg.reduce(|one, other| Some(one?.max(other?))).flatten()
    }

    /// Returns `true` if commands lead each axis to where it is read, after a time without readings. An
    /// axis that stands may have coasted by `coasts_deg`.
    pub(super) fn explains(&self, readings: [Option<AxisReading>; 2], coasts_deg: f64) -> bool {
        let mut axes = self.axes.iter().zip(readings);
        let explains = |axis: &AxisWatch, reading: AxisReading| axis.explains(reading, coasts_deg);
        axes.all(|(axis, reading)| reading.is_none_or(|reading| explains(axis, reading)))
    }

    /// The axes that are outside their interval although foreign motion is not yet proved.
    pub(super) fn suspects(&self, now: Instant) -> [bool; 2] {
        self.axes.each_ref().map(|axis| axis.is_suspect(now))
    }

    /// Takes a reading of each axis that has an angle. Returns an axis that somebody else has moved.
    pub(super) fn take(&mut self, readings: [Option<AxisReading>; 2]) -> Option<Foreign> {
        let mut foreign = None;
        for (index, (axis, reading)) in self.axes.iter_mut().zip(readings).enumerate() {
            let evidence = reading.and_then(|reading| axis.take(reading));
            foreign = foreign.or(evidence.map(|evidence| Foreign { axis: index, evidence }));
        }
        foreign
    }
}

#[cfg(test)]
mod tests;
