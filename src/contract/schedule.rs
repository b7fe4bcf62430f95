//! The schedule, as a station shows it.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    passes::PassListKey,
    plan::schedule::{Change, Schedule},
};

/// The schedule with its revision.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Planned {
    pub schedule: Schedule,
    /// Changes with every new schedule.
    pub revision: u64,
    /// `None` before the first.
    pub made_at: Option<Timestamp>,
    /// End of what was planned.
    #[serde(rename = "until")]
    pub end: Option<Timestamp>,
    /// Changes that the last new schedule made.
    pub changes: Vec<Change>,
}

/// Cost of taking a pass that the schedule leaves out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Swap {
    pub pass: PassListKey,
    /// Revision of the schedule that it was worked out against.
    pub revision: u64,
    /// Changes of the schedule that follow; `None` where the pass cannot be taken at all.
    pub changes: Option<Vec<Change>>,
}
