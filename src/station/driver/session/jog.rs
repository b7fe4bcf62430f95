//! The lease of a jog: a jog lives only while the window renews it.

use std::time::Duration;

use super::Session;
use crate::{
    clock::{Instant, Moment},
    contract::driver::Event,
    device::Motion,
};

/// A jog that was not renewed for this long is over.
pub const LEASE: Duration = Duration::from_millis(300);
/// A jog needs a position younger than this.
const FRESH: Duration = Duration::from_secs(1);
/// A jog starts at a position younger than this, or at one that was asked for after the key went
/// down: the command and the next position may each be late by 300 ms before this one is too old.
const YOUNG: Duration = Duration::from_millis(300);
/// Longest time that a jog waits for its position. One reply may be lost, and Azel asks some units
/// nothing for a second after that.
const PATIENCE: Duration = Duration::from_secs(3);

/// A held jog key.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Jog {
    /// Signed rates of the two axes, degrees a second.
    pub(super) rates_deg_s: [f64; 2],
    pressed_at: Instant,
    /// A younger position has been asked for.
    asked: bool,
    /// When the jog ends unless renewed.
    pub(super) until: Instant,
    /// The motion went through the gate.
    pub(super) started: bool,
    /// The gate refused it, and the operator knows.
    pub(super) refused: bool,
}

impl Jog {
    fn motion(&self) -> Motion {
        let [x_deg_s, y_deg_s] = self.rates_deg_s;
        Motion::Jog { x_deg_s, y_deg_s }
    }
}

/// The operator's jog keys.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum JogKey {
    Up,
    Down(Jog),
    /// A jog with these rates ended before its key came up. It needs a new press, or the same
    /// key could move the antenna again after the window has frozen.
    Spent([f64; 2]),
}

impl JogKey {
    pub(super) fn held(&self) -> Option<&Jog> {
        match self {
            Self::Down(jog) => Some(jog),
            Self::Up | Self::Spent(_) => None,
        }
    }

    fn held_mut(&mut self) -> Option<&mut Jog> {
        match self {
            Self::Down(jog) => Some(jog),
            Self::Up | Self::Spent(_) => None,
        }
    }

    /// The jog that went through the gate.
    pub(super) fn started(&self) -> Option<&Jog> {
        self.held().filter(|jog| jog.started)
    }

    /// Ends a jog whose key is still down.
    pub(super) fn spend(&mut self) {
        if let Self::Down(jog) = self {
            *self = Self::Spent(jog.rates_deg_s);
        }
    }

    /// Ends a jog; the same key may begin another.
    pub(super) fn end(&mut self) {
        if let Self::Down(_) = self {
            *self = Self::Up;
        }
    }
}

impl Session {
    /// The key is down; called repeatedly while it stays down.
    pub(super) fn hold_jog(&mut self, rates_deg_s: [f64; 2], now: Moment) {
        let until = now.steady + LEASE;
        match &mut self.key {
            JogKey::Spent(rates) if is_same_way(*rates, rates_deg_s) => return,
            JogKey::Down(jog) if same(jog.rates_deg_s, rates_deg_s) => jog.until = until,
            key => {
                // Another direction or rate: stand still in between.
                if key.started().is_some() {
                    self.halt_quietly(now);
                }
                self.key = JogKey::Down(Jog {
                    rates_deg_s,
                    pressed_at: now.steady,
                    asked: false,
                    until,
                    started: false,
                    refused: false,
                });
            }
        }
        self.start_jog(now);
    }

    pub(super) fn release_jog(&mut self, now: Moment) {
        if self.key.started().is_some() {
            self.halt_quietly(now);
        }
        self.key = JogKey::Up;
    }

    /// Sends a held jog to the gate once no halt is under way.
    fn start_jog(&mut self, now: Moment) {
        if self.stop.is_under_way() || self.key.held().is_none_or(|jog| jog.started) {
            return;
        }
        if !self.is_marked(now) || self.awaits_young_position(now) {
            return;
        }
        let Some(jog) = self.key.held() else { return };
        let motion = jog.motion();
        let intent = self.activity.intent();
        let started = self
            .gate
            .check(motion, intent, now)
            .and_then(|()| self.arm_dead_man(now))
            .and_then(|()| self.gate.start(motion, intent, false, now));
        let Some(jog) = self.key.held_mut() else { return };
        match started {
            Ok(()) => {
                jog.started = true;
                self.stop.forget();
            }
            // A key that stays down tries again, but the reason is reported once.
            Err(refusal) => {
                if !std::mem::replace(&mut jog.refused, true) {
                    self.tell(Event::NotSent(refusal));
                }
            }
        }
    }

    /// Returns `true` while the jog waits for a position that lasts until the next one comes. The
    /// gate judges the age of a position that does not come.
    fn awaits_young_position(&mut self, now: Moment) -> bool {
        let Some(look) = self.gate.state().measured else { return false };
        let Some(jog) = self.key.held_mut() else { return false };
        let age = now.steady.saturating_duration_since(look.asked);
        let waited = now.steady.saturating_duration_since(jog.pressed_at);
        if age < YOUNG || look.asked >= jog.pressed_at || waited >= PATIENCE {
            return false;
        }
        if !std::mem::replace(&mut jog.asked, true) {
            self.gate.device().ask_position(now);
        }
        true
    }

    /// Ends a jog that is no longer renewed, or whose position is too old.
    pub(super) fn watch_jog(&mut self, now: Moment) {
        let Some(jog) = self.key.held() else { return };
        let over = now.steady >= jog.until;
        if !jog.started {
            if over {
                self.key = JogKey::Up;
            } else {
                self.start_jog(now);
            }
            return;
        }
        let end = if over {
            Some(Event::JogLeaseOver)
        } else if self.position_age(now).is_none_or(|age| age >= FRESH) {
            Some(Event::JogPositionOld)
        } else {
            // The motion was allowed at the start, but may have reached a limit or met a fault
            // since.
            let intent = self.activity.intent();
            self.gate.check(jog.motion(), intent, now).err().map(Event::NotSent)
        };
        if let Some(event) = end {
            let rates_deg_s = jog.rates_deg_s;
            self.halt_quietly(now);
            self.key = JogKey::Spent(rates_deg_s);
            self.tell(event);
        }
    }
}

/// Returns `true` if two jogs turn the same axes the same way, at whatever rates.
fn is_same_way(a: [f64; 2], b: [f64; 2]) -> bool {
    let way = |rate: f64| rate.partial_cmp(&0.0);
    a.map(way) == b.map(way)
}

/// A held key repeats exactly the same numbers.
fn same(a: [f64; 2], b: [f64; 2]) -> bool {
    a.map(f64::to_bits) == b.map(f64::to_bits)
}
