//! Host keys that only the operator can decide about, in plain words for the
//! window, and what is done with the answer.

use std::io;

use serde::{Deserialize, Serialize};

use crate::job::Job;
use crate::{
    job::Wake,
    transfer::{ConnectError, KnownHosts, OfferedKey, Peer},
};

/// A host key that is not the known one.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct DoubtfulKey {
    /// The host as the file of known hosts names it.
    pub address: String,
    /// The kind of key, such as `ssh-ed25519`.
    pub algorithm: String,
    /// `SHA256:…`, as `ssh-keygen -l` shows it on the host.
    pub fingerprint: String,
    /// Fingerprints of the keys that it should have; empty where nothing is
    /// known of the host.
    pub pinned: Vec<String>,
}

impl DoubtfulKey {
    /// The host has another key than before, which is refused.
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

/// The key behind `error`, if it is about one that the operator can decide
/// about; or else the error.
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

/// What the operator has decided.
pub(super) enum Decision {
    /// It is the right key.
    Trust(Box<OfferedKey>),
    /// All known keys of the host are to be forgotten.
    Forget(Peer),
}

/// Writes the decision down. The result is why that failed, if it did.
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
