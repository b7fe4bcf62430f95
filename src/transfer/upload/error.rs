//! Where an upload stands, and where it may end.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::transfer::{FolderError, KeptError};

/// A step of an upload, in order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum UploadStep {
    /// Reads what is on the unit now.
    ReadOld,
    /// Keeps it on this computer.
    KeepOld,
    /// Writes the new file beside the old one.
    Write,
    /// Reads the new file again and compares.
    Compare,
    /// Puts the new file in the place of the old one. Cannot be cancelled from
    /// here on.
    Replace,
    /// Reads it in its place and compares.
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

/// How far an upload is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Progress {
    /// What is done now.
    pub step: UploadStep,
    /// Bytes of the file that are done in this step.
    pub done_bytes: u64,
    /// Bytes of the new file; what is on the unit may have more or fewer.
    pub file_bytes: u64,
}

/// Why an upload ended early.
#[derive(Debug, thiserror::Error)]
pub enum UploadReason {
    /// The operator wanted it.
    #[error("cancelled")]
    Cancelled,
    /// The unit or the link.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// The old file could not be kept on this computer.
    #[error(transparent)]
    Keep(#[from] KeptError),
    /// What was read back is something else.
    #[error("what is there is not what was sent; try again, and check the disk of the unit")]
    Differs,
}

/// What is on the unit after an upload that failed. The old elements are never
/// lost: they are on the unit as said here and, from [`UploadStep::Write`] on,
/// kept on this computer too.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FolderState {
    /// All is as it was.
    AsBefore,
    /// The old file is as it was; part of the new one may lie beside it, and the
    /// next upload removes it.
    Leftover {
        /// The name of the part.
        name: String,
    },
    /// Either the old file or the whole new one is in its place.
    OldOrNew,
    /// The old file is whole under another name, and the new one may be in its
    /// place. The next upload puts the old one back first where it is missing.
    OldAside {
        /// The other name.
        name: String,
    },
    /// The new file took its place after it had been compared; it was not
    /// proved there, or another file was found.
    NewUnproved,
}

impl fmt::Display for FolderState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::AsBefore => f.write_str("the unit has its old file, nothing was changed"),
            Self::Leftover { name } => {
                write!(f, "the unit has its old file; {name} may be left beside it")
            }
            Self::OldOrNew => f.write_str("the unit has the old or the new file, whole"),
            Self::OldAside { name } => {
                write!(
                    f,
                    "the old file is whole on the unit, maybe as {name}; upload again to mend it"
                )
            }
            Self::NewUnproved => f.write_str(
                "the new file is in its place but not proved; upload again or roll back",
            ),
        }
    }
}

/// An upload that did not end in proof.
#[derive(Debug, thiserror::Error)]
#[error("the upload failed while {step}: {reason} ({state})")]
pub struct UploadError {
    /// What was being done.
    pub step: UploadStep,
    /// Why it ended.
    pub reason: UploadReason,
    /// What is on the unit now.
    pub state: FolderState,
}
