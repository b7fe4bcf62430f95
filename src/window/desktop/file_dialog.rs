//! The file dialogs of the desktop. Each function returns once the operator has chosen, so call it
//! on a background thread.

use std::path::{Path, PathBuf};

/// Error: this computer has no program that shows file dialogs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "this desktop shows no file dialogs; the packages xdg-desktop-portal-gtk or zenity add them"
)]
pub struct NoDialog;

/// Asks for files to open; returns no files after Cancel.
pub fn files_to_open(title: &str) -> Result<Vec<PathBuf>, NoDialog> {
    let dialog = dialog(title)?;
    Ok(dialog.pick_files().unwrap_or_default())
}

/// Asks for one file to open, starting in `folder`; `None` after Cancel.
pub fn file_to_open(title: &str, folder: Option<&Path>) -> Result<Option<PathBuf>, NoDialog> {
    let dialog = dialog(title)?;
    Ok(match folder {
        Some(folder) => dialog.set_directory(folder).pick_file(),
        None => dialog.pick_file(),
    })
}

/// Asks where to save a file and proposes `name`; `None` after Cancel.
pub fn file_to_save(title: &str, name: &str) -> Result<Option<PathBuf>, NoDialog> {
    let dialog = dialog(title)?;
    Ok(dialog.set_file_name(name).save_file())
}

fn dialog(title: &str) -> Result<rfd::FileDialog, NoDialog> {
    // A dialog that fails to open would look like a cancelled one.
    if is_shown() { Ok(rfd::FileDialog::new().set_title(title)) } else { Err(NoDialog) }
}

#[cfg(not(target_os = "linux"))]
fn is_shown() -> bool {
    true
}

#[cfg(target_os = "linux")]
fn is_shown() -> bool {
    has_portal().unwrap_or(false) || has_zenity()
}

/// Returns `true` if the desktop session has file dialogs ("File Chooser" of the XDG Desktop
/// Portal).
#[cfg(target_os = "linux")]
fn has_portal() -> zbus::Result<bool> {
    let bus = zbus::blocking::Connection::session()?;
    let portal = zbus::blocking::Proxy::new(
        &bus,
        "org.freedesktop.portal.Desktop",
        "/org/freedesktop/portal/desktop",
        "org.freedesktop.portal.FileChooser",
    )?;
    Ok(portal.get_property::<u32>("version").is_ok())
}

#[cfg(target_os = "linux")]
fn has_zenity() -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).any(|folder| folder.join("zenity").is_file())
}
