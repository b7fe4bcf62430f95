//! Paths that the operator types, because the desktop shows no file dialogs.

use std::path::PathBuf;

use super::export::Export;

/// A path that the operator types for a file to save.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TypedPath {
    pub path: PathBuf,
    /// The operator agrees that the file at this path is replaced.
    pub replaces: bool,
}

/// Asks the operator to type the path of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PathRequest {
    pub purpose: PathPurpose,
    /// The path that is proposed, or was typed before.
    pub path: PathBuf,
    /// Why the path is to be typed, or typed again.
    pub reason: String,
}

/// The purpose of a typed path.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PathPurpose {
    Save {
        export: Export,
        /// The file at the proposed path exists and would be replaced.
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
