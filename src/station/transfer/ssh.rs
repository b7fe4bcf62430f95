//! SSH connections to a folder on a unit.

use std::{io, path::Path, sync::Arc};

use russh::{
    Disconnect, Preferred,
    client::{self, AuthResult, Handle},
    keys::{Algorithm, PrivateKey, PrivateKeyWithHashAlg, PublicKeyOrCertificate, load_secret_key},
};
use secrecy::{ExposeSecret as _, SecretString};
use tokio::net::TcpStream;
use tokio_util::sync::CancellationToken;

use super::{
    ConnectError, ConnectStep, Interruption, KeyFileProblem, KeyVerdict, KnownHosts, Limits, Login,
    OfferedKey, Peer, Proof, SftpFolder, limits::within,
};

/// An SSH connection after log-in. Dropping it ends it.
pub(super) type Ssh = Handle<Judge>;

/// Opens `folder` on `peer` as `login`. `known` decides about the host's key before any
/// secret is sent; an unknown key is returned as an error, to be shown, pinned and tried
/// again. Call it within a runtime that runs no session: unlocking a key takes a while.
pub async fn open_sftp(
    peer: &Peer,
    folder: &str,
    login: &Login,
    known: &KnownHosts,
    limits: Limits,
    cancel: &CancellationToken,
) -> Result<SftpFolder, ConnectError> {
    let ssh = connect(peer, login, known, limits, cancel).await?;
    let opening = SftpFolder::open(ssh, folder, limits);
    within(limits.log_in, cancel, opening)
        .await
        .map_err(|by| interrupted(ConnectStep::OpenFiles, by, peer))?
        .map_err(|reason| failed(ConnectStep::OpenFiles, &reason, peer))
}

/// Checks the key of `peer` and hangs up, so that nobody is asked for a password that
/// could not be sent. Errors are those of [`open_sftp`].
pub async fn check_host_key(
    peer: &Peer,
    known: &KnownHosts,
    limits: Limits,
    cancel: &CancellationToken,
) -> Result<(), ConnectError> {
    let handle = shake_hands(peer, known, limits, cancel).await?;
    // The connection may be gone already; then an error says nothing new.
    let _ = handle.disconnect(Disconnect::ByApplication, "", "").await;
    Ok(())
}

/// Connects to a host with the right key, without logging in.
async fn shake_hands(
    peer: &Peer,
    known: &KnownHosts,
    limits: Limits,
    cancel: &CancellationToken,
) -> Result<Ssh, ConnectError> {
    let config = config(&known.algorithms(&peer.host, peer.port)?);
    let stream = dial(peer, limits, cancel).await?;
    let judge = Judge { known: known.clone(), peer: peer.clone() };
    let shaking = client::connect_stream(Arc::new(config), stream, judge);
    within(limits.log_in, cancel, shaking)
        .await
        .map_err(|by| interrupted(ConnectStep::Handshake, by, peer))?
        .map_err(|error| match error {
            Refused::Key(error) => error,
            Refused::Ssh(error) => failed(ConnectStep::Handshake, &error, peer),
        })
}

async fn connect(
    peer: &Peer,
    login: &Login,
    known: &KnownHosts,
    limits: Limits,
    cancel: &CancellationToken,
) -> Result<Ssh, ConnectError> {
    // Done first, so that a wrong passphrase costs no connection.
    let key = match &login.proof {
        Proof::Password(_) => None,
        Proof::KeyFile { path, passphrase } => Some(private_key(path, passphrase.as_ref())?),
    };
    let mut handle = shake_hands(peer, known, limits, cancel).await?;
    let result = within(limits.log_in, cancel, log_in(&mut handle, login, key))
        .await
        .map_err(|by| interrupted(ConnectStep::LogIn, by, peer))?
        .map_err(|error| failed(ConnectStep::LogIn, &error, peer))?;
    match result {
        AuthResult::Success => Ok(handle),
        AuthResult::Failure { remaining_methods, .. } => {
            // The connection may be gone already; then an error says nothing new.
            let _ = handle.disconnect(Disconnect::ByApplication, "", "").await;
            let methods: Vec<&str> = remaining_methods.iter().map(Into::into).collect();
            Err(ConnectError::LoginRefused {
                user: login.user.clone(),
                hint: format!("the host accepts: {}", methods.join(", ")),
                peer: peer.clone(),
            })
        }
    }
}

/// Opens a TCP connection.
pub(super) async fn dial(
    peer: &Peer,
    limits: Limits,
    cancel: &CancellationToken,
) -> Result<TcpStream, ConnectError> {
    let dialling = TcpStream::connect((peer.host.as_str(), peer.port));
    let unreachable = |source| ConnectError::Unreachable { source, peer: peer.clone() };
    let stream = within(limits.connect, cancel, dialling)
        .await
        .map_err(|by| interrupted(ConnectStep::Connect, by, peer))?
        .map_err(unreachable)?;
    stream.set_nodelay(true).map_err(unreachable)?;
    Ok(stream)
}

pub(super) fn interrupted(step: ConnectStep, by: Interruption, peer: &Peer) -> ConnectError {
    ConnectError::Interrupted { step, by, peer: peer.clone() }
}

pub(super) fn failed(step: ConnectStep, reason: &impl ToString, peer: &Peer) -> ConnectError {
    ConnectError::Failed { step, reason: reason.to_string(), peer: peer.clone() }
}

/// Prefers the algorithms of the pinned keys: otherwise a host with several keys would
/// seem to have changed when it gets a better one.
fn config(pinned: &[Algorithm]) -> client::Config {
    let is_pinned = |kind: &Algorithm| {
        pinned.iter().any(|pinned| {
            pinned == kind
                || matches!((pinned, kind), (Algorithm::Rsa { .. }, Algorithm::Rsa { .. }))
        })
    };
    let (mut kinds, others): (Vec<_>, Vec<_>) =
        Preferred::DEFAULT.key.iter().cloned().partition(is_pinned);
    kinds.extend(others);
    client::Config {
        preferred: Preferred { key: kinds.into(), ..Preferred::DEFAULT },
        ..client::Config::default()
    }
}

async fn log_in(
    handle: &mut Handle<Judge>,
    login: &Login,
    key: Option<PrivateKey>,
) -> Result<AuthResult, russh::Error> {
    match (&login.proof, key) {
        (Proof::Password(password), _) => {
            handle.authenticate_password(&login.user, password.expose_secret()).await
        }
        (Proof::KeyFile { .. }, Some(key)) => {
            let hash = handle.best_supported_rsa_hash().await?.flatten();
            let key = PrivateKeyWithHashAlg::new(Arc::new(key), hash);
            handle.authenticate_publickey(&login.user, key).await
        }
        (Proof::KeyFile { .. }, None) => Err(russh::Error::NoAuthMethod),
    }
}

fn private_key(path: &Path, passphrase: Option<&SecretString>) -> Result<PrivateKey, ConnectError> {
    use russh::keys::Error;
    load_secret_key(path, passphrase.map(SecretString::expose_secret)).map_err(|error| {
        let problem = match error {
            Error::IO(error) if error.kind() != io::ErrorKind::InvalidData => {
                KeyFileProblem::Disk(error)
            }
            Error::KeyIsEncrypted => KeyFileProblem::Locked,
            _ if passphrase.is_some() => KeyFileProblem::WrongPassphrase,
            _ => KeyFileProblem::Form,
        };
        ConnectError::KeyFile { problem, path: path.to_owned() }
    })
}

/// Checks the host's key.
pub(super) struct Judge {
    known: KnownHosts,
    peer: Peer,
}

#[derive(Debug, thiserror::Error)]
pub(super) enum Refused {
    #[error(transparent)]
    Ssh(#[from] russh::Error),
    #[error(transparent)]
    Key(ConnectError),
}

impl client::Handler for Judge {
    type Error = Refused;

    async fn check_server_key(
        &mut self,
        offered: &PublicKeyOrCertificate,
    ) -> Result<bool, Self::Error> {
        let PublicKeyOrCertificate::PublicKey { key, .. } = offered else { return Ok(false) };
        let offered = Box::new(OfferedKey::new(&self.peer.host, self.peer.port, key.clone()));
        let verdict = self.known.check(&offered).map_err(|error| Refused::Key(error.into()))?;
        Err(Refused::Key(match verdict {
            KeyVerdict::Pinned => return Ok(true),
            KeyVerdict::Unknown => ConnectError::UnknownHostKey(offered),
            KeyVerdict::Changed { pinned } => ConnectError::HostKeyChanged { pinned, offered },
            KeyVerdict::Revoked => ConnectError::HostKeyRevoked(offered),
        }))
    }
}
