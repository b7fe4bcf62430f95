//! Names of stored satellites.

use std::fmt;

/// Length of the field on the line, bytes.
pub(super) const NAME_BYTES: usize = 10;

/// Reason why a name cannot be sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NameError {
    #[error("the name has more than {NAME_BYTES} characters")]
    TooLong,
    /// A character other than an upper-case letter, digit or ASCII sign.
    #[error("the name has a character other than A to Z, 0 to 9 and ASCII signs: {0:?}")]
    Character(char),
    #[error("the name is empty")]
    Empty,
}

/// Name of a stored satellite: ten characters of printable ASCII. It must match the stored name
/// exactly, so it keeps its leading blanks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SatelliteName([u8; NAME_BYTES]);

impl SatelliteName {
    /// Field without a name.
    pub const BLANK: Self = Self([b' '; NAME_BYTES]);

    /// Returns a name of 1 to 10 characters: upper-case letters, digits and ASCII signs, padded
    /// with trailing blanks.
    pub fn new(name: &str) -> Result<Self, NameError> {
        let mut field = [b' '; NAME_BYTES];
        let mut places = field.iter_mut();
        for character in name.chars() {
            let byte = u8::try_from(character)
                .ok()
                // Units store upper case, and a name must match the stored one (appendix E).
                .filter(|byte| (b' '..0x7f).contains(byte) && !byte.is_ascii_lowercase())
                .ok_or(NameError::Character(character))?;
            *places.next().ok_or(NameError::TooLong)? = byte;
        }
        if name.trim().is_empty() { Err(NameError::Empty) } else { Ok(Self(field)) }
    }

    /// Returns the name in a field of a frame, with any characters.
    pub(super) fn from_field(field: &[u8]) -> Option<Self> {
        // The characters are unchecked: a listed name must go back to the unit unchanged.
        field.try_into().ok().map(Self)
    }

    /// Returns the field of a frame.
    pub(super) const fn field(&self) -> &[u8; NAME_BYTES] {
        &self.0
    }

    /// Returns the name without its trailing blanks.
    pub fn as_str(&self) -> &str {
        std::str::from_utf8(&self.0).unwrap_or_default().trim_end_matches(' ')
    }

    pub fn is_blank(&self) -> bool {
        *self == Self::BLANK
    }

    /// Returns `true` if the name is ten digits, which a unit reads as a position.
    pub(super) fn is_all_digits(&self) -> bool {
        self.0.iter().all(u8::is_ascii_digit)
    }
}

impl fmt::Display for SatelliteName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_padded_and_their_left_blanks_kept() {
        assert_eq!(SatelliteName::new("SBS 6").unwrap().field(), b"SBS 6     ");
        assert_eq!(SatelliteName::new(" A").unwrap().as_str(), " A");
    }

    #[test]
    fn what_no_controller_stores_is_refused() {
        assert_eq!(SatelliteName::new("  "), Err(NameError::Empty));
        assert_eq!(SatelliteName::new("ELEVEN CHAR"), Err(NameError::TooLong));
        assert_eq!(SatelliteName::new("sbs 6"), Err(NameError::Character('s')));
        for bad in ["\u{7f}", "A\u{3}", "\u{c9}"] {
            assert!(matches!(SatelliteName::new(bad), Err(NameError::Character(_))), "{bad:?}");
        }
    }
}
