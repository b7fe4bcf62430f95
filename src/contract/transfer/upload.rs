//! Steps and proof of an upload.

use std::fmt;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    astro::time,
    transfer::{FileHash, FileName, FileObject, Peer},
};

/// Steps of an upload, in order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum UploadStep {
    /// Reading of the current file on the unit.
    ReadOld,
    /// Storage of the current file on this computer.
    KeepOld,
    /// Writing of the new file beside the current file.
    Write,
    /// Read-back of the new file, with comparison.
    Compare,
    /// Replacement of the current file by the new file. From here on, the upload cannot be
    /// cancelled.
    Replace,
    /// Read-back of the new file in its final place, with comparison.
    Prove,
}

impl fmt::Display for UploadStep {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::ReadOld => "reading the file on the unit",
            Self::KeepOld => "keeping the file of the unit on this computer",
            Self::Write => "writing the new file beside the old one",
            Self::Compare => "comparing the new file with what was sent",
            Self::Replace => "putting the new file in its place",
            Self::Prove => "comparing the file in its place with what was sent",
        })
    }
}

/// Progress of an upload.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Progress {
    pub step: UploadStep,
    /// Bytes completed in this step.
    pub done_bytes: u64,
    /// Size of the new file, bytes; the current file on the unit may be larger or smaller.
    pub file_bytes: u64,
}

/// Proof that a file is on a unit, by a read-back in its final place.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Uploaded {
    pub unit: Peer,
    /// Name of the file on the unit.
    pub file: FileName,
    pub bytes: u64,
    pub sha256: FileHash,
    /// Time of the read-back.
    #[serde(rename = "at")]
    pub time: Timestamp,
    /// Objects in the order of the file.
    pub objects: Vec<FileObject>,
}

impl Uploaded {
    /// Returns the age of the oldest elements in the file at `now`, seconds.
    pub fn oldest_age_s(&self, now: Timestamp) -> Option<f64> {
        let oldest = self.objects.iter().map(|object| object.epoch).min()?;
        Some(time::seconds_between(oldest, now))
    }
}
