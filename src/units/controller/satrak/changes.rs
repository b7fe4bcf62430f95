//! Changes of settings, and the effects of their answers.

use super::{
    Satrak,
    settings::Plan,
    settings_plan::{Doing, NextRequest},
};
use crate::{
    clock::{Instant, Moment},
    device::settings::{SettingsWrite, WriteError},
    protocol::satrak::{Reply, Request},
};

impl Satrak {
    fn doing(&self) -> Doing {
        let moves = self.state.measured.is_none_or(|measured| measured.moving());
        let tracks = self.program_may_run();
        let moves = moves || tracks || self.motion_waits() || self.preparation.is_some();
        let is_auto = self.state.program.is_some_and(|program| program.auto == Some(true));
        Doing { moves, tracks, is_auto }
    }

    /// Returns the next step of the current change; `None` if there is none, or while the unit
    /// still works on a setting.
    fn next_of_change(&self, now: Moment) -> Option<NextRequest> {
        let settings_write = self.changes.under_way().filter(|_| self.slow.is_none())?;
        Some(match Plan::for_key(settings_write.group.key) {
            Some(plan) => plan.next(settings_write, self.doing(), now),
            None => NextRequest::Over(Err(WriteError::NoSuchSetting)),
        })
    }

    /// Returns the next request of the current change. Ends the change once it has no request and
    /// nothing to wait for.
    pub(super) fn write_request(&mut self, now: Moment) -> Option<Request> {
        match self.next_of_change(now)? {
            NextRequest::Send(Request::Setting(_)) if self.changes.are_locked() => {
                self.end_change(Err(WriteError::LockedOut), now);
                None
            }
            NextRequest::Send(request) => Some(request),
            NextRequest::At(_) => None,
            NextRequest::Over(result) => {
                self.end_change(result, now);
                None
            }
        }
    }

    /// Returns the time at which to call [`Self::write_request`] again.
    pub(super) fn write_due(&self, now: Moment) -> Option<Instant> {
        if self.slow.is_some() || self.changes.is_empty() {
            return None;
        }
        Some(match self.next_of_change(now) {
            Some(NextRequest::At(time)) => time,
            Some(NextRequest::Send(_) | NextRequest::Over(_)) | None => now.steady,
        })
    }

    pub(super) fn change_answered(&mut self, reply: &Reply, now: Moment) {
        let ahead_s = self.reported.clock.map(|clock| clock.ahead_s);
        self.advance_change(now, |settings_write| match Plan::for_key(settings_write.group.key) {
            Some(plan) => plan.answered(settings_write, reply, ahead_s),
            None => Err(WriteError::NoSuchSetting),
        });
    }

    pub(super) fn change_refused(&mut self, code: String, now: Moment) {
        self.advance_change(now, |settings_write| settings_write.refused(code));
    }

    pub(super) fn change_unanswered(&mut self, now: Moment) {
        self.advance_change(now, SettingsWrite::unanswered);
    }

    fn advance_change(
        &mut self,
        now: Moment,
        step: impl FnOnce(&mut SettingsWrite) -> Result<(), WriteError>,
    ) {
        if self.changes.advance(&mut self.state, now, step) {
            self.look_soon(now);
        }
    }

    fn end_change(&mut self, result: Result<(), WriteError>, now: Moment) {
        self.changes.end(result, &mut self.state, now);
        self.look_soon(now);
    }
}
