//! Puts a group of settings on the unit and proves it: looks whether the unit
//! still holds what the operator saw, sends, reads back, and asks what the unit
//! makes of it.

use super::settings::{Plan, Proof, Wish};
use crate::{
    clock::Moment,
    device::settings::{Hindrance, ReadFailure, SettleError, Settling, Step},
    protocol::satrak::{Faults, Reply, Request},
};

/// A clock is set within this after a full second, nanoseconds.
const FULL_SECOND_NS: i32 = 60_000_000;

/// What is to be done for a change now.
pub(super) enum Next {
    /// This is to be sent.
    Send(Request),
    /// Nothing before this time.
    At(crate::clock::Instant),
    /// It is over.
    Over(Result<(), SettleError>),
}

/// What the unit does while a change is to be sent.
#[derive(Debug, Clone, Copy)]
pub(super) struct Doing {
    /// An axis turns, or the program that turns it is on.
    pub(super) moves: bool,
    /// Its program is on.
    pub(super) tracks: bool,
    /// Its program starts by itself.
    pub(super) is_auto: bool,
}

impl Doing {
    /// Why a setting that decides where the antenna points is not sent. The gate
    /// has let it through; what has begun since then comes first.
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
    /// What is to be done now for a change of this group.
    pub(super) fn next(&self, settling: &Settling, doing: Doing, now: Moment) -> Next {
        match settling.step() {
            Step::Look | Step::ReadBack => Next::Send(Request::Query(self.query)),
            Step::Done => match self.also.get(settling.checked()) {
                Some(query) => Next::Send(Request::Query(*query)),
                None => Next::Over(settling.result()),
            },
            Step::Send => self.command(settling, doing, now),
        }
    }

    fn command(&self, settling: &Settling, doing: Doing, now: Moment) -> Next {
        if settling.needs_standstill() && doing.moves {
            return Next::Over(Err(SettleError::Moving));
        }
        if let Some((field, hindrance)) = settling.moving_field().zip(doing.hindrance()) {
            return Next::Over(Err(SettleError::Hindered { field, hindrance }));
        }
        if self.is_clock {
            let after = now.utc.subsec_nanosecond().rem_euclid(1_000_000_000);
            if after > FULL_SECOND_NS {
                let wait = 1_000_000_000_u32.saturating_sub(after.unsigned_abs());
                return Next::At(now.steady + std::time::Duration::from_nanos(wait.into()));
            }
        }
        let Some(write) = self.write else { return Next::Over(Err(SettleError::NoSuchSetting)) };
        let wish = Wish { new: &settling.change.values, held: settling.before(), utc: now.utc };
        match write(&wish) {
            Ok(setting) => Next::Send(Request::Setting(setting)),
            Err(error) => Next::Over(Err(error)),
        }
    }

    /// The present step of a change of this group was answered. An error ends it at once.
    pub(super) fn answered(
        &self,
        settling: &mut Settling,
        reply: &Reply,
        ahead_s: Option<f64>,
    ) -> Result<(), SettleError> {
        let values = || (self.values)(reply).ok_or(SettleError::Unread(ReadFailure::Unanswered));
        match settling.step() {
            Step::Look => settling.looked(values()?)?,
            Step::Send => settling.accepted(),
            Step::ReadBack => {
                let (group, held) = (self.group, values()?);
                let new = &settling.change.values;
                let differing = (self.differing)(&Proof { group, new, held: &held, ahead_s });
                settling.read_back(&held, differing);
            }
            Step::Done => settling.judge(match reply {
                Reply::Faults(faults) => self.judged(*faults),
                _ => Ok(()),
            }),
        }
        Ok(())
    }

    /// What the faults say about values that the unit holds.
    fn judged(&self, faults: Faults) -> Result<(), SettleError> {
        let objection = (self.judge)(faults);
        objection.map_or(Ok(()), |why| Err(SettleError::Useless(why.to_owned())))
    }
}
