//! Fetches a source of elements from here as a unit would, so that the operator
//! sees what the unit will get before it is told to.

mod ftp;
mod seen;
mod web;

use serde::{Deserialize, Serialize};

use rustls::{RootCertStore, pki_types::CertificateDer};
use secrecy::SecretString;
use tokio_util::sync::CancellationToken;

pub use seen::{Seen, UnitView, what_a_unit_sees};

use super::{
    ConnectError, FolderError, Interruption, KnownHosts, Limits, Login, Peer, Proof,
    folder::Folder as _, limits::within, open_sftp,
};

/// Where a unit is told to fetch its elements.
#[derive(Debug, Clone)]
pub enum ElementSource {
    /// An `http` or `https` address.
    Web {
        /// As the unit is told.
        url: String,
    },
    /// A file on a server.
    Server {
        peer: Peer,
        /// How it is spoken to.
        protocol: FileProtocol,
        user: String,
        password: SecretString,
        /// The file, with its folder if that is not where the log-in leads.
        file: String,
    },
}

/// How a server of files is spoken to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum FileProtocol {
    /// Plain: password and file can be read on the way.
    Ftp,
    /// With TLS from the first command on (`AUTH TLS`, RFC 4217).
    FtpTls,
    /// Over SSH.
    Sftp,
}

impl FileProtocol {
    /// What a unit most likely speaks on `port`: it is told a port and no
    /// protocol, and the example of its document has 22.
    pub fn of_port(port: u16) -> Self {
        if port == 22 { Self::Sftp } else { Self::Ftp }
    }
}

/// Whom a fetch trusts.
#[derive(Debug, Clone)]
pub struct Trust {
    /// Keys of SSH hosts.
    pub known_hosts: KnownHosts,
    /// Certificate authorities of the station's own FTP servers, in DER, beside
    /// the public ones. The web has the public ones alone.
    pub own_authorities: Vec<CertificateDer<'static>>,
}

impl Trust {
    /// All authorities; one that cannot be read is left out, with a line in the log.
    fn authorities(&self) -> RootCertStore {
        let mut roots = RootCertStore { roots: webpki_roots::TLS_SERVER_ROOTS.to_vec() };
        let (_, unread) = roots.add_parsable_certificates(self.own_authorities.iter().cloned());
        if unread > 0 {
            tracing::warn!(
                unread,
                "some of the station's own certificate authorities cannot be read"
            );
        }
        roots
    }
}

/// Why a source gave nothing. The unit was not told anything.
#[derive(Debug, thiserror::Error)]
pub enum FetchError {
    /// No connection, or no log-in.
    #[error(transparent)]
    Connect(#[from] ConnectError),
    /// Cancelled, or the whole did not come in time.
    #[error("the file did not come: {0}; check the link and try again")]
    Interrupted(#[from] Interruption),
    /// Not an address of the web.
    #[error("not an http or https address, or one with a user name in it; correct the address")]
    Address,
    /// No whole answer.
    #[error("no answer ({0}); check address and link")]
    NoAnswer(String),
    /// The server sends the asker elsewhere; whether the unit follows is not known.
    #[error("the server sends the asker on to {to}; give the unit that address")]
    Redirected {
        /// Where to.
        to: String,
    },
    /// Another answer than the file.
    #[error("the server answered {status} instead of the file; check the address")]
    Status {
        /// The status of HTTP.
        status: u16,
    },
    /// There is no such file.
    #[error("the server has no such file; check its name and folder")]
    NoFile,
    /// The folder or file cannot be read.
    #[error("cannot read the file: {0}")]
    Folder(#[from] FolderError),
    /// TLS could not be agreed on.
    #[error("no safe connection ({0}); check the server's certificate")]
    Tls(String),
    /// The server said no in its own words.
    #[error("the server refused ({0}); check the file and the rights of the user")]
    Refused(String),
    /// Larger than this program takes.
    #[error("the file is larger than {0} bytes; this is not a file of elements for a unit")]
    TooLarge(u64),
}

/// Fetches the file of `source`, as it is. Within a runtime that no session
/// runs on.
pub async fn fetch(
    source: &ElementSource,
    trust: &Trust,
    limits: Limits,
    cancel: &CancellationToken,
) -> Result<Vec<u8>, FetchError> {
    match source {
        ElementSource::Web { url } => web::fetch(url, limits, cancel).await,
        ElementSource::Server { peer, protocol: FileProtocol::Sftp, user, password, file } => {
            let proof = Proof::Password(password.clone());
            let login = Login { user: user.clone(), proof };
            let (folder, name) = file.rsplit_once('/').unwrap_or((".", file));
            let folder = if folder.is_empty() { "/" } else { folder };
            let known = &trust.known_hosts;
            let mut folder = open_sftp(peer, folder, &login, known, limits, cancel).await?;
            let found = within(limits.file, cancel, folder.read(name, &mut |_| {})).await??;
            Ok(found.ok_or(FetchError::NoFile)?.bytes)
        }
        ElementSource::Server { peer, protocol, user, password, file } => {
            let roots = (*protocol == FileProtocol::FtpTls).then(|| trust.authorities());
            ftp::fetch(ftp::Request { peer, roots, user, password, file }, limits, cancel).await
        }
    }
}
