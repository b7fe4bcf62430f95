//! Puts a configuration on the device and proves it: looks, sends once, reads
//! back.

use super::{
    Genius,
    exchange::Purpose,
    settings::{GROUPS, configuration, differing, rotator_of, values},
};
use crate::{
    clock::Moment,
    device::settings::{Change, SettleError, Settling, Step},
    protocol::rotator_genius::Request,
};

/// What is to be done for a change now.
enum Next {
    /// This is to be sent.
    Send(Request),
    /// It is over.
    Over(Result<(), SettleError>),
}

impl Genius {
    /// Takes up the next change when none is under way.
    fn begin_change(&mut self, now: Moment) {
        while self.settling.is_none()
            && let Some(change) = self.changes.pop_front()
        {
            match Settling::new(&change, GROUPS) {
                Ok(settling) => {
                    self.settling = Some(settling);
                    self.show_change();
                }
                Err(error) => self.settled(change, Err(error), now),
            }
        }
    }

    /// The next request of the changes, of which those that have none are over.
    pub(super) fn settling_request(&mut self, now: Moment) -> Option<(Request, Purpose)> {
        loop {
            self.begin_change(now);
            match self.next_step(self.settling.as_ref()?) {
                Next::Send(Request::Configure(_)) if self.are_changes_locked => {
                    self.end_change(Err(SettleError::LockedOut), now);
                }
                Next::Send(request) => return Some((request, Purpose::Settle)),
                Next::Over(result) => self.end_change(result, now),
            }
        }
    }

    fn next_step(&self, settling: &Settling) -> Next {
        match settling.step() {
            Step::Look | Step::ReadBack => Next::Send(Request::Read),
            Step::Done => Next::Over(settling.result()),
            // A device that is configured lets go of what it turns.
            Step::Send if self.moving() || self.motion_waits() => {
                Next::Over(Err(SettleError::Moving))
            }
            Step::Send => {
                let number = rotator_of(settling.group.key).ok_or(SettleError::NoSuchSetting);
                let sent = number.and_then(|number| {
                    configuration(number, &settling.change.values, settling.before())
                });
                sent.map_or_else(
                    |error| Next::Over(Err(error)),
                    |sent| Next::Send(Request::Configure(sent)),
                )
            }
        }
    }

    /// A status has come that a change waits for.
    pub(super) fn change_read(&mut self, now: Moment) {
        let (Some(settling), Some(status)) = (&mut self.settling, &self.status) else { return };
        let Some(number) = rotator_of(settling.group.key) else { return };
        let held = values(status, number);
        let result = match settling.step() {
            Step::Look => settling.looked(held),
            Step::ReadBack => {
                let mut sent = settling.before().clone();
                sent.extend(settling.change.values.clone());
                let differing = differing(settling.group, &sent, &held);
                settling.read_back(&held, differing);
                Ok(())
            }
            Step::Send | Step::Done => Ok(()),
        };
        self.go_on(result, now);
    }

    /// The device has answered the command of a change.
    pub(super) fn change_judged(&mut self, is_accepted: bool, now: Moment) {
        let Some(settling) = &mut self.settling else { return };
        let result = if is_accepted {
            settling.accepted();
            Ok(())
        } else {
            settling.refused("F".to_owned())
        };
        self.go_on(result, now);
    }

    /// The device has not answered.
    pub(super) fn change_unanswered(&mut self, now: Moment) {
        let Some(settling) = &mut self.settling else { return };
        let result = settling.unanswered();
        self.go_on(result, now);
    }

    fn go_on(&mut self, result: Result<(), SettleError>, now: Moment) {
        match result {
            Ok(()) => self.show_change(),
            Err(error) => self.end_change(Err(error), now),
        }
    }

    fn show_change(&mut self) {
        if let Some(settling) = &self.settling {
            let (group, step) = (settling.group.key, settling.shown());
            self.state.group(group).step = Some(step);
        }
    }

    fn end_change(&mut self, result: Result<(), SettleError>, now: Moment) {
        if let Some(settling) = self.settling.take() {
            self.settled(settling.change, result, now);
        }
    }

    /// The change is over, for good or bad.
    pub(super) fn settled(&mut self, change: Change, result: Result<(), SettleError>, now: Moment) {
        let is_followed = self.changes.iter().any(|other| other.group == change.group);
        self.state.end_change(change, result, is_followed, now);
    }

    /// The link is gone: what may be on the device is not known.
    pub(super) fn abandon_changes(&mut self, now: Moment) {
        if let Some(settling) = self.settling.take() {
            let is_lost = settling.may_be_sent();
            let error = if is_lost { SettleError::LinkLost } else { SettleError::NoLink };
            self.settled(settling.change, Err(error), now);
        }
        while let Some(change) = self.changes.pop_front() {
            self.settled(change, Err(SettleError::NoLink), now);
        }
    }
}
