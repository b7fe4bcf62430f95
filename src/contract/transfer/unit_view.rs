//! A unit's view of a file of elements.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{
    orbit::Refusal,
    transfer::{FileHash, FileObject},
};

/// A unit's view of a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct UnitView {
    pub bytes: u64,
    pub sha256: FileHash,
    /// Number of readable objects.
    pub objects: usize,
    /// Unreadable objects with the reasons; the unit may read them or fail on them.
    pub refused: Vec<Refusal>,
    /// Number of further refusals.
    pub refused_unlisted: usize,
    /// The file is TLE, the only form that units are known to read.
    pub is_tle: bool,
    /// Result of the unit's search for its satellite.
    pub satellite: SatelliteMatch,
}

/// Result of a search for a satellite by name.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum SatelliteMatch {
    Found(FileObject),
    /// Several objects have this name; the unit takes one of them.
    Several(Vec<FileObject>),
    /// No object has this name: the unit will report that it cannot find the satellite.
    Missing {
        /// Similar names in the file.
        similar: Vec<String>,
    },
}

impl UnitView {
    /// Returns the newest epoch of the objects found.
    pub fn epoch(&self) -> Option<Timestamp> {
        match &self.satellite {
            SatelliteMatch::Found(object) => Some(object.epoch),
            SatelliteMatch::Several(objects) => objects.iter().map(|object| object.epoch).max(),
            SatelliteMatch::Missing { .. } => None,
        }
    }
}
