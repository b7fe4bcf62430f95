//! Failures to connect to another computer's files.

use std::{fmt, io, path::PathBuf};

use super::{Interruption, KnownHostsError, OfferedKey};
use crate::contract::transfer::Peer;

/// Step of connecting to another computer's files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ConnectStep {
    Connect,
    /// Negotiation of the protocol.
    Handshake,
    LogIn,
    OpenFiles,
}

impl fmt::Display for ConnectStep {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Connect => "connecting",
            Self::Handshake => "agreeing on encryption",
            Self::LogIn => "logging in",
            Self::OpenFiles => "opening the files",
        })
    }
}

/// Reason why there is no connection. Nothing was changed on the host.
#[derive(Debug, thiserror::Error)]
pub enum ConnectError {
    #[error("cannot reach it: {source}; check address, port and cable: {peer}")]
    Unreachable { source: io::Error, peer: Peer },
    /// The attempt was cancelled or timed out.
    #[error(
        "gave up while {step}: {interruption}; check that the right service listens there: {peer}"
    )]
    Interrupted { step: ConnectStep, interruption: Interruption, peer: Peer },
    /// The host speaks another protocol, or hung up.
    #[error("failed while {step}: {reason}; check that the right service listens there: {peer}")]
    Failed {
        step: ConnectStep,
        /// Reason in the protocol's words.
        reason: String,
        peer: Peer,
    },
    /// The host and Azel know no common algorithm.
    #[error(
        "the host offers only {kind} that are not known or not safe: {offered}; update its SSH server \
         or the firmware of the unit: {peer}"
    )]
    NoAgreement { kind: &'static str, offered: String, peer: Peer },
    /// Key that Azel sees for the first time: the operator must compare the fingerprint.
    #[error(
        "the host key is not known yet: {} {}; compare it with the one on the unit, then accept it: {}",
        .0.algorithm(), .0.fingerprint(), .0.address()
    )]
    UnknownHostKey(Box<OfferedKey>),
    /// Key that differs from the pinned keys; Azel refuses it.
    #[error(
        "the host key has changed: it was {}, it is {}; either the unit was replaced or someone is \
         in between; find out before forgetting the old key: {}",
        pinned.join(" or "), offered.fingerprint(), offered.address()
    )]
    HostKeyChanged {
        /// Fingerprints of the pinned keys.
        pinned: Vec<String>,
        offered: Box<OfferedKey>,
    },
    /// Key marked as stolen or withdrawn; Azel refuses it.
    #[error("the host key is marked as revoked: {}; give the unit a new one: {}", .0.fingerprint(), .0.address())]
    HostKeyRevoked(Box<OfferedKey>),
    #[error(transparent)]
    KnownHosts(#[from] KnownHostsError),
    #[error("the private key cannot be used: {problem}: {}", path.display())]
    KeyFile { problem: KeyFileProblem, path: PathBuf },
    /// Wrong password or key, or a user without the right to log in.
    #[error("log-in refused for user {user}; check user name and password or key; {hint}: {peer}")]
    LoginRefused {
        user: String,
        /// Methods that the host accepts, or other possible causes.
        hint: String,
        peer: Peer,
    },
}

/// Reason why a private key cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum KeyFileProblem {
    #[error("{0}; check the path and its permissions")]
    Disk(io::Error),
    /// Locked key without a given passphrase.
    #[error("it is locked; type its passphrase")]
    Locked,
    #[error("the passphrase does not open it; type it again")]
    WrongPassphrase,
    /// File that is not a private key of a known kind.
    #[error("it is not a private key of a kind known here; use one made by ssh-keygen")]
    Form,
}
