//! State of a file on a unit.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::transfer::FileHash;

/// State of a file on a unit at one time.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct KeptFile {
    /// Host and port of the unit.
    pub unit: String,
    /// Name of the file on the unit.
    pub file: String,
    /// Hash of the whole file.
    pub sha256: FileHash,
    /// Size of the whole file, bytes.
    pub bytes: u64,
    /// Time at which Azel sent the file or read it on the unit.
    #[serde(rename = "at")]
    pub time: Timestamp,
    pub origin: Origin,
}

/// Origin of a file on a unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Origin {
    /// The file existed before this program replaced it.
    Found,
    /// This program sent it.
    Uploaded,
}
