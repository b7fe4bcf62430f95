//! Progress of a lock-out: a reading must prove that the unit does not start on its own.

use std::time::Duration;

use crate::{clock::Instant, device::AntennaState};

/// Timeout of reading auto-track back as off.
const READ_BACK: Duration = Duration::from_secs(10);

/// Progress of a lock-out, if the unit is locked out.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Locking(Option<LockProgress>);

#[derive(Debug, Clone, Copy, PartialEq)]
struct LockProgress {
    begun: Instant,
    /// `true` if the unit has a program that could start on its own.
    has_program: bool,
    /// `true` if Azel disabled auto-track on this link.
    is_asked: bool,
    /// `true` if the unit's report proves that it does not start on its own.
    is_proved: bool,
    /// `true` after the first proof: since then, the person who works on the unit may have enabled
    /// auto-track.
    was_proved: bool,
    /// `true` if the operator knows about the missing proof.
    is_reported: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum LockStep {
    Wait,
    SwitchOff,
    /// Report to the operator that the unit may start on its own.
    Report,
}

impl Locking {
    pub(super) fn begin(&mut self, has_program: bool, now: Instant) {
        self.0 = Some(LockProgress {
            begun: now,
            has_program,
            is_asked: false,
            is_proved: !has_program,
            was_proved: false,
            is_reported: false,
        });
    }

    pub(super) fn end(&mut self) {
        self.0 = None;
    }

    /// Returns `true` until the lock-out is complete. `stops`: a halt is under way.
    pub(super) fn is_under_way(&self, stops: bool) -> bool {
        self.0.is_some_and(|progress| !progress.is_proved || stops)
    }

    /// Keeps the unit from starting on its own and checks it, once per link, until proved.
    pub(super) fn next(&mut self, state: &AntennaState, is_unread: bool, now: Instant) -> LockStep {
        let Some(progress) = self.0.as_mut().filter(|progress| progress.has_program) else {
            return LockStep::Wait;
        };
        if is_unread {
            progress.is_asked = false;
            return LockStep::Wait;
        }
        if state.measured.is_none_or(|measured| measured.requested <= progress.begun) {
            return LockStep::Wait;
        }
        match state.program.and_then(|program| program.auto) {
            Some(false) => {
                (progress.is_proved, progress.was_proved) = (true, true);
                progress.is_reported = false;
                LockStep::Wait
            }
            Some(true) if progress.is_proved => {
                progress.is_proved = false;
                self.report()
            }
            Some(true) | None if !progress.is_asked && !progress.was_proved => {
                progress.is_asked = true;
                progress.begun = now;
                LockStep::SwitchOff
            }
            Some(true) | None if now.saturating_duration_since(progress.begun) >= READ_BACK => {
                self.report()
            }
            Some(true) | None => LockStep::Wait,
        }
    }

    /// Requests one report that the unit may start on its own.
    pub(super) fn report(&mut self) -> LockStep {
        let Some(progress) = &mut self.0 else { return LockStep::Wait };
        if std::mem::replace(&mut progress.is_reported, true) {
            LockStep::Wait
        } else {
            LockStep::Report
        }
    }
}
