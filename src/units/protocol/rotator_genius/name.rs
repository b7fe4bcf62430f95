//! Names of rotators: Latin-1 in fields of fixed length.

/// Max length of a name in a configuration (section 1.1), bytes. A status has room for 12.
pub const MAX_NAME_BYTES: usize = 10;

/// Reason why the protocol cannot carry a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NameProblem {
    #[error("is longer than {MAX_NAME_BYTES} characters")]
    TooLong,
    /// A character outside Latin-1, or one of its control characters.
    #[error("holds a character outside printable Latin-1")]
    NotPrintable,
    /// A blank at an end, which would become part of the padding of the field.
    #[error("begins or ends with a blank")]
    OuterBlank,
}

/// A name for a configuration; may be empty.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RotatorName(String);

impl RotatorName {
    /// Accepts at most [`MAX_NAME_BYTES`] printable characters of Latin-1 without a blank at
    /// either end.
    pub fn new(name: &str) -> Result<Self, NameProblem> {
        let is_printable = |c: char| u8::try_from(c).is_ok() && !c.is_control();
        if !name.chars().all(is_printable) {
            Err(NameProblem::NotPrintable)
        } else if name.chars().count() > MAX_NAME_BYTES {
            Err(NameProblem::TooLong)
        } else if name.starts_with(' ') || name.ends_with(' ') {
            Err(NameProblem::OuterBlank)
        } else {
            Ok(Self(name.to_owned()))
        }
    }

    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// Returns exactly [`MAX_NAME_BYTES`] bytes, padded with blanks.
    pub(super) fn bytes(&self) -> impl Iterator<Item = u8> {
        let blanks = std::iter::repeat(b' ');
        self.0.chars().filter_map(|c| u8::try_from(c).ok()).chain(blanks).take(MAX_NAME_BYTES)
    }
}

/// Returns the text of a name field without the blanks and zero bytes that pad its ends.
pub(super) fn from_field(field: &[u8]) -> String {
    // The document says "extended ASCII", so each byte is a character. UTF-8 would refuse some
    // bytes.
    let text: String = field.iter().map(|byte| char::from(*byte)).collect();
    text.trim_matches([' ', '\0']).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_carried_is_refused_with_the_reason() {
        for (name, problem) in [
            ("elevenchars", NameProblem::TooLong),
            ("Ka\u{131}s", NameProblem::NotPrintable),
            ("a\0", NameProblem::NotPrintable),
            ("a\u{85}", NameProblem::NotPrintable),
            (" a", NameProblem::OuterBlank),
            ("a ", NameProblem::OuterBlank),
        ] {
            assert_eq!(RotatorName::new(name), Err(problem), "{name:?}");
        }
    }

    #[test]
    fn a_name_fills_its_field_in_latin_1() {
        let bytes = |name| RotatorName::new(name).unwrap().bytes().collect::<Vec<_>>();
        assert_eq!(bytes("TOW1"), b"TOW1      ");
        assert_eq!(bytes(""), b"          ");
        assert_eq!(bytes("Ünten |h"), b"\xdcnten |h  ");
        assert_eq!(from_field(b"  \xdcnten\0 \0"), "Ünten");
    }
}
