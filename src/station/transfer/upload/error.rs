//! Steps of an upload, and its possible failures.

use std::fmt;

use crate::{
    contract::transfer::UploadStep,
    transfer::{FolderError, KeptError},
};

/// Reason why an upload ended early.
#[derive(Debug, thiserror::Error)]
pub enum UploadReason {
    #[error("cancelled")]
    Cancelled,
    /// Failure of the unit or the link.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// The old file could not be stored on this computer.
    #[error(transparent)]
    Keep(#[from] KeptError),
    /// The file read back differs from the new one.
    #[error("what is there is not what was sent; try again, and check the disk of the unit")]
    Differs,
}

/// State of the unit's folder after a failed upload. The old elements are never lost. This state
/// says where they are on the unit; from [`UploadStep::Write`] on, this computer also has them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FolderState {
    AsBefore,
    /// The old file is unchanged. Part of the new file may be beside it; the next upload removes
    /// this part.
    Leftover {
        /// Name of the partial file.
        name: String,
    },
    /// Either the old file or the complete new one is in its place.
    OldOrNew,
    /// The old file is complete under another name, and the new file may be in its place. If the
    /// place is empty, the next upload first restores the old file.
    OldAside {
        name: String,
    },
    /// The new file took its place after the comparison, but it was not proved in that place, or
    /// another file was found.
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
                    "the old file is whole on the unit, maybe as {name}; upload again to repair it"
                )
            }
            Self::NewUnproved => f.write_str(
                "the new file is in its place but not verified; upload again or roll back",
            ),
        }
    }
}

/// Upload that ended without proof.
#[derive(Debug, thiserror::Error)]
#[error("the upload failed while {step}: {reason} ({state})")]
pub struct UploadError {
    /// Step that failed.
    pub step: UploadStep,
    pub reason: UploadReason,
    /// Current state of the unit.
    pub state: FolderState,
}
