//! Why there is no connection to another computer's files.

use std::{fmt, io, path::PathBuf};

use serde::{Deserialize, Serialize};

use super::{Interruption, KnownHostsError, OfferedKey};

/// Another computer.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Peer {
    /// Its name or IP address.
    pub host: String,
    pub port: u16,
}

impl fmt::Display for Peer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.host.contains(':') {
            write!(f, "[{}]:{}", self.host, self.port)
        } else {
            write!(f, "{}:{}", self.host, self.port)
        }
    }
}

/// A step towards another computer's files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ConnectStep {
    /// The connection itself.
    Connect,
    /// Agreeing on how to talk.
    Handshake,
    /// Saying who asks.
    LogIn,
    /// Opening the files.
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

/// Why there is no connection. Nothing was changed on the other side.
#[derive(Debug, thiserror::Error)]
pub enum ConnectError {
    /// No connection at all.
    #[error("cannot reach it: {source}; check address, port and cable: {peer}")]
    Unreachable { source: io::Error, peer: Peer },
    /// Cancelled, or no answer in time.
    #[error("gave up while {step}: {by}; check that the right service listens there: {peer}")]
    Interrupted { step: ConnectStep, by: Interruption, peer: Peer },
    /// The other side speaks something else, or hung up.
    #[error("failed while {step}: {reason}; check that the right service listens there: {peer}")]
    Failed {
        step: ConnectStep,
        /// In the words of the protocol.
        reason: String,
        peer: Peer,
    },
    /// Never seen before: the operator has to compare the fingerprint.
    #[error(
        "the host key is not known yet: {} {}; compare it with the one on the unit, then accept it: {}",
        .0.algorithm(), .0.fingerprint(), .0.address()
    )]
    UnknownHostKey(Box<OfferedKey>),
    /// Another key than before: refused.
    #[error(
        "the host key has changed: it was {}, it is {}; either the unit was replaced or someone is \
         in between; find out before forgetting the old key: {}",
        pinned.join(" or "), offered.fingerprint(), offered.address()
    )]
    HostKeyChanged {
        /// Fingerprints of the keys it should have.
        pinned: Vec<String>,
        /// What it has.
        offered: Box<OfferedKey>,
    },
    /// The key was marked as stolen or withdrawn: refused.
    #[error("the host key is marked as revoked: {}; give the unit a new one: {}", .0.fingerprint(), .0.address())]
    HostKeyRevoked(Box<OfferedKey>),
    /// The file of host keys cannot be used.
    #[error(transparent)]
    KnownHosts(#[from] KnownHostsError),
    /// The private key cannot be used.
    #[error("the private key cannot be used: {problem}: {}", path.display())]
    KeyFile { problem: KeyFileProblem, path: PathBuf },
    /// Wrong password or key, or a user that may not log in.
    #[error("log-in refused for user {user}; check user name and password or key; {hint}: {peer}")]
    LoginRefused {
        /// Who asked.
        user: String,
        /// What the host would take, or what else may be wrong.
        hint: String,
        /// Who refused.
        peer: Peer,
    },
}

/// Why a private key cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum KeyFileProblem {
    /// The operating system refused.
    #[error("{0}; check path and rights")]
    Disk(io::Error),
    /// It is locked.
    #[error("it is locked; type its passphrase")]
    Locked,
    /// The passphrase does not open it.
    #[error("the passphrase does not open it; type it again")]
    WrongPassphrase,
    /// No private key.
    #[error("it is no private key of a kind known here; use one made by ssh-keygen")]
    Form,
}
