//! Test fetch of a source of elements, done like a unit's fetch. The operator sees beforehand what
//! the unit will get.

mod ftp;
mod unit_reading;
mod web;

use rustls::{RootCertStore, pki_types::CertificateDer};
use secrecy::SecretString;
use tokio_util::sync::CancellationToken;

use super::{
    ConnectError, FolderError, Interruption, KnownHosts, Limits, Login, Proof, folder::Folder as _,
    limits::with_timeout, open_sftp,
};
use crate::{
    contract::transfer::{FileProtocol, OldAlgorithm, Peer},
    library::system_authorities,
};
pub use unit_reading::what_a_unit_sees;

/// Source of a unit's elements on the network.
#[derive(Debug, Clone)]
pub enum ElementSource {
    /// Web address, `http` or `https`.
    Web {
        /// Address in the unit's settings.
        url: String,
    },
    /// File on a server.
    Server {
        peer: Peer,
        protocol: FileProtocol,
        user: String,
        password: SecretString,
        /// File name, with its folder unless it is in the log-in folder.
        file: String,
    },
}

/// Keys and authorities that a fetch trusts.
#[derive(Debug, Clone)]
pub struct Trust {
    /// Keys of SSH hosts.
    pub known_hosts: KnownHosts,
    /// Certificate authorities of the station's own FTP servers, in DER. They count beside the
    /// public and the system's authorities; web fetches use only the public ones.
    pub own_authorities: Vec<CertificateDer<'static>>,
}

impl Trust {
    /// Collects all authorities. Skips unreadable ones, with a line in the log.
    fn authorities(&self) -> RootCertStore {
        let mut roots = RootCertStore { roots: webpki_roots::TLS_SERVER_ROOTS.to_vec() };
        let own = self.own_authorities.iter().chain(system_authorities()).cloned();
        let (_, unread) = roots.add_parsable_certificates(own);
        if unread > 0 {
            tracing::warn!(
                unread,
                "some certificate authorities of the station or the system cannot be read"
            );
        }
        roots
    }
}

/// Reason why a fetch failed. Azel sent nothing to the unit.
#[derive(Debug, thiserror::Error)]
pub enum FetchError {
    /// No connection, or no log-in.
    #[error(transparent)]
    Connect(#[from] ConnectError),
    /// The fetch was cancelled, or not complete in time.
    #[error("the file did not arrive: {0}; check the link and try again")]
    Interrupted(#[from] Interruption),
    /// The address is not a valid web address.
    #[error("not an http or https address, or one with a user name in it; correct the address")]
    Address,
    /// The server gave no complete answer.
    #[error("no answer ({0}); check address and link")]
    NoAnswer(String),
    /// The server redirects the request; a unit may not follow.
    #[error("the server redirects to {destination}; give the unit that address")]
    Redirected {
        /// New address.
        destination: String,
    },
    /// HTTP answer other than the file.
    #[error("the server answered {status} instead of the file; check the address")]
    Status {
        /// HTTP status code of the answer.
        status: u16,
    },
    #[error("the server has no such file; check its name and folder")]
    NoFile,
    #[error("cannot read the file: {0}")]
    Folder(#[from] FolderError),
    /// The server and Azel found no common TLS settings.
    #[error("no secure connection ({0}); check the server's certificate")]
    Tls(String),
    /// The server's answer has no known form of the protocol.
    #[error("the server's answer was not understood ({0}); try SFTP, or another server")]
    NotUnderstood(String),
    /// The server refused, with its reason.
    #[error("the server refused ({0}); check the file and the user's permissions")]
    Refused(String),
    /// The file exceeds Azel's size limit, bytes.
    #[error("the file is larger than {0} bytes; this is not a file of elements for a unit")]
    TooLarge(u64),
}

/// Fetched file of a source.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fetched {
    /// Content of the file, unchanged.
    pub bytes: Vec<u8>,
    /// Old algorithms of the SSH connection; none for other protocols.
    pub old_algorithms: Vec<OldAlgorithm>,
}

impl From<Vec<u8>> for Fetched {
    fn from(bytes: Vec<u8>) -> Self {
        Self { bytes, old_algorithms: Vec::new() }
    }
}

/// Fetches the file of `source`. Must be called within a runtime that runs no session.
pub async fn fetch(
    source: &ElementSource,
    trust: &Trust,
    limits: Limits,
    cancel: &CancellationToken,
) -> Result<Fetched, FetchError> {
    match source {
        ElementSource::Web { url } => Ok(web::fetch(url, limits, cancel).await?.into()),
        ElementSource::Server { peer, protocol: FileProtocol::Sftp, user, password, file } => {
            let proof = Proof::Password(password.clone());
            let login = Login { user: user.clone(), proof };
            let (folder, name) = file.rsplit_once('/').unwrap_or((".", file));
            let folder = if folder.is_empty() { "/" } else { folder };
            let known_hosts = &trust.known_hosts;
            let mut folder = open_sftp(peer, folder, &login, known_hosts, limits, cancel).await?;
            let found = with_timeout(limits.file, cancel, folder.read(name, &mut |_| {})).await??;
            let bytes = found.ok_or(FetchError::NoFile)?.bytes;
            Ok(Fetched { bytes, old_algorithms: folder.old_algorithms().to_vec() })
        }
        ElementSource::Server { peer, protocol, user, password, file } => {
            let roots = (*protocol == FileProtocol::FtpTls).then(|| trust.authorities());
            let request = ftp::Request { peer, roots, user, password, file };
            Ok(ftp::fetch(request, limits, cancel).await?.into())
        }
    }
}
