//! What a device holds, what it is to hold, and what came of it.

use std::{collections::BTreeMap, sync::Arc};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{Hindrance, Unfit, Values};
use crate::name::{self, Name};

/// The groups of a device by their keys, each as far as it is known.
pub type Held = BTreeMap<Name, GroupState>;

/// What is known of a group.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct GroupState {
    /// As last read.
    pub held: Option<HeldGroup>,
    /// Why the last attempt to read it failed; `None` when it did not.
    pub failure: Option<ReadFailure>,
    /// How far a change of it is; `None` while none is under way.
    pub step: Option<WriteStep>,
    /// The last change of it that is over.
    pub written: Option<Arc<Written>>,
}

/// A group as it was read.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HeldGroup {
    /// What the device said.
    #[serde(deserialize_with = "name::map")]
    pub values: Values,
    /// When it said so.
    pub read_at: Timestamp,
}

/// Why a group could not be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error, Serialize, Deserialize)]
pub enum ReadFailure {
    /// The device does not know the question. Its code stands as it came.
    #[error("the unit answered ERR,{0}")]
    Refused(String),
    /// No answer, or none that can be read.
    #[error("the unit did not answer")]
    Unanswered,
}

/// How far a change is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum WriteStep {
    /// Others come first.
    Waiting,
    /// It is read whether the device still holds what the operator saw.
    Looking,
    /// It was sent.
    Sending,
    /// It is read back.
    ReadingBack,
}

/// What a group of a device is to hold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Change {
    /// Told again with the outcome.
    pub ticket: u64,
    /// Key of the group.
    #[serde(deserialize_with = "name::one")]
    pub group: Name,
    /// The new values; what is not among them stays.
    #[serde(deserialize_with = "name::map")]
    pub values: Values,
    /// What the operator saw on the device. When it holds something else by
    /// then, nothing is sent. `None` for whatever it holds.
    #[serde(deserialize_with = "name::option_map")]
    pub seen: Option<Values>,
    /// The operator has unlocked the service functions.
    pub is_unlocked: bool,
}

/// A change that is over.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Written {
    /// What was asked for.
    pub change: Change,
    /// When it was over.
    pub at: Timestamp,
    /// Read back and found right; or why not.
    pub result: Result<(), WriteError>,
}

/// Why a device does not hold what it was to hold, or is not known to.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize, Deserialize)]
pub enum WriteError {
    /// There is no link.
    #[error("there is no link to the unit")]
    NoLink,
    /// The link went while the change was under way.
    #[error("the link was lost before it was read back")]
    LinkLost,
    /// No such group, or nothing in it can be set.
    #[error("the unit has no such setting")]
    NoSuchSetting,
    /// A service function that is not unlocked.
    #[error("service functions are locked")]
    Locked,
    /// The unit is locked out for maintenance. Nothing was sent.
    #[error("the unit is locked out for maintenance")]
    LockedOut,
    /// Not while the antenna moves.
    #[error("the antenna moves")]
    Moving,
    /// A setting that decides where the antenna points, at a bad time. Nothing
    /// was sent.
    #[error("{hindrance}")]
    Hindered {
        /// Key of its field.
        #[serde(deserialize_with = "name::one")]
        field: Name,
        /// Why not now.
        hindrance: Hindrance,
    },
    /// The group could not be read before.
    #[error("the present values cannot be read: {0}")]
    Unread(ReadFailure),
    /// Someone else has changed the group meanwhile. Nothing was sent.
    #[error("the values on the unit have changed meanwhile")]
    ChangedMeanwhile,
    /// A value that cannot be sent. Nothing was sent.
    #[error("{field} {reason}")]
    CannotBeSent {
        /// Key of its field.
        #[serde(deserialize_with = "name::one")]
        field: Name,
        /// Why not.
        reason: Unfit,
    },
    /// The device said no. Its code stands as it came.
    #[error("the unit answered ERR,{0}")]
    Refused(String),
    /// No answer, and the read-back shows the old values.
    #[error("the unit did not answer and kept its values")]
    Unanswered,
    /// It was accepted or not answered, and could not be read back.
    #[error("it could not be read back: {0}")]
    NotReadBack(ReadFailure),
    /// The read-back differs in these fields.
    #[error("the unit holds other values after it said OK")]
    Differs(#[serde(deserialize_with = "name::list")] Vec<Name>),
    /// The device holds the values and cannot work with them.
    #[error("{0}")]
    Useless(String),
}
