//! The schedule in the snapshot of a station.

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
    /// Number that changes with every new schedule.
    pub revision: u64,
    /// Time of the computation; `None` before the first schedule.
    pub made_at: Option<Timestamp>,
    /// End of the planned time.
    #[serde(rename = "until")]
    pub end: Option<Timestamp>,
    /// Changes against the previous schedule.
    pub changes: Vec<Change>,
}

/// Cost of taking a pass that the schedule leaves out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Swap {
    pub pass: PassListKey,
    /// Revision of the schedule behind this computation.
    pub revision: u64,
    /// Resulting changes of the schedule; `None` if no antenna can take the pass at all.
    pub changes: Option<Vec<Change>>,
}
