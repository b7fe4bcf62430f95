//! Upkeep of the dead-man during a manual motion.

use super::Session;
use crate::{
    clock::Moment,
    contract::driver::{Event, Refusal, Safety},
};

impl Session {
    /// Arms the dead-man before a motion that only a STOP would end.
    pub(super) fn arm_dead_man(&mut self, now: Moment) -> Result<(), Refusal> {
        // Such a unit ends a jog without Azel unless the jog is renewed.
        if self.setup.can().ends_jogs {
            return Ok(());
        }
        let Err(error) = self.stop.guard.ensure_armed(now.steady) else { return Ok(()) };
        tracing::error!(antenna = self.setup.name(), %error, "no dead-man");
        let is_allowed = self.stop.guard.is_allowed_without(now.steady);
        if is_allowed { Ok(()) } else { Err(Refusal::Unguarded) }
    }

    /// Sends a beat while the lease holds or a halt is under way.
    pub(super) fn beat(&mut self, now: Moment) {
        let (jog, stops) = (self.commanded.key.pressed(), self.stop.is_under_way());
        let may_move = jog.is_some() || stops;
        let lease_holds = jog.is_some_and(|jog| now.steady < jog.end());
        if !self.stop.guard.beat(may_move, lease_holds || stops, now.steady) {
            // The child assumed a dead process and sent STOP. The motion has ended, so Azel proves
            // standstill.
            self.halt(now);
            self.tell(Event::Safety(Safety::DeadManFired));
        }
    }
}
