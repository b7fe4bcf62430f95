//! Who logs in, and how.

use std::path::PathBuf;

use secrecy::{ExposeSecret as _, SecretString};

use super::FileHash;

/// The user that every Satrak has from its maker, offered as a first choice.
pub const FACTORY_USER: &str = "sftpsatr";

/// Where every Satrak looks for files of elements, by its protocol document.
pub const UNIT_FOLDER: &str = "/svs/satrak/tle";

/// SHA-256 of the password that every Satrak has from its maker, after
/// [`FACTORY_USER`] and a colon. It is known to whoever has the document of the
/// protocol, so its use is worth a warning.
const FACTORY_DIGEST: &str = "1cbcd885a8bcd187c65f4bbefba29967dd520511f5887bd5f4ae1011ebca100c";

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
    /// A password.
    Password(SecretString),
    /// A private key in a file.
    KeyFile {
        /// In OpenSSH's form, or PEM.
        path: PathBuf,
        /// What the file is locked with, if it is.
        passphrase: Option<SecretString>,
    },
}

/// Whether `password` is the one that every Satrak has from its maker. Whoever
/// uses it should be told to change it.
pub fn is_factory_password(password: &SecretString) -> bool {
    let salted = SecretString::from(format!("{FACTORY_USER}:{}", password.expose_secret()));
    FileHash::of(salted.expose_secret().as_bytes()).to_string() == FACTORY_DIGEST
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_one_password_is_the_factory_s() {
        assert!(!is_factory_password(&"".into()));
        assert!(!is_factory_password(&FACTORY_USER.into()));
        assert_eq!(FACTORY_DIGEST.len(), 64);
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
