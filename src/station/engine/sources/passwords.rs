//! Passwords for log-ins at element servers.

use std::{
    sync::{Arc, Mutex, PoisonError},
    time::Duration,
};

use crate::{
    contract::sources::{SPACE_TRACK_HOST, log_in_key},
    engine::uploads,
    library::PasswordStore,
    orbit::FetchProblem,
    secret::Secret,
    transfer::{Account, Keyring as _, KeyringError, MemoryKeyring, TimedKeyring},
};

/// Timeout for the keyring. A locked keyring may ask the operator, who may be away.
const KEYRING_LIMIT: Duration = Duration::from_secs(20);

/// Passwords for log-ins: typed since Azel's start, and stored in the keyring.
#[derive(Debug, Clone)]
pub(in crate::engine) struct Passwords {
    keyring: TimedKeyring,
    session: Arc<MemoryKeyring>,
    /// Typed passwords for the keyring, until the server accepts them.
    unproved: Arc<MemoryKeyring>,
    /// Problems with the keyring.
    problems: Arc<Mutex<Vec<String>>>,
}

impl Passwords {
    pub(in crate::engine) fn new(places: &uploads::Places) -> Self {
        let keyring = TimedKeyring::new(Arc::clone(&places.keyring), KEYRING_LIMIT);
        Self::with_keyring(keyring, Arc::clone(&places.session))
    }

    pub(super) fn with_keyring(keyring: TimedKeyring, session: Arc<MemoryKeyring>) -> Self {
        Self { keyring, session, unproved: Arc::default(), problems: Arc::default() }
    }

    /// Uses a typed password from now on. If the operator wants it, the keyring stores the password
    /// after the server has accepted it.
    pub(in crate::engine) fn take(&self, user: &str, secret: &Secret, is_kept: bool) {
        let account = account(user);
        // Keyrings in memory never fail.
        let _ = self.session.set(&account, secret.inner());
        let _ = if is_kept {
            self.unproved.set(&account, secret.inner())
        } else {
            self.unproved.remove(&account)
        };
    }

    /// Removes the password of `user`, also from the keyring.
    pub(super) fn forget(&self, user: &str) {
        let account = account(user);
        let _ = self.session.remove(&account);
        let _ = self.unproved.remove(&account);
        match self.keyring.remove(account) {
            // Without a keyring, there is nothing to remove.
            Ok(()) | Err(KeyringError::Missing(_)) => {}
            Err(error) => self.add_problem(format!("the password stays in the keyring: {error}")),
        }
    }

    fn add_problem(&self, problem: String) {
        self.problems.lock().unwrap_or_else(PoisonError::into_inner).push(problem);
    }

    pub(super) fn take_problems(&self) -> Vec<String> {
        std::mem::take(&mut self.problems.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// Returns `true` if `keyring` has this password.
fn has(keyring: &MemoryKeyring, account: &Account, password: &Secret) -> bool {
    let stored = keyring.get(account).ok().flatten();
    stored.is_some_and(|stored| Secret::from(stored) == *password)
}

impl PasswordStore for Passwords {
    fn get(&self, user: &str) -> Result<Secret, FetchProblem> {
        let account = account(user);
        if let Ok(Some(secret)) = self.session.get(&account) {
            return Ok(secret.into());
        }
        match self.keyring.get(account) {
            Ok(Some(secret)) => Ok(secret.into()),
            Ok(None) => Err(FetchProblem::NoPassword),
            Err(error) => Err(FetchProblem::Keyring(error.to_string())),
        }
    }

    fn accepted(&self, user: &str, password: &Secret) {
        let account = account(user);
        if !has(&self.unproved, &account, password) {
            return;
        }
        let _ = self.unproved.remove(&account);
        if let Err(error) = self.keyring.set(account, password.inner().clone()) {
            self.add_problem(format!("the password is not kept: {error}"));
        }
    }

    /// Removes a refused password, but keeps another one that the operator has typed since.
    fn refused(&self, user: &str, password: &Secret) {
        let account = account(user);
        for keyring in [&self.session, &self.unproved] {
            if has(keyring, &account, password) {
                let _ = keyring.remove(&account);
            }
        }
    }
}

/// Returns the account of a log-in name at Space-Track.
pub(super) fn account(user: &str) -> Account {
    Account { user: log_in_key(user), address: format!("{SPACE_TRACK_HOST}:443") }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::transfer::Keyring;

    pub(in crate::engine::sources) fn passwords(keyring: Arc<dyn Keyring>) -> Passwords {
        let keyring = TimedKeyring::new(keyring, Duration::from_millis(50));
        Passwords::with_keyring(keyring, Arc::default())
    }

    #[test]
    fn a_typed_password_is_used_and_kept_once_the_server_accepts_it() {
        for is_kept in [false, true] {
            let keyring = Arc::new(MemoryKeyring::default());
            let passwords = passwords(Arc::clone(&keyring) as Arc<dyn Keyring>);
            let stored = || keyring.get(&account("op")).unwrap().map(Secret::from);
            assert_eq!(passwords.get("op"), Err(FetchProblem::NoPassword));
            let secret = Secret::new("hunter2");
            passwords.take(" OP", &secret, is_kept);
            assert_eq!(passwords.get("op"), Ok(secret.clone()));
            assert_eq!(passwords.get("other"), Err(FetchProblem::NoPassword));
            assert_eq!(stored(), None, "the server has not accepted it");
            passwords.accepted("op", &secret);
            assert_eq!(stored(), Some(secret.clone()).filter(|_| is_kept));
            assert!(!format!("{passwords:?}").contains("hunter2"));
        }
    }

    #[test]
    fn a_refused_password_is_dropped_and_replaces_no_kept_one() {
        let keyring = Arc::new(MemoryKeyring::default());
        let passwords = passwords(Arc::clone(&keyring) as Arc<dyn Keyring>);
        let [secret, wrong, newer] = ["kept", "wrong", "newer"].map(Secret::new);
        keyring.set(&account("op"), secret.inner()).unwrap();
        passwords.take("op", &wrong, true);
        passwords.refused("op", &wrong);
        passwords.accepted("op", &wrong);
        assert_eq!(passwords.get("op"), Ok(secret.clone()), "a kept password outlasts a wrong one");
        passwords.take("op", &newer, false);
        passwords.refused("op", &secret);
        assert_eq!(passwords.get("op"), Ok(newer), "typed since");
    }
}
