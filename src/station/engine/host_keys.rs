//! Host keys that need a decision of the operator, and the decision itself.

use std::io;

use serde::{Deserialize, Serialize};

use crate::{
    contract::transfer::Peer,
    job::{Job, Wake},
    transfer::{ConnectError, KnownHosts, OfferedKey},
};

/// A host key that is not the known one, or the key of an unknown host.
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
    /// Returns `true` if the host has another key than before, which is refused.
    pub fn is_changed(&self) -> bool {
        !self.pinned.is_empty()
    }

    pub(super) fn of(offered: &OfferedKey, pinned: Vec<String>) -> Self {
        Self {
            address: offered.address(),
            algorithm: offered.algorithm(),
            fingerprint: offered.fingerprint(),
            pinned,
        }
    }
}

/// The key behind `error` if the operator can decide about it, or else the error.
pub(super) fn doubtful(
    error: ConnectError,
) -> Result<(Box<OfferedKey>, DoubtfulKey), ConnectError> {
    let (offered, pinned) = match error {
        ConnectError::UnknownHostKey(offered) => (offered, Vec::new()),
        ConnectError::HostKeyChanged { pinned, offered } => (offered, pinned),
        error => return Err(error),
    };
    let key = DoubtfulKey::of(&offered, pinned);
    Ok((offered, key))
}

/// Decision of the operator.
pub(super) enum Decision {
    /// Trust this key.
    Trust(Box<OfferedKey>),
    /// Forget all known keys of the host.
    Forget(Peer),
}

/// Starts writing the decision to the file of known hosts. The job returns why that failed.
pub(super) fn decide(
    known: &KnownHosts,
    decision: Decision,
    wake: Wake,
) -> io::Result<Job<Result<(), String>>> {
    let known = known.clone();
    Job::start("azel-known-hosts", wake, move |_| {
        let done = match &decision {
            Decision::Trust(offered) => known.pin(offered),
            Decision::Forget(peer) => known.forget(&peer.host, peer.port),
        };
        done.map_err(|error| error.to_string())
    })
}
