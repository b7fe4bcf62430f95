//! Uploads of element files to units. The displayed state contains no secret.

mod choice;
mod order;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    host_keys::DoubtfulKey,
    secret::Secret,
    transfer::{FileObject, KeptFile, OldAlgorithm, Progress, Uploaded},
};
pub use choice::{Chosen, ChosenObject};
pub use order::{Cargo, Order};

/// Displayed state of uploads.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Uploads {
    /// Name of the antenna of the last order.
    pub antenna: String,
    /// The last order puts an earlier file back.
    pub is_roll_back: bool,
    pub stage: Stage,
    /// Further messages to the operator.
    pub warnings: Vec<Warning>,
    /// Files that the operator can put back.
    #[serde(rename = "kept")]
    pub kept_files: KeptFiles,
}

/// Progress of an order, from the start to its outcome.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub enum Stage {
    /// No order.
    #[default]
    Idle,
    /// The unit tracks or may begin to track: the operator must agree.
    AsksAboutTracking(Busy),
    /// The upload is under way.
    Working {
        /// `None` until the unit has accepted the log-in.
        progress: Option<Progress>,
        /// The operator has cancelled the order.
        is_cancelled: bool,
    },
    /// The operator must decide about the host's key, seen for the first time.
    AsksAboutHostKey(DoubtfulKey),
    /// The operator must type a password or a passphrase.
    AsksForSecret(SecretWanted),
    /// The file is on the unit, and Azel is setting the unit to use it.
    Selecting(Box<Uploaded>),
    /// The unit uses the file.
    Proved(Box<Proved>),
    /// The order failed or was cancelled.
    Failed(Failure),
}

impl Stage {
    /// Returns `true` while an order is under way or waits for an answer.
    pub fn is_open(&self) -> bool {
        !matches!(self, Self::Idle | Self::Proved(_) | Self::Failed(_))
    }

    /// Returns `true` if a cancellation would still take effect.
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

/// A secret that the operator must type.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SecretWanted {
    /// User name, or path of a key file.
    pub user: String,
    /// Address of the unit.
    pub address: String,
    /// Azel needs a passphrase of a key file, not a password.
    pub is_passphrase: bool,
    /// Reason why the previous secret was refused.
    pub refused: Option<String>,
    /// Reason why the keyring cannot store the secret.
    pub keyring_problem: Option<String>,
}

/// A file on a unit, and the unit's report that it uses the file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Proved {
    pub uploaded: Uploaded,
    /// Satellite that the unit found in the file.
    pub satellite: FileObject,
    /// Time of the unit's report.
    #[serde(rename = "at")]
    pub time: Timestamp,
}

/// End of an order that failed or was cancelled.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Failure {
    /// Reason, and the state of the unit.
    pub text: String,
    /// The operator has cancelled the order.
    pub is_cancel: bool,
    /// File, if it reached the unit nevertheless.
    pub uploaded: Option<Box<Uploaded>>,
    /// The host key that was refused.
    pub changed_key: Option<DoubtfulKey>,
}

/// A message beside the outcome of an order.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Warning {
    /// The password is the factory password of every such unit.
    FactoryPassword,
    /// The secret was not stored, for this reason.
    NotKept(String),
    /// The connection used these algorithms, because the host offers nothing better.
    OldAlgorithms(Vec<OldAlgorithm>),
}

/// Files that the operator can put back on a unit.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct KeptFiles {
    /// Host and port of the unit, and the name of the file there.
    #[serde(rename = "of")]
    pub origin: (String, String),
    /// Files, newest first, or the reason why there is no list; `None` while Azel reads the list.
    pub list: Option<Result<Vec<KeptEntry>, String>>,
}

/// A file that the operator can put back.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KeptEntry {
    /// File, with its time.
    pub file: KeptFile,
    /// Objects in the file, or the reason why it cannot be read.
    pub objects: Result<Vec<FileObject>, String>,
}

/// Request of a view.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Ask {
    /// Start of this order. Azel ignores it while another order is open.
    Begin(Box<Order>),
    /// Agreement that the unit's tracking may end.
    AgreeToTracking,
    /// Confirmation that the shown key is right.
    TrustHostKey,
    /// Deletion of the known keys of the host that was refused.
    ForgetHostKey,
    /// Secret for the log-in.
    Secret {
        secret: Secret,
        /// Azel stores the secret in the keyring of the operating system.
        keep: bool,
    },
    /// Cancellation of the current work, or the answer no to a question.
    Cancel,
    /// Confirmation that the operator has read the outcome of the last order.
    Dismiss,
    /// Request for the files that can be put back.
    ListKept {
        /// Host and port of the unit.
        unit: String,
        /// Name of the file on the unit.
        file: String,
    },
}

/// Reason why the operator must agree before Azel sets a unit to use a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Busy {
    /// The unit tracks; Azel will stop the track.
    Tracks,
    /// Auto-track is on, so the unit may begin to track. Azel will switch it off.
    MayTrack,
}
