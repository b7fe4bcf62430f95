//! What the operator wants on a unit.

use std::path::PathBuf;

use crate::{
    device::ElementFiles,
    transfer::{Account, FileName, KeptFile, Peer, TleFile},
};

/// A file of elements for a unit, and the way there.
#[derive(Debug, Clone, PartialEq)]
pub struct Order {
    /// Name of the antenna whose unit it is.
    pub antenna: String,
    /// How the unit takes files.
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
#[derive(Debug, Clone, PartialEq)]
pub enum Cargo {
    /// These elements.
    New(TleFile),
    /// What was there before.
    Kept(KeptFile),
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
