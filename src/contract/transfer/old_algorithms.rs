//! Old algorithms of SSH.

use serde::{Deserialize, Serialize};

/// An outdated algorithm that a connection uses because the host offers nothing better.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct OldAlgorithm {
    pub part: AlgorithmPart,
    /// Name in the protocol, such as `diffie-hellman-group14-sha1`.
    pub name: String,
}

/// The part of a connection that an algorithm protects.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AlgorithmPart {
    KeyExchange,
    HostKey,
    Cipher,
    /// Message authentication code.
    Mac,
}
