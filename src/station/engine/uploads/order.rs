//! Order of the operator for a unit.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::{
    contract::{transfer::Peer, uploads::Order},
    transfer::Account,
};

/// Destination of an upload.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::engine) struct UploadTarget {
    pub(in crate::engine) unit: Peer,
    /// Folder on the unit.
    pub(in crate::engine) folder: String,
    /// Name of the file in the folder.
    pub(in crate::engine) file: String,
    pub(in crate::engine) user: String,
    /// Private key for the log-in; `None` for a password.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::engine) key_file: Option<PathBuf>,
}

/// Returns the destination of the next upload to this unit.
pub(in crate::engine) fn target(order: &Order) -> UploadTarget {
    UploadTarget {
        unit: order.unit.clone(),
        folder: order.folder.clone(),
        file: order.file.as_str().to_owned(),
        user: order.user.clone(),
        key_file: order.key_file.clone(),
    }
}

/// Returns the account that stores the password or passphrase.
pub(super) fn account(order: &Order) -> Account {
    let key_file = order.key_file.as_ref();
    let user = key_file.map_or_else(|| order.user.clone(), |path| path.display().to_string());
    Account { user, address: order.unit.to_string() }
}
