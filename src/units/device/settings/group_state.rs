//! Settings that a unit holds, changes to them, and the outcome of changes.

use std::{collections::BTreeMap, sync::Arc};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{Hindrance, Unfit, Values};
use crate::name::{self, Name};

/// Known groups of a unit by key.
pub type GroupStates = BTreeMap<Name, GroupState>;

/// Known state of a group.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct GroupState {
    /// Values of the last read.
    #[serde(rename = "held")]
    pub last_read: Option<HeldGroup>,
    /// Reason why the last read failed; `None` after a success.
    pub failure: Option<ReadFailure>,
    /// Step of the change under way; `None` without a change.
    pub step: Option<WriteStep>,
    /// The last finished change.
    pub written: Option<Arc<Written>>,
}

/// Values of a group as Azel read them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HeldGroup {
    #[serde(deserialize_with = "name::map")]
    pub values: Values,
    pub read_at: Timestamp,
}

/// Reason why Azel could not read a group.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error, Serialize, Deserialize)]
pub enum ReadFailure {
    /// A question that the unit does not know. The text is its answer.
    #[error("the unit answered {0}")]
    Refused(String),
    /// A missing or unreadable answer.
    #[error("the unit did not answer")]
    Unanswered,
}

/// Step of a change.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum WriteStep {
    /// Pending, because other changes come first.
    Waiting,
    /// Reading of the current values, to compare them with the values that the operator saw.
    Looking,
    /// Sending: the change went out and is not answered.
    Sending,
    /// Reading back of the values.
    ReadingBack,
}

/// New values for a group of a unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Change {
    /// Number that the outcome repeats.
    pub ticket: u64,
    /// Key of the group.
    #[serde(deserialize_with = "name::one")]
    pub group: Name,
    /// New values. Fields that are absent here keep their values.
    #[serde(deserialize_with = "name::map")]
    pub values: Values,
    /// Values that the operator saw. If the unit holds other values, Azel sends nothing. `None`
    /// accepts any values.
    #[serde(rename = "seen", deserialize_with = "name::option_map")]
    pub expected: Option<Values>,
    /// `true` if the operator has unlocked the service functions.
    pub is_unlocked: bool,
}

/// A finished change.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Written {
    pub change: Change,
    /// End of the change.
    #[serde(rename = "at")]
    pub time: Timestamp,
    /// Outcome; `Ok` if Azel has read the values back and they are right.
    pub result: Result<(), WriteError>,
}

/// Reason why a change is not on the unit, or may not be.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize, Deserialize)]
pub enum WriteError {
    #[error("there is no link to the unit")]
    NoLink,
    #[error("the link was lost before it was read back")]
    LinkLost,
    /// A group that does not exist, or a value that cannot be set.
    #[error("the unit has no such setting")]
    NoSuchSetting,
    #[error("service functions are locked")]
    Locked,
    /// Lock-out of the unit: Azel sent nothing.
    #[error("the unit is locked out for maintenance")]
    LockedOut,
    #[error("the antenna moves")]
    Moving,
    /// A STOP that came first: Azel sent nothing.
    #[error("it was stopped before it was sent")]
    Stopped,
    /// A bad moment for a change that decides where the antenna points: Azel sent nothing.
    #[error("{hindrance}")]
    Hindered {
        /// Key of the field.
        #[serde(deserialize_with = "name::one")]
        field: Name,
        hindrance: Hindrance,
    },
    /// A group that Azel could not read before the change.
    #[error("the present values cannot be read: {0}")]
    Unread(ReadFailure),
    /// A group that someone else has changed in the meantime: Azel sent nothing.
    #[error("the values on the unit have changed meanwhile")]
    ChangedMeanwhile,
    /// A value that cannot be sent: Azel sent nothing.
    #[error("{field} {reason}")]
    CannotBeSent {
        /// Key of the field.
        #[serde(deserialize_with = "name::one")]
        field: Name,
        reason: Unfit,
    },
    /// A refusal of the unit. The text is its answer.
    #[error("the unit answered {0}")]
    Refused(String),
    /// A missing answer; the read-back shows the old values.
    #[error("the unit did not answer and kept its values")]
    Unanswered,
    /// A missing read-back after the unit accepted the change or did not answer.
    #[error("it could not be read back: {0}")]
    NotReadBack(ReadFailure),
    /// A read-back that differs in these fields.
    #[error("the unit holds other values after it said OK")]
    Differs(#[serde(deserialize_with = "name::list")] Vec<Name>),
    /// Values that the unit holds but cannot use.
    #[error("{0}")]
    Useless(String),
}
