//! Folders of the desktop: the file manager, and the folder for documents.

use std::{
    io,
    path::{Path, PathBuf},
    process::{Command, ExitStatus, Stdio},
};

/// Reason why a folder was not opened.
#[derive(Debug, thiserror::Error)]
pub enum NotOpened {
    #[error("{PROGRAM} cannot be started: {0}")]
    NoProgram(io::Error),
    #[error("{PROGRAM} failed: {0}")]
    Failed(ExitStatus),
}

#[cfg(target_os = "macos")]
const PROGRAM: &str = "open";
#[cfg(windows)]
const PROGRAM: &str = "explorer";
#[cfg(not(any(target_os = "macos", windows)))]
const PROGRAM: &str = "xdg-open";

/// Shows `folder` in the file manager. Waits for the program of the file manager, so call it on a
/// background thread.
pub fn open(folder: &Path) -> Result<(), NotOpened> {
    open_with(PROGRAM, folder)
}

/// Returns the folder for the operator's documents, or the home folder.
pub fn documents() -> Option<PathBuf> {
    let user = directories::UserDirs::new()?;
    let documents = user.document_dir().filter(|folder| folder.is_dir());
    Some(documents.unwrap_or_else(|| user.home_dir()).to_owned())
}

fn open_with(program: &str, folder: &Path) -> Result<(), NotOpened> {
    let status = Command::new(program)
        .arg(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .map_err(NotOpened::NoProgram)?;
    // The Windows program reports a failure even on success.
    if status.success() || cfg!(windows) { Ok(()) } else { Err(NotOpened::Failed(status)) }
}

#[cfg(unix)]
#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_that_fails_or_is_not_there_is_told() {
        assert!(open_with("true", Path::new("/")).is_ok());
        assert!(matches!(open_with("false", Path::new("/")), Err(NotOpened::Failed(_))));
        let none = open_with("/no/such/program", Path::new("/"));
        assert!(matches!(none, Err(NotOpened::NoProgram(_))));
    }
}
