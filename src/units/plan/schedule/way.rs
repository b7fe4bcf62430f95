//! How an antenna can take a pass: where its axes stand, and which seconds count.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::sight::Samples;
use crate::plan::{Barrier, Loss};

/// Milliseconds since 1970.
pub(super) fn ms(time: Timestamp) -> i64 {
    time.as_millisecond()
}

/// The time at this number of milliseconds since 1970.
pub(super) fn at_ms(ms: i64) -> Timestamp {
    Timestamp::from_millisecond(ms).unwrap_or_default()
}

/// A span of time.
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

    /// Returns the time that both have in common, if any.
    pub(super) fn intersection(self, other: Self) -> Option<Self> {
        let spans =
            Self { from_ms: self.from_ms.max(other.from_ms), to_ms: self.to_ms.min(other.to_ms) };
        (spans.from_ms < spans.to_ms).then_some(spans)
    }

    /// Returns the times that two lists have in common, each in the order of time.
    pub(super) fn intersections(a: &[Self], b: &[Self]) -> Vec<Self> {
        a.iter().flat_map(|a| b.iter().filter_map(|b| a.intersection(*b))).collect()
    }
}

/// Ways in which an antenna can take a pass, or the reason why it cannot.
#[derive(Debug, Clone, PartialEq)]
pub enum Verdict {
    /// One way for each turn on which the azimuth axis can begin.
    Possible(Vec<Way>),
    Impossible(Impossible),
}

/// Why an antenna cannot take a pass.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Impossible {
    /// The unit cannot be told the name of the satellite, by which it finds its elements.
    Name,
    /// The pass stays below the minimum elevation of the antenna.
    TooLow,
    /// The horizon mask hides all of it.
    Hidden,
    /// The mount loses so much of it.
    Lost(Lost),
    /// It leads through a keep-out or the surroundings of the Sun.
    KeepOut(Barrier),
    /// No way leads to its start or from its end past what must not be entered.
    NoWay,
}

/// Part of a pass that a mount loses, or all of it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Lost {
    pub seconds: f64,
    /// Where the loss begins.
    #[serde(rename = "at")]
    pub loss: Loss,
}

/// One way of taking a pass: from the first second that counts to the last.
#[derive(Debug, Clone, PartialEq)]
pub struct Way {
    /// Time that counts: within half the beamwidth, above the mask and the minimum elevation.
    counted: Vec<Span>,
    /// Where the axes stand at equal intervals, degrees as the mount counts.
    axes_deg: [Vec<f64>; 2],
    first_ms: i64,
    step_s: f64,
    pub(super) lost: Option<Lost>,
}

impl Way {
    /// `counted` is not empty.
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

    /// Milliseconds that count within `span`.
    pub(super) fn counted_ms(&self, span: Span) -> i64 {
        Span::total_ms(&Span::intersections(&self.counted, &[span]))
    }

    /// The first millisecond from `at_ms` on that counts.
    pub(super) fn next_counted_ms(&self, at_ms: i64) -> Option<i64> {
        let span = self.counted.iter().find(|span| at_ms < span.to_ms)?;
        Some(span.from_ms.max(at_ms))
    }

    /// When the stretch begins that counts after the one at `at_ms`.
    pub(super) fn next_stretch_ms(&self, at_ms: i64) -> Option<i64> {
        self.counted.iter().map(|span| span.from_ms).find(|from_ms| at_ms < *from_ms)
    }

    /// Where the axes stand at a time, degrees as the mount counts.
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
