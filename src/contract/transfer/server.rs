//! File server.

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
    /// Plain FTP: others on the network can read the password and the file.
    Ftp,
    /// FTP with TLS from the first command on (`AUTH TLS`, RFC 4217).
    FtpTls,
    /// SFTP over SSH.
    Sftp,
}

impl FileProtocol {
    /// Returns the likeliest protocol of a unit on `port`. The unit's setting has a port but no
    /// protocol, and the example in its document has port 22.
    pub fn of_port(port: u16) -> Self {
        if port == 22 { Self::Sftp } else { Self::Ftp }
    }
}
