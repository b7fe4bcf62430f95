//! Stored passwords, only in the keyring of the operating system.

use std::{
    collections::BTreeMap,
    fmt,
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
        mpsc,
    },
    thread,
    time::Duration,
};

use keyring::Error;
use secrecy::{ExposeSecret as _, SecretString};

/// Service name of the entries in a keyring.
const SERVICE: &str = "azel";

/// Owner of a secret.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Account {
    /// User on the host, or path of a key file.
    pub user: String,
    /// Host with its port.
    pub address: String,
}

impl fmt::Display for Account {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}@{}", self.user, self.address)
    }
}

/// Reason why a keyring failed.
#[derive(Debug, thiserror::Error)]
pub enum KeyringError {
    /// No keyring can be reached: the operator must type the password each time.
    #[error("there is no keyring on this computer ({0})")]
    Missing(String),
    /// The keyring refused, for instance because it is locked.
    #[error("the keyring refused ({0}); unlock it, or type the password")]
    Refused(String),
    /// The keyring waits for the operator to unlock it.
    #[error("the keyring does not answer; unlock it, or type the password")]
    NoAnswer,
}

/// Store of passwords. Calls may wait for the operator to unlock the store: make them on a worker
/// thread outside any runtime.
pub trait Keyring: Send + Sync {
    /// Returns the secret of `account`, if one is stored.
    fn get(&self, account: &Account) -> Result<Option<SecretString>, KeyringError>;
    /// Stores the secret of `account` in place of the previous one.
    fn set(&self, account: &Account, secret: &SecretString) -> Result<(), KeyringError>;
    /// Removes the secret of `account`, if one is stored.
    fn remove(&self, account: &Account) -> Result<(), KeyringError>;
}

/// Keyring behind a timeout, called on its own thread, so that a locked keyring blocks nobody. At
/// most one thread waits for the keyring at a time.
#[derive(Clone)]
pub struct TimedKeyring {
    keyring: Arc<dyn Keyring>,
    is_asked: Arc<AtomicBool>,
    limit: Duration,
}

impl TimedKeyring {
    pub fn new(keyring: Arc<dyn Keyring>, limit: Duration) -> Self {
        Self { keyring, is_asked: Arc::default(), limit }
    }

    /// Returns the secret of `account`, if one is stored.
    pub fn get(&self, account: Account) -> Result<Option<SecretString>, KeyringError> {
        self.ask(move |keyring| keyring.get(&account))
    }

    /// Stores the secret of `account` in place of the previous one.
    pub fn set(&self, account: Account, secret: SecretString) -> Result<(), KeyringError> {
        self.ask(move |keyring| keyring.set(&account, &secret))
    }

    /// Removes the secret of `account`, if one is stored.
    pub fn remove(&self, account: Account) -> Result<(), KeyringError> {
        self.ask(move |keyring| keyring.remove(&account))
    }

    fn ask<T: Send + 'static>(
        &self,
        question: impl FnOnce(&dyn Keyring) -> Result<T, KeyringError> + Send + 'static,
    ) -> Result<T, KeyringError> {
        if self.is_asked.swap(true, Ordering::AcqRel) {
            return Err(KeyringError::NoAnswer);
        }
        let (keyring, is_asked) =
            (Arc::clone(&self.keyring), AskedMark(Arc::clone(&self.is_asked)));
        let (send, answer) = mpsc::sync_channel(1);
        let ask = move || {
            let answer = question(&*keyring);
            drop(is_asked);
            // After the timeout, the receiver is gone.
            let _ = send.send(answer);
        };
        let started = thread::Builder::new().name("azel-keyring".to_owned()).spawn(ask);
        started.map_err(|error| KeyringError::Missing(error.to_string()))?;
        answer.recv_timeout(self.limit).unwrap_or(Err(KeyringError::NoAnswer))
    }
}

impl fmt::Debug for TimedKeyring {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("TimedKeyring").field("limit", &self.limit).finish_non_exhaustive()
    }
}

/// Guard that clears the mark when the keyring has answered or its thread has ended.
struct AskedMark(Arc<AtomicBool>);

impl Drop for AskedMark {
    fn drop(&mut self) {
        self.0.store(false, Ordering::Release);
    }
}

/// Keyring of the operating system: Secret Service, Keychain or Credential Manager.
#[derive(Debug, Clone, Copy, Default)]
pub struct SystemKeyring;

impl SystemKeyring {
    fn entry(account: &Account) -> Result<keyring::v1::Entry, KeyringError> {
        keyring::v1::Entry::new(SERVICE, &account.to_string())
            .map_err(|error| keyring_error(&error))
    }
}

impl Keyring for SystemKeyring {
    fn get(&self, account: &Account) -> Result<Option<SecretString>, KeyringError> {
        match Self::entry(account)?.get_password() {
            Ok(secret) => Ok(Some(secret.into())),
            Err(Error::NoEntry) => Ok(None),
            Err(error) => Err(keyring_error(&error)),
        }
    }

    fn set(&self, account: &Account, secret: &SecretString) -> Result<(), KeyringError> {
        Self::entry(account)?
            .set_password(secret.expose_secret())
            .map_err(|error| keyring_error(&error))
    }

    fn remove(&self, account: &Account) -> Result<(), KeyringError> {
        match Self::entry(account)?.delete_credential() {
            Ok(()) | Err(Error::NoEntry) => Ok(()),
            Err(error) => Err(keyring_error(&error)),
        }
    }
}

/// Converts an error to Azel's own words: some errors contain the secret that could not be decoded.
fn keyring_error(error: &Error) -> KeyringError {
    match error {
        Error::PlatformFailure(cause) => KeyringError::Missing(cause.to_string()),
        Error::NoDefaultStore => KeyringError::Missing("none answers".to_owned()),
        Error::NoStorageAccess(cause) => KeyringError::Refused(cause.to_string()),
        Error::BadEncoding(_) | Error::BadDataFormat(..) => {
            KeyringError::Refused("the entry is not text".to_owned())
        }
        Error::Ambiguous(_) => KeyringError::Refused("there are several entries".to_owned()),
        Error::TooLong(subject, max) => {
            KeyringError::Refused(format!("{subject} is longer than {max} characters"))
        }
        _ => KeyringError::Refused("the entry cannot be used".to_owned()),
    }
}

/// Keyring that lasts until the program ends, for computers without another keyring and for tests.
#[derive(Debug, Default)]
pub struct MemoryKeyring {
    secrets: Mutex<BTreeMap<Account, SecretString>>,
}

impl Keyring for MemoryKeyring {
    fn get(&self, account: &Account) -> Result<Option<SecretString>, KeyringError> {
        let secrets = self.secrets.lock().unwrap_or_else(PoisonError::into_inner);
        Ok(secrets.get(account).cloned())
    }

    fn set(&self, account: &Account, secret: &SecretString) -> Result<(), KeyringError> {
        let mut secrets = self.secrets.lock().unwrap_or_else(PoisonError::into_inner);
        secrets.insert(account.clone(), secret.clone());
        Ok(())
    }

    fn remove(&self, account: &Account) -> Result<(), KeyringError> {
        self.secrets.lock().unwrap_or_else(PoisonError::into_inner).remove(account);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_keyring_gives_back_what_it_was_given_and_shows_nothing() {
        let keyring = MemoryKeyring::default();
        let account = Account { user: "op".to_owned(), address: "unit:22".to_owned() };
        assert!(keyring.get(&account).unwrap().is_none());
        keyring.set(&account, &"hunter1".into()).unwrap();
        keyring.set(&account, &"hunter2".into()).unwrap();
        assert_eq!(keyring.get(&account).unwrap().unwrap().expose_secret(), "hunter2");
        assert!(!format!("{keyring:?}").contains("hunter"));
        let other = Account { user: "root".to_owned(), ..account.clone() };
        assert!(keyring.get(&other).unwrap().is_none());
        keyring.remove(&account).unwrap();
        keyring.remove(&account).unwrap();
        assert!(keyring.get(&account).unwrap().is_none());
    }

    /// Keyring that answers once its lock is free.
    struct LockedKeyring(Arc<Mutex<()>>);

    impl Keyring for LockedKeyring {
        fn get(&self, _: &Account) -> Result<Option<SecretString>, KeyringError> {
            drop(self.0.lock());
            Ok(Some("hunter2".into()))
        }

        fn set(&self, _: &Account, _: &SecretString) -> Result<(), KeyringError> {
            drop(self.0.lock());
            Ok(())
        }

        fn remove(&self, _: &Account) -> Result<(), KeyringError> {
            Ok(())
        }
    }

    #[test]
    fn a_locked_keyring_blocks_nobody_and_gets_one_thread() {
        let lock = Arc::new(Mutex::new(()));
        let locked = lock.lock().unwrap();
        let keyring = TimedKeyring::new(
            Arc::new(LockedKeyring(Arc::clone(&lock))),
            Duration::from_millis(50),
        );
        let account = Account { user: "op".to_owned(), address: "server:443".to_owned() };
        for _ in 0..3 {
            let answer = keyring.get(account.clone());
            assert!(matches!(answer, Err(KeyringError::NoAnswer)));
        }
        // The keyring and the one waiting thread hold the mark.
        assert_eq!(Arc::strong_count(&keyring.is_asked), 2);
        drop(locked);
        let waits = |keyring: &TimedKeyring| keyring.is_asked.load(Ordering::Acquire);
        for _ in 0..1000 {
            if !waits(&keyring) {
                break;
            }
            thread::sleep(Duration::from_millis(5));
        }
        let patient = TimedKeyring { limit: Duration::from_mins(1), ..keyring };
        assert_eq!(patient.get(account).unwrap().unwrap().expose_secret(), "hunter2");
    }

    #[test]
    fn errors_carry_no_secret() {
        let error = keyring_error(&Error::BadEncoding(b"hunter2".to_vec()));
        assert!(matches!(error, KeyringError::Refused(_)));
        assert!(
            !format!("{error} {error:?}").contains("hunter")
                && !format!("{error:?}").contains("104")
        );
    }
}
