//! Passwords at rest, only ever in the keyring of the operating system.

use std::{
    collections::BTreeMap,
    fmt,
    sync::{Mutex, PoisonError},
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
    /// Host and port.
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
    /// No keyring runs or can be reached: the operator is asked each time.
    #[error("there is no keyring on this computer ({0})")]
    Missing(String),
    /// The keyring refused, for instance because it is locked.
    #[error("the keyring refused ({0}); unlock it, or type the password")]
    Refused(String),
}

/// Store of passwords. Calls may wait for the operator to unlock it: make them on a worker
/// thread outside any runtime.
pub trait Keyring: Send + Sync {
    /// Secret of `account`, if one is stored.
    fn get(&self, account: &Account) -> Result<Option<SecretString>, KeyringError>;
    /// Stores the secret of `account` in place of the previous one.
    fn set(&self, account: &Account, secret: &SecretString) -> Result<(), KeyringError>;
    /// Removes the secret of `account`, if one is stored.
    fn remove(&self, account: &Account) -> Result<(), KeyringError>;
}

/// Keyring of the operating system: Secret Service, Keychain or Credential Manager.
#[derive(Debug, Clone, Copy, Default)]
pub struct SystemKeyring;

impl SystemKeyring {
    fn entry(account: &Account) -> Result<keyring::v1::Entry, KeyringError> {
        keyring::v1::Entry::new(SERVICE, &account.to_string()).map_err(|error| told(&error))
    }
}

impl Keyring for SystemKeyring {
    fn get(&self, account: &Account) -> Result<Option<SecretString>, KeyringError> {
        match Self::entry(account)?.get_password() {
            Ok(secret) => Ok(Some(secret.into())),
            Err(Error::NoEntry) => Ok(None),
            Err(error) => Err(told(&error)),
        }
    }

    fn set(&self, account: &Account, secret: &SecretString) -> Result<(), KeyringError> {
        Self::entry(account)?.set_password(secret.expose_secret()).map_err(|error| told(&error))
    }

    fn remove(&self, account: &Account) -> Result<(), KeyringError> {
        match Self::entry(account)?.delete_credential() {
            Ok(()) | Err(Error::NoEntry) => Ok(()),
            Err(error) => Err(told(&error)),
        }
    }
}

/// Azel's own words: some errors carry the secret that could not be decoded.
fn told(error: &Error) -> KeyringError {
    match error {
        Error::PlatformFailure(cause) => KeyringError::Missing(cause.to_string()),
        Error::NoDefaultStore => KeyringError::Missing("none answers".to_owned()),
        Error::NoStorageAccess(cause) => KeyringError::Refused(cause.to_string()),
        Error::BadEncoding(_) | Error::BadDataFormat(..) => {
            KeyringError::Refused("the entry is not text".to_owned())
        }
        Error::Ambiguous(_) => KeyringError::Refused("there are several entries".to_owned()),
        Error::TooLong(what, most) => {
            KeyringError::Refused(format!("{what} is longer than {most} characters"))
        }
        _ => KeyringError::Refused("the entry cannot be used".to_owned()),
    }
}

/// A keyring that lasts as long as the program: for a session without another one, and for
/// tests.
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

    #[test]
    fn errors_carry_no_secret() {
        let error = told(&Error::BadEncoding(b"hunter2".to_vec()));
        assert!(matches!(error, KeyringError::Refused(_)));
        assert!(
            !format!("{error} {error:?}").contains("hunter")
                && !format!("{error:?}").contains("104")
        );
    }
}
