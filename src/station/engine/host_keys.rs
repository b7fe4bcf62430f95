//! Host keys that the operator must decide about, and the decision.

use crate::{
    contract::{host_keys::DoubtfulKey, transfer::Peer},
    job::{Job, Wake},
    transfer::{ConnectError, KnownHosts, OfferedKey},
};

fn doubtful_key(offered: &OfferedKey, pinned: Vec<String>) -> DoubtfulKey {
    DoubtfulKey {
        address: offered.address(),
        algorithm: offered.algorithm(),
        fingerprint: offered.fingerprint(),
        pinned,
    }
}

/// Returns the key behind `error` if the operator can decide about it, or else the error.
pub(super) fn doubtful(
    error: ConnectError,
) -> Result<(Box<OfferedKey>, DoubtfulKey), ConnectError> {
    let (offered, pinned) = match error {
        ConnectError::UnknownHostKey(offered) => (offered, Vec::new()),
        ConnectError::HostKeyChanged { pinned, offered } => (offered, pinned),
        error => return Err(error),
    };
    let key = doubtful_key(&offered, pinned);
    Ok((offered, key))
}

/// Decision of the operator.
pub(super) enum Decision {
    /// Trust in this key.
    Trust(Box<OfferedKey>),
    /// Removal of all known keys of the host.
    Forget(Peer),
}

/// Starts writing the decision to the file of known hosts. The job's result is the reason of a
/// failure.
pub(super) fn decide(
    known_hosts: &KnownHosts,
    decision: Decision,
    wake: Wake,
) -> Job<Result<(), String>> {
    let known_hosts = known_hosts.clone();
    Job::start("azel-known-hosts", wake, move |_| {
        let done = match &decision {
            Decision::Trust(offered) => known_hosts.pin(offered),
            Decision::Forget(peer) => known_hosts.forget(&peer.host, peer.port),
        };
        done.map_err(|error| error.to_string())
    })
}
