//! Puts a group of settings on the unit and proves it: looks whether the unit
//! still holds what the operator saw, sends, reads back, and asks what the unit
//! makes of it.

use super::settings::{GROUPS, Plan, Proof, Wish, values_of};
use crate::{
    controller::{
        Moment,
        settings::{
            Access, Change, Field, Group, Guard, ReadFailure, SettleError, SettleStep, Values,
        },
    },
    protocol::satrak::{Faults, Reply, Request},
};

/// A clock is set within this after a full second, nanoseconds.
const FULL_SECOND_NS: i32 = 60_000_000;

/// A change on its way to the unit.
#[derive(Debug)]
pub(super) struct Settling {
    pub(super) change: Change,
    group: &'static Group,
    step: Step,
    /// As read before anything was sent.
    before: Values,
    /// What came of sending and reading back so far.
    result: Result<(), SettleError>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    Look,
    Send,
    ReadBack,
    /// The questions of [`Plan::also`], by their place.
    Also(usize),
}

/// What is to be done for a change now.
pub(super) enum Next {
    /// This is to be sent.
    Send(Request),
    /// Nothing before this time.
    At(std::time::Instant),
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
}

impl Settling {
    /// The first step of `change`; an error when it cannot be begun.
    pub(super) fn new(change: &Change) -> Result<Self, SettleError> {
        let group = GROUPS.iter().find(|group| group.key == change.group);
        let group = *group.ok_or(SettleError::NoSuchSetting)?;
        let writable =
            |key: &&str| group.field(key).is_some_and(|field| field.access != Access::Read);
        if change.values.is_empty() || !change.values.keys().all(writable) {
            return Err(SettleError::NoSuchSetting);
        }
        if group.guard(&change.values) == Guard::Service && !change.is_unlocked {
            return Err(SettleError::Locked);
        }
        let (before, step) = (Values::new(), Step::Look);
        Ok(Self { change: change.clone(), group, step, before, result: Ok(()) })
    }

    /// How far it is.
    pub(super) fn shown(&self) -> SettleStep {
        match self.step {
            Step::Look => SettleStep::Looking,
            Step::Send => SettleStep::Sending,
            Step::ReadBack | Step::Also(_) => SettleStep::ReadingBack,
        }
    }

    /// Whether the unit may have taken something of it.
    pub(super) fn may_be_sent(&self) -> bool {
        self.step != Step::Look
    }

    fn plan(&self) -> Option<Plan> {
        Plan::of(self.group.key)
    }

    /// What is to be done now.
    pub(super) fn next(&self, doing: Doing, now: Moment) -> Next {
        let Some(plan) = self.plan() else { return Next::Over(Err(SettleError::NoSuchSetting)) };
        match self.step {
            Step::Look | Step::ReadBack => Next::Send(Request::Query(plan.query)),
            Step::Also(place) => match plan.also.get(place) {
                Some(query) => Next::Send(Request::Query(*query)),
                None => Next::Over(self.result.clone()),
            },
            Step::Send => self.command(&plan, doing, now),
        }
    }

    fn command(&self, plan: &Plan, doing: Doing, now: Moment) -> Next {
        if self.group.guard(&self.change.values) == Guard::Service && doing.moves {
            return Next::Over(Err(SettleError::Moving));
        }
        if plan.is_clock {
            if doing.tracks {
                return Next::Over(Err(SettleError::Tracking));
            }
            let after = now.utc.subsec_nanosecond().rem_euclid(1_000_000_000);
            if after > FULL_SECOND_NS {
                let wait = 1_000_000_000_u32.saturating_sub(after.unsigned_abs());
                return Next::At(now.steady + std::time::Duration::from_nanos(wait.into()));
            }
        }
        let Some(write) = plan.write else { return Next::Over(Err(SettleError::NoSuchSetting)) };
        let wish = Wish { new: &self.change.values, held: &self.before, utc: now.utc };
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
        match (self.step, reply) {
            (Step::Look, _) => {
                self.before = self.values(reply)?;
                if self.has_changed_meanwhile() {
                    return Err(SettleError::ChangedMeanwhile);
                }
                self.step = Step::Send;
            }
            (Step::Send, _) => self.step = Step::ReadBack,
            (Step::ReadBack, _) => {
                let held = self.values(reply)?;
                let differing = self.differing(&held, ahead_s);
                self.result = match std::mem::replace(&mut self.result, Ok(())) {
                    Ok(()) | Err(SettleError::Unanswered) if differing.is_empty() => Ok(()),
                    Ok(()) => Err(SettleError::Differs(differing)),
                    Err(SettleError::Unanswered) if held != self.before => {
                        Err(SettleError::Differs(differing))
                    }
                    Err(error) => Err(error),
                };
                self.step = Step::Also(0);
            }
            (Step::Also(place), reply) => {
                if let Reply::Faults(faults) = reply
                    && self.result.is_ok()
                {
                    self.result = self.judge(*faults);
                }
                self.step = Step::Also(place + 1);
            }
        }
        Ok(())
    }

    /// The unit said no.
    pub(super) fn refused(&mut self, code: String) -> Result<(), SettleError> {
        match self.step {
            Step::Look => return Err(SettleError::Unread(ReadFailure::Refused(code))),
            Step::Send => {
                self.result = Err(SettleError::Refused(code));
                self.step = Step::ReadBack;
            }
            Step::ReadBack => return self.not_read_back(ReadFailure::Refused(code)),
            Step::Also(place) => self.step = Step::Also(place + 1),
        }
        Ok(())
    }

    /// No answer came, or none that can be read.
    pub(super) fn unanswered(&mut self) -> Result<(), SettleError> {
        match self.step {
            Step::Look => return Err(SettleError::Unread(ReadFailure::Unanswered)),
            Step::Send => {
                self.result = Err(SettleError::Unanswered);
                self.step = Step::ReadBack;
            }
            Step::ReadBack => return self.not_read_back(ReadFailure::Unanswered),
            Step::Also(place) => self.step = Step::Also(place + 1),
        }
        Ok(())
    }

    fn not_read_back(&self, failure: ReadFailure) -> Result<(), SettleError> {
        match &self.result {
            Err(refused @ SettleError::Refused(_)) => Err(refused.clone()),
            _ => Err(SettleError::NotReadBack(failure)),
        }
    }

    fn values(&self, reply: &Reply) -> Result<Values, SettleError> {
        let of_group = values_of(reply, None).filter(|(group, _)| group.key == self.group.key);
        of_group.map(|(_, values)| values).ok_or(SettleError::Unread(ReadFailure::Unanswered))
    }

    /// Values that are only reported may change at any time.
    fn has_changed_meanwhile(&self) -> bool {
        let Some(seen) = &self.change.seen else { return false };
        self.editable().any(|field| match (seen.get(field.key), self.before.get(field.key)) {
            (Some(seen), Some(now)) => !field.kind.same(seen, now),
            (seen, now) => seen.is_some() != now.is_some(),
        })
    }

    fn editable(&self) -> impl Iterator<Item = &'static Field> {
        self.group.fields.iter().filter(|field| field.access == Access::Edit)
    }

    /// The fields that do not hold what was asked for.
    fn differing(&self, held: &Values, ahead_s: Option<f64>) -> Vec<&'static str> {
        let Some(plan) = self.plan() else { return Vec::new() };
        (plan.differing)(&Proof { group: self.group, new: &self.change.values, held, ahead_s })
    }

    /// What the faults say about values that the unit holds.
    fn judge(&self, faults: Faults) -> Result<(), SettleError> {
        let objection = self.plan().and_then(|plan| (plan.judge)(faults));
        objection.map_or(Ok(()), |why| Err(SettleError::Useless(why.to_owned())))
    }
}
