//! A server of files.

use std::fmt;

use serde::{Deserialize, Serialize};

#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Peer {
    /// Name or IP address.
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

/// Protocol of a file server.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum FileProtocol {
    /// Plain FTP: password and file can be read on the way.
    Ftp,
    /// With TLS from the first command on (`AUTH TLS`, RFC 4217).
    FtpTls,
    /// Over SSH.
    Sftp,
}

impl FileProtocol {
    /// Protocol that a unit most likely uses on `port`. The unit's setting is a port without a
    /// protocol, and the example of its document has 22.
    pub fn of_port(port: u16) -> Self {
        if port == 22 { Self::Sftp } else { Self::Ftp }
    }
}
