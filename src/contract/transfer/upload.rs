//! Steps of an upload, and its proof.

use std::fmt;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    astro::time,
    transfer::{FileHash, FileName, FileObject, Peer},
};

/// Step of an upload, in order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum UploadStep {
    /// Read the present file on the unit.
    ReadOld,
    /// Keep it on this computer.
    KeepOld,
    /// Write the new file beside the old one.
    Write,
    /// Read the new file again and compare.
    Compare,
    /// Put the new file in the place of the old one. From here on there is no cancelling.
    Replace,
    /// Read the new file in its place and compare.
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
    /// Bytes finished in this step.
    pub done_bytes: u64,
    /// Size of the new file; the present file on the unit may be larger or smaller.
    pub file_bytes: u64,
}

/// Proof that a file is on a unit: it was read back in its place.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Uploaded {
    pub unit: Peer,
    /// Name of the file on the unit.
    pub file: FileName,
    pub bytes: u64,
    pub sha256: FileHash,
    /// Time of reading back.
    #[serde(rename = "at")]
    pub time: Timestamp,
    /// Objects in the order of the file.
    pub objects: Vec<FileObject>,
}

impl Uploaded {
    /// Age of the oldest elements in the file at `now`, seconds.
    pub fn oldest_age_s(&self, now: Timestamp) -> Option<f64> {
        let oldest = self.objects.iter().map(|object| object.epoch).min()?;
        Some(time::seconds_between(oldest, now))
    }
}
