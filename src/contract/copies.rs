//! Copies of the settings of units.

use std::path::PathBuf;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::device::settings::SettingsCopy;

/// State of the copies of units' settings.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Copies {
    /// Outcome of the last save.
    pub saved: Option<Saving>,
    /// Copy that is compared with an antenna; `None` without a comparison.
    pub open: Option<OpenCopy>,
}

/// Outcome of a save.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Saving {
    /// Name of the antenna.
    pub antenna: String,
    #[serde(rename = "at")]
    pub time: Timestamp,
    /// Path of the copy, or the error text.
    pub result: Result<PathBuf, String>,
}

/// A comparison of a copy with an antenna.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OpenCopy {
    /// Name of the antenna.
    pub antenna: String,
    /// Copies of this antenna, newest first.
    pub listed: Vec<PathBuf>,
    /// Copy that was read, with its path, or the error text.
    pub read: Option<(PathBuf, Result<SettingsCopy, String>)>,
}
