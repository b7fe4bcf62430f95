//! Unencoded answers, whose form quirks can change.

use std::collections::BTreeSet;

use jiff::Timestamp;
use jiff::tz::TimeZone;

use super::Quirk;
use crate::protocol::satrak::{RequestError, Verb, Word};

/// Codes in refusals. The document announces codes but lists none, so these codes are the
/// simulator's own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ErrorCode {
    /// The word is unknown, or not valid with this sign.
    Unknown = 1,
    /// Wrong number of values.
    Count = 2,
    /// A value cannot be read or is invalid.
    Value = 3,
    /// The antenna cannot reach the direction.
    OutOfReach = 4,
    /// A precondition of the request is missing: GPS lock, satellite or window.
    NotReady = 5,
    /// A fault forbids the request.
    Fault = 6,
    /// The unit accepts no setting.
    Refused = 7,
}

impl From<RequestError> for ErrorCode {
    fn from(error: RequestError) -> Self {
        match error {
            RequestError::Unknown => Self::Unknown,
            RequestError::Count { .. } => Self::Count,
            RequestError::Value(_) | RequestError::Field(_) => Self::Value,
        }
    }
}

/// Value in an answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Value {
    /// Text that is sent unchanged.
    Text(String),
    /// Number with a decimal point.
    Decimal(String),
}

impl Value {
    #[allow(clippy::needless_pass_by_value, reason = "numbers and references, all small")]
    pub(super) fn text(text: impl ToString) -> Self {
        Self::Text(text.to_string())
    }

    pub(super) fn flag(flag: bool) -> Self {
        Self::text(u8::from(flag))
    }

    /// Returns a number with a fixed count of decimals.
    pub(super) fn fixed(value: f64, decimals: usize) -> Self {
        let text = format!("{value:.decimals$}");
        let is_minus_zero = text.starts_with('-') && !text.contains(|c| ('1'..='9').contains(&c));
        Self::Decimal(if is_minus_zero { text.replacen('-', "", 1) } else { text })
    }

    /// Returns a number with one to three decimals, as many as needed.
    pub(super) fn decimal(value: f64) -> Self {
        let (Self::Decimal(text) | Self::Text(text)) = Self::fixed(value, 3);
        let trimmed = text.strip_suffix("00").or(text.strip_suffix('0')).unwrap_or(&text);
        Self::Decimal(trimmed.to_owned())
    }

    /// Returns hour, minute, second, day, month and year.
    pub(super) fn time(time: Timestamp) -> Vec<Self> {
        let civil = TimeZone::UTC.to_datetime(time);
        [civil.hour(), civil.minute(), civil.second(), civil.day(), civil.month()]
            .map(i16::from)
            .into_iter()
            .chain([civil.year()])
            .map(Self::text)
            .collect()
    }
}

/// Answer to one request.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Answer {
    /// Word with its sign, such as `STATUS?`.
    word: String,
    values: Vec<Value>,
}

impl Answer {
    /// Creates the answer to a query.
    pub(super) fn values(word: Word, values: Vec<Value>) -> Self {
        Self { word: format!("{word}{}", Verb::Query.sign()), values }
    }

    pub(super) fn done(word: &str) -> Self {
        Self { word: word.to_owned(), values: vec![Value::text("OK")] }
    }

    pub(super) fn refused(word: &str, code: ErrorCode) -> Self {
        let values = vec![Value::text("ERR"), Value::text(code as u8)];
        Self { word: word.to_owned(), values }
    }

    /// Returns the payload in the form that the quirks request.
    pub(super) fn payload(&self, quirks: &BTreeSet<Quirk>) -> String {
        let mut values: Vec<String> = self
            .values
            .iter()
            .map(|value| match value {
                Value::Decimal(text) if quirks.contains(&Quirk::DecimalComma) => {
                    text.replace('.', ",")
                }
                Value::Decimal(text) | Value::Text(text) => text.clone(),
            })
            .collect();
        // Only a full reply loses its last value; an error keeps both values.
        for (quirk, word, count) in [
            (Quirk::Fields15, "STATUS?", 15),
            (Quirk::Err11, "ERRSTATUS?", 11),
            (Quirk::Time6, "TIME?", 6),
        ] {
            if quirks.contains(&quirk) && self.word == word && self.values.len() == count + 1 {
                values.pop();
            }
        }
        let word = match self.word.strip_suffix('=') {
            Some(name) if quirks.contains(&Quirk::SpaceBeforeEq) => format!("{name} ="),
            _ => self.word.clone(),
        };
        let is_bare = quirks.contains(&Quirk::NoComma) && self.word == "STATUS?";
        let comma = if is_bare || values.is_empty() { "" } else { "," };
        format!("{word}{comma}{}", values.join(","))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_look_like_the_documents() {
        let text = |value| match value {
            Value::Decimal(text) | Value::Text(text) => text,
        };
        assert_eq!(text(Value::decimal(3.0)), "3.0");
        assert_eq!(text(Value::decimal(5.25)), "5.25");
        assert_eq!(text(Value::decimal(-0.0001)), "0.0");
        assert_eq!(text(Value::decimal(100.125)), "100.125");
        assert_eq!(text(Value::fixed(299.494, 2)), "299.49");
        assert_eq!(text(Value::fixed(-0.001, 2)), "0.00");
        assert_eq!(text(Value::fixed(-0.1, 1)), "-0.1");
    }

    #[test]
    fn quirks_change_the_form_only_where_they_belong() {
        let set = Answer::done("STOP=");
        let status = Answer::values(Word::Status, vec![Value::fixed(1.5, 1); 16]);
        let payload = |answer: &Answer, quirk| answer.payload(&BTreeSet::from([quirk]));
        assert_eq!(payload(&set, Quirk::SpaceBeforeEq), "STOP =,OK");
        assert_eq!(payload(&set, Quirk::NoComma), "STOP=,OK");
        assert!(payload(&status, Quirk::NoComma).starts_with("STATUS?1.5,1.5"));
        assert!(payload(&status, Quirk::DecimalComma).starts_with("STATUS?,1,5,1,5"));
        assert_eq!(payload(&status, Quirk::Fields15).matches("1.5").count(), 15);
        assert_eq!(payload(&status, Quirk::Err11).matches("1.5").count(), 16);
        let refused = Answer::refused("STATUS?", ErrorCode::Fault);
        assert_eq!(payload(&refused, Quirk::Fields15), "STATUS?,ERR,6");
    }
}
