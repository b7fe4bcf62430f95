//! The queue of changes, and what their answers bring about.

use super::{
    Satrak,
    settle::{Doing, Next, Settling},
};
use crate::{
    clock::{Instant, Moment},
    device::settings::{Change, SettleError},
    protocol::satrak::{Reply, Request},
};

impl Satrak {
    /// Takes up the next change when none is under way.
    pub(super) fn begin_change(&mut self, now: Moment) {
        while self.settling.is_none()
            && let Some(change) = self.changes.pop_front()
        {
            match Settling::new(&change) {
                Ok(settling) => {
                    self.settling = Some(settling);
                    self.show_change();
                }
                Err(error) => self.settled(change, Err(error), now),
            }
        }
    }

    fn doing(&self) -> Doing {
        let moves = self.state.measured.is_none_or(|measured| measured.moving());
        let tracks = self.program_may_run();
        let moves = moves || tracks || self.motion_waits() || self.preparation.is_some();
        let is_auto = self.state.program.is_some_and(|program| program.auto == Some(true));
        Doing { moves, tracks, is_auto }
    }

    /// The next request of the change under way. It is over when there is none
    /// and nothing to wait for.
    pub(super) fn settling_request(&mut self, now: Moment) -> Option<Request> {
        if self.slow.is_some() {
            return None;
        }
        match self.settling.as_ref()?.next(self.doing(), now) {
            Next::Send(Request::Setting(_)) if self.are_changes_locked => {
                self.end_change(Err(SettleError::LockedOut), now);
                None
            }
            Next::Send(request) => Some(request),
            Next::At(_) => None,
            Next::Over(result) => {
                self.end_change(result, now);
                None
            }
        }
    }

    /// When [`Self::settling_request`] is worth a call.
    pub(super) fn settling_due(&self, now: Moment) -> Option<Instant> {
        if self.slow.is_some() {
            return None;
        }
        let Some(settling) = &self.settling else {
            return (!self.changes.is_empty()).then_some(now.steady);
        };
        Some(match settling.next(self.doing(), now) {
            Next::At(time) => time,
            Next::Send(_) | Next::Over(_) => now.steady,
        })
    }

    pub(super) fn change_answered(&mut self, reply: &Reply, now: Moment) {
        let ahead_s = self.reported.clock.map(|clock| clock.ahead_s);
        self.advance_change(now, |settling| settling.answered(reply, ahead_s));
    }

    pub(super) fn change_refused(&mut self, code: String, now: Moment) {
        self.advance_change(now, |settling| settling.refused(code));
    }

    pub(super) fn change_unanswered(&mut self, now: Moment) {
        self.advance_change(now, Settling::unanswered);
    }

    fn advance_change(
        &mut self,
        now: Moment,
        step: impl FnOnce(&mut Settling) -> Result<(), SettleError>,
    ) {
        let Some(settling) = &mut self.settling else { return };
        match step(settling) {
            Ok(()) => self.show_change(),
            Err(error) => self.end_change(Err(error), now),
        }
    }

    fn show_change(&mut self) {
        if let Some(settling) = &self.settling {
            let (group, step) = (settling.core.change.group, settling.core.shown());
            self.state.group(group).step = Some(step);
        }
    }

    fn end_change(&mut self, result: Result<(), SettleError>, now: Moment) {
        if let Some(settling) = self.settling.take() {
            self.settled(settling.core.change, result, now);
        }
        self.look_soon(now);
    }

    /// The change is over, for good or bad.
    pub(super) fn settled(&mut self, change: Change, result: Result<(), SettleError>, now: Moment) {
        let is_followed = self.changes.iter().any(|other| other.group == change.group);
        self.state.end_change(change, result, is_followed, now);
    }

    /// The link is gone: what may be on the unit is not known.
    pub(super) fn abandon_changes(&mut self, now: Moment) {
        if let Some(settling) = self.settling.take() {
            let lost = settling.core.may_be_sent();
            let error = if lost { SettleError::LinkLost } else { SettleError::NoLink };
            self.settled(settling.core.change, Err(error), now);
        }
        while let Some(change) = self.changes.pop_front() {
            self.settled(change, Err(SettleError::NoLink), now);
        }
    }
}
