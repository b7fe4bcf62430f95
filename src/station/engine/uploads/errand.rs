//! One attempt to upload a file to a unit, on its own thread: keyring, connection, host key,
//! log-in, upload and proof.

use std::{io, sync::Arc};

use tokio_util::sync::CancellationToken;

use super::Places;
use crate::{
    clock::Clock,
    contract::{
        transfer::{OldAlgorithm, Progress, Uploaded},
        uploads::{Cargo, Order},
    },
    engine::uploads::order::account,
    job::{Job, Wake},
    secret::Secret,
    transfer::{
        Account, ConnectError, Interruption, KeyFileProblem, Keyring as _, Login, Proof,
        SecretString, Transfer, Upload, UploadReason, check_host_key, is_factory_password,
        open_sftp, upload,
    },
};

pub(super) struct Errand {
    pub(super) order: Order,
    /// Secret that the operator typed.
    pub(super) secret: Option<Secret>,
}

/// Outcome of an attempt.
#[derive(Debug)]
pub(super) enum Outcome {
    /// The file is on the unit.
    Uploaded(Box<Uploaded>),
    /// The host's key differs from the known key, or no key is known.
    HostKey(ConnectError),
    /// The operator must type the secret.
    Secret {
        /// Reason why the unit refused the last secret.
        refused: Option<String>,
    },
    /// The operator cancelled; the text is the state of the unit.
    Cancelled(String),
    Failed(String),
}

/// Report of an attempt.
#[derive(Debug)]
pub(super) struct Report {
    pub(super) outcome: Outcome,
    /// `true` if the unit accepted the log-in.
    pub(super) is_logged_in: bool,
    /// `true` if the password is the factory password of every unit.
    pub(super) is_factory: bool,
    /// Reason why the keyring could not be read.
    pub(super) keyring_problem: Option<String>,
    /// Old algorithms of the connection.
    pub(super) old_algorithms: Vec<OldAlgorithm>,
}

impl Report {
    /// Returns the report of a failure before the first step.
    pub(super) fn failed(text: String) -> Self {
        Self {
            outcome: Outcome::Failed(text),
            is_logged_in: false,
            is_factory: false,
            keyring_problem: None,
            old_algorithms: Vec::new(),
        }
    }
}

pub(super) fn start(
    errand: Errand,
    places: &Places,
    clock: &Clock,
    wake: Wake,
) -> io::Result<Transfer<Report>> {
    let (places, clock) = (places.clone(), clock.clone());
    Transfer::start("azel-upload", wake, move |mut tell, cancel| {
        // Keyrings must be called outside the runtime.
        let (secret, keyring_problem) = find_secret(&errand, &places);
        async move {
            let (order, places) = (&errand.order, &places);
            let (is_logged_in, old_algorithms) = (false, Vec::new());
            let mut attempt = Attempt { order, places, is_logged_in, old_algorithms };
            let takes = errand.order.takes;
            let factory = |secret: &SecretString| is_factory_password(secret, takes);
            let is_factory =
                errand.order.key_file.is_none() && secret.as_ref().is_some_and(factory);
            let outcome = attempt.run(secret, &clock, &mut *tell, &cancel).await;
            let Attempt { is_logged_in, old_algorithms, .. } = attempt;
            Report { outcome, is_logged_in, is_factory, keyring_problem, old_algorithms }
        }
    })
}

/// Returns the typed secret, or else the one in the session's memory or the keyring.
fn find_secret(errand: &Errand, places: &Places) -> (Option<SecretString>, Option<String>) {
    if let Some(secret) = &errand.secret {
        return (Some(secret.inner().clone()), None);
    }
    let account = account(&errand.order);
    if let Ok(Some(secret)) = places.session.get(&account) {
        return (Some(secret), None);
    }
    match places.keyring.get(&account) {
        Ok(secret) => (secret, None),
        Err(error) => (None, Some(error.to_string())),
    }
}

struct Attempt<'a> {
    order: &'a Order,
    places: &'a Places,
    is_logged_in: bool,
    old_algorithms: Vec<OldAlgorithm>,
}

impl Attempt<'_> {
    async fn run(
        &mut self,
        secret: Option<SecretString>,
        clock: &Clock,
        tell: &mut dyn FnMut(Progress),
        cancel: &CancellationToken,
    ) -> Outcome {
        let (order, places) = (self.order, self.places);
        let elements = match &order.cargo {
            Cargo::New(file) => file.clone(),
            Cargo::Kept(kept_file) => match places.kept_files.read(kept_file) {
                Ok(file) => file,
                Err(error) => return Outcome::Failed(error.to_string()),
            },
        };
        let proof = match (&order.key_file, &secret) {
            (Some(path), passphrase) => {
                Proof::KeyFile { path: path.clone(), passphrase: passphrase.clone() }
            }
            (None, Some(password)) => Proof::Password(password.clone()),
            (None, None) => {
                // Check the host first: the operator must not type a password for a wrong host.
                let known_hosts = &places.known_hosts;
                return match check_host_key(&order.unit, known_hosts, places.limits, cancel).await {
                    Ok(old_algorithms) => {
                        self.old_algorithms = old_algorithms;
                        Outcome::Secret { refused: None }
                    }
                    Err(error) => self.refused(error),
                };
            }
        };
        let login = Login { user: order.user.clone(), proof };
        let (known_hosts, limits) = (&places.known_hosts, places.limits);
        let opened =
            open_sftp(&order.unit, &order.folder, &login, known_hosts, limits, cancel).await;
        let mut folder = match opened {
            Ok(folder) => folder,
            Err(error) => return self.refused(error),
        };
        self.is_logged_in = true;
        self.old_algorithms = folder.old_algorithms().to_vec();
        if let Some(secret) = &secret {
            // The keyring in memory never fails.
            let _ = places.session.set(&account(order), secret);
        }
        let request = Upload { unit: order.unit.clone(), file: order.file.clone(), elements };
        match upload(&mut folder, request, &places.kept_files, clock, tell, cancel).await {
            Ok(uploaded) => Outcome::Uploaded(Box::new(uploaded)),
            Err(error) if matches!(error.reason, UploadReason::Cancelled) => {
                Outcome::Cancelled(error.state.to_string())
            }
            Err(error) => Outcome::Failed(error.to_string()),
        }
    }

    fn refused(&self, error: ConnectError) -> Outcome {
        match &error {
            ConnectError::UnknownHostKey(_) | ConnectError::HostKeyChanged { .. } => {
                Outcome::HostKey(error)
            }
            ConnectError::LoginRefused { .. } if self.order.key_file.is_none() => {
                self.forget();
                Outcome::Secret { refused: Some(error.to_string()) }
            }
            ConnectError::KeyFile { problem: KeyFileProblem::Locked, .. } => {
                Outcome::Secret { refused: None }
            }
            ConnectError::KeyFile { problem: KeyFileProblem::WrongPassphrase, .. } => {
                self.forget();
                Outcome::Secret { refused: Some(error.to_string()) }
            }
            ConnectError::Interrupted { interruption: Interruption::Cancelled, .. } => {
                Outcome::Cancelled("nothing was changed on the unit".to_owned())
            }
            _ => Outcome::Failed(error.to_string()),
        }
    }

    fn forget(&self) {
        // The keyring in memory never fails.
        let _ = self.places.session.remove(&account(self.order));
    }
}

/// Saves `secret` in the keyring. The job's result is the reason of a failure.
pub(super) fn keep_secret(
    places: &Places,
    account: Account,
    secret: Secret,
    wake: Wake,
) -> Job<Result<(), String>> {
    let keyring = Arc::clone(&places.keyring);
    Job::start("azel-keyring", wake, move |_| {
        keyring.set(&account, secret.inner()).map_err(|error| error.to_string())
    })
}
