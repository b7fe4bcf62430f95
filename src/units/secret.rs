//! Passwords, wherever they are on their way.

use secrecy::{ExposeSecret as _, SecretString};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A password or passphrase. Never shown by `Debug`, never written down by serde, wiped when
/// dropped.
#[derive(Debug, Clone)]
pub struct Secret(SecretString);

impl Secret {
    /// Takes what was typed out of its field, which is empty afterwards.
    pub fn take(typed: &mut String) -> Self {
        Self(std::mem::take(typed).into())
    }

    /// Hides `text`.
    pub fn new(text: impl AsRef<str>) -> Self {
        Self(text.as_ref().into())
    }

    /// The text itself. For the wire and the keyring only.
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

/// Leaves the secret out.
impl Serialize for Secret {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_none()
    }
}

/// Reads a secret that a client sends; one that was left out is empty.
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
