//! Rules that keep a unit fit between passes.

use std::path::PathBuf;

use serde::Serialize;

use super::is_default;

/// What Azel does to a unit between passes while automatic operation is on. Off by default.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Upkeep {
    /// Sets the unit's clock when it is off by more than the limit.
    #[serde(skip_serializing_if = "is_default")]
    pub sets_clock: bool,
    /// Error of the unit's clock from which it is set, seconds, 2 to 60.
    pub clock_limit_s: f64,
    /// Uploads newer elements when the unit's are older than the limit.
    #[serde(skip_serializing_if = "is_default")]
    pub uploads_elements: bool,
    /// Age of the unit's elements from which newer ones are uploaded, days, 0.1 to 1000.
    pub element_limit_d: f64,
    /// Where the last verified upload went; `None` before the first.
    #[serde(rename = "upload", skip_serializing_if = "Option::is_none")]
    pub way: Option<UploadWay>,
}

/// Where a unit takes its element file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct UploadWay {
    pub host: String,
    pub port: u16,
    /// Folder on the unit.
    pub folder: String,
    /// Name of the file in the folder.
    pub file: String,
    pub user: String,
    /// Private key for the log-in; `None` for the password in the keyring.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub key_file: Option<PathBuf>,
}

impl Default for Upkeep {
    fn default() -> Self {
        Self {
            sets_clock: false,
            clock_limit_s: 5.0,
            uploads_elements: false,
            element_limit_d: 2.0,
            way: None,
        }
    }
}
