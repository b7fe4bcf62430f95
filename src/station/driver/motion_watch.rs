//! Motion watch: the possible interval of each axis if only commands of Azel and the unit's own
//! program move it. Somebody else has moved an axis whose reading is outside.
//!
//! The watch has no clock and no link, and its memory is bounded.

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

/// Min time between two readings outside the interval that prove foreign motion: a single reading
/// may be wrong.
const APART: Duration = Duration::from_millis(500);
/// Max time in which a standing axis swings back after a gust pushed it out.
const SWINGS_BACK: Duration = Duration::from_secs(9);

/// Known properties of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AxisFigures {
    /// Step of the reported angle, degrees.
    pub(super) resolution_deg: f64,
    /// Max difference between two angles of an axis that stands in the wind, degrees.
    pub(super) sway_deg: f64,
    /// Max distance from the target at which the unit ends a motion to a position, degrees.
    pub(super) arrives_within_deg: f64,
    /// `true` if the reported angle jumps by a full turn somewhere.
    pub(super) wraps: bool,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AxisReading {
    /// Angle, degrees as the mount counts.
    pub(super) angle_deg: f64,
    pub(super) motion: AxisMotion,
    pub(super) drive: Drive,
    pub(super) requested: Instant,
    pub(super) received: Instant,
}

/// Axis that somebody else has moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Foreign {
    pub(super) axis: usize,
    pub(super) evidence: Evidence,
}

/// Watch over both axes of an antenna.
#[derive(Debug)]
pub(super) struct MotionWatch {
    axes: [AxisWatch; 2],
    /// Number of sent motions, and number of the newest answered motion.
    sent: u64,
    answered: u64,
}

impl MotionWatch {
    /// Creates the watch with the earlier lessons about each axis.
    pub(super) fn new(figures: [AxisFigures; 2], lessons: &[AxisLessons; 2]) -> Self {
        let [first, second] = figures;
        let [first_lessons, second_lessons] = lessons;
        let axes = [AxisWatch::new(first, first_lessons), AxisWatch::new(second, second_lessons)];
        Self { axes, sent: 0, answered: 0 }
    }

    pub(super) fn lessons(&self) -> [AxisLessons; 2] {
        self.axes.each_ref().map(AxisWatch::lessons)
    }

    /// Discards the lessons, because the drives have changed.
    pub(super) fn forget_lessons(&mut self) {
        for axis in &mut self.axes {
            axis.forget_lessons();
        }
    }

    /// Records an outgoing motion that leads each axis to its lead; an axis with `None` keeps its
    /// motions.
    pub(super) fn note_command(&mut self, leads: [Option<Lead>; 2], now: Instant) {
        self.sent += 1;
        for (axis, lead) in self.axes.iter_mut().zip(leads) {
            if let Some(lead) = lead {
                axis.note_command(lead, self.sent, now);
            }
        }
    }

    /// Records that the unit accepted the oldest unanswered motion, which ends the motions before
    /// it.
    pub(super) fn note_acceptance(&mut self, now: Instant) {
        self.answered = (self.answered + 1).min(self.sent);
        for axis in &mut self.axes {
            axis.note_acceptance(self.answered, now);
        }
    }

    /// Records that the unit refused the oldest unanswered motion, or that its outcome is unknown.
    pub(super) fn note_refusal(&mut self) {
        self.answered = (self.answered + 1).min(self.sent);
    }

    /// Records that the link is gone and no answer will come.
    pub(super) fn note_lost_answers(&mut self) {
        self.answered = self.sent;
    }

    /// Records that both axes stand: a motion without a known end is over.
    pub(super) fn note_rest(&mut self) {
        for axis in &mut self.axes {
            axis.note_rest();
        }
    }

    /// Records proved standstill of both axes after a halt: no motion continues.
    pub(super) fn note_standstill(&mut self, now: Instant) {
        self.answered = self.sent;
        for axis in &mut self.axes {
            axis.note_standstill(now);
        }
    }

    /// Restarts the watch after a time without readings: the next reading is the new reference.
    pub(super) fn restart(&mut self) {
        for axis in &mut self.axes {
            axis.restart();
        }
    }

    /// Records that the unit's own program may move both axes.
    pub(super) fn open(&mut self, now: Instant) {
        for axis in &mut self.axes {
            axis.open(now);
        }
    }

    /// Returns the measured sway of the standing axes, degrees, at most 1; `None` until all `axes`
    /// have been measured.
    pub(super) fn measured_sway_deg(&self, axes: usize) -> Option<f64> {
        let sways_deg = self.axes.iter().take(axes).map(AxisWatch::measured_sway_deg);
        sways_deg.reduce(|one, other| Some(one?.max(other?))).flatten()
    }

    /// Returns `true` if commands explain the reading of each axis after a time without readings. A
    /// standing axis may have coasted by `coasts_deg`.
    pub(super) fn explains(&self, readings: [Option<AxisReading>; 2], coasts_deg: f64) -> bool {
        let mut axes = self.axes.iter().zip(readings);
        let explains = |axis: &AxisWatch, reading: AxisReading| axis.explains(reading, coasts_deg);
        axes.all(|(axis, reading)| reading.is_none_or(|reading| explains(axis, reading)))
    }

    /// Returns the axes that are outside their interval although foreign motion is not yet proved.
    pub(super) fn suspects(&self, now: Instant) -> [bool; 2] {
        self.axes.each_ref().map(|axis| axis.is_suspect(now))
    }

    /// Takes a reading of each axis that has an angle. Returns an axis that somebody else has
    /// moved.
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
