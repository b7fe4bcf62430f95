//! Positions of both axes along a pass, planned before the pass begins.

use jiff::Timestamp;

use super::{drives::Drives, round::round, target::Course};
use crate::{
    astro::{
        TrackOffsets,
        time::{add_seconds, seconds_between},
    },
    plan::{
        Bounds, Sample,
        az_el::{Flip, FlipChoice, Planned, Start},
    },
};

/// Min interval between two points of a path, seconds.
const MIN_STEP_S: f64 = 0.5;
/// Max number of points of a path.
const MAX_POINTS: f64 = 2400.0;
/// Max difference of an axis rate for which a path remains valid, as a share of the rate.
const SAME_RATE: f64 = 0.02;
/// Share of its rate above which an axis counts as slewing.
const FULL_RATE: f64 = 0.999;

/// Positions of both axes at equal intervals, never faster than the axes turn. The axes stand
/// before the beginning and after the end.
#[derive(Debug, Clone)]
pub(super) struct Path {
    start: Timestamp,
    end: Timestamp,
    step_s: f64,
    /// Turn of each axis in one step at full rate, degrees.
    max_deg: [f64; 2],
    axes: [Vec<f64>; 2],
    flip: Flip,
    goes_round: bool,
}

impl Path {
    /// Plans the path of [`Drives::along`] along `course` with `offsets` from `begin` to `end`,
    /// with detours round the keep-outs of `bounds`. The path ends early if the target decays;
    /// `None` if it has already decayed.
    pub(super) fn along(
        (course, offsets): (&Course, TrackOffsets),
        drives: &Drives,
        bounds: &Bounds,
        (begin, end): (Timestamp, Timestamp),
        start: Start,
        choice: FlipChoice,
    ) -> Option<Self> {
        let span_s = seconds_between(begin, end).max(0.0);
        // A pass of many hours moves slowly, so its points may be further apart.
        let step_s = (span_s / MAX_POINTS).max(MIN_STEP_S);
        let steps = (span_s / step_s).ceil() as u32;
        let samples: Vec<Sample> = (0..=steps)
            .map_while(|step| {
                let time = add_seconds(begin, f64::from(step) * step_s);
                course.demanded(time, offsets).map(|direction| Sample { time, direction })
            })
            .collect();
        let max_deg = drives.rates_deg_s.map(|rate_deg_s| rate_deg_s * step_s);
        let Planned { flip, axes_deg: axes, goes_round, .. } =
            drives.along_within(bounds, &samples, step_s, start, choice);
        let end_time = samples.last()?.time;
        Some(Self { start: begin, end: end_time, step_s, max_deg, axes, flip, goes_round })
    }

    pub(super) fn end(&self) -> Timestamp {
        self.end
    }

    /// Returns `true` if the path was planned for these rates.
    pub(super) fn is_for(&self, rates_deg_s: [f64; 2]) -> bool {
        let mut axes = self.max_deg.into_iter().zip(rates_deg_s);
        axes.all(|(max_deg, rate_deg_s)| {
            // A measured rate varies slightly, and a new path for each reading would never settle.
            (rate_deg_s * self.step_s / max_deg - 1.0).abs() < SAME_RATE
        })
    }

    /// Returns `true` for a path with a detour round a keep-out.
    pub(super) fn goes_round(&self) -> bool {
        self.goes_round
    }

    pub(super) fn flip(&self) -> Flip {
        self.flip
    }

    /// Returns the seconds from the beginning of the path to `time`.
    pub(super) fn seconds(&self, time: Timestamp) -> f64 {
        seconds_between(self.start, time)
    }

    /// Returns the lowest and highest position of an axis between two times, in seconds from the
    /// beginning of the path, the earlier first.
    pub(super) fn span_deg(&self, axis: usize, from_s: f64, to_s: f64) -> (f64, f64) {
        let [start, end] = [from_s, to_s].map(|at_s| self.position_deg(axis, at_s));
        let inner = self.positions_between(axis, from_s, to_s);
        inner.fold((start.min(end), start.max(end)), widened)
    }

    /// Does the same as [`Path::span_deg`], but continues as long as the span stays within
    /// `within_deg`.
    pub(super) fn longest_span_deg(
        &self,
        axis: usize,
        from_s: f64,
        to_s: f64,
        within_deg: f64,
    ) -> (f64, f64) {
        let mut span = self.span_deg(axis, from_s, to_s);
        for position in self.positions_between(axis, to_s, f64::INFINITY) {
            let wider = widened(span, position);
            // One command suffices as long as the path stays within the tolerance of the axis.
            if wider.1 - wider.0 > within_deg {
                break;
            }
            span = wider;
        }
        span
    }

    /// Returns the end of the current slew of an axis; `None` if the axis is not slewing.
    pub(super) fn slew_end_deg(&self, axis: usize, at_s: f64) -> Option<f64> {
        let (first, max_deg) = (self.index(at_s), self.max_deg.get(axis)?);
        let rest = self.axes.get(axis)?.get(first..)?;
        let slews = |pair: &&[f64]| {
            let [before, after] = pair else { return false };
            (after - before).abs() >= FULL_RATE * max_deg
        };
        let grows = |pair: &[f64]| {
            let [before, after] = pair else { return false };
            after > before
        };
        let begun = rest.windows(2).next().filter(slews)?;
        let steps = rest.windows(2).take_while(slews);
        // A slew that reverses ends there: one command would skip the turn.
        let steps = steps.take_while(|pair| grows(pair) == grows(begun)).count();
        rest.get(steps).copied()
    }

    /// Returns the positions of both axes at `time`, degrees as the mount counts.
    pub(super) fn positions_deg(&self, time: Timestamp) -> [f64; 2] {
        let at_s = self.seconds(time);
        [0, 1].map(|axis| self.position_deg(axis, at_s))
    }

    fn position_deg(&self, axis: usize, at_s: f64) -> f64 {
        let Some(points) = self.axes.get(axis) else { return 0.0 };
        let first = self.index(at_s);
        let before = points.get(first).copied().unwrap_or_default();
        let after = points.get(first + 1).copied().unwrap_or(before);
        let share = (at_s / self.step_s - first as f64).clamp(0.0, 1.0);
        before + (after - before) * share
    }

    /// Returns the points strictly between two times.
    fn positions_between(&self, axis: usize, from_s: f64, to_s: f64) -> impl Iterator<Item = f64> {
        let points = self.axes.get(axis).map(Vec::as_slice).unwrap_or_default();
        let first = (from_s / self.step_s).floor().max(-1.0) + 1.0;
        let after = (to_s / self.step_s).ceil().clamp(0.0, points.len() as f64);
        points.get(first as usize..after as usize).unwrap_or_default().iter().copied()
    }

    /// Returns the index of the point at or before `at_s`.
    fn index(&self, at_s: f64) -> usize {
        let last = self.axes[0].len().saturating_sub(1);
        ((at_s / self.step_s).floor().max(0.0) as usize).min(last)
    }
}

impl Drives {
    /// Does the same as [`Drives::along`], with detours round the keep-outs of `bounds`.
    pub(in crate::plan) fn along_within(
        &self,
        bounds: &Bounds,
        samples: &[Sample],
        step_s: f64,
        start: Start,
        choice: FlipChoice,
    ) -> Planned {
        let mut planned = self.along(samples, step_s, start, choice);
        // A rotator without elevation cannot go over or under a keep-out.
        if bounds.has_way_round() && self.has_elevation {
            let limits = self.axis_limits();
            let detoured = round(&planned.axes_deg, samples, step_s, start, limits, bounds);
            if let Some(axes_deg) = detoured {
                planned = Planned { axes_deg, goes_round: true, ..planned };
            }
        }
        planned
    }
}

fn widened((min, max): (f64, f64), position: f64) -> (f64, f64) {
    (min.min(position), max.max(position))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a path that rises by a degree per second for ten seconds, then slews down at 5
    /// degrees per second for four.
    fn path() -> Path {
        let up = (0..=20).map(|step| f64::from(step) * 0.5);
        let down = (1..=8).map(|step| 10.0 - 2.5 * f64::from(step));
        let axis: Vec<f64> = up.chain(down).chain([-10.0; 4]).collect();
        let start = Timestamp::UNIX_EPOCH;
        Path {
            start,
            end: add_seconds(start, 16.0),
            step_s: 0.5,
            max_deg: [2.5; 2],
            axes: [axis.clone(), axis],
            flip: Flip::None,
            goes_round: false,
        }
    }

    #[test]
    fn between_its_points_it_is_straight_and_beyond_its_ends_it_stands() {
        let path = path();
        for (at_s, expected) in [(-9.0, 0.0), (0.25, 0.25), (10.1, 9.5), (99.0, -10.0)] {
            let position = path.position_deg(0, at_s);
            assert!((position - expected).abs() < 1e-9, "{at_s} {position}");
        }
    }

    #[test]
    fn a_span_holds_every_position_between_two_times() {
        let path = path();
        assert_eq!(path.span_deg(0, 9.0, 11.0), (5.0, 10.0));
        assert_eq!(path.span_deg(0, -5.0, -1.0), (0.0, 0.0));
        assert_eq!(path.span_deg(1, 50.0, 60.0), (-10.0, -10.0));
        assert_eq!(path.longest_span_deg(0, -5.0, -1.0, 3.0), (0.0, 3.0));
        assert_eq!(path.longest_span_deg(0, 9.0, 11.0, 3.0), (5.0, 10.0));
    }

    #[test]
    fn a_slew_is_known_by_its_rate_and_its_end() {
        let path = path();
        assert_eq!(path.slew_end_deg(0, 3.0), None);
        assert_eq!(path.slew_end_deg(0, 10.2), Some(-10.0));
        assert_eq!(path.slew_end_deg(0, 13.9), Some(-10.0));
        assert_eq!(path.slew_end_deg(0, 14.1), None);
        assert_eq!(path.slew_end_deg(0, 99.0), None);
    }
}
