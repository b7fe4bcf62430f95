//! The holder of a station file or of a unit.

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
    /// Socket on which it takes STOP.
    pub socket: Option<PathBuf>,
    /// Its name of the antenna, where it holds a unit.
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

/// Why something is not claimed here.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum HeldBy {
    /// Another Azel of this machine holds it; `None` where it does not say who it is.
    Azel(Option<Holder>),
    /// No lock can be made, for this reason, so nobody knows whether another program has it.
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
