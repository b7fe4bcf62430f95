//! Changes of settings on their way to the gate.

use super::{Event, Session};
use crate::{clock::Moment, device::settings::Change};

impl Session {
    /// Puts `change` on the device; why it is not sent stands among the outcomes of
    /// the settings too.
    pub(super) fn write_settings(&mut self, change: Change, now: Moment) {
        let (may_move, stopping) = (self.may_move(), self.stop.is_under_way());
        if let Err(refusal) = self.gate.write_settings(change, may_move, stopping, now) {
            self.tell(Event::NotSent(refusal));
        }
    }
}
