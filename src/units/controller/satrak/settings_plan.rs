//! Verified writing of a group of settings. Azel checks that the unit still holds the values that
//! the operator saw, sends the change, reads it back and asks the unit for faults.

use super::settings::{Desired, Plan, Proof};
use crate::{
    clock::Moment,
    device::settings::{Hindrance, ReadFailure, SettingsWrite, WriteAction, WriteError},
    protocol::satrak::{Faults, Reply, Request},
};

/// Max delay after a full second at which Azel sets a clock, nanoseconds.
const FULL_SECOND_NS: i32 = 60_000_000;

/// The next step of a change.
pub(super) enum NextRequest {
    Send(Request),
    /// Pause until this time.
    At(crate::clock::Instant),
    Over(Result<(), WriteError>),
}

/// Activity of the unit while a change waits.
#[derive(Debug, Clone, Copy)]
pub(super) struct Doing {
    /// `true` while an axis turns, or the program that turns it is on.
    pub(super) moves: bool,
    pub(super) tracks: bool,
    pub(super) is_auto: bool,
}

impl Doing {
    /// Returns the reason not to send a setting that decides where the antenna points. The gate has
    /// allowed the setting, but a motion may have begun since.
    fn hindrance(self) -> Option<Hindrance> {
        match self {
            Self { tracks: true, .. } => Some(Hindrance::Tracks),
            Self { is_auto: true, .. } => Some(Hindrance::AutoTrack),
            Self { moves: true, .. } => Some(Hindrance::Moves),
            _ => None,
        }
    }
}

impl Plan {
    /// Returns the next step of a change of this group.
    pub(super) fn next(
        &self,
        settings_write: &SettingsWrite,
        doing: Doing,
        now: Moment,
    ) -> NextRequest {
        match settings_write.step() {
            WriteAction::Look | WriteAction::ReadBack => {
                NextRequest::Send(Request::Query(self.query))
            }
            WriteAction::Done => match self.also.get(settings_write.checked()) {
                Some(query) => NextRequest::Send(Request::Query(*query)),
                None => NextRequest::Over(settings_write.result()),
            },
            WriteAction::Send => self.command(settings_write, doing, now),
        }
    }

    fn command(&self, settings_write: &SettingsWrite, doing: Doing, now: Moment) -> NextRequest {
        if settings_write.needs_standstill() && doing.moves {
            return NextRequest::Over(Err(WriteError::Moving));
        }
        if let Some((field, hindrance)) = settings_write.moving_field().zip(doing.hindrance()) {
            return NextRequest::Over(Err(WriteError::Hindered { field, hindrance }));
        }
        if self.is_clock {
            let after = now.utc.subsec_nanosecond().rem_euclid(1_000_000_000);
            if after > FULL_SECOND_NS {
                let wait = 1_000_000_000_u32.saturating_sub(after.unsigned_abs());
                return NextRequest::At(now.steady + std::time::Duration::from_nanos(wait.into()));
            }
        }
        let Some(write) = self.write else {
            return NextRequest::Over(Err(WriteError::NoSuchSetting));
        };
        let desired = Desired {
            new: &settings_write.change.values,
            unit_values: settings_write.before(),
            utc: now.utc,
        };
        match write(&desired) {
            Ok(setting) => NextRequest::Send(Request::Setting(setting)),
            Err(error) => NextRequest::Over(Err(error)),
        }
    }

    /// Takes the reply to the current step. An error ends the change immediately.
    pub(super) fn answered(
        &self,
        settings_write: &mut SettingsWrite,
        reply: &Reply,
        ahead_s: Option<f64>,
    ) -> Result<(), WriteError> {
        let values = || (self.values)(reply).ok_or(WriteError::Unread(ReadFailure::Unanswered));
        match settings_write.step() {
            WriteAction::Look => settings_write.looked(values()?)?,
            WriteAction::Send => settings_write.accepted(),
            WriteAction::ReadBack => {
                let (group, current) = (self.group, values()?);
                let new = &settings_write.change.values;
                let differing =
                    (self.differing)(&Proof { group, new, unit_values: &current, ahead_s });
                settings_write.read_back(&current, differing);
            }
            WriteAction::Done => settings_write.judge(match reply {
                Reply::Faults(faults) => self.judged(*faults),
                _ => Ok(()),
            }),
        }
        Ok(())
    }

    /// Returns an error if the faults show that the unit cannot use its values.
    fn judged(&self, faults: Faults) -> Result<(), WriteError> {
        let objection = (self.judge)(faults);
        objection.map_or(Ok(()), |reason| Err(WriteError::Useless(reason.to_owned())))
    }
}
