//! Lease of a jog: a jog runs only while the window renews it.

use std::time::Duration;

use super::{
    Session,
    jog_key::{Jog, PositionWait},
};
use crate::{clock::Moment, contract::driver::Event};

/// Time after which a jog without renewal ends.
pub const LEASE: Duration = Duration::from_millis(300);
/// Max age of the position for a jog.
const FRESH: Duration = Duration::from_secs(1);
impl Session {
    /// Handles a key press; the window calls this repeatedly while the key stays down.
    pub(super) fn hold_jog(&mut self, rates_deg_s: [f64; 2], now: Moment) {
        let end = now.steady + LEASE;
        if self.commanded.key.is_spent(rates_deg_s) {
            return;
        }
        if !self.commanded.key.renew(rates_deg_s, end) {
            // A different direction or rate needs standstill first.
            if self.commanded.key.started().is_some() {
                self.halt_quietly(now);
            }
            self.commanded.key.press(rates_deg_s, end, now.steady);
        }
        self.start_jog(now);
    }

    pub(super) fn release_jog(&mut self, now: Moment) {
        if self.commanded.key.started().is_some() {
            self.halt_quietly(now);
        }
        self.commanded.key.release();
    }

    /// Sends a held jog to the gate once no halt is under way.
    fn start_jog(&mut self, now: Moment) {
        if self.stop.is_under_way() || self.commanded.key.pressed().is_none_or(Jog::is_started) {
            return;
        }
        // Request the mark before any motion. Without it, the next start after a crash would not
        // know that the antenna turns.
        if !self.is_marked(now) || self.awaits_young_position(now) {
            return;
        }
        let Some(jog) = self.commanded.key.pressed() else { return };
        let motion = jog.motion();
        let intent = self.commanded.activity.intent();
        let started = self
            .gate
            .check(motion, intent, now)
            .and_then(|()| self.arm_dead_man(now))
            .and_then(|()| self.gate.start(motion, intent, false, now));
        match started {
            Ok(()) => {
                self.commanded.key.start();
                self.stop.forget();
            }
            // A held key retries, but the session reports the reason once.
            Err(refusal) => {
                if self.commanded.key.is_first_refusal() {
                    self.tell(Event::NotSent(refusal));
                }
            }
        }
    }

    /// Returns `true` while the jog waits for a fresh position that stays valid until the next one.
    /// The gate judges the age of a missing position.
    fn awaits_young_position(&mut self, now: Moment) -> bool {
        let requested = self.gate.state().measured.map(|measured| measured.requested);
        match requested.map_or(PositionWait::Over, |requested| {
            self.commanded.key.wait_for_position(requested, now.steady)
        }) {
            PositionWait::Over => false,
            PositionWait::Ask => {
                self.gate.device().ask_position(now);
                true
            }
            PositionWait::Wait => true,
        }
    }

    /// Ends a jog without renewal, or with an outdated position.
    pub(super) fn watch_jog(&mut self, now: Moment) {
        let Some(jog) = self.commanded.key.pressed() else { return };
        let is_over = now.steady >= jog.end();
        if !jog.is_started() {
            if is_over {
                self.commanded.key.release();
            } else {
                self.start_jog(now);
            }
            return;
        }
        let end = if is_over {
            Some(Event::JogLeaseOver)
        } else if self.position_age(now).is_none_or(|age| age >= FRESH) {
            Some(Event::JogPositionOld)
        } else {
            // The motion was allowed at the start, but may have reached a limit or met a fault
            // since.
            let intent = self.commanded.activity.intent();
            self.gate.check(jog.motion(), intent, now).err().map(Event::NotSent)
        };
        if let Some(event) = end {
            let rates_deg_s = jog.rates_deg_s();
            self.halt_quietly(now);
            self.commanded.key.spend_rates(rates_deg_s);
            self.tell(event);
        }
    }
}
