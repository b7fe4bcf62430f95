//! An order of the operator for a unit.

use std::path::PathBuf;

use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error as _};

use crate::{
    device::ElementFiles,
    transfer::{FileName, KeptFile, Peer, TleFile},
    written,
};

/// An element file for a unit, with the way to get it there.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self")]
pub struct Order {
    /// Name of the unit's antenna.
    pub antenna: String,
    /// How the unit takes files.
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
    /// Private key for the log-in; `None` for a password.
    pub key_file: Option<PathBuf>,
    /// Content of the file.
    pub cargo: Cargo,
    /// Catalog number of the satellite to track; `None` for the one that the unit holds, or
    /// the first of the file.
    pub satellite: Option<u32>,
    /// Started by a rule: the order fails instead of asking.
    #[serde(default)]
    pub is_unattended: bool,
}

/// Content of a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Cargo {
    /// New elements.
    New(TleFile),
    /// An earlier file, put back.
    Kept(KeptFile),
}

impl Serialize for Order {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Self::serialize(self, serializer)
    }
}

/// Refuses a file name that leads out of its folder.
impl<'de> Deserialize<'de> for Order {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let order = Self::deserialize(deserializer)?;
        FileName::new(order.file.as_str(), order.takes).map_err(D::Error::custom)?;
        Ok(order)
    }
}
