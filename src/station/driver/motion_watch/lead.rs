//! Motions that may still turn an axis, and their leads.

use std::time::Duration;

use super::range::Range;
use crate::clock::Instant;

/// Max time for which an axis coasts.
pub(super) const COASTS: Duration = Duration::from_secs(3);

/// Lead of a motion of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::driver) enum Lead {
    /// Motion to this angle, degrees as the mount counts.
    To(f64),
    /// Motion to this angle in either direction, degrees as the mount counts.
    EitherWay(f64),
    /// Motion by this many degrees from the current angle.
    By(f64),
    /// Motion up to an end of the travel: up or clockwise, or in the opposite direction.
    ToEnd {
        is_up: bool,
    },
    Anywhere,
}

/// Motion that may still turn the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LiveMotion {
    pub(super) number: u64,
    /// Lowest angle, or furthest counter-clockwise, to which the axis turns, degrees; infinite if
    /// it does not turn that way.
    pub(super) down_to_deg: f64,
    pub(super) up_to_deg: f64,
    /// `true` if the end of the motion is a position.
    pub(super) ends: bool,
    /// `true` if the unit may report this motion as a jog.
    pub(super) is_jog: bool,
    /// `true` if the motion may take either direction.
    pub(super) either_way: bool,
    /// Initial directions of the motion, down and up: the axis may coast in these directions.
    pub(super) led: [bool; 2],
    /// Last times at which the axis was at or above its end, and at or below it. Only then may it
    /// run past the end downwards, and upwards.
    pub(super) passed: [Option<Instant>; 2],
    /// Time by which the drive obeys a newer motion.
    pub(super) expiry: Option<Instant>,
}

impl LiveMotion {
    /// Returns the state of the motion at `time`; `None` if the axis has come to rest before.
    pub(super) fn state_at(self, time: Instant) -> Option<Self> {
        let Some(expiry) = self.expiry.filter(|expiry| *expiry < time) else { return Some(self) };
        if expiry + COASTS < time {
            return None;
        }
        let [down, up] = self.led;
        Some(Self {
            down_to_deg: if down { self.down_to_deg } else { f64::INFINITY },
            up_to_deg: if up { self.up_to_deg } else { f64::NEG_INFINITY },
            ..self
        })
    }

    /// Records on which side of the end the axis is; `range` is `None` if that is unknown.
    pub(super) fn look(&mut self, range: Option<Range>, arrives_deg: f64, time: Instant) {
        let [from_above, from_below] = &mut self.passed;
        if range.is_none_or(|range| range.to_deg >= self.down_to_deg - arrives_deg) {
            *from_above = Some(time);
        }
        if range.is_none_or(|range| range.from_deg <= self.up_to_deg + arrives_deg) {
            *from_below = Some(time);
        }
    }

    pub(super) fn join(self, newer: Self) -> Self {
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
            expiry: self.expiry.zip(newer.expiry).map(|(one, other)| one.max(other)),
        }
    }
}
