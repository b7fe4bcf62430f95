//! The stations that the window can change to, and the current change.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

/// A station that the window has opened before.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct KnownStation {
    pub name: String,
    /// File of the station.
    pub path: PathBuf,
}

/// A station to change to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum NextStation {
    /// The demo station.
    Demo,
    /// A new station; the operator sets it up next to the demo station.
    New,
    File(PathBuf),
}

/// The stations of the station menu.
#[derive(Debug, Clone, Default)]
pub struct Stations {
    /// Known stations, the last used first.
    pub stations: Vec<KnownStation>,
    /// File of the current station. For the demo station, the file of the station that it may
    /// become.
    pub open: Option<PathBuf>,
    /// Name of the station that the operator has to confirm, or that the window changes to.
    pub next: Option<String>,
    /// `true` while the current station ends and the next one begins.
    pub is_changing: bool,
    /// Reason why Azel did not open the last chosen station.
    pub refused: Option<String>,
}

impl Stations {
    /// Returns the menu text for a known station. The file name distinguishes stations of the same
    /// name.
    pub fn label(&self, station: &KnownStation) -> String {
        let is_alone =
            self.stations.iter().filter(|known_station| known_station.name == station.name).count()
                < 2;
        match station.path.file_stem().filter(|_| !is_alone) {
            Some(file) => format!("{} ({})", station.name, file.to_string_lossy()),
            None => station.name.clone(),
        }
    }
}
