//! Texts that fit between commas. The protocol has no escape, so Azel refuses a text that it cannot
//! carry.

use std::fmt;

use super::ValueError;

/// Max length of a text, bytes: five such texts still fit in a line.
const MAX_TEXT_BYTES: usize = 180;
/// Max length of a web address, bytes.
const MAX_URL_BYTES: usize = 400;

/// Reason why the protocol cannot carry a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum TextProblem {
    #[error("is empty")]
    Empty,
    /// A text longer than 180 bytes, or a web address longer than 400.
    #[error("is too long")]
    TooLong,
    /// A comma, which separates values.
    #[error("holds a comma")]
    Comma,
    /// A `$` or `*`, which frame the message.
    #[error("holds a dollar sign or a star")]
    FrameSign,
    #[error("holds a character outside printable ASCII")]
    NotPrintable,
    /// A blank at an end, which the unit removes by unknown rules.
    #[error("begins or ends with a blank")]
    OuterBlank,
    /// A lone `?`, which means "keep the value".
    #[error("is a single question mark")]
    KeepSign,
}

fn check(text: &str, max_bytes: usize) -> Result<(), TextProblem> {
    let problem = [
        (text.is_empty(), TextProblem::Empty),
        (text.len() > max_bytes, TextProblem::TooLong),
        (text.bytes().any(|byte| !(0x20..0x7f).contains(&byte)), TextProblem::NotPrintable),
        (text.contains(','), TextProblem::Comma),
        (text.contains(['$', '*']), TextProblem::FrameSign),
        (text.trim() != text, TextProblem::OuterBlank),
        (text == "?", TextProblem::KeepSign),
    ]
    .into_iter()
    .find_map(|(wrong, problem)| wrong.then_some(problem));
    problem.map_or(Ok(()), Err)
}

/// A text that the protocol can carry as one value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TextValue(String);

impl TextValue {
    /// Checks `text`. The error contains `name`.
    pub fn new(name: &'static str, text: &str) -> Result<Self, ValueError> {
        check(text, MAX_TEXT_BYTES).map_err(|problem| ValueError::Text { name, problem })?;
        Ok(Self(text.to_owned()))
    }

    pub fn as_str(&self) -> &str {
        &self.0
    }
}

/// A web address with percent-encoded commas.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UrlValue(String);

impl UrlValue {
    /// Takes `url` as typed, and encodes its commas.
    pub fn new(url: &str) -> Result<Self, ValueError> {
        // A comma would end the value. A server accepts the percent form of the same address.
        let url = url.replace(',', "%2C");
        let name = "web address";
        check(&url, MAX_URL_BYTES).map_err(|problem| ValueError::Text { name, problem })?;
        Ok(Self(url))
    }

    /// Returns the address as Azel sends it.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

/// A password. Neither `Debug` nor other code prints it, but the unit returns it in clear.
#[derive(Clone, PartialEq, Eq)]
pub struct Password(String);

impl Password {
    pub fn new(text: &str) -> Result<Self, ValueError> {
        let name = "password";
        check(text, MAX_TEXT_BYTES).map_err(|problem| ValueError::Text { name, problem })?;
        Ok(Self(text.to_owned()))
    }

    /// Returns a password as a unit reported it.
    pub(super) fn reported(text: &str) -> Self {
        // The password is unchecked, because a unit may hold a password that Azel could not send.
        Self(text.to_owned())
    }

    /// Returns the password in clear. Never log it.
    pub fn reveal(&self) -> &str {
        &self.0
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

impl fmt::Debug for Password {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Password")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_carried_is_refused_with_the_reason() {
        for (text, problem) in [
            ("", TextProblem::Empty),
            ("a,b", TextProblem::Comma),
            ("a*b", TextProblem::FrameSign),
            ("$", TextProblem::FrameSign),
            ("a\r\n", TextProblem::NotPrintable),
            ("\u{130}stanbul", TextProblem::NotPrintable),
            (" a", TextProblem::OuterBlank),
            ("?", TextProblem::KeepSign),
        ] {
            let refused = ValueError::Text { name: "name", problem };
            assert_eq!(TextValue::new("name", text), Err(refused), "{text:?}");
        }
        assert!(TextValue::new("name", "IRIDIUM 70 [+]").is_ok());
        assert!(TextValue::new("name", "what?").is_ok());
        assert!(TextValue::new("name", &"x".repeat(181)).is_err());
    }

    #[test]
    fn a_password_is_never_printed() {
        let password = Password::new("hunter2").unwrap();
        assert!(!format!("{password:?}").contains("hunter2"));
        let error = Password::new("hunter2,x").unwrap_err();
        assert!(!format!("{error} {error:?}").contains("hunter2"));
    }

    #[test]
    fn commas_of_an_address_are_encoded() {
        assert_eq!(UrlValue::new("https://x/a,b").unwrap().as_str(), "https://x/a%2Cb");
        assert!(UrlValue::new("https://x/a b*").is_err());
    }
}
