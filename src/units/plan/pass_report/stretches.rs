//! The state of a pass, stretch by stretch.

use jiff::Timestamp;

use super::{APART_S, TrackPoint, TrackedPass};
use crate::astro::time::{add_seconds, seconds_between};

/// A stretch of a pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stretch {
    pub(super) from: Timestamp,
    pub(super) until: Timestamp,
    pub(super) state: State,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum State {
    /// Within half the beamwidth.
    InBeam,
    Outside,
    NotMeasured,
    NotCommanded,
}

impl Stretch {
    pub(super) fn seconds(&self) -> f64 {
        seconds_between(self.from, self.until)
    }
}

impl TrackedPass<'_> {
    /// The stretches of the pass, in order and without gaps, up to where the program ended. Between
    /// two positions the error is taken to change evenly.
    pub(super) fn stretches(&self, points: &[TrackPoint]) -> Vec<Stretch> {
        let end = self.ended.unwrap_or(self.until);
        let (mut found, mut at) = (Stretches(Vec::new()), self.from);
        for (since, until) in self.breaks.commanded(self.from, end) {
            found.add(at, since, State::NotCommanded);
            self.measured(since, until, points, &mut found);
            at = until;
        }
        found.add(at, end, State::NotCommanded);
        found.0
    }

    /// Adds what was measured from `since` until `to`.
    fn measured(
        &self,
        since: Timestamp,
        to: Timestamp,
        points: &[TrackPoint],
        found: &mut Stretches,
    ) {
        let mut add = |from: Timestamp, until: Timestamp, state| {
            found.add(from.max(since), until.min(to), state);
        };
        let near = add_seconds(since, -APART_S)..=add_seconds(to, APART_S);
        let mut points = points.iter().filter(|point| near.contains(&point.time));
        let Some(mut before) = points.next() else { return add(since, to, State::NotMeasured) };
        // Before the first and after the last position the pass is as it was measured there.
        let is_near = |a: Timestamp, b: Timestamp| seconds_between(a, b) <= APART_S;
        let at_first = is_near(since, before.time);
        add(since, before.time, if at_first { self.state(before) } else { State::NotMeasured });
        for point in points {
            let states = (self.state(before), self.state(point));
            if !is_near(before.time, point.time) {
                add(before.time, point.time, State::NotMeasured);
            } else if states.0 == states.1 {
                add(before.time, point.time, states.0);
            } else {
                let crossing = self.crossing(before, point);
                add(before.time, crossing, states.0);
                add(crossing, point.time, states.1);
            }
            before = point;
        }
        let at_last = is_near(before.time, to);
        add(before.time, to, if at_last { self.state(before) } else { State::NotMeasured });
    }

    fn state(&self, point: &TrackPoint) -> State {
        if self.is_in_beam(point) { State::InBeam } else { State::Outside }
    }

    /// When the satellite crosses half the beamwidth between two positions.
    fn crossing(&self, before: &TrackPoint, after: &TrackPoint) -> Timestamp {
        let half_deg = self.limits.half_beam.degrees();
        let change_deg = after.error.off_deg - before.error.off_deg;
        let share = ((half_deg - before.error.off_deg) / change_deg).clamp(0.0, 1.0);
        add_seconds(before.time, share * seconds_between(before.time, after.time))
    }
}

struct Stretches(Vec<Stretch>);

impl Stretches {
    fn add(&mut self, from: Timestamp, until: Timestamp, state: State) {
        if from >= until {
            return;
        }
        match self.0.last_mut() {
            Some(last) if last.state == state => last.until = until,
            _ => self.0.push(Stretch { from, until, state }),
        }
    }
}
