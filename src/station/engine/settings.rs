//! Settings that start a station.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use tokio::sync::mpsc;

use super::{claim::LockFolders, sources::Places, uploads};
use crate::{contract::claim::HolderKind, orbit::Catalog, record::PassNote, station};

/// Places of a station's files and its role among the Azels of this machine.
#[derive(Debug, Clone, Default)]
pub struct Settings {
    /// Path of the station file; `None` for the user's own.
    pub path: Option<PathBuf>,
    /// Folder for elements from servers; `None` for the user's own.
    pub library: Option<PathBuf>,
    /// Places of host keys, old uploads and secrets; `None` for the user's own.
    pub upload_places: Option<uploads::Places>,
    /// Program to start as the dead-man; `None` for none.
    pub dead_man: Option<PathBuf>,
    /// Folder for marks of motions by hand; `None` for none.
    pub marks: Option<PathBuf>,
    /// Folder for the records of stations; `None` to record nothing.
    pub records: Option<PathBuf>,
    /// Elements that replace the sources' elements; Azel then reads no source.
    pub elements: Option<Arc<Catalog>>,
    /// Channel for reports of passes, besides the record.
    pub reports: Option<mpsc::Sender<PassNote>>,
    /// Folders for claims of the station and its units, and the role of this process; `None`
    /// to ignore other Azels.
    pub claims: Option<(LockFolders, HolderKind)>,
}

impl Settings {
    /// Returns the path of the station file, if this user has a place for one.
    pub fn station_path(&self) -> Option<PathBuf> {
        self.path.clone().or_else(station::settings_path)
    }

    /// Returns the folder for elements from servers, if this user has a place for it.
    pub fn library_path(&self) -> Option<PathBuf> {
        let station = self.station_path();
        let places = Places::new(station.as_deref(), self.library.clone());
        places.library().map(Path::to_path_buf)
    }
}
