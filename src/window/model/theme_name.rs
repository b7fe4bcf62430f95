//! Names of the themes.

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ThemeName {
    /// Dark theme for the operations room, the default.
    #[default]
    Dark,
    /// Light theme for bright rooms and projectors.
    Light,
    /// Theme in one red hue, for outdoor and observatory work.
    Night,
}

impl ThemeName {
    /// Returns the next theme in the cycle.
    #[must_use]
    pub fn next(self) -> Self {
        match self {
            Self::Dark => Self::Light,
            Self::Light => Self::Night,
            Self::Night => Self::Dark,
        }
    }
}
