//! A change on its way to a device, whatever the device: looks whether it still
//! holds what the operator saw, sends, and reads back. Nothing is sent twice.

use super::{Access, Change, Field, Group, Guard, ReadFailure, Values, WriteError, WriteStep};

/// A change that is under way.
#[derive(Debug)]
pub(crate) struct SettingsWrite {
    /// What was asked for.
    pub(crate) change: Change,
    /// The group of it.
    pub(crate) group: &'static Group,
    step: Step,
    /// As read before anything was sent.
    before: Values,
    /// What came of sending and reading back so far.
    result: Result<(), WriteError>,
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

impl SettingsWrite {
    /// The first step of `change` on a device with these groups; an error when it
    /// cannot be begun.
    pub(crate) fn new(
        change: &Change,
        groups: &'static [&'static Group],
    ) -> Result<Self, WriteError> {
        let group = groups.iter().find(|group| group.key == change.group);
        let group = *group.ok_or(WriteError::NoSuchSetting)?;
        let writable =
            |key: &&str| group.field(key).is_some_and(|field| field.access != Access::Read);
        if change.values.is_empty() || !change.values.keys().all(writable) {
            return Err(WriteError::NoSuchSetting);
        }
        if group.guard(&change.values) == Guard::Service && !change.is_unlocked {
            return Err(WriteError::Locked);
        }
        let (before, step) = (Values::new(), Step::Look);
        Ok(Self { change: change.clone(), group, step, before, result: Ok(()), checked: 0 })
    }

    /// What it waits for.
    pub(crate) fn step(&self) -> Step {
        self.step
    }

    /// How far it is, for the operator.
    pub(crate) fn shown(&self) -> WriteStep {
        match self.step {
            Step::Look => WriteStep::Looking,
            Step::Send => WriteStep::Sending,
            Step::ReadBack | Step::Done => WriteStep::ReadingBack,
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
    pub(crate) fn looked(&mut self, held: Values) -> Result<(), WriteError> {
        self.before = held;
        if self.has_changed_meanwhile() {
            return Err(WriteError::ChangedMeanwhile);
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
            Ok(()) | Err(WriteError::Unanswered) if differing.is_empty() => Ok(()),
            Ok(()) => Err(WriteError::Differs(differing)),
            Err(WriteError::Unanswered) if *held != self.before => {
                Err(WriteError::Differs(differing))
            }
            Err(error) => Err(error),
        };
        self.step = Step::Done;
    }

    /// The device said no to what it waits for.
    pub(crate) fn refused(&mut self, code: String) -> Result<(), WriteError> {
        match self.step {
            Step::Look => return Err(WriteError::Unread(ReadFailure::Refused(code))),
            Step::Send => {
                self.result = Err(WriteError::Refused(code));
                self.step = Step::ReadBack;
            }
            Step::ReadBack => return self.not_read_back(ReadFailure::Refused(code)),
            Step::Done => self.checked += 1,
        }
        Ok(())
    }

    /// No answer came, or none that can be read.
    pub(crate) fn unanswered(&mut self) -> Result<(), WriteError> {
        match self.step {
            Step::Look => return Err(WriteError::Unread(ReadFailure::Unanswered)),
            Step::Send => {
                self.result = Err(WriteError::Unanswered);
                self.step = Step::ReadBack;
            }
            Step::ReadBack => return self.not_read_back(ReadFailure::Unanswered),
            Step::Done => self.checked += 1,
        }
        Ok(())
    }

    fn not_read_back(&self, failure: ReadFailure) -> Result<(), WriteError> {
        match &self.result {
            Err(refused @ WriteError::Refused(_)) => Err(refused.clone()),
            _ => Err(WriteError::NotReadBack(failure)),
        }
    }

    /// A question after the read-back was answered; whether the device can work with the
    /// values is in `verdict`.
    pub(crate) fn judge(&mut self, verdict: Result<(), WriteError>) {
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
    pub(crate) fn result(&self) -> Result<(), WriteError> {
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
