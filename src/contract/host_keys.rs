//! Host keys that need a decision of the operator.

use serde::{Deserialize, Serialize};

/// A host key that differs from the known keys, or the key of an unknown host.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct DoubtfulKey {
    /// Host as named in the file of known hosts.
    pub address: String,
    /// Kind of key, such as `ssh-ed25519`.
    pub algorithm: String,
    /// `SHA256:…`, as `ssh-keygen -l` shows it on the host.
    pub fingerprint: String,
    /// Fingerprints of the expected keys; empty for an unknown host.
    pub pinned: Vec<String>,
}

impl DoubtfulKey {
    /// Returns `true` if the key differs from the known keys of the host. Azel refuses such a key.
    pub fn is_changed(&self) -> bool {
        !self.pinned.is_empty()
    }
}
