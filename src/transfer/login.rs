//! Who logs in, and how.

use std::path::PathBuf;

use secrecy::{ExposeSecret as _, SecretString};

use super::FileHash;
use crate::device::ElementFiles;

/// Who logs in. `Debug` shows no secret.
#[derive(Debug, Clone)]
pub struct Login {
    /// The name on the host.
    pub user: String,
    /// What proves it.
    pub proof: Proof,
}

/// What proves who logs in.
#[derive(Debug, Clone)]
pub enum Proof {
    Password(SecretString),
    /// A private key in a file.
    KeyFile {
        /// In OpenSSH's form, or PEM.
        path: PathBuf,
        /// What the file is locked with, if it is.
        passphrase: Option<SecretString>,
    },
}

/// Whether `password` is the one that every unit of a make has from its maker. Whoever
/// uses it should be told to change it.
pub fn is_factory_password(password: &SecretString, of: &ElementFiles) -> bool {
    let salted = SecretString::from(format!("{}:{}", of.factory_user, password.expose_secret()));
    FileHash::of(salted.expose_secret().as_bytes()).to_string() == of.factory_digest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::controller::satrak::ELEMENT_FILES;

    #[test]
    fn only_one_password_is_the_factory_s() {
        assert!(!is_factory_password(&"".into(), &ELEMENT_FILES));
        assert!(!is_factory_password(&ELEMENT_FILES.factory_user.into(), &ELEMENT_FILES));
        assert_eq!(ELEMENT_FILES.factory_digest.len(), 64);
    }

    #[test]
    fn a_log_in_shows_no_secret() {
        let password =
            Login { user: "op".to_owned(), proof: Proof::Password("hunter2-password".into()) };
        let key = Proof::KeyFile {
            path: "/home/op/key".into(),
            passphrase: Some("hunter2-passphrase".into()),
        };
        for shown in [format!("{password:?}"), format!("{password:#?}"), format!("{key:?}")] {
            assert!(!shown.contains("hunter2"), "{shown}");
        }
    }
}
