//! SSH connections to a folder on a unit.

use std::{
    io,
    path::Path,
    sync::{Arc, OnceLock},
};

use russh::{
    AlgorithmKind, Disconnect, MethodKind, Names, Preferred, cipher,
    client::{
        self, AuthResult, GexParams, Handle, KeyboardInteractiveAuthResponse as Interactive,
        Session,
    },
    kex,
    keys::{Algorithm, PrivateKey, PrivateKeyWithHashAlg, PublicKeyOrCertificate, load_secret_key},
    mac,
};
use secrecy::{ExposeSecret as _, SecretString};
use tokio::net::TcpStream;
use tokio_util::sync::CancellationToken;

use super::{
    ConnectError, ConnectStep, Interruption, KeyFileProblem, KeyVerdict, KnownHosts, Limits, Login,
    OfferedKey, Proof, SftpFolder, limits::with_timeout,
};
use crate::contract::transfer::{AlgorithmPart, OldAlgorithm, Peer};

/// SSH connection. Dropping it closes the connection.
pub(super) struct Ssh {
    pub(super) handle: Handle<Judge>,
    /// Old algorithms of the connection.
    pub(super) old_algorithms: Vec<OldAlgorithm>,
}

/// Opens `folder` on `peer` as `login`. `known_hosts` checks the host's key before Azel sends any
/// secret. An unknown key is an error, so that the operator can pin the key and try again. Must be
/// called within a runtime that runs no session: unlocking a key takes a while.
pub async fn open_sftp(
    peer: &Peer,
    folder: &str,
    login: &Login,
    known_hosts: &KnownHosts,
    limits: Limits,
    cancel: &CancellationToken,
) -> Result<SftpFolder, ConnectError> {
    let ssh = connect(peer, login, known_hosts, limits, cancel).await?;
    let opening = SftpFolder::open(ssh, folder, limits);
    with_timeout(limits.log_in, cancel, opening)
        .await
        .map_err(|interruption| interrupted(ConnectStep::OpenFiles, interruption, peer))?
        .map_err(|reason| failed(ConnectStep::OpenFiles, &reason, peer))
}

/// Checks the key of `peer` and hangs up. Azel then asks for a password only if the host is right.
/// Returns the old algorithms of the connection, or an error like [`open_sftp`].
pub async fn check_host_key(
    peer: &Peer,
    known_hosts: &KnownHosts,
    limits: Limits,
    cancel: &CancellationToken,
) -> Result<Vec<OldAlgorithm>, ConnectError> {
    let ssh = shake_hands(peer, known_hosts, limits, cancel).await?;
    // Ignore errors: the connection may already be gone.
    let _ = ssh.handle.disconnect(Disconnect::ByApplication, "", "").await;
    Ok(ssh.old_algorithms)
}

/// Connects to a host and checks its key, without logging in.
async fn shake_hands(
    peer: &Peer,
    known_hosts: &KnownHosts,
    limits: Limits,
    cancel: &CancellationToken,
) -> Result<Ssh, ConnectError> {
    let config = config(&known_hosts.algorithms(&peer.host, peer.port)?);
    let stream = dial(peer, limits, cancel).await?;
    let old = Arc::new(OnceLock::new());
    let judge =
        Judge { known_hosts: known_hosts.clone(), peer: peer.clone(), old: Arc::clone(&old) };
    let shaking = client::connect_stream(Arc::new(config), stream, judge);
    let handle = with_timeout(limits.log_in, cancel, shaking)
        .await
        .map_err(|interruption| interrupted(ConnectStep::Handshake, interruption, peer))?
        .map_err(|error| match error {
            Refused::Key(error) => error,
            Refused::Ssh(russh::Error::NoCommonAlgo { kind, theirs, .. }) => {
                let kind = match kind {
                    AlgorithmKind::Kex => "key exchanges",
                    AlgorithmKind::Key => "kinds of host keys",
                    AlgorithmKind::Cipher => "ciphers",
                    AlgorithmKind::Mac => "message authentication codes",
                    AlgorithmKind::Compression => "compressions",
                };
                let offered = theirs.join(", ");
                ConnectError::NoAgreement { kind, offered, peer: peer.clone() }
            }
            Refused::Ssh(error) => failed(ConnectStep::Handshake, &error, peer),
        })?;
    // The key exchange is complete, so the algorithms are known.
    Ok(Ssh { handle, old_algorithms: old.get().cloned().unwrap_or_default() })
}

async fn connect(
    peer: &Peer,
    login: &Login,
    known_hosts: &KnownHosts,
    limits: Limits,
    cancel: &CancellationToken,
) -> Result<Ssh, ConnectError> {
    // Unlock the key first, so that a wrong passphrase needs no connection.
    let key = match &login.proof {
        Proof::Password(_) => None,
        Proof::KeyFile { path, passphrase } => Some(private_key(path, passphrase.as_ref())?),
    };
    let mut ssh = shake_hands(peer, known_hosts, limits, cancel).await?;
    let result = with_timeout(limits.log_in, cancel, log_in(&mut ssh.handle, login, key))
        .await
        .map_err(|interruption| interrupted(ConnectStep::LogIn, interruption, peer))?
        .map_err(|error| failed(ConnectStep::LogIn, &error, peer))?;
    match result {
        AuthResult::Success => Ok(ssh),
        AuthResult::Failure { remaining_methods, .. } => {
            // Ignore errors: the connection may already be gone.
            let _ = ssh.handle.disconnect(Disconnect::ByApplication, "", "").await;
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
    let stream = with_timeout(limits.connect, cancel, dialling)
        .await
        .map_err(|interruption| interrupted(ConnectStep::Connect, interruption, peer))?
        .map_err(unreachable)?;
    stream.set_nodelay(true).map_err(unreachable)?;
    Ok(stream)
}

pub(super) fn interrupted(
    step: ConnectStep,
    interruption: Interruption,
    peer: &Peer,
) -> ConnectError {
    ConnectError::Interrupted { step, interruption, peer: peer.clone() }
}

pub(super) fn failed(step: ConnectStep, reason: &impl ToString, peer: &Peer) -> ConnectError {
    ConnectError::Failed { step, reason: reason.to_string(), peer: peer.clone() }
}

/// Returns a configuration that prefers the algorithms of the pinned keys. Otherwise a host with
/// several keys would seem changed after getting a better key.
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
    let preferred = Preferred {
        key: kinds.into(),
        kex: [&*Preferred::DEFAULT.kex, &MODERN_KEX, &OLD_KEX].concat().into(),
        cipher: [&*Preferred::DEFAULT.cipher, &OLD_CIPHERS].concat().into(),
        mac: [&*Preferred::DEFAULT.mac, &OLD_MACS].concat().into(),
        ..Preferred::DEFAULT
    };
    let default = client::Config::default();
    // Old servers have groups of 2048 bits.
    let gex = GexParams::new(2048, 4096, 8192).unwrap_or_else(|_| default.gex.clone());
    client::Config { preferred, gex, ..default }
}

/// Key exchanges as good as the default ones.
const MODERN_KEX: [kex::Name; 3] =
    [kex::ECDH_SHA2_NISTP256, kex::ECDH_SHA2_NISTP384, kex::ECDH_SHA2_NISTP521];
/// Algorithms of old servers and units. They are used only if a server offers nothing better,
/// because the client's order decides (RFC 4253, section 7.1).
const OLD_KEX: [kex::Name; 3] = [kex::DH_G14_SHA1, kex::DH_GEX_SHA1, kex::DH_G1_SHA1];
const OLD_CIPHERS: [cipher::Name; 3] =
    [cipher::AES_256_CBC, cipher::AES_192_CBC, cipher::AES_128_CBC];
const OLD_MACS: [mac::Name; 2] = [mac::HMAC_SHA1_ETM, mac::HMAC_SHA1];
const AUTHENTICATING_CIPHERS: [cipher::Name; 3] =
    [cipher::CHACHA20_POLY1305, cipher::AES_256_GCM, cipher::AES_128_GCM];
/// Algorithm `ssh-rsa`, which signs with SHA-1. The library itself puts it last.
const OLD_HOST_KEY: Algorithm = Algorithm::Rsa { hash: None };

/// Returns the old algorithms among the agreed ones.
fn old_algorithms(names: &Names) -> Vec<OldAlgorithm> {
    let old = |part, is_old: bool, name: &str| {
        is_old.then(|| OldAlgorithm { part, name: name.to_owned() })
    };
    let kex = &names.kex;
    let cipher = &names.cipher;
    let macs = [names.client_mac, names.server_mac];
    // An authenticating cipher uses no MAC, even if one was agreed on.
    let authenticates = AUTHENTICATING_CIPHERS.contains(cipher);
    let mac = macs.iter().find(|mac| OLD_MACS.contains(mac) && !authenticates);
    [
        old(AlgorithmPart::KeyExchange, OLD_KEX.contains(kex), kex.as_ref()),
        old(AlgorithmPart::HostKey, names.key == OLD_HOST_KEY, names.key.as_str()),
        old(AlgorithmPart::Cipher, OLD_CIPHERS.contains(cipher), cipher.as_ref()),
        mac.and_then(|mac| old(AlgorithmPart::Mac, true, mac.as_ref())),
    ]
    .into_iter()
    .flatten()
    .collect()
}

async fn log_in(
    handle: &mut Handle<Judge>,
    login: &Login,
    key: Option<PrivateKey>,
) -> Result<AuthResult, russh::Error> {
    match (&login.proof, key) {
        (Proof::Password(password), _) => {
            let result =
                handle.authenticate_password(&login.user, password.expose_secret()).await?;
            let AuthResult::Failure { remaining_methods, .. } = &result else { return Ok(result) };
            // A host that accepts passwords has refused this one: a second try could lock the user.
            let asks = remaining_methods.contains(&MethodKind::KeyboardInteractive)
                && !remaining_methods.contains(&MethodKind::Password);
            if asks { answer_prompts(handle, &login.user, password).await } else { Ok(result) }
        }
        (Proof::KeyFile { .. }, Some(key)) => {
            let hash = handle.best_supported_rsa_hash().await?.flatten();
            let key = PrivateKeyWithHashAlg::new(Arc::new(key), hash);
            handle.authenticate_publickey(&login.user, key).await
        }
        (Proof::KeyFile { .. }, None) => Err(russh::Error::NoAuthMethod),
    }
}

/// Logs in by keyboard-interactive (RFC 4256): answers a host's single hidden question with the
/// password. Only the operator could answer other questions.
async fn answer_prompts(
    handle: &mut Handle<Judge>,
    user: &str,
    password: &SecretString,
) -> Result<AuthResult, russh::Error> {
    let mut reply = handle.authenticate_keyboard_interactive_start(user, None).await?;
    let mut is_sent = false;
    for _ in 0..MAX_ROUNDS {
        let prompts = match reply {
            Interactive::Success => return Ok(AuthResult::Success),
            Interactive::Failure { remaining_methods, partial_success } => {
                return Ok(AuthResult::Failure { remaining_methods, partial_success });
            }
            Interactive::InfoRequest { prompts, .. } => prompts,
        };
        let answers = match &prompts[..] {
            [] => Vec::new(),
            [prompt] if !prompt.echo && !is_sent => {
                is_sent = true;
                vec![password.expose_secret().to_owned()]
            }
            _ => break,
        };
        reply = handle.authenticate_keyboard_interactive_respond(answers).await?;
    }
    let remaining_methods = [MethodKind::KeyboardInteractive].as_slice().into();
    Ok(AuthResult::Failure { remaining_methods, partial_success: false })
}

/// Max number of questions of a host.
const MAX_ROUNDS: usize = 5;

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

/// Handler that checks the host's key.
pub(super) struct Judge {
    known_hosts: KnownHosts,
    peer: Peer,
    /// Old algorithms from the first key exchange; later exchanges agree on the same ones.
    old: Arc<OnceLock<Vec<OldAlgorithm>>>,
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

    async fn kex_done(
        &mut self,
        _secret: Option<&[u8]>,
        names: &Names,
        _session: &mut Session,
    ) -> Result<(), Self::Error> {
        let old = self.old.get_or_init(|| old_algorithms(names));
        if !old.is_empty() {
            let names = old.iter().map(|old| old.name.as_str()).collect::<Vec<_>>().join(", ");
            let peer = &self.peer;
            tracing::warn!(%peer, old = names, "the host offers nothing better than old algorithms: update it");
        }
        Ok(())
    }

    async fn check_server_key(
        &mut self,
        offered: &PublicKeyOrCertificate,
    ) -> Result<bool, Self::Error> {
        let PublicKeyOrCertificate::PublicKey { key, .. } = offered else { return Ok(false) };
        let offered = Box::new(OfferedKey::new(&self.peer.host, self.peer.port, key.clone()));
        let verdict =
            self.known_hosts.check(&offered).map_err(|error| Refused::Key(error.into()))?;
        Err(Refused::Key(match verdict {
            KeyVerdict::Pinned => return Ok(true),
            KeyVerdict::Unknown => ConnectError::UnknownHostKey(offered),
            KeyVerdict::Changed { pinned } => ConnectError::HostKeyChanged { pinned, offered },
            KeyVerdict::Revoked => ConnectError::HostKeyRevoked(offered),
        }))
    }
}

#[cfg(test)]
mod tests;
