//! Paths that the operator enters because the desktop shows no file dialogs.

use std::path::PathBuf;

use super::export::Export;

/// A path that the operator enters for a file to save.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TypedPath {
    pub path: PathBuf,
    /// `true` if the operator agrees to replace the file at this path.
    pub replaces: bool,
}

/// A request to the operator to enter the path of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PathRequest {
    pub purpose: PathPurpose,
    /// The proposed path, or the path entered before.
    pub path: PathBuf,
    /// Reason why Azel asks for the path, or asks again.
    pub reason: String,
}

/// The purpose of an entered path.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PathPurpose {
    Save {
        export: Export,
        /// `true` if the file at the proposed path exists and would be replaced.
        replaces: bool,
    },
    Open(OpenedFile),
}

/// A file that the operator opens.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OpenedFile {
    Station,
    Elements,
}
