//! State of a pass, stretch by stretch.

use jiff::Timestamp;

use super::{APART_S, TrackPoint, TrackedPass};
use crate::astro::time::{add_seconds, seconds_between};

/// Part of a pass with a constant state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stretch {
    pub(super) start: Timestamp,
    pub(super) end: Timestamp,
    pub(super) state: StretchState,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum StretchState {
    /// Positions within half the beamwidth.
    InBeam,
    Outside,
    NotMeasured,
    NotCommanded,
}

impl Stretch {
    pub(super) fn seconds(&self) -> f64 {
        seconds_between(self.start, self.end)
    }
}

impl TrackedPass<'_> {
    /// Returns the stretches of the pass, in order and without gaps, up to the end of the program.
    /// Assumes that the error changes evenly between two positions.
    pub(super) fn stretches(&self, points: &[TrackPoint]) -> Vec<Stretch> {
        let end = self.ended.unwrap_or(self.end);
        let (mut found, mut time) = (Stretches(Vec::new()), self.start);
        for (start, stop_time) in self.breaks.commanded(self.start, end) {
            found.add(time, start, StretchState::NotCommanded);
            self.measured(start, stop_time, points, &mut found);
            time = stop_time;
        }
        found.add(time, end, StretchState::NotCommanded);
        found.0
    }

    /// Adds the measurements from `start` until `end`.
    fn measured(
        &self,
        start: Timestamp,
        end: Timestamp,
        points: &[TrackPoint],
        found: &mut Stretches,
    ) {
        let mut add = |begin: Timestamp, stop_time: Timestamp, state| {
            found.add(begin.max(start), stop_time.min(end), state);
        };
        let near = add_seconds(start, -APART_S)..=add_seconds(end, APART_S);
        let mut points = points.iter().filter(|point| near.contains(&point.time));
        let Some(mut before) = points.next() else {
            return add(start, end, StretchState::NotMeasured);
        };
        // Before the first and after the last position, the nearest measurement counts.
        let is_near = |a: Timestamp, b: Timestamp| seconds_between(a, b) <= APART_S;
        let at_first = is_near(start, before.time);
        add(
            start,
            before.time,
            if at_first { self.state(before) } else { StretchState::NotMeasured },
        );
        for point in points {
            let states = (self.state(before), self.state(point));
            if !is_near(before.time, point.time) {
                add(before.time, point.time, StretchState::NotMeasured);
            } else if states.0 == states.1 {
                add(before.time, point.time, states.0);
            } else {
                let crossing = self.crossing(before, point);
                add(before.time, crossing, states.0);
                add(crossing, point.time, states.1);
            }
            before = point;
        }
        let at_last = is_near(before.time, end);
        add(before.time, end, if at_last { self.state(before) } else { StretchState::NotMeasured });
    }

    fn state(&self, point: &TrackPoint) -> StretchState {
        if self.is_in_beam(point) { StretchState::InBeam } else { StretchState::Outside }
    }

    /// Returns the time at which the satellite crosses half the beamwidth between two positions.
    fn crossing(&self, before: &TrackPoint, after: &TrackPoint) -> Timestamp {
        let half_deg = self.limits.half_beam.degrees();
        let change_deg = after.error.off_deg - before.error.off_deg;
        let share = ((half_deg - before.error.off_deg) / change_deg).clamp(0.0, 1.0);
        add_seconds(before.time, share * seconds_between(before.time, after.time))
    }
}

struct Stretches(Vec<Stretch>);

impl Stretches {
    fn add(&mut self, start: Timestamp, end: Timestamp, state: StretchState) {
        if start >= end {
            return;
        }
        match self.0.last_mut() {
            Some(last) if last.state == state => last.end = end,
            _ => self.0.push(Stretch { start, end, state }),
        }
    }
}
