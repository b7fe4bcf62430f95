//! Record of an antenna that Azel moved, until its standstill is proved.

use std::time::Duration;

use super::Session;
use crate::clock::Moment;

/// Max time from a sent motion until the antenna must have started to move.
const SETTLED: Duration = Duration::from_secs(5);

impl Session {
    /// Returns `true` if Azel moved the antenna or owes it a STOP, and standstill is not proved
    /// yet.
    pub(super) fn is_unproved(&self) -> bool {
        self.gate.unproved_since().is_some() || self.stop.is_under_way()
    }

    /// Records standstill after a halt. A unit that may start on its own stays unproved.
    pub(super) fn prove_still(&mut self) {
        self.commanded.note_standstill();
        // A unit with auto-track on may begin to turn at any time without a command of Azel.
        if !self.may_start_by_itself() {
            self.gate.clear_unproved();
        }
    }

    /// Checks whether a motion without a STOP is over.
    pub(super) fn watch_standstill(&mut self, _: Moment) {
        let Some(start) = self.gate.unproved_since() else { return };
        let state = self.gate.state();
        let stands = state.measured.is_some_and(|measured| {
            measured.requested.saturating_duration_since(start) >= SETTLED && !measured.moving()
        });
        let program_is_off = state.program.is_none_or(|program| !program.enabled);
        if stands && program_is_off && !self.may_move() {
            self.prove_still();
        }
    }

    fn may_start_by_itself(&self) -> bool {
        self.gate.state().program.is_some_and(|program| program.auto == Some(true))
    }
}
