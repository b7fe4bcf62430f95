//! The stations that the window can change to, and the change under way.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

/// A station that was open in the window before.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct KnownStation {
    pub name: String,
    /// Its file.
    pub path: PathBuf,
}

/// A station to change to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum NextStation {
    /// The demo station.
    Demo,
    /// A new one: the set-up beside the demo station.
    New,
    File(PathBuf),
}

/// The stations of the station menu.
#[derive(Debug, Clone, Default)]
pub struct Stations {
    /// The last used first.
    pub stations: Vec<KnownStation>,
    /// File of the station in the window; for the demo station that of the station it may become.
    pub open: Option<PathBuf>,
    /// The station that the operator is asked about, or that the window changes to.
    pub next: Option<String>,
    /// The station in the window ends, and the next one begins.
    pub is_changing: bool,
    /// Why the last one that was chosen was not opened.
    pub refused: Option<String>,
}

impl Stations {
    /// Returns the text of the menu for a known station. The files tell two of the same name apart.
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
