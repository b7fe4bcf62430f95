//! Whether an antenna that was moved from here is known to stand since.

use std::time::Duration;

use super::Session;

/// Metal that does not move so long after a motion was sent does not begin to
/// any more.
const SETTLED: Duration = Duration::from_secs(5);

impl Session {
    /// It was moved from here, or a stop is owed, and standstill is not proved.
    pub(super) fn is_unproved(&self) -> bool {
        self.gate.unproved_since().is_some() || self.stop.is_under_way()
    }

    /// Keeps it for the next session of the unit too, whose antenna may be changed in
    /// the settings meanwhile.
    pub(super) fn keep_unproved(&mut self) {
        let since = self.gate.unproved_since();
        if since != self.owed.kept_unproved {
            self.owed.kept_unproved = since;
            self.owed.debts.keep_unproved(&self.owed.unit, self.owed.number, since);
        }
    }

    /// A halt is over: nothing moves. A unit that may start by itself is not done.
    pub(super) fn prove_still(&mut self) {
        self.acts = false;
        if !self.may_start_by_itself() {
            self.gate.proved_still();
        }
    }

    /// Looks whether a motion that nobody stopped is over.
    pub(super) fn watch_standstill(&mut self) {
        let Some(since) = self.gate.unproved_since() else { return };
        let state = self.gate.state();
        let seen = state.measured.is_some_and(|measured| {
            measured.asked.saturating_duration_since(since) >= SETTLED && !measured.moving()
        });
        let program_is_off = state.program.is_none_or(|program| !program.enabled);
        if seen && program_is_off && !self.may_move() {
            self.prove_still();
        }
    }

    fn may_start_by_itself(&self) -> bool {
        self.gate.state().program.is_some_and(|program| program.auto == Some(true))
    }
}
