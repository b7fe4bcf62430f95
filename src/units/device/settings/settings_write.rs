//! One change of settings under way to a unit. The change reads the current values, sends the new
//! values, and reads them back. It sends nothing twice.

use super::{Access, Change, Field, Group, Guard, ReadFailure, Values, WriteError, WriteStep};

/// A change that is under way.
#[derive(Debug)]
pub(crate) struct SettingsWrite {
    pub(crate) change: Change,
    pub(crate) group: &'static Group,
    step: WriteAction,
    /// Values that were read before the change.
    before: Values,
    /// Outcome of sending and reading back so far.
    result: Result<(), WriteError>,
    /// Number of finished questions after the read-back.
    checked: usize,
    /// `true` if the gate has judged the change as a motion, because the antenna tracks.
    is_judged: bool,
}

/// The answer for which a change waits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum WriteAction {
    /// The current values.
    Look,
    /// The answer to the command.
    Send,
    /// The values after the command.
    ReadBack,
    /// Answers to questions after the read-back, if any.
    Done,
}

impl SettingsWrite {
    /// Starts `change` on a unit with these groups. Returns the reason if it cannot start.
    pub(crate) fn new(
        change: &Change,
        groups: &'static [&'static Group],
        is_judged: bool,
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
        let (before, step) = (Values::new(), WriteAction::Look);
        let change = change.clone();
        Ok(Self { change, group, step, before, result: Ok(()), checked: 0, is_judged })
    }

    pub(crate) fn step(&self) -> WriteAction {
        self.step
    }

    /// Returns the progress for the operator.
    pub(crate) fn shown(&self) -> WriteStep {
        match self.step {
            WriteAction::Look => WriteStep::Looking,
            WriteAction::Send => WriteStep::Sending,
            WriteAction::ReadBack | WriteAction::Done => WriteStep::ReadingBack,
        }
    }

    /// Returns `true` if the change may be sent only while nothing moves.
    pub(crate) fn needs_standstill(&self) -> bool {
        self.group.guard(&self.change.values) == Guard::Service
    }

    /// Returns the key of the first field of the change that decides where the antenna points and
    /// must wait for standstill.
    pub(crate) fn moving_field(&self) -> Option<&'static str> {
        let field = self.group.moving_field(&self.change.values).map(|field| field.key);
        field.filter(|_| !self.is_judged)
    }

    /// Returns `true` for a motion: a change that the gate has judged while the antenna tracks.
    pub(crate) fn is_judged(&self) -> bool {
        self.is_judged
    }

    /// Returns `true` if the unit may have taken a part of the change.
    pub(crate) fn may_be_sent(&self) -> bool {
        self.step != WriteAction::Look
    }

    /// Returns the values that the unit held before the change.
    pub(crate) fn before(&self) -> &Values {
        &self.before
    }

    /// Takes the current values. The change ends if they differ from the values that the operator
    /// saw.
    pub(crate) fn looked(&mut self, unit_values: Values) -> Result<(), WriteError> {
        self.before = unit_values;
        if self.has_changed_meanwhile() {
            return Err(WriteError::ChangedMeanwhile);
        }
        self.step = WriteAction::Send;
        Ok(())
    }

    /// Handles the unit's acceptance of the command.
    pub(crate) fn accepted(&mut self) {
        self.step = WriteAction::ReadBack;
    }

    /// Takes the values of the read-back. `differing` contains the keys of the fields that do not
    /// hold the requested values.
    pub(crate) fn read_back(&mut self, unit_values: &Values, differing: Vec<&'static str>) {
        self.result = match std::mem::replace(&mut self.result, Ok(())) {
            Ok(()) | Err(WriteError::Unanswered) if differing.is_empty() => Ok(()),
            Ok(()) => Err(WriteError::Differs(differing)),
            Err(WriteError::Unanswered) if *unit_values != self.before => {
                Err(WriteError::Differs(differing))
            }
            Err(error) => Err(error),
        };
        self.step = WriteAction::Done;
    }

    /// Handles a refusal of the question or command of the current step.
    pub(crate) fn refused(&mut self, code: String) -> Result<(), WriteError> {
        match self.step {
            WriteAction::Look => return Err(WriteError::Unread(ReadFailure::Refused(code))),
            WriteAction::Send => {
                self.result = Err(WriteError::Refused(code));
                self.step = WriteAction::ReadBack;
            }
            WriteAction::ReadBack => return self.not_read_back(ReadFailure::Refused(code)),
            WriteAction::Done => self.checked += 1,
        }
        Ok(())
    }

    /// Handles a missing or unreadable answer to the question or command of the current step.
    pub(crate) fn unanswered(&mut self) -> Result<(), WriteError> {
        match self.step {
            WriteAction::Look => return Err(WriteError::Unread(ReadFailure::Unanswered)),
            WriteAction::Send => {
                self.result = Err(WriteError::Unanswered);
                self.step = WriteAction::ReadBack;
            }
            WriteAction::ReadBack => return self.not_read_back(ReadFailure::Unanswered),
            WriteAction::Done => self.checked += 1,
        }
        Ok(())
    }

    fn not_read_back(&self, failure: ReadFailure) -> Result<(), WriteError> {
        match &self.result {
            Err(refused @ WriteError::Refused(_)) => Err(refused.clone()),
            _ => Err(WriteError::NotReadBack(failure)),
        }
    }

    /// Takes the answer to a question after the read-back. `verdict` says whether the unit can use
    /// the values.
    pub(crate) fn judge(&mut self, verdict: Result<(), WriteError>) {
        self.checked += 1;
        if self.result.is_ok() {
            self.result = verdict;
        }
    }

    pub(crate) fn checked(&self) -> usize {
        self.checked
    }

    /// Returns the outcome so far.
    pub(crate) fn result(&self) -> Result<(), WriteError> {
        self.result.clone()
    }

    /// Returns `true` if the values differ from those that the operator saw. Only editable fields
    /// count, because reported values may change at any time.
    fn has_changed_meanwhile(&self) -> bool {
        let Some(previous) = &self.change.expected else { return false };
        let is_editable = |field: &&Field| field.access == Access::Edit;
        let changed = |field: &Field| match (previous.get(field.key), self.before.get(field.key)) {
            (Some(before), Some(now)) => !field.kind.same(before, now),
            (before, now) => before.is_some() != now.is_some(),
        };
        self.group.fields.iter().filter(is_editable).any(changed)
    }
}
