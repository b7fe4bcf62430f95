//! The themes by name.

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ThemeName {
    /// The default, for the operations room.
    #[default]
    Dark,
    /// For bright rooms and projectors.
    Light,
    /// One red hue, for outdoor and observatory work.
    Night,
}

impl ThemeName {
    /// The next theme in the ring.
    #[must_use]
    pub fn next(self) -> Self {
        match self {
            Self::Dark => Self::Light,
            Self::Light => Self::Night,
            Self::Night => Self::Dark,
        }
    }
}
