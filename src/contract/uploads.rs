//! Uploads of element files to units. No secret is in the displayed state.

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
    /// The last order puts back an earlier file.
    pub is_roll_back: bool,
    pub stage: Stage,
    /// Further messages to the operator.
    pub warnings: Vec<Warning>,
    /// Files that can be put back.
    #[serde(rename = "kept")]
    pub kept_files: KeptFiles,
}

/// Stage of an order.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub enum Stage {
    /// No order.
    #[default]
    Idle,
    /// The unit tracks, or may begin to: the operator must agree.
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
    /// The file is on the unit, and the unit is being set to use it.
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

    /// Returns `true` if a cancel would still take effect.
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
    /// The user, or the path of a key file.
    pub user: String,
    /// Address of the unit.
    pub address: String,
    /// A passphrase of a key file is wanted, not a password.
    pub is_passphrase: bool,
    /// Why the last secret was refused.
    pub refused: Option<String>,
    /// Why the secret cannot be kept in the keyring.
    pub keyring_problem: Option<String>,
}

/// A file on a unit, and the unit's report that it uses it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Proved {
    pub uploaded: Uploaded,
    /// The satellite that the unit found in it.
    pub satellite: FileObject,
    /// Time of the unit's report.
    #[serde(rename = "at")]
    pub time: Timestamp,
}

/// End of an order that failed or was cancelled.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Failure {
    /// The reason, and the state of the unit.
    pub text: String,
    /// The operator has cancelled the order.
    pub is_cancel: bool,
    /// The file, where it is on the unit nevertheless.
    pub uploaded: Option<Box<Uploaded>>,
    /// The host key that was refused.
    pub changed_key: Option<DoubtfulKey>,
}

/// A message beside the outcome of an order.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Warning {
    /// The password is the one that the maker sets in every unit.
    FactoryPassword,
    /// The secret was not kept, for this reason.
    NotKept(String),
    /// The connection used these algorithms, because the host offers nothing better.
    OldAlgorithms(Vec<OldAlgorithm>),
}

/// The files that can be put back on a unit.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct KeptFiles {
    /// Host and port of the unit, and the name of the file there.
    #[serde(rename = "of")]
    pub origin: (String, String),
    /// Newest first, or why there is no list; `None` while it is read.
    pub list: Option<Result<Vec<KeptEntry>, String>>,
}

/// A file that can be put back.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KeptEntry {
    /// File and time.
    pub file: KeptFile,
    /// Objects in the file, or why it cannot be read.
    pub objects: Result<Vec<FileObject>, String>,
}

/// A request of a view.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Ask {
    /// Carry out this order. Ignored while another order is open.
    Begin(Box<Order>),
    /// The unit's tracking may end.
    AgreeToTracking,
    /// The shown key is the right one.
    TrustHostKey,
    /// Forget the known keys of the host that was refused.
    ForgetHostKey,
    /// Go on with this secret.
    Secret {
        secret: Secret,
        /// Keep it in the keyring of the operating system.
        keep: bool,
    },
    /// Cancel the work under way, or answer a question with no.
    Cancel,
    /// The operator has read the outcome of the last order.
    Dismiss,
    /// List the files that can be put back.
    ListKept {
        /// Host and port of the unit.
        unit: String,
        /// Name of the file on the unit.
        file: String,
    },
}

/// Why the operator must agree before a unit is set to use a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Busy {
    /// The unit tracks; the track will be stopped.
    Tracks,
    /// Auto-track is on: the unit may begin to track. It will be switched off.
    MayTrack,
}
