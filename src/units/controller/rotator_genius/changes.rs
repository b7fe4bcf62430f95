//! Verified writing of a configuration: Azel reads it, sends it once and reads it back.

use super::{
    Genius,
    exchange::Purpose,
    settings::{configuration, differing, rotator_of, values},
};
use crate::{
    clock::Moment,
    device::settings::{SettingsWrite, WriteAction, WriteError},
    protocol::rotator_genius::Request,
};

/// The next step of a change.
enum NextChange {
    Send(Request),
    Over(Result<(), WriteError>),
}

impl Genius {
    /// Returns the next request of the pending changes; ends the changes that have none.
    pub(super) fn write_request(&mut self, now: Moment) -> Option<(Request, Purpose)> {
        loop {
            self.changes.begin(&mut self.state, now);
            match self.next_step(self.changes.under_way()?) {
                NextChange::Send(Request::Configure(_)) if self.changes.are_locked() => {
                    self.changes.end(Err(WriteError::LockedOut), &mut self.state, now);
                }
                NextChange::Send(request) => return Some((request, Purpose::WriteSettings)),
                NextChange::Over(result) => self.changes.end(result, &mut self.state, now),
            }
        }
    }

    fn next_step(&self, settings_write: &SettingsWrite) -> NextChange {
        match settings_write.step() {
            WriteAction::Look | WriteAction::ReadBack => NextChange::Send(Request::Read),
            WriteAction::Done => NextChange::Over(settings_write.result()),
            // Configuring the unit makes it release the rotators that it turns.
            WriteAction::Send if self.moving() || self.motion_waits() => {
                NextChange::Over(Err(WriteError::Moving))
            }
            WriteAction::Send => {
                let number = rotator_of(settings_write.group.key).ok_or(WriteError::NoSuchSetting);
                let sent = number.and_then(|number| {
                    configuration(number, &settings_write.change.values, settings_write.before())
                });
                sent.map_or_else(
                    |error| NextChange::Over(Err(error)),
                    |sent| NextChange::Send(Request::Configure(sent)),
                )
            }
        }
    }

    /// Takes a status that a pending change needs.
    pub(super) fn change_read(&mut self, now: Moment) {
        let Some(status) = &self.status else { return };
        self.changes.advance(&mut self.state, now, |settings_write| {
            let Some(number) = rotator_of(settings_write.group.key) else { return Ok(()) };
            let unit_values = values(status, number);
            match settings_write.step() {
                WriteAction::Look => settings_write.looked(unit_values),
                WriteAction::ReadBack => {
                    let mut sent = settings_write.before().clone();
                    sent.extend(settings_write.change.values.clone());
                    let differing = differing(settings_write.group, &sent, &unit_values);
                    settings_write.read_back(&unit_values, differing);
                    Ok(())
                }
                WriteAction::Send | WriteAction::Done => Ok(()),
            }
        });
    }

    /// Handles the unit's answer to the command of a change.
    pub(super) fn change_judged(&mut self, is_accepted: bool, now: Moment) {
        self.changes.advance(&mut self.state, now, |settings_write| {
            if is_accepted {
                settings_write.accepted();
                return Ok(());
            }
            settings_write.refused("F".to_owned())
        });
    }

    /// Handles a missing answer to the command of a change.
    pub(super) fn change_unanswered(&mut self, now: Moment) {
        self.changes.advance(&mut self.state, now, SettingsWrite::unanswered);
    }
}
