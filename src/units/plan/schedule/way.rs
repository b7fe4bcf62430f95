//! Path of an antenna along a pass: the positions of its axes, and the seconds that count.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::sight::Samples;
use crate::plan::{Barrier, Loss};

/// Converts a time to milliseconds since 1970.
pub(super) fn ms(time: Timestamp) -> i64 {
    time.as_millisecond()
}

/// Converts milliseconds since 1970 to a time.
pub(super) fn at_ms(ms: i64) -> Timestamp {
    Timestamp::from_millisecond(ms).unwrap_or_default()
}

/// Span of time, milliseconds since 1970.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Span {
    pub(super) from_ms: i64,
    pub(super) to_ms: i64,
}

impl Span {
    pub(super) fn length_ms(self) -> i64 {
        self.to_ms - self.from_ms
    }

    pub(super) fn total_ms(spans: &[Self]) -> i64 {
        spans.iter().map(|span| span.length_ms()).sum()
    }

    /// Returns the common time of both spans, if any.
    pub(super) fn intersection(self, other: Self) -> Option<Self> {
        let spans =
            Self { from_ms: self.from_ms.max(other.from_ms), to_ms: self.to_ms.min(other.to_ms) };
        (spans.from_ms < spans.to_ms).then_some(spans)
    }

    /// Returns the common times of two lists, each in the order of time.
    pub(super) fn intersections(a: &[Self], b: &[Self]) -> Vec<Self> {
        a.iter().flat_map(|a| b.iter().filter_map(|b| a.intersection(*b))).collect()
    }
}

/// Paths on which an antenna can take a pass, or the reason why it cannot.
#[derive(Debug, Clone, PartialEq)]
pub enum Verdict {
    /// Possible paths, one for each turn on which the azimuth axis can begin.
    Possible(Vec<Way>),
    Impossible(Impossible),
}

/// Reason why an antenna cannot take a pass.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Impossible {
    /// Unsupported name of the satellite, by which the unit would find its elements.
    Name,
    /// Elevation of the whole pass below the minimum of the antenna.
    TooLow,
    /// Horizon mask that hides the whole pass.
    Hidden,
    /// Loss of too much of the pass by the mount.
    Lost(Lost),
    /// Keep-out, or the surroundings of the Sun, on the path of the pass.
    KeepOut(Barrier),
    /// Missing path past barriers to the start of the pass or from its end.
    NoWay,
}

/// Part of a pass that a mount loses, or the whole pass.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Lost {
    pub seconds: f64,
    /// Cause of the loss at its beginning.
    #[serde(rename = "at")]
    pub loss: Loss,
}

/// Single path along a pass, from the first counted second to the last.
#[derive(Debug, Clone, PartialEq)]
pub struct Way {
    /// Counted time: within half the beamwidth, above the mask and the minimum elevation.
    counted: Vec<Span>,
    /// Axis positions at equal intervals, degrees as the mount counts.
    axes_deg: [Vec<f64>; 2],
    first_ms: i64,
    step_s: f64,
    pub(super) lost: Option<Lost>,
}

impl Way {
    /// Creates a path. `counted` must not be empty.
    pub(super) fn new(
        samples: &Samples,
        axes_deg: [Vec<f64>; 2],
        counted: Vec<Span>,
        lost: Option<Lost>,
    ) -> Self {
        let first_ms = samples.list.first().map_or(0, |first| ms(first.time));
        Self { counted, axes_deg, first_ms, step_s: samples.step_s, lost }
    }

    pub(super) fn span(&self) -> Span {
        Span {
            from_ms: self.counted.first().map_or(0, |span| span.from_ms),
            to_ms: self.counted.last().map_or(0, |span| span.to_ms),
        }
    }

    /// Returns the counted milliseconds within `span`.
    pub(super) fn counted_ms(&self, span: Span) -> i64 {
        Span::total_ms(&Span::intersections(&self.counted, &[span]))
    }

    /// Returns the first counted millisecond from `at_ms` on.
    pub(super) fn next_counted_ms(&self, at_ms: i64) -> Option<i64> {
        let span = self.counted.iter().find(|span| at_ms < span.to_ms)?;
        Some(span.from_ms.max(at_ms))
    }

    /// Returns the start of the counted stretch after the one at `at_ms`.
    pub(super) fn next_stretch_ms(&self, at_ms: i64) -> Option<i64> {
        self.counted.iter().map(|span| span.from_ms).find(|from_ms| at_ms < *from_ms)
    }

    /// Returns the axis positions at a time, degrees as the mount counts.
    pub(super) fn axes_deg(&self, at_ms: i64) -> [f64; 2] {
        let steps = ((at_ms - self.first_ms) as f64 / 1000.0 / self.step_s).max(0.0);
        let (index, share) = (steps.floor() as usize, steps.fract());
        [0, 1].map(|axis: usize| {
            let axis = self.axes_deg.get(axis).map(Vec::as_slice).unwrap_or_default();
            let last = axis.last().copied().unwrap_or_default();
            let before = axis.get(index).copied().unwrap_or(last);
            let after = axis.get(index + 1).copied().unwrap_or(last);
            before + (after - before) * share
        })
    }
}
