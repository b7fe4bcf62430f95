//! Files of elements for the units: one upload or roll-back at a time, from the
//! choice of satellites to the unit's own word that it has found them.
//!
//! Invariants: nothing is called proved before the file was read back in its
//! place and the unit has named the satellite out of it; what takes time runs
//! on threads of its own; no secret stands in what is shown.

mod choice;
mod desk;
mod errand;
mod flow;
mod order;
mod places;
mod select;
mod sessions;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

pub use choice::{Chosen, ChosenObject};
pub(super) use desk::{Desk, Told};
pub use order::{Cargo, Order};
pub use places::Places;
pub use select::Busy;
pub(super) use select::UnitNow;

use super::host_keys::DoubtfulKey;
use crate::secret::Secret;
use crate::transfer::{FileObject, KeptFile, Progress, Uploaded};

/// What is shown of uploads.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Uploads {
    /// Name of the antenna that the last order is for.
    pub antenna: String,
    /// The last order puts back what was there before.
    pub is_roll_back: bool,
    /// Where it stands.
    pub stage: Stage,
    /// What the operator should know besides.
    pub warnings: Vec<Warning>,
    /// What can be put back.
    pub kept: Kept,
}

/// Where an order stands.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub enum Stage {
    /// There is none.
    #[default]
    Idle,
    /// The unit tracks, or may begin to: the operator has to agree.
    AsksAboutTracking(Busy),
    /// The file is on its way.
    Working {
        /// How far it is; `None` until the unit took the log-in.
        progress: Option<Progress>,
        /// The operator does not want it any more.
        is_cancelled: bool,
    },
    /// The operator has to decide about the host's key, seen for the first time.
    AsksAboutHostKey(DoubtfulKey),
    /// The operator has to type a password or a passphrase.
    AsksForSecret(SecretWanted),
    /// The file is on the unit, which is told to use it.
    Selecting(Box<Uploaded>),
    /// The unit uses the file.
    Proved(Box<Proved>),
    /// It did not end well.
    Failed(Failure),
}

impl Stage {
    /// Something is under way, or waits for an answer.
    pub fn is_open(&self) -> bool {
        !matches!(self, Self::Idle | Self::Proved(_) | Self::Failed(_))
    }

    /// Whether a cancel would still be followed.
    pub fn can_cancel(&self) -> bool {
        use crate::transfer::UploadStep;
        match self {
            Self::Working { progress, is_cancelled } => {
                !is_cancelled && progress.is_none_or(|now| now.step < UploadStep::Replace)
            }
            _ => false,
        }
    }
}

/// What is to be typed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SecretWanted {
    /// Whose: the user, or the path of a key file.
    pub user: String,
    /// Where.
    pub address: String,
    /// The passphrase of a key file, not a password.
    pub is_passphrase: bool,
    /// Why the last one was no good.
    pub refused: Option<String>,
    /// Why it cannot be kept in the keyring.
    pub keyring_problem: Option<String>,
}

/// A file on a unit, and the unit's word that it uses it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Proved {
    /// The file.
    pub uploaded: Uploaded,
    /// The satellite that the unit found in it.
    pub satellite: FileObject,
    /// When the unit said so.
    pub at: Timestamp,
}

/// How an order ended that did not end well.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Failure {
    /// Why, and what is on the unit now.
    pub text: String,
    /// The operator wanted it.
    pub is_cancel: bool,
    /// The file that is on the unit all the same.
    pub uploaded: Option<Box<Uploaded>>,
    /// The key of the host that was refused.
    pub changed_key: Option<DoubtfulKey>,
}

/// What the operator should know besides.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Warning {
    /// The password is the one that every unit has from its maker.
    FactoryPassword,
    /// The secret was not kept, and why.
    NotKept(String),
}

/// The files that can be put back on a unit.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Kept {
    /// Host and port of the unit and name of the file that was asked about.
    pub of: (String, String),
    /// The newest first, or why there is no list; `None` while it is read.
    pub list: Option<Result<Vec<KeptEntry>, String>>,
}

/// A file that can be put back.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KeptEntry {
    /// What and when.
    pub file: KeptFile,
    /// What is in it, or why it cannot be had.
    pub objects: Result<Vec<FileObject>, String>,
}

/// What a view asks for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Ask {
    /// Carry this out. While another order is open, nothing happens.
    Begin(Box<Order>),
    /// The tracking of the unit may end.
    AgreeToTracking,
    /// The key that was shown is the right one.
    TrustHostKey,
    /// The known keys of the host that was refused are to be forgotten.
    ForgetHostKey,
    /// Go on with this secret.
    Secret {
        /// What was typed.
        secret: Secret,
        /// Keep it in the keyring of the operating system.
        keep: bool,
    },
    /// Nobody wants it any more: ends what is under way, answers a question
    /// with no.
    Cancel,
    /// What came of the last order was read.
    Dismiss,
    /// List what can be put back.
    ListKept {
        /// Host and port of the unit.
        unit: String,
        /// Name of the file there.
        file: String,
    },
}
