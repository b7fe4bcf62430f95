//! The lease of a jog: it lives only while the window renews it.

use std::time::{Duration, Instant};

use super::{Event, Session};
use crate::controller::{Moment, Motion};

/// A hold that was not renewed for this long is over.
pub(super) const LEASE: Duration = Duration::from_millis(300);
/// A jog needs a position younger than this.
const FRESH: Duration = Duration::from_secs(1);

/// A jog key that is held.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Jog {
    /// Signed rates of the two axes, degrees a second.
    pub(super) rates_deg_s: [f64; 2],
    /// When the hold ends unless renewed.
    pub(super) until: Instant,
    /// The motion went through the gate.
    pub(super) started: bool,
    /// The gate said no, and the operator was told.
    pub(super) refused: bool,
}

impl Session {
    /// The key is down. Called again and again while it stays down.
    pub(super) fn hold_jog(&mut self, rates_deg_s: [f64; 2], now: Moment) {
        let until = now.steady + LEASE;
        match &mut self.jog {
            Some(jog) if same(jog.rates_deg_s, rates_deg_s) => jog.until = until,
            running => {
                // Another direction or rate: stand still in between.
                let turn_around = running.take().is_some_and(|jog| jog.started);
                if turn_around {
                    self.halt_quietly(now);
                }
                self.jog = Some(Jog { rates_deg_s, until, started: false, refused: false });
            }
        }
        self.start_jog(now);
    }

    /// The key is up.
    pub(super) fn release_jog(&mut self, now: Moment) {
        if self.jog.take().is_some_and(|jog| jog.started) {
            self.halt_quietly(now);
        }
    }

    /// Sends a held jog to the gate once no halt is under way.
    fn start_jog(&mut self, now: Moment) {
        let Some(jog) = self.jog.as_mut().filter(|jog| !jog.started) else { return };
        if self.halting.is_some() {
            return;
        }
        let [x_deg_s, y_deg_s] = jog.rates_deg_s;
        let motion = Motion::Jog { x_deg_s, y_deg_s };
        match self.gate.start(motion, self.intent, false, now) {
            Ok(()) => {
                jog.started = true;
                self.stopped_at = None;
            }
            // A key that stays down tries again, but the reason is told once.
            Err(refusal) => {
                if !std::mem::replace(&mut jog.refused, true) {
                    self.tell(Event::NotSent(refusal));
                }
            }
        }
    }

    /// Ends a jog that is no longer renewed, or that moves blindly.
    pub(super) fn watch_jog(&mut self, now: Moment) {
        let Some(jog) = &self.jog else { return };
        let over = now.steady >= jog.until;
        if !jog.started {
            if over {
                self.jog = None;
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
            // What was free when it began may have become a limit or a fault.
            let [x_deg_s, y_deg_s] = jog.rates_deg_s;
            let motion = Motion::Jog { x_deg_s, y_deg_s };
            self.gate.check(motion, self.intent, now).err().map(Event::NotSent)
        };
        if let Some(event) = end {
            self.halt_quietly(now);
            self.tell(event);
        }
    }
}

/// A held key repeats the very same numbers.
fn same(a: [f64; 2], b: [f64; 2]) -> bool {
    a.map(f64::to_bits) == b.map(f64::to_bits)
}
