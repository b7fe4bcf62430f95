//! Writes a configuration and proves it: reads, sends once, reads back.

use super::{
    Genius,
    exchange::Purpose,
    settings::{configuration, differing, rotator_of, values},
};
use crate::{
    clock::Moment,
    device::settings::{SettingsWrite, Step, WriteError},
    protocol::rotator_genius::Request,
};

/// The next step of a change.
enum Next {
    Send(Request),
    Over(Result<(), WriteError>),
}

impl Genius {
    /// The next request of the changes; ends those that have none.
    pub(super) fn write_request(&mut self, now: Moment) -> Option<(Request, Purpose)> {
        loop {
            self.changes.begin(&mut self.state, now);
            match self.next_step(self.changes.under_way()?) {
                Next::Send(Request::Configure(_)) if self.changes.are_locked() => {
                    self.changes.end(Err(WriteError::LockedOut), &mut self.state, now);
                }
                Next::Send(request) => return Some((request, Purpose::WriteSettings)),
                Next::Over(result) => self.changes.end(result, &mut self.state, now),
            }
        }
    }

    fn next_step(&self, settings_write: &SettingsWrite) -> Next {
        match settings_write.step() {
            Step::Look | Step::ReadBack => Next::Send(Request::Read),
            Step::Done => Next::Over(settings_write.result()),
            // A unit that is being configured lets go of what it turns.
            Step::Send if self.moving() || self.motion_waits() => {
                Next::Over(Err(WriteError::Moving))
            }
            Step::Send => {
                let number = rotator_of(settings_write.group.key).ok_or(WriteError::NoSuchSetting);
                let sent = number.and_then(|number| {
                    configuration(number, &settings_write.change.values, settings_write.before())
                });
                sent.map_or_else(
                    |error| Next::Over(Err(error)),
                    |sent| Next::Send(Request::Configure(sent)),
                )
            }
        }
    }

    /// Takes a status that a change waits for.
    pub(super) fn change_read(&mut self, now: Moment) {
        let Some(status) = &self.status else { return };
        self.changes.advance(&mut self.state, now, |settings_write| {
            let Some(number) = rotator_of(settings_write.group.key) else { return Ok(()) };
            let unit_values = values(status, number);
            match settings_write.step() {
                Step::Look => settings_write.looked(unit_values),
                Step::ReadBack => {
                    let mut sent = settings_write.before().clone();
                    sent.extend(settings_write.change.values.clone());
                    let differing = differing(settings_write.group, &sent, &unit_values);
                    settings_write.read_back(&unit_values, differing);
                    Ok(())
                }
                Step::Send | Step::Done => Ok(()),
            }
        });
    }

    /// The unit has answered the command of a change.
    pub(super) fn change_judged(&mut self, is_accepted: bool, now: Moment) {
        self.changes.advance(&mut self.state, now, |settings_write| {
            if is_accepted {
                settings_write.accepted();
                return Ok(());
            }
            settings_write.refused("F".to_owned())
        });
    }

    /// The unit has not answered.
    pub(super) fn change_unanswered(&mut self, now: Moment) {
        self.changes.advance(&mut self.state, now, SettingsWrite::unanswered);
    }
}
