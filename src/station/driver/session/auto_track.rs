//! Debt of a disabled auto-track: the session disables auto-track until a reading proves that the
//! unit does not start on its own.

use std::time::Duration;

use crate::{clock::Instant, device::AntennaState};

/// Interval before Azel again asks a unit to disable auto-track.
const AGAIN: Duration = Duration::from_secs(3);

/// Progress of disabling auto-track.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct AutoTrackOff {
    /// Time of the last request on this link to disable auto-track.
    requested_at: Option<Instant>,
    /// `true` if the operator knows that the unit keeps auto-track enabled.
    is_reported: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NextStep {
    Wait,
    SwitchOff,
    /// Proof: a reading shows auto-track off.
    Proved,
    /// Missing proof: Azel sent the request, but the unit cannot report auto-track.
    Unreadable,
}

impl AutoTrackOff {
    /// Records the time of a request; `None` for a new link without a request.
    pub(super) fn record_request(&mut self, time: Option<Instant>) {
        self.requested_at = time;
    }

    pub(super) fn is_first_report(&mut self) -> bool {
        !std::mem::replace(&mut self.is_reported, true)
    }

    /// Evaluates the auto-track reading, and repeats the request if auto-track is still on.
    pub(super) fn next(&mut self, state: &AntennaState, now: Instant) -> NextStep {
        let requested_at = self.requested_at;
        // A report from before the command cannot show its effect.
        let is_answer = |time| state.measured.is_some_and(|measured| measured.requested > time);
        let read = state.program.filter(|_| requested_at.is_some_and(is_answer));
        match read.map(|program| program.auto) {
            Some(Some(false)) => NextStep::Proved,
            Some(None) => NextStep::Unreadable,
            Some(Some(true)) | None => {
                let is_due = |time| now.saturating_duration_since(time) >= AGAIN;
                if !requested_at.is_none_or(is_due) {
                    return NextStep::Wait;
                }
                self.requested_at = Some(now);
                NextStep::SwitchOff
            }
        }
    }
}
