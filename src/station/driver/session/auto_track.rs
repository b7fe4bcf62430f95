//! Auto-track that is to be off is owed to the unit, like a STOP: it is switched off until the
//! unit has been read as one that does not start by itself.

use std::time::Duration;

use super::Session;
use crate::{
    clock::{Instant, Moment},
    contract::driver::Event,
};

/// A unit that still has auto-track on is told again after this time.
const AGAIN: Duration = Duration::from_secs(3);

impl Session {
    /// From now on the unit is not to start by itself.
    pub(super) fn end_auto_track(&mut self) {
        if self.variant.capabilities.has_program {
            self.owed.debts.owe_auto_track_off(&self.owed.unit);
            self.owed.auto_track_told = None;
            self.owed.auto_stays_told = false;
        }
    }

    /// The unit has refused to switch auto-track off, or has not answered. It is told again and
    /// again, and the operator once.
    pub(super) fn auto_stays_on(&mut self) {
        let is_told = std::mem::replace(&mut self.owed.auto_stays_told, true);
        if !is_told || !self.owes_auto_track_off() {
            self.tell(Event::AutoStaysOn);
        }
    }

    /// The operator, or automatic operation, wants the unit to start by itself.
    pub(super) fn allow_auto_track(&mut self) {
        self.owed.debts.settle_auto_track(&self.owed.unit);
    }

    pub(super) fn owes_auto_track_off(&self) -> bool {
        self.owed.debts.owes_auto_track_off(&self.owed.unit)
    }

    /// The unit is told on this link; `None` for a new link.
    pub(super) fn told_auto_track_off(&mut self, at: Option<Instant>) {
        self.owed.auto_track_told = at;
    }

    /// Switches auto-track off where that is owed, and reads it back.
    pub(super) fn watch_auto_track(&mut self, now: Moment) {
        if !self.owes_auto_track_off() {
            return;
        }
        let told = self.owed.auto_track_told;
        let state = self.gate.state();
        let is_answer = |told| state.measured.is_some_and(|measured| measured.asked > told);
        let read = state.program.filter(|_| told.is_some_and(is_answer));
        match read.map(|program| program.auto) {
            Some(Some(false)) => self.allow_auto_track(),
            Some(None) => {
                // It has been told, and nothing that it says shows more.
                self.allow_auto_track();
                self.tell(Event::AutoTrackNotKnown);
            }
            Some(Some(true)) | None => {
                let is_due = |told| now.steady.saturating_duration_since(told) >= AGAIN;
                if told.is_none_or(is_due) {
                    self.owed.auto_track_told = Some(now.steady);
                    self.gate.device().disable_auto();
                }
            }
        }
    }
}
