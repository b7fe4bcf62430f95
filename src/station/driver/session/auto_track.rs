//! Auto-track that is to be off is owed to the unit, like a STOP: it is switched off until the
//! unit has been read as one that does not start by itself.

use std::time::Duration;

use crate::{clock::Instant, device::AntennaState};

/// A unit that still has auto-track on is told again after this time.
const AGAIN: Duration = Duration::from_secs(3);

/// Progress of switching auto-track off.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct AutoTrackOff {
    /// When the unit was last asked on this link to switch auto-track off.
    asked_at: Option<Instant>,
    /// The operator knows that the unit does not switch it off.
    is_reported: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NextStep {
    Wait,
    SwitchOff,
    /// The unit was read as off.
    Proved,
    /// The unit was asked, and no report of it can show more.
    Unreadable,
}

impl AutoTrackOff {
    /// `None` for a new link, on which nothing was asked.
    pub(super) fn asked(&mut self, at: Option<Instant>) {
        self.asked_at = at;
    }

    pub(super) fn is_first_report(&mut self) -> bool {
        !std::mem::replace(&mut self.is_reported, true)
    }

    /// Reads auto-track back, and asks the unit again where it is still on.
    pub(super) fn next(&mut self, state: &AntennaState, now: Instant) -> NextStep {
        let asked_at = self.asked_at;
        // A report from before the command shows nothing of its effect.
        let is_answer =
            |asked_at| state.measured.is_some_and(|measured| measured.requested > asked_at);
        let read = state.program.filter(|_| asked_at.is_some_and(is_answer));
        match read.map(|program| program.auto) {
            Some(Some(false)) => NextStep::Proved,
            Some(None) => NextStep::Unreadable,
            Some(Some(true)) | None => {
                let is_due = |asked_at| now.saturating_duration_since(asked_at) >= AGAIN;
                if !asked_at.is_none_or(is_due) {
                    return NextStep::Wait;
                }
                self.asked_at = Some(now);
                NextStep::SwitchOff
            }
        }
    }
}
