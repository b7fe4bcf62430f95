//! Log-in on another computer.

use std::path::PathBuf;

use secrecy::{ExposeSecret as _, SecretString};

use crate::{contract::transfer::FileHash, device::ElementFiles};

/// User with the proof of identity. `Debug` shows no secret.
#[derive(Debug, Clone)]
pub struct Login {
    /// Name of the user on the host.
    pub user: String,
    pub proof: Proof,
}

/// Proof of a user's identity.
#[derive(Debug, Clone)]
pub enum Proof {
    Password(SecretString),
    KeyFile {
        /// Key file in OpenSSH's form or PEM.
        path: PathBuf,
        /// Passphrase of the key file, if it has one.
        passphrase: Option<SecretString>,
    },
}

/// Returns `true` if `password` is the factory password of every unit of a make. The user should
/// then change it.
pub fn is_factory_password(password: &SecretString, element_files: &ElementFiles) -> bool {
    let salted =
        SecretString::from(format!("{}:{}", element_files.factory_user, password.expose_secret()));
    FileHash::new(salted.expose_secret().as_bytes()).to_string() == element_files.factory_digest
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
