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
    /// The unit has not reported the value.
    Unknown,
    Unchanged,
    Edited,
    /// The value must be confirmed separately.
    ConfirmFirst,
    /// The value needs the service functions, which are locked.
    NeedsService,
    Sending,
    Verified(Timestamp),
    /// Accepted by the unit, which never reports the value.
    Taken(Timestamp),
    Rejected,
    Invalid(Unfit),
    /// The value goes out with that of the field with this label, which cannot be sent.
    HeldBackBy(&'static str),
    ReadOnly,
    /// A time that the unit told then, as of its clock.
    Read(Timestamp),
    Locked,
}

impl FieldState {
    /// State in a word or two.
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

/// State of `field` in `group`, with the new value if it can be sent.
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

/// State of `field` regardless of the fields that its value goes out with.
fn alone(
    unit: &ShownUnit<'_>,
    group: &Group,
    field: &Field,
    draft: &Draft,
) -> (FieldState, Option<Value>) {
    let current = unit.values(group.key);
    let is_told = current.is_some_and(|current| current.contains_key(field.key));
    // A value that is never reported is known as far as its group is.
    let is_known = is_told || (field.access == Access::Write && current.is_some());
    if field.access == Access::Read {
        // A value missing from a group that was read is one that the unit does not report.
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
