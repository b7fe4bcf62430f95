//! State of a record.

use std::path::PathBuf;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

/// File, size and failures of a record.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Status {
    pub path: PathBuf,
    /// Size on disk at the last check, bytes.
    pub bytes: u64,
    /// Failure while Azel cannot write.
    pub failing: Option<Failing>,
    /// Last time at which Azel found that the open file was removed or replaced.
    #[serde(default)]
    pub removed: Option<Timestamp>,
    /// Number of gaps in the record since the program started to write it.
    #[serde(default)]
    pub gaps: u64,
}

/// Reason why Azel cannot write.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Failing {
    #[serde(rename = "since")]
    pub last_write: Timestamp,
    #[serde(rename = "why")]
    pub reason: String,
    /// Number of waiting entries.
    pub waiting: u64,
}
