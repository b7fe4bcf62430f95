//! Motions that may still turn an axis, and where they lead.

use std::time::Duration;

use super::range::Range;
use crate::clock::Instant;

/// Longest time that an axis coasts.
pub(super) const COASTS: Duration = Duration::from_secs(3);

/// Where a motion leads an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::driver) enum Lead {
    /// To this angle, degrees as the mount counts.
    To(f64),
    /// To this angle by either way round, degrees as the mount counts.
    EitherWay(f64),
    /// By this many degrees from where the axis is.
    By(f64),
    /// Up to an end of the travel: up or clockwise, or the other way.
    ToEnd {
        is_up: bool,
    },
    Anywhere,
}

/// A motion that may still turn the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Live {
    pub(super) number: u64,
    /// The axis turns no further down, or counter-clockwise, than this; infinite where it does not
    /// turn that way at all.
    pub(super) down_to_deg: f64,
    pub(super) up_to_deg: f64,
    /// Its end is a position.
    pub(super) ends: bool,
    /// The unit may report this motion as a jog.
    pub(super) is_jog: bool,
    /// It may lead there either way round.
    pub(super) either_way: bool,
    /// It led up, or down, when it was sent: the axis may coast on that way.
    pub(super) led: [bool; 2],
    /// When the axis was last not below its end, and not above: only then may it run past it downwards,
    /// and upwards.
    pub(super) passed: [Option<Instant>; 2],
    /// A newer motion is obeyed by then.
    pub(super) until: Option<Instant>,
}

impl Live {
    /// Returns it as it is at `at`; `None` if it has come to rest by then.
    pub(super) fn at(self, at: Instant) -> Option<Self> {
        let Some(until) = self.until.filter(|until| *until < at) else { return Some(self) };
        if until + COASTS < at {
            return None;
        }
        let [down, up] = self.led;
        Some(Self {
            down_to_deg: if down { self.down_to_deg } else { f64::INFINITY },
            up_to_deg: if up { self.up_to_deg } else { f64::NEG_INFINITY },
            ..self
        })
    }

    /// Notes on which side of its end the axis is; `range`: `None` where that is not known.
    pub(super) fn look(&mut self, range: Option<Range>, arrives_deg: f64, at: Instant) {
        let [from_above, from_below] = &mut self.passed;
        if range.is_none_or(|range| range.to_deg >= self.down_to_deg - arrives_deg) {
            *from_above = Some(at);
        }
        if range.is_none_or(|range| range.from_deg <= self.up_to_deg + arrives_deg) {
            *from_below = Some(at);
        }
    }

    pub(super) fn joined(self, newer: Self) -> Self {
        let [down, up] = self.led;
        let [newer_down, newer_up] = newer.led;
        Self {
            number: newer.number,
            down_to_deg: self.down_to_deg.min(newer.down_to_deg),
            up_to_deg: self.up_to_deg.max(newer.up_to_deg),
            ends: self.ends && newer.ends,
            is_jog: self.is_jog || newer.is_jog,
            either_way: self.either_way || newer.either_way,
            led: [down || newer_down, up || newer_up],
            passed: newer.passed,
            until: self.until.zip(newer.until).map(|(one, other)| one.max(other)),
        }
    }
}
