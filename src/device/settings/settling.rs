//! A change on its way to a device, whatever the device: looks whether it still
//! holds what the operator saw, sends, and reads back. Nothing is sent twice.

use super::{Access, Change, Field, Group, Guard, ReadFailure, SettleError, SettleStep, Values};

/// A change that is under way.
#[derive(Debug)]
pub(crate) struct Settling {
    /// What was asked for.
    pub(crate) change: Change,
    /// The group of it.
    pub(crate) group: &'static Group,
    step: Step,
    /// As read before anything was sent.
    before: Values,
    /// What came of sending and reading back so far.
    result: Result<(), SettleError>,
    /// How many questions after the read-back are over.
    checked: usize,
}

/// What a change waits for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Step {
    /// The present values.
    Look,
    /// The answer to the command.
    Send,
    /// The values after it.
    ReadBack,
    /// Nothing any more.
    Done,
}

impl Settling {
    /// The first step of `change` on a device with these groups; an error when it
    /// cannot be begun.
    pub(crate) fn new(
        change: &Change,
        groups: &'static [&'static Group],
    ) -> Result<Self, SettleError> {
        let group = groups.iter().find(|group| group.key == change.group);
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
        Ok(Self { change: change.clone(), group, step, before, result: Ok(()), checked: 0 })
    }

    /// What it waits for.
    pub(crate) fn step(&self) -> Step {
        self.step
    }

    /// How far it is, for the operator.
    pub(crate) fn shown(&self) -> SettleStep {
        match self.step {
            Step::Look => SettleStep::Looking,
            Step::Send => SettleStep::Sending,
            Step::ReadBack | Step::Done => SettleStep::ReadingBack,
        }
    }

    /// It may be sent only while nothing moves.
    pub(crate) fn needs_standstill(&self) -> bool {
        self.group.guard(&self.change.values) == Guard::Service
    }

    /// The key of a field that decides where the antenna points.
    pub(crate) fn moving_field(&self) -> Option<&'static str> {
        self.group.moving_field(&self.change.values).map(|field| field.key)
    }

    /// Whether the device may have taken something of it.
    pub(crate) fn may_be_sent(&self) -> bool {
        self.step != Step::Look
    }

    /// What the device held before.
    pub(crate) fn before(&self) -> &Values {
        &self.before
    }

    /// The present values came.
    pub(crate) fn looked(&mut self, held: Values) -> Result<(), SettleError> {
        self.before = held;
        if self.has_changed_meanwhile() {
            return Err(SettleError::ChangedMeanwhile);
        }
        self.step = Step::Send;
        Ok(())
    }

    /// The device has taken the command.
    pub(crate) fn accepted(&mut self) {
        self.step = Step::ReadBack;
    }

    /// The values after the command came; the fields with these keys do not hold
    /// what was asked for.
    pub(crate) fn read_back(&mut self, held: &Values, differing: Vec<&'static str>) {
        self.result = match std::mem::replace(&mut self.result, Ok(())) {
            Ok(()) | Err(SettleError::Unanswered) if differing.is_empty() => Ok(()),
            Ok(()) => Err(SettleError::Differs(differing)),
            Err(SettleError::Unanswered) if *held != self.before => {
                Err(SettleError::Differs(differing))
            }
            Err(error) => Err(error),
        };
        self.step = Step::Done;
    }

    /// The device said no to what it waits for.
    pub(crate) fn refused(&mut self, code: String) -> Result<(), SettleError> {
        match self.step {
            Step::Look => return Err(SettleError::Unread(ReadFailure::Refused(code))),
            Step::Send => {
                self.result = Err(SettleError::Refused(code));
                self.step = Step::ReadBack;
            }
            Step::ReadBack => return self.not_read_back(ReadFailure::Refused(code)),
            Step::Done => self.checked += 1,
        }
        Ok(())
    }

    /// No answer came, or none that can be read.
    pub(crate) fn unanswered(&mut self) -> Result<(), SettleError> {
        match self.step {
            Step::Look => return Err(SettleError::Unread(ReadFailure::Unanswered)),
            Step::Send => {
                self.result = Err(SettleError::Unanswered);
                self.step = Step::ReadBack;
            }
            Step::ReadBack => return self.not_read_back(ReadFailure::Unanswered),
            Step::Done => self.checked += 1,
        }
        Ok(())
    }

    fn not_read_back(&self, failure: ReadFailure) -> Result<(), SettleError> {
        match &self.result {
            Err(refused @ SettleError::Refused(_)) => Err(refused.clone()),
            _ => Err(SettleError::NotReadBack(failure)),
        }
    }

    /// A question after the read-back was answered; whether the device can work with the
    /// values is in `verdict`.
    pub(crate) fn judge(&mut self, verdict: Result<(), SettleError>) {
        self.checked += 1;
        if self.result.is_ok() {
            self.result = verdict;
        }
    }

    /// How many questions after the read-back are over.
    pub(crate) fn checked(&self) -> usize {
        self.checked
    }

    /// What came of it.
    pub(crate) fn result(&self) -> Result<(), SettleError> {
        self.result.clone()
    }

    /// Values that are only reported may change at any time.
    fn has_changed_meanwhile(&self) -> bool {
        let Some(seen) = &self.change.seen else { return false };
        let is_editable = |field: &&Field| field.access == Access::Edit;
        let changed = |field: &Field| match (seen.get(field.key), self.before.get(field.key)) {
            (Some(seen), Some(now)) => !field.kind.same(seen, now),
            (seen, now) => seen.is_some() != now.is_some(),
        };
        self.group.fields.iter().filter(is_editable).any(changed)
    }
}
