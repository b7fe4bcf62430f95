//! Path of setting changes to the gate.

use super::Session;
use crate::{clock::Moment, contract::driver::Event, device::settings::Change};

impl Session {
    /// Writes `change`. If the gate does not send it, the reason also appears among the setting
    /// outcomes.
    pub(super) fn write_settings(&mut self, change: Change, now: Moment) {
        let (may_move, stopping) = (self.may_move(), self.stop.is_under_way());
        match self.gate.write_settings(change, may_move, stopping, now) {
            Ok(()) => self.gate.readings_change(now),
            Err(refusal) => self.tell(Event::NotSent(refusal)),
        }
    }
}
