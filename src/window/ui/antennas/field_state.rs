//! State of a field.

use jiff::Timestamp;

use super::{
    draft::{Draft, Outcome, Reading},
    unit::ShownUnit,
};
use crate::{
    astro::time::seconds_between,
    device::settings::{Access, Field, Group, Guard, Kind, Unfit, Value},
    ui::{format, widgets::form::Mark},
};

#[derive(Debug, Clone, PartialEq)]
pub(super) enum FieldState {
    /// Value that the unit has not reported.
    Unknown,
    Unchanged,
    Edited,
    /// Value that needs a separate confirmation.
    ConfirmFirst,
    /// Value that needs the service functions, which are locked.
    NeedsService,
    Sending,
    Verified(Timestamp),
    /// Value that the unit accepted but never reports.
    Taken(Timestamp),
    Rejected,
    Invalid(Unfit),
    /// Value in one change with the field of this label, which Azel cannot send.
    HeldBackBy(&'static str),
    ReadOnly,
    /// Time value of the unit, with the moment at which Azel read it.
    Read(Timestamp),
    Locked,
}

impl FieldState {
    /// Returns the state in one or two words.
    pub(super) fn word(&self, now: Timestamp) -> String {
        match self {
            Self::Unknown => "Not read".to_owned(),
            Self::Unchanged => "Unchanged".to_owned(),
            Self::Edited => "Edited".to_owned(),
            Self::ConfirmFirst => "Confirm first".to_owned(),
            Self::NeedsService => "Service locked".to_owned(),
            Self::Sending => "Sending".to_owned(),
            Self::Verified(time) => format!("Verified {}", format::moment(*time, now)),
            Self::Taken(time) => format!("Accepted {}", format::moment(*time, now)),
            Self::Rejected => "Rejected".to_owned(),
            Self::Invalid(_) => "Invalid".to_owned(),
            Self::HeldBackBy(_) => "Held back".to_owned(),
            Self::ReadOnly => "Read only".to_owned(),
            Self::Read(time) => format!("Read {} ago", format::age(seconds_between(*time, now))),
            Self::Locked => "Locked".to_owned(),
        }
    }

    pub(super) fn mark(&self) -> Mark {
        match self {
            Self::Unchanged | Self::ReadOnly | Self::Read(_) => Mark::Plain,
            Self::Edited => Mark::Edited,
            Self::ConfirmFirst | Self::HeldBackBy(_) => Mark::Pending,
            Self::NeedsService => Mark::NeedsUnlock,
            Self::Sending => Mark::Sending,
            Self::Verified(_) | Self::Taken(_) => Mark::Good,
            Self::Rejected | Self::Invalid(_) => Mark::Refused,
            Self::Unknown => Mark::Unknown,
            Self::Locked => Mark::Locked,
        }
    }

    /// Returns `true` if the operator may type into the field.
    pub(super) fn is_editable(&self) -> bool {
        !matches!(
            self,
            Self::Unknown | Self::Sending | Self::ReadOnly | Self::Read(_) | Self::Locked
        )
    }

    /// Returns `true` if the field holds a value that is not on the unit.
    pub(super) fn is_edit(&self) -> bool {
        matches!(
            self,
            Self::Edited
                | Self::ConfirmFirst
                | Self::NeedsService
                | Self::Rejected
                | Self::Invalid(_)
                | Self::HeldBackBy(_)
        )
    }
}

/// Returns the state of `field` in `group`, with the new value if Azel can send it.
pub(super) fn new(
    unit: &ShownUnit<'_>,
    group: &Group,
    field: &Field,
    draft: &Draft,
) -> (FieldState, Option<Value>) {
    let (state, value) = alone(unit, group, field, draft);
    let holds_back = |other: &&Field| {
        let (state, value) = alone(unit, group, other, draft);
        state.is_edit() && value.is_none()
    };
    match group.other_parts(field).find(holds_back) {
        Some(other) if value.is_some() => (FieldState::HeldBackBy(other.label), None),
        _ => (state, value),
    }
}

/// Returns the state of `field`, regardless of the fields in the same change.
fn alone(
    unit: &ShownUnit<'_>,
    group: &Group,
    field: &Field,
    draft: &Draft,
) -> (FieldState, Option<Value>) {
    let current = unit.values(group.key);
    let is_told = current.is_some_and(|current| current.contains_key(field.key));
    // A value that the unit never reports counts as known once Azel has read its group.
    let is_known = is_told || (field.access == Access::Write && current.is_some());
    if field.access == Access::Read {
        // The unit does not report a value that is missing after a reading of its group.
        let state = match (unit.read_at(group.key), &field.kind) {
            (None, _) => FieldState::Unknown,
            (Some(time), Kind::Time) => FieldState::Read(time),
            (Some(_), _) => FieldState::ReadOnly,
        };
        return (state, None);
    }
    if draft.is_sending(field.key) {
        return (FieldState::Sending, None);
    }
    if group.is_service && !unit.is_unlocked {
        let is_typed = draft.reading(field, current) != Reading::Same;
        return (if is_typed { FieldState::NeedsService } else { FieldState::Locked }, None);
    }
    if !is_known {
        return (FieldState::Unknown, None);
    }
    let state = match draft.reading(field, current) {
        Reading::Unfit(unfit) => FieldState::Invalid(unfit),
        Reading::Same => match draft.outcome(field, current) {
            Some(Outcome::Verified(time)) => FieldState::Verified(time),
            Some(Outcome::Taken(time)) => FieldState::Taken(time),
            Some(Outcome::Rejected) | None => FieldState::Unchanged,
        },
        Reading::New(value) => return edited(unit, group, field, draft, value),
    };
    (state, None)
}

fn edited(
    unit: &ShownUnit<'_>,
    group: &Group,
    field: &Field,
    draft: &Draft,
    value: Value,
) -> (FieldState, Option<Value>) {
    let guard = if group.is_service { Guard::Free } else { (field.guard)(&value) };
    if guard == Guard::Service && !unit.is_unlocked {
        (FieldState::NeedsService, None)
    } else if guard != Guard::Free && !draft.is_confirmed(field.key) {
        (FieldState::ConfirmFirst, None)
    } else if draft.outcome(field, unit.values(group.key)) == Some(Outcome::Rejected) {
        (FieldState::Rejected, Some(value))
    } else {
        (FieldState::Edited, Some(value))
    }
}
