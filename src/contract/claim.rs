//! Holder of a station file or of a unit.

use std::path::PathBuf;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

/// The process that holds a claim.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Holder {
    pub kind: HolderKind,
    /// Process id.
    pub process: u32,
    #[serde(rename = "since")]
    pub start: Timestamp,
    /// Socket on which the process accepts STOP.
    pub socket: Option<PathBuf>,
    /// Holder's name for the antenna, if the claim is for a unit.
    pub antenna: Option<String>,
}

/// Kind of Azel that holds a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum HolderKind {
    /// An Azel with a window.
    #[default]
    Window,
    /// `azel serve`.
    Serve,
}

/// Reason why this Azel does not hold a claim.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum HeldBy {
    /// Another Azel on this machine holds the claim; `None` if it does not identify itself.
    Azel(Option<Holder>),
    /// Azel cannot lock the claim, for this reason, so another program may hold it.
    Unknown(String),
}

impl std::fmt::Display for HeldBy {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let holder = match self {
            Self::Azel(holder) => holder,
            Self::Unknown(reason) => {
                return write!(f, "perhaps another program (Azel could not lock it: {reason})");
            }
        };
        let Some(Holder { kind, process, start, .. }) = holder else {
            return write!(f, "another Azel");
        };
        let kind = match kind {
            HolderKind::Window => "another window of Azel",
            HolderKind::Serve => "azel serve",
        };
        write!(f, "{kind} (process {process}, since {})", start.strftime("%F %H:%MZ"))
    }
}
