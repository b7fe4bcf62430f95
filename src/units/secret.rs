//! Passwords in memory, protected against output.

use secrecy::{ExposeSecret as _, SecretString};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A password or passphrase. `Debug` never shows it, serde never writes it, and memory is wiped
/// when it is dropped.
#[derive(Debug, Clone)]
pub struct Secret(SecretString);

impl Secret {
    /// Takes the typed text out of its field and leaves the field empty.
    pub fn take(typed: &mut String) -> Self {
        Self(std::mem::take(typed).into())
    }

    /// Returns a secret with `text`.
    pub fn new(text: impl AsRef<str>) -> Self {
        Self(text.as_ref().into())
    }

    /// Returns the text in clear, only for the wire and the keyring.
    pub fn reveal(&self) -> &str {
        self.0.expose_secret()
    }

    pub fn inner(&self) -> &SecretString {
        &self.0
    }
}

impl From<SecretString> for Secret {
    fn from(secret: SecretString) -> Self {
        Self(secret)
    }
}

impl PartialEq for Secret {
    fn eq(&self, other: &Self) -> bool {
        self.0.expose_secret() == other.0.expose_secret()
    }
}

impl Eq for Secret {}

/// Writes nothing instead of the secret.
impl Serialize for Secret {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_none()
    }
}

/// Reads a secret that a client sends; a missing secret becomes empty.
impl<'de> Deserialize<'de> for Secret {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Option::<String>::deserialize(deserializer)
            .map(|text| Self(text.unwrap_or_default().into()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_secret_leaves_its_field_and_is_never_printed() {
        let mut typed = "hunter2".to_owned();
        let secret = Secret::take(&mut typed);
        assert!(typed.is_empty());
        assert!(!format!("{secret:?}").contains("hunter2"));
        assert_eq!(serde_json::to_string(&secret).unwrap(), "null");
        assert_eq!(serde_json::from_str::<Secret>("\"hunter2\"").unwrap(), secret);
        assert!(secret == Secret::new("hunter2") && secret != Secret::new("hunter3"));
    }
}
