//! Fetch of one file from an FTP server, with or without TLS.
//!
//! The FTP library writes whole commands, passwords included, to the `log` facade at its
//! finest level. `Cargo.toml` compiles that level out.

use std::sync::Arc;

use rustls::{ClientConfig, RootCertStore, crypto::ring};
use secrecy::{ExposeSecret as _, SecretString};
use suppaftp::{
    FtpError, Mode, Status,
    tokio::{AsyncRustlsConnector, AsyncRustlsFtpStream},
    tokio_rustls::TlsConnector,
    types::FileType,
};
use tokio::io::AsyncReadExt as _;
use tokio_util::sync::CancellationToken;

use super::FetchError;
use crate::transfer::{
    ConnectError, ConnectStep, Limits, Peer,
    limits::within,
    ssh::{dial, failed, interrupted},
};

/// A file, its server and the log-in.
pub(super) struct Request<'a> {
    pub(super) peer: &'a Peer,
    /// Trusted roots for TLS; `None` for plain FTP.
    pub(super) roots: Option<RootCertStore>,
    pub(super) user: &'a str,
    pub(super) password: &'a SecretString,
    pub(super) file: &'a str,
}

pub(super) async fn fetch(
    request: Request<'_>,
    limits: Limits,
    cancel: &CancellationToken,
) -> Result<Vec<u8>, FetchError> {
    let Request { peer, roots, user, password, file } = request;
    let stream = dial(peer, limits, cancel).await?;
    let is_ipv6 = stream.peer_addr().is_ok_and(|address| address.is_ipv6());
    let step = ConnectStep::Handshake;
    let mut ftp = within(limits.log_in, cancel, greet(stream, roots, peer))
        .await
        .map_err(|by| interrupted(step, by, peer))??;
    let step = ConnectStep::LogIn;
    within(limits.log_in, cancel, ftp.login(user, password.expose_secret()))
        .await
        .map_err(|by| interrupted(step, by, peer))?
        .map_err(|error| match error {
            FtpError::UnexpectedResponse(_) => ConnectError::LoginRefused {
                user: user.to_owned(),
                hint: "the server may want another protocol, such as FTP with TLS".to_owned(),
                peer: peer.clone(),
            },
            error => failed(step, &error, peer),
        })?;
    // The address in the answer is often the one behind a router, or a trap.
    ftp.set_passive_nat_workaround(true);
    ftp.set_mode(if is_ipv6 { Mode::ExtendedPassive } else { Mode::Passive });
    within(limits.file, cancel, retrieve(&mut ftp, file, limits)).await?
}

async fn greet(
    stream: tokio::net::TcpStream,
    roots: Option<RootCertStore>,
    peer: &Peer,
) -> Result<AsyncRustlsFtpStream, FetchError> {
    let step = ConnectStep::Handshake;
    let told = |error: FtpError| match error {
        FtpError::SecureError(reason) => FetchError::Tls(reason),
        error => failed(step, &error, peer).into(),
    };
    let ftp = AsyncRustlsFtpStream::connect_with_stream(stream).await.map_err(told)?;
    let Some(roots) = roots else { return Ok(ftp) };
    let config = ClientConfig::builder_with_provider(Arc::new(ring::default_provider()))
        .with_safe_default_protocol_versions()
        .map_err(|error| FetchError::Tls(error.to_string()))?
        .with_root_certificates(roots)
        .with_no_client_auth();
    let connector = AsyncRustlsConnector::from(TlsConnector::from(Arc::new(config)));
    ftp.into_secure(connector, &peer.host).await.map_err(told)
}

async fn retrieve(
    ftp: &mut AsyncRustlsFtpStream,
    file: &str,
    limits: Limits,
) -> Result<Vec<u8>, FetchError> {
    let told = |error: FtpError| match error {
        FtpError::UnexpectedResponse(response) if response.status == Status::FileUnavailable => {
            FetchError::NoFile
        }
        FtpError::UnexpectedResponse(response) => FetchError::Refused(response.to_string()),
        FtpError::SecureError(reason) => FetchError::Tls(reason),
        error => FetchError::NoAnswer(error.to_string()),
    };
    // Binary: text mode would change the line ends.
    ftp.transfer_type(FileType::Binary).await.map_err(told)?;
    let mut stream = ftp.retr_as_stream(file).await.map_err(told)?;
    let mut bytes = Vec::new();
    let most = limits.file_bytes.saturating_add(1);
    (&mut stream)
        .take(most)
        .read_to_end(&mut bytes)
        .await
        .map_err(|error| FetchError::NoAnswer(error.to_string()))?;
    if bytes.len() as u64 > limits.file_bytes {
        return Err(FetchError::TooLarge(limits.file_bytes));
    }
    // Only this answer tells a complete file from an interrupted one.
    stream.finish().await.map_err(told)?;
    Ok(bytes)
}
