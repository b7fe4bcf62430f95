//! The value of a setting, and its text.

use std::collections::BTreeMap;

use jiff::{Timestamp, civil::DateTime, tz::TimeZone};
use serde::{Deserialize, Serialize};

use super::Kind;
use crate::{name::Name, secret::Secret};

/// Values of a group by the keys of their fields.
pub type Values = BTreeMap<Name, Value>;

/// The value of a field.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Value {
    /// Of a [`Kind::Flag`].
    Flag(bool),
    /// Of a [`Kind::Choice`]: its code, which may be one without a name.
    Choice(i64),
    /// Of a [`Kind::Integer`].
    Integer(i64),
    /// Of a [`Kind::Decimal`], or of a [`Kind::Place`] in degrees.
    Decimal(f64),
    /// Of a [`Kind::Text`].
    Text(String),
    /// Of a [`Kind::Password`].
    Secret(Secret),
    /// Of a [`Kind::Time`].
    Time(Timestamp),
}

/// Why a value cannot be used; reads on from the name of its field.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize, Deserialize)]
pub enum Unfit {
    /// No number where one is wanted.
    #[error("is not a number")]
    NotANumber,
    /// No whole number where one is wanted.
    #[error("is not a whole number")]
    NotWhole,
    /// Outside its ends.
    #[error("is not between {least} and {most}")]
    Range {
        /// Lowest that is taken, in words.
        least: String,
        /// Highest that is taken, in words.
        most: String,
    },
    /// No latitude or longitude.
    #[error("is no place such as 41.02{0}")]
    NotAPlace(char),
    /// No time.
    #[error("is no time such as 2026-08-12 11:30:00")]
    NotATime,
    /// No name of a choice.
    #[error("is none of its choices")]
    NotAChoice,
    /// A text that the protocol cannot carry.
    #[error("{0}")]
    Text(String),
}

impl Kind {
    /// Reads what the operator typed.
    pub fn read(&self, text: &str) -> Result<Value, Unfit> {
        let trimmed = text.trim();
        match *self {
            Self::Flag => match trimmed {
                "On" => Ok(Value::Flag(true)),
                "Off" => Ok(Value::Flag(false)),
                _ => Err(Unfit::NotAChoice),
            },
            Self::Choice(choices) => choices
                .iter()
                .find(|(_, name)| *name == trimmed)
                .map(|(code, _)| Value::Choice(*code))
                .ok_or(Unfit::NotAChoice),
            Self::Integer { least, most } => {
                let value: i64 = number(trimmed).parse().map_err(|_| Unfit::NotWhole)?;
                let range = || Unfit::Range { least: least.to_string(), most: most.to_string() };
                (least..=most).contains(&value).then_some(Value::Integer(value)).ok_or_else(range)
            }
            Self::Decimal { least, most, .. } => decimal(trimmed, least, most).map(Value::Decimal),
            Self::Place { most, letters } => place(trimmed, most, letters).map(Value::Decimal),
            Self::Text(check) => check(text).map(|()| Value::Text(text.to_owned())),
            Self::Password(check) => check(text).map(|()| Value::Secret(Secret::new(text))),
            Self::Time => {
                let time: Result<DateTime, _> = trimmed.trim_end_matches(['Z', 'z']).parse();
                let time = time.ok().and_then(|time| TimeZone::UTC.to_timestamp(time).ok());
                time.map(Value::Time).ok_or(Unfit::NotATime)
            }
        }
    }

    /// The value as the operator reads and types it. A password is nothing.
    pub fn text(&self, value: &Value) -> String {
        match (self, value) {
            (_, Value::Flag(on)) => if *on { "On" } else { "Off" }.to_owned(),
            (Self::Choice(choices), Value::Choice(code)) => choices
                .iter()
                .find(|(known, _)| known == code)
                .map_or_else(|| format!("unknown ({code})"), |(_, name)| (*name).to_owned()),
            (Self::Decimal { places, .. }, Value::Decimal(number)) => decimals(*number, *places),
            (Self::Place { letters: [plus, minus], .. }, Value::Decimal(angle)) => {
                let letter = if *angle < 0.0 { minus } else { plus };
                format!("{:.2}{letter}", angle.abs())
            }
            (_, Value::Choice(number) | Value::Integer(number)) => number.to_string(),
            (_, Value::Decimal(number)) => number.to_string(),
            (_, Value::Text(text)) => text.clone(),
            (_, Value::Secret(_)) => String::new(),
            (_, Value::Time(time)) => {
                TimeZone::UTC.to_datetime(*time).strftime("%Y-%m-%d %H:%M:%S").to_string()
            }
        }
    }

    /// Whether two values say the same at the fineness of this kind.
    pub fn same(&self, a: &Value, b: &Value) -> bool {
        match (self, a, b) {
            (Self::Password(_), Value::Secret(a), Value::Secret(b)) => a == b,
            (Self::Time, Value::Time(a), Value::Time(b)) => a.as_second() == b.as_second(),
            _ => a == b || self.text(a) == self.text(b) && !matches!(a, Value::Secret(_)),
        }
    }
}

/// At least `places` decimal places, and more where the number has more.
fn decimals(number: f64, places: usize) -> String {
    let shortest = number.to_string();
    let has = shortest.split_once('.').map_or(0, |(_, digits)| digits.len());
    if has > places { shortest } else { format!("{number:.places$}") }
}

/// A comma for a point, a true minus sign and thin spaces are what people type
/// and paste.
fn number(text: &str) -> String {
    text.chars()
        .filter(|c| !c.is_whitespace())
        .map(|c| match c {
            ',' => '.',
            '\u{2212}' => '-',
            other => other,
        })
        .collect()
}

fn decimal(text: &str, least: f64, most: f64) -> Result<f64, Unfit> {
    let value: f64 = number(text).parse().map_err(|_| Unfit::NotANumber)?;
    if !value.is_finite() {
        return Err(Unfit::NotANumber);
    }
    let range = || Unfit::Range { least: least.to_string(), most: most.to_string() };
    // As fine as any controller takes it; and minus zero would look like a change.
    let value = (value * 1000.0).round() / 1000.0 + 0.0;
    (least..=most).contains(&value).then_some(value).ok_or_else(range)
}

fn place(text: &str, most: f64, [plus, minus]: [char; 2]) -> Result<f64, Unfit> {
    let wrong = || Unfit::NotAPlace(plus);
    let letter = text.chars().next_back().ok_or_else(wrong)?.to_ascii_uppercase();
    let (digits, sign) = match letter {
        letter if letter == plus => (text.strip_suffix(|_| true), 1.0),
        letter if letter == minus => (text.strip_suffix(|_| true), -1.0),
        _ => (Some(text), 1.0),
    };
    let has_letter = letter == plus || letter == minus;
    let least = if has_letter { 0.0 } else { -most };
    match decimal(digits.ok_or_else(wrong)?, least, most) {
        Ok(angle) => Ok(angle * sign),
        Err(Unfit::NotANumber) => Err(wrong()),
        Err(other) => Err(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LATITUDE: Kind = Kind::Place { most: 90.0, letters: ['N', 'S'] };
    const OFFSET: Kind = Kind::Decimal { least: -10.0, most: 10.0, places: 2 };

    #[test]
    fn numbers_are_read_as_people_type_them() {
        assert_eq!(OFFSET.read(" \u{2212}0,15 "), Ok(Value::Decimal(-0.15)));
        assert_eq!(OFFSET.read("-0"), Ok(Value::Decimal(0.0)));
        assert_eq!(OFFSET.read("NaN"), Err(Unfit::NotANumber));
        assert!(matches!(OFFSET.read("10.01"), Err(Unfit::Range { .. })));
        let lead = Kind::Integer { least: 0, most: 3_600_000 };
        assert_eq!(lead.read("90\u{2009}000"), Ok(Value::Integer(90_000)));
        assert_eq!(lead.read("1.5"), Err(Unfit::NotWhole));
    }

    #[test]
    fn the_letter_is_the_sign_and_a_sign_needs_none() {
        assert_eq!(LATITUDE.read("41.02n"), Ok(Value::Decimal(41.02)));
        assert_eq!(LATITUDE.read("33.86 S"), Ok(Value::Decimal(-33.86)));
        assert_eq!(LATITUDE.read("-33.86"), Ok(Value::Decimal(-33.86)));
        for bad in ["", "N", "-33.86S", "91N", "41.02E", "x\u{130}"] {
            assert!(LATITUDE.read(bad).is_err(), "{bad}");
        }
        assert_eq!(LATITUDE.text(&Value::Decimal(-33.86)), "33.86S");
    }

    #[test]
    fn times_come_back_as_typed() {
        let time = Kind::Time.read("2026-08-12 11:30:05Z").unwrap();
        assert_eq!(Kind::Time.text(&time), "2026-08-12 11:30:05");
        assert_eq!(Kind::Time.read("2026-02-30 11:30:00"), Err(Unfit::NotATime));
    }

    #[test]
    fn a_secret_is_never_printed_and_still_compared() {
        let kind = Kind::Password(|_| Ok(()));
        let (a, b) = (kind.read("hunter2").unwrap(), kind.read("hunter3").unwrap());
        assert!(!format!("{a:?}{}", kind.text(&a)).contains("hunter2"));
        assert!(kind.same(&a, &a.clone()) && !kind.same(&a, &b));
    }

    #[test]
    fn a_code_without_a_name_is_shown_as_it_came() {
        let kind = Kind::Choice(&[(0, "Off"), (1, "On")]);
        assert_eq!(kind.text(&Value::Choice(7)), "unknown (7)");
        assert_eq!(kind.read("unknown (7)"), Err(Unfit::NotAChoice));
        assert!(kind.same(&Value::Choice(7), &Value::Choice(7)));
    }

    #[test]
    fn what_the_unit_reports_finer_is_not_hidden() {
        assert_eq!(OFFSET.text(&Value::Decimal(0.125)), "0.125");
        assert_eq!(OFFSET.text(&Value::Decimal(1.0)), "1.00");
    }
}
