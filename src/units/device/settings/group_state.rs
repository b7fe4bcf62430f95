//! Settings that a unit holds, changes to them, and the outcome of changes.

use std::{collections::BTreeMap, sync::Arc};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{Hindrance, Unfit, Values};
use crate::name::{self, Name};

/// Groups of a unit by key, each as far as known.
pub type GroupStates = BTreeMap<Name, GroupState>;

/// Known state of a group.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct GroupState {
    /// Values as last read.
    #[serde(rename = "held")]
    pub last_read: Option<HeldGroup>,
    /// Why the last read failed; `None` where it did not.
    pub failure: Option<ReadFailure>,
    /// Step of the change under way; `None` without one.
    pub step: Option<WriteStep>,
    /// The last finished change.
    pub written: Option<Arc<Written>>,
}

/// Values of a group as read.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HeldGroup {
    #[serde(deserialize_with = "name::map")]
    pub values: Values,
    pub read_at: Timestamp,
}

/// Why a group could not be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error, Serialize, Deserialize)]
pub enum ReadFailure {
    /// The unit does not know the question. The text is its answer.
    #[error("the unit answered {0}")]
    Refused(String),
    /// No readable answer came.
    #[error("the unit did not answer")]
    Unanswered,
}

/// Step of a change.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum WriteStep {
    /// Other changes come first.
    Waiting,
    /// The present values are read, to compare them with those that the operator saw.
    Looking,
    /// The change was sent.
    Sending,
    /// The values are read back.
    ReadingBack,
}

/// New values for a group of a unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Change {
    /// Number that is repeated with the outcome.
    pub ticket: u64,
    /// Key of the group.
    #[serde(deserialize_with = "name::one")]
    pub group: Name,
    /// New values. Fields that are absent here keep theirs.
    #[serde(deserialize_with = "name::map")]
    pub values: Values,
    /// Values that the operator saw. If the unit holds others by then, nothing is sent.
    /// `None` accepts any.
    #[serde(rename = "seen", deserialize_with = "name::option_map")]
    pub expected: Option<Values>,
    /// The operator has unlocked the service functions.
    pub is_unlocked: bool,
}

/// A finished change.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Written {
    pub change: Change,
    /// End of the change.
    #[serde(rename = "at")]
    pub time: Timestamp,
    /// `Ok` when the values were read back and found right.
    pub result: Result<(), WriteError>,
}

/// Why a change is not on the unit, or is not known to be.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize, Deserialize)]
pub enum WriteError {
    #[error("there is no link to the unit")]
    NoLink,
    #[error("the link was lost before it was read back")]
    LinkLost,
    /// The group does not exist, or a value of the change cannot be set.
    #[error("the unit has no such setting")]
    NoSuchSetting,
    #[error("service functions are locked")]
    Locked,
    /// Nothing was sent.
    #[error("the unit is locked out for maintenance")]
    LockedOut,
    #[error("the antenna moves")]
    Moving,
    /// STOP came first. Nothing was sent.
    #[error("it was stopped before it was sent")]
    Stopped,
    /// The change decides where the antenna points, and this is a bad moment. Nothing was
    /// sent.
    #[error("{hindrance}")]
    Hindered {
        /// Key of the field.
        #[serde(deserialize_with = "name::one")]
        field: Name,
        hindrance: Hindrance,
    },
    /// The group could not be read before the change.
    #[error("the present values cannot be read: {0}")]
    Unread(ReadFailure),
    /// Someone else has changed the group meanwhile. Nothing was sent.
    #[error("the values on the unit have changed meanwhile")]
    ChangedMeanwhile,
    /// A value cannot be sent. Nothing was sent.
    #[error("{field} {reason}")]
    CannotBeSent {
        /// Key of the field.
        #[serde(deserialize_with = "name::one")]
        field: Name,
        reason: Unfit,
    },
    /// The unit refused. The text is its answer.
    #[error("the unit answered {0}")]
    Refused(String),
    /// No answer came, and the read-back shows the old values.
    #[error("the unit did not answer and kept its values")]
    Unanswered,
    /// The change was accepted or not answered, and could not be read back.
    #[error("it could not be read back: {0}")]
    NotReadBack(ReadFailure),
    /// The read-back differs in these fields.
    #[error("the unit holds other values after it said OK")]
    Differs(#[serde(deserialize_with = "name::list")] Vec<Name>),
    /// The unit holds the values but cannot work with them.
    #[error("{0}")]
    Useless(String),
}
