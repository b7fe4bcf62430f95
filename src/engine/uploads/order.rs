//! What the operator wants on a unit.

use std::path::PathBuf;

use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error as _};

use crate::engine::written;
use crate::{
    device::ElementFiles,
    transfer::{Account, FileName, KeptFile, Peer, TleFile},
};

/// A file of elements for a unit, and the way there.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self")]
pub struct Order {
    /// Name of the antenna whose unit it is.
    pub antenna: String,
    /// How the unit takes files.
    #[serde(with = "written::element_files")]
    pub takes: &'static ElementFiles,
    /// Where the unit's files are served.
    pub unit: Peer,
    /// The folder of elements there.
    pub folder: String,
    /// The file in it.
    pub file: FileName,
    /// Who logs in.
    pub user: String,
    /// Logs in with this private key; `None` for a password.
    pub key_file: Option<PathBuf>,
    /// What is to be in the file.
    pub cargo: Cargo,
    /// The satellite that the unit is to follow; `None` for the one that it
    /// holds, or the first of the file.
    pub satellite: Option<u32>,
}

/// What is to be in a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Cargo {
    /// These elements.
    New(TleFile),
    /// What was there before.
    Kept(KeptFile),
}

impl Serialize for Order {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        Self::serialize(self, to)
    }
}

/// Refuses a file that would not be in its folder.
impl<'de> Deserialize<'de> for Order {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let order = Self::deserialize(from)?;
        FileName::new(order.file.as_str(), order.takes).map_err(D::Error::custom)?;
        Ok(order)
    }
}

impl Order {
    /// Under which the password or passphrase is kept.
    pub fn account(&self) -> Account {
        let user = self
            .key_file
            .as_ref()
            .map_or_else(|| self.user.clone(), |path| path.display().to_string());
        Account { user, address: self.unit.to_string() }
    }
}
