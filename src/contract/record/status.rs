//! State of a record.

use std::path::PathBuf;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

/// State of a record.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Status {
    pub path: PathBuf,
    /// Size on disk when it was last looked at, bytes.
    pub bytes: u64,
    /// Nothing is written at present.
    pub failing: Option<Failing>,
    /// When somebody was last found to have removed the file while it was open, or put another one in
    /// its place.
    #[serde(default)]
    pub removed: Option<Timestamp>,
}

/// Why nothing is written.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Failing {
    /// When something was written last.
    #[serde(rename = "since")]
    pub last_write: Timestamp,
    #[serde(rename = "why")]
    pub reason: String,
    /// Entries that wait.
    pub waiting: u64,
}
