//! Operator's order for a unit.

use std::path::PathBuf;

use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error as _};

use crate::{
    device::ElementFiles,
    transfer::{FileName, KeptFile, Peer, TleFile},
    written,
};

/// An element file for a unit, with the data for its transfer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self")]
pub struct Order {
    /// Name of the unit's antenna.
    pub antenna: String,
    /// Element files that the unit accepts.
    #[serde(with = "written::element_files")]
    pub takes: &'static ElementFiles,
    /// Server of the unit's files.
    pub unit: Peer,
    /// Folder of the element files on the unit.
    pub folder: String,
    /// Name of the file in the folder.
    pub file: FileName,
    /// User name for the log-in.
    pub user: String,
    /// Private key for the log-in; `None` for log-in by password.
    pub key_file: Option<PathBuf>,
    /// Content of the file.
    pub cargo: Cargo,
    /// Catalog number of the satellite to track; `None` for the unit's current satellite, or the
    /// first in the file.
    pub satellite: Option<u32>,
    /// A rule started the order: the order fails instead of asking the operator.
    #[serde(default)]
    pub is_unattended: bool,
}

/// Content of a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Cargo {
    /// New elements.
    New(TleFile),
    /// Earlier file that is put back.
    Kept(KeptFile),
}

impl Serialize for Order {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Self::serialize(self, serializer)
    }
}

/// Deserialisation that refuses a file name outside its folder.
impl<'de> Deserialize<'de> for Order {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let order = Self::deserialize(deserializer)?;
        FileName::new(order.file.as_str(), order.takes).map_err(D::Error::custom)?;
        Ok(order)
    }
}
