//! Puts a group of settings on the unit and proves it: looks whether the unit
//! still holds what the operator saw, sends, reads back, and asks what the unit
//! makes of it.

use super::settings::{GROUPS, Plan, Proof, Wish, values_of};
use crate::{
    clock::Moment,
    device::settings::{self, Change, Hindrance, ReadFailure, SettleError, Step, Values},
    protocol::satrak::{Faults, Reply, Request},
};

/// A clock is set within this after a full second, nanoseconds.
const FULL_SECOND_NS: i32 = 60_000_000;

/// A change on its way to the unit.
#[derive(Debug)]
pub(super) struct Settling {
    pub(super) core: settings::Settling,
    /// How many questions of [`Plan::also`] are over.
    asked_also: usize,
}

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

impl Settling {
    /// The first step of `change`; an error when it cannot be begun.
    pub(super) fn new(change: &Change) -> Result<Self, SettleError> {
        Ok(Self { core: settings::Settling::new(change, GROUPS)?, asked_also: 0 })
    }

    fn plan(&self) -> Option<&'static Plan> {
        Plan::of(self.core.group.key)
    }

    /// What is to be done now.
    pub(super) fn next(&self, doing: Doing, now: Moment) -> Next {
        let Some(plan) = self.plan() else { return Next::Over(Err(SettleError::NoSuchSetting)) };
        match self.core.step() {
            Step::Look | Step::ReadBack => Next::Send(Request::Query(plan.query)),
            Step::Done => match plan.also.get(self.asked_also) {
                Some(query) => Next::Send(Request::Query(*query)),
                None => Next::Over(self.core.result()),
            },
            Step::Send => self.command(plan, doing, now),
        }
    }

    fn command(&self, plan: &Plan, doing: Doing, now: Moment) -> Next {
        if self.core.needs_standstill() && doing.moves {
            return Next::Over(Err(SettleError::Moving));
        }
        if let Some((field, hindrance)) = self.core.moving_field().zip(doing.hindrance()) {
            return Next::Over(Err(SettleError::Hindered { field, hindrance }));
        }
        if plan.is_clock {
            let after = now.utc.subsec_nanosecond().rem_euclid(1_000_000_000);
            if after > FULL_SECOND_NS {
                let wait = 1_000_000_000_u32.saturating_sub(after.unsigned_abs());
                return Next::At(now.steady + std::time::Duration::from_nanos(wait.into()));
            }
        }
        let Some(write) = plan.write else { return Next::Over(Err(SettleError::NoSuchSetting)) };
        let wish = Wish { new: &self.core.change.values, held: self.core.before(), utc: now.utc };
        match write(&wish) {
            Ok(setting) => Next::Send(Request::Setting(setting)),
            Err(error) => Next::Over(Err(error)),
        }
    }

    /// The present step was answered. An error ends it at once.
    pub(super) fn answered(
        &mut self,
        reply: &Reply,
        ahead_s: Option<f64>,
    ) -> Result<(), SettleError> {
        match self.core.step() {
            Step::Look => self.core.looked(self.values(reply)?)?,
            Step::Send => self.core.accepted(),
            Step::ReadBack => {
                let held = self.values(reply)?;
                let differing = self.differing(&held, ahead_s);
                self.core.read_back(&held, differing);
            }
            Step::Done => {
                if let Reply::Faults(faults) = reply {
                    self.core.judge(self.judge(*faults));
                }
                self.asked_also += 1;
            }
        }
        Ok(())
    }

    /// The unit said no.
    pub(super) fn refused(&mut self, code: String) -> Result<(), SettleError> {
        self.asked_also += usize::from(self.core.step() == Step::Done);
        self.core.refused(code)
    }

    /// No answer came, or none that can be read.
    pub(super) fn unanswered(&mut self) -> Result<(), SettleError> {
        self.asked_also += usize::from(self.core.step() == Step::Done);
        self.core.unanswered()
    }

    fn values(&self, reply: &Reply) -> Result<Values, SettleError> {
        let of_group = values_of(reply).filter(|(group, _)| group.key == self.core.group.key);
        of_group.map(|(_, values)| values).ok_or(SettleError::Unread(ReadFailure::Unanswered))
    }

    /// The fields that do not hold what was asked for.
    fn differing(&self, held: &Values, ahead_s: Option<f64>) -> Vec<&'static str> {
        let Some(plan) = self.plan() else { return Vec::new() };
        let (group, new) = (self.core.group, &self.core.change.values);
        (plan.differing)(&Proof { group, new, held, ahead_s })
    }

    /// What the faults say about values that the unit holds.
    fn judge(&self, faults: Faults) -> Result<(), SettleError> {
        let objection = self.plan().and_then(|plan| (plan.judge)(faults));
        objection.map_or(Ok(()), |why| Err(SettleError::Useless(why.to_owned())))
    }
}
