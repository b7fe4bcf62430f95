//! Fetch of one file from an FTP server, with or without TLS.
//!
//! The FTP library logs whole commands, including passwords, through the `log` facade at its finest
//! level. `Cargo.toml` compiles that level out.

use std::sync::Arc;

use rustls::{ClientConfig, RootCertStore, crypto::ring, pki_types::ServerName};
use secrecy::{ExposeSecret as _, SecretString};
use suppaftp::{
    FtpError, Status,
    tokio::{AsyncRustlsConnector, AsyncRustlsFtpStream},
    tokio_rustls::TlsConnector,
    types::{FileType, Response},
};
use tokio::{
    io::{AsyncRead, AsyncReadExt as _},
    net::TcpStream,
};
use tokio_util::sync::CancellationToken;

use super::FetchError;
use crate::{
    contract::transfer::Peer,
    transfer::{
        ConnectError, ConnectStep, Limits,
        limits::with_timeout,
        ssh::{dial, failed, interrupted},
    },
};

/// File to fetch, with its server and log-in.
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
    // Use the control connection's address: the one in an answer is often behind a router, or a
    // trap.
    let address = stream.peer_addr().map_err(|error| failed(ConnectStep::Connect, &error, peer))?;
    let data = Peer { host: address.ip().to_string(), port: peer.port };
    let tls = roots.map(tls_connector).transpose()?;
    let step = ConnectStep::Handshake;
    let mut ftp = with_timeout(limits.log_in, cancel, greet(stream, tls.clone(), peer))
        .await
        .map_err(|interruption| interrupted(step, interruption, peer))??;
    let step = ConnectStep::LogIn;
    with_timeout(limits.log_in, cancel, ftp.login(user, password.expose_secret()))
        .await
        .map_err(|interruption| interrupted(step, interruption, peer))?
        .map_err(|error| match error {
            FtpError::UnexpectedResponse(_) => ConnectError::LoginRefused {
                user: user.to_owned(),
                hint: "the server may want another protocol, such as FTP with TLS".to_owned(),
                peer: peer.clone(),
            },
            error => failed(step, &error, peer),
        })?;
    let work = async {
        // Binary mode: text mode would change the line ends.
        ftp.transfer_type(FileType::Binary).await.map_err(in_words)?;
        let stream = open_data(&mut ftp, data, limits, cancel).await?;
        retrieve(&mut ftp, file, (stream, tls, peer), limits).await
    };
    with_timeout(limits.file, cancel, work).await?
}

fn tls_connector(roots: RootCertStore) -> Result<TlsConnector, FetchError> {
    let config = ClientConfig::builder_with_provider(Arc::new(ring::default_provider()))
        .with_safe_default_protocol_versions()
        .map_err(|error| FetchError::Tls(error.to_string()))?
        .with_root_certificates(roots)
        .with_no_client_auth();
    Ok(TlsConnector::from(Arc::new(config)))
}

async fn greet(
    stream: TcpStream,
    tls: Option<TlsConnector>,
    peer: &Peer,
) -> Result<AsyncRustlsFtpStream, FetchError> {
    let step = ConnectStep::Handshake;
    let problem = |error: FtpError| match error {
        FtpError::SecureError(reason) => FetchError::Tls(reason),
        error => failed(step, &error, peer).into(),
    };
    let ftp = AsyncRustlsFtpStream::connect_with_stream(stream).await.map_err(problem)?;
    let Some(tls) = tls else { return Ok(ftp) };
    ftp.into_secure(AsyncRustlsConnector::from(tls), &peer.host).await.map_err(problem)
}

fn in_words(error: FtpError) -> FetchError {
    match error {
        FtpError::UnexpectedResponse(response) if response.status == Status::FileUnavailable => {
            FetchError::NoFile
        }
        // Replies from 400 up refuse a command (RFC 959, section 4.2).
        FtpError::UnexpectedResponse(response) if response.status.code() >= 400 => {
            FetchError::Refused(response.to_string())
        }
        FtpError::UnexpectedResponse(response) => FetchError::NotUnderstood(response.to_string()),
        FtpError::BadResponse => FetchError::NotUnderstood("no reply of FTP".to_owned()),
        FtpError::SecureError(reason) => FetchError::Tls(reason),
        error => FetchError::NoAnswer(error.to_string()),
    }
}

/// Opens the connection for a file in extended passive mode (RFC 2428). Falls back to plain passive
/// mode (RFC 959) if the server does not know it or its port cannot be reached.
async fn open_data(
    ftp: &mut AsyncRustlsFtpStream,
    data: Peer,
    limits: Limits,
    cancel: &CancellationToken,
) -> Result<TcpStream, FetchError> {
    let dial_port =
        async |port| dial(&Peer { port, ..data.clone() }, limits, cancel).await.map_err(Into::into);
    let extended = passive_port(ftp, "EPSV", Status::ExtendedPassiveMode, extended_port).await;
    let first = match extended {
        Ok(port) => dial_port(port).await,
        Err(error) => Err(error),
    };
    match first {
        Ok(stream) => Ok(stream),
        Err(error @ (FetchError::NoAnswer(_) | FetchError::Interrupted(_))) => Err(error),
        Err(_) => {
            dial_port(passive_port(ftp, "PASV", Status::PassiveMode, plain_port).await?).await
        }
    }
}

async fn passive_port(
    ftp: &mut AsyncRustlsFtpStream,
    command: &str,
    expected: Status,
    port: fn(&str) -> Option<u16>,
) -> Result<u16, FetchError> {
    let response: Response = ftp.custom_command(command, &[expected]).await.map_err(in_words)?;
    let text = String::from_utf8_lossy(&response.body);
    port(&text).ok_or_else(|| FetchError::NotUnderstood(response.to_string()))
}

/// Returns the port in an answer to EPSV. It stands between four equal characters, such as
/// `(|||6446|)`; some servers omit the parentheses.
fn extended_port(text: &str) -> Option<u16> {
    let letters: Vec<char> = text.chars().collect();
    letters.windows(3).enumerate().find_map(|(place, window)| {
        let mark = *window.first()?;
        if mark.is_alphanumeric()
            || mark.is_whitespace()
            || window.iter().any(|other| *other != mark)
        {
            return None;
        }
        let rest: String = letters.get(place + 3..)?.iter().collect();
        let (digits, _) = rest.split_once(mark)?;
        digits.parse().ok().filter(|port| *port > 0)
    })
}

/// Returns the port in an answer to PASV, from the last two of six numbers. The parentheses may be
/// missing (RFC 1123, section 4.1.2.6).
fn plain_port(text: &str) -> Option<u16> {
    let text = text.replace(", ", ",");
    text.split(|letter: char| !letter.is_ascii_digit() && letter != ',').find_map(|word| {
        let numbers: Result<Vec<u8>, _> =
            word.trim_matches(',').split(',').map(str::parse).collect();
        match numbers.ok()?[..] {
            [.., high, low] if word.matches(',').count() >= 5 => {
                Some(u16::from_be_bytes([high, low])).filter(|port| *port > 0)
            }
            _ => None,
        }
    })
}

async fn retrieve(
    ftp: &mut AsyncRustlsFtpStream,
    file: &str,
    (stream, tls, peer): (TcpStream, Option<TlsConnector>, &Peer),
    limits: Limits,
) -> Result<Vec<u8>, FetchError> {
    let is_line = !file.contains(['\r', '\n']);
    let command = is_line.then(|| format!("RETR {file}")).ok_or(FetchError::NoFile)?;
    let begun = [Status::AboutToSend, Status::AlreadyOpen];
    ftp.custom_command(command, &begun).await.map_err(in_words)?;
    let bytes = match tls {
        Some(tls) => {
            let name = ServerName::try_from(peer.host.clone())
                .map_err(|error| FetchError::Tls(error.to_string()))?;
            let stream = tls.connect(name, stream).await;
            read(stream.map_err(|error| FetchError::Tls(error.to_string()))?, limits).await?
        }
        None => read(stream, limits).await?,
    };
    // Only the server's answer after the file shows that the file is complete. The answer precedes
    // the one to the next command.
    let ended = [Status::ClosingDataConnection, Status::RequestedFileActionOk];
    ftp.custom_command("NOOP", &ended).await.map_err(in_words)?;
    Ok(bytes)
}

async fn read(stream: impl AsyncRead, limits: Limits) -> Result<Vec<u8>, FetchError> {
    let mut bytes = Vec::new();
    std::pin::pin!(stream)
        .take(limits.file_bytes.saturating_add(1))
        .read_to_end(&mut bytes)
        .await
        .map_err(|error| FetchError::NoAnswer(error.to_string()))?;
    if bytes.len() as u64 > limits.file_bytes {
        return Err(FetchError::TooLarge(limits.file_bytes));
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests;
