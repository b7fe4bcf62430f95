//! The value of a setting, and its text.

use std::collections::BTreeMap;

use jiff::{Timestamp, civil::DateTime, tz::TimeZone};
use serde::{Deserialize, Serialize};

use super::{Kind, points};
use crate::{device::CountPoint, name::Name, secret::Secret};

const ON: &str = "On";
const DISABLED_WORD: &str = "Off";

/// Values of a group by the keys of their fields.
pub type Values = BTreeMap<Name, Value>;

/// The value of a field.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Value {
    /// Value of a [`Kind::Flag`].
    Flag(bool),
    /// Code of a [`Kind::Choice`], which may have no name.
    Choice(i64),
    /// Value of a [`Kind::Integer`].
    Integer(i64),
    /// Value of a [`Kind::Decimal`] or [`Kind::Number`], or of a [`Kind::Place`] in degrees.
    Decimal(f64),
    /// Text of a [`Kind::Text`], or the word of a [`Kind::Word`].
    Text(String),
    /// Value of a [`Kind::Password`].
    Secret(Secret),
    /// Value of a [`Kind::Time`].
    Time(Timestamp),
    /// Value of [`Kind::Points`].
    Points(Vec<CountPoint>),
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<i64> for Value {
    fn from(number: i64) -> Self {
        Self::Integer(number)
    }
}

impl From<Vec<CountPoint>> for Value {
    fn from(points: Vec<CountPoint>) -> Self {
        Self::Points(points)
    }
}

/// Reason why a value cannot be used, as the rest of a sentence after the name of its field.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize, Deserialize)]
pub enum Unfit {
    #[error("must be a number from {} to {}", signed(min), signed(max))]
    Number { min: f64, max: f64 },
    #[error("must be a whole number from {} to {}", signed(min), signed(max))]
    Integer { min: i64, max: i64 },
    #[error("must be an angle up to {max}°, such as 41.02{letter}")]
    Place { max: f64, letter: char },
    #[error("must be a time such as 2026-08-12 11:30:00")]
    Time,
    /// A value that is none of the choices, which are listed.
    #[error("must be one of {0}")]
    Choice(String),
    /// Another reason: a sentence without its subject and its full stop.
    #[error("{0}")]
    Text(String),
}

/// Returns the text of a number with a true minus sign.
fn signed(number: &impl ToString) -> String {
    number.to_string().replace('-', "\u{2212}")
}

impl Kind {
    /// Reads a text that the operator typed.
    pub fn read(&self, text: &str) -> Result<Value, Unfit> {
        let trimmed = text.trim();
        let read = match *self {
            Self::Text(check) => return check(text).map(|()| Value::Text(text.to_owned())),
            Self::Password(check) => return check(text).map(|()| Value::Secret(Secret::new(text))),
            Self::Points => return points::read(text).map(Value::Points),
            Self::Flag => match trimmed {
                ON => Some(Value::Flag(true)),
                DISABLED_WORD => Some(Value::Flag(false)),
                _ => None,
            },
            Self::Choice(choices) => {
                let named = choices.iter().find(|(_, name)| *name == trimmed);
                named.map(|(code, _)| Value::Choice(*code))
            }
            Self::Word(choices) => {
                let named = choices.iter().find(|(_, name)| *name == trimmed);
                named.map(|(word, _)| Value::Text((*word).to_owned()))
            }
            Self::Integer { min, max } => {
                let number = plain(trimmed).parse().ok();
                number.filter(|number| (min..=max).contains(number)).map(Value::Integer)
            }
            Self::Decimal { min, max, .. } => decimal(trimmed, min, max).map(Value::Decimal),
            Self::Number { min, max } => {
                number(trimmed).filter(|number| (min..=max).contains(number)).map(Value::Decimal)
            }
            Self::Place { max, letters } => place(trimmed, max, letters).map(Value::Decimal),
            Self::Time => {
                let time: Option<DateTime> = trimmed.trim_end_matches(['Z', 'z']).parse().ok();
                time.and_then(|time| TimeZone::UTC.to_timestamp(time).ok()).map(Value::Time)
            }
        };
        read.ok_or_else(|| self.unfit())
    }

    /// Returns the reason to refuse a value of another kind or outside the range.
    pub(crate) fn unfit(&self) -> Unfit {
        match *self {
            Self::Flag | Self::Choice(_) | Self::Word(_) => {
                Unfit::Choice(self.choices().unwrap_or_default().join(", "))
            }
            Self::Integer { min, max } => Unfit::Integer { min, max },
            Self::Decimal { min, max, .. } | Self::Number { min, max } => {
                Unfit::Number { min, max }
            }
            Self::Place { max, letters: [letter, _] } => Unfit::Place { max, letter },
            Self::Text(_) | Self::Password(_) => Unfit::Text("must be a text".to_owned()),
            Self::Points => Unfit::Text("must be measured points".to_owned()),
            Self::Time => Unfit::Time,
        }
    }

    /// Checks that the field can hold `value`, which is true for every value that [`Self::read`]
    /// returns.
    pub fn check(&self, value: &Value) -> Result<(), Unfit> {
        let read = self.read(&self.text(value))?;
        (read == *value).then_some(()).ok_or_else(|| self.unfit())
    }

    /// Returns the names that can be chosen; `None` if any text can be typed.
    pub fn choices(&self) -> Option<Vec<&'static str>> {
        match self {
            Self::Flag => Some(vec![DISABLED_WORD, ON]),
            Self::Choice(choices) => Some(choices.iter().map(|(_, name)| *name).collect()),
            Self::Word(choices) => Some(choices.iter().map(|(_, name)| *name).collect()),
            _ => None,
        }
    }

    /// Returns the text of an untouched field: its first choice, or an empty text.
    pub fn untouched(&self) -> String {
        let first = self.choices().and_then(|choices| choices.first().copied());
        first.unwrap_or_default().to_owned()
    }

    /// Returns the value as the operator reads and types it; an empty text for a password.
    pub fn text(&self, value: &Value) -> String {
        match (self, value) {
            (_, Value::Flag(on)) => if *on { ON } else { DISABLED_WORD }.to_owned(),
            (Self::Choice(choices), Value::Choice(code)) => choices
                .iter()
                .find(|(code_here, _)| code_here == code)
                .map_or_else(|| format!("unknown ({code})"), |(_, name)| (*name).to_owned()),
            (Self::Word(choices), Value::Text(word)) => {
                let choice = choices.iter().find(|(candidate, _)| candidate == word);
                choice.map_or_else(|| format!("unknown ({word})"), |(_, name)| (*name).to_owned())
            }
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
            (_, Value::Points(points)) => points::write(points),
        }
    }

    /// Returns `true` if two values are the same at the resolution of this kind.
    pub fn same(&self, a: &Value, b: &Value) -> bool {
        match (self, a, b) {
            (Self::Password(_), Value::Secret(a), Value::Secret(b)) => a == b,
            (Self::Time, Value::Time(a), Value::Time(b)) => a.as_second() == b.as_second(),
            _ => a == b || self.text(a) == self.text(b) && !matches!(a, Value::Secret(_)),
        }
    }
}

/// Returns a number with at least `places` decimal places, or more if the number has more.
fn decimals(number: f64, places: usize) -> String {
    let shortest = number.to_string();
    let has = shortest.split_once('.').map_or(0, |(_, digits)| digits.len());
    if has > places { shortest } else { format!("{number:.places$}") }
}

/// Reads a number as people type and paste it: with a point or a comma, with either minus sign, and
/// with blanks between its digits.
pub fn number(text: &str) -> Option<f64> {
    // Adding zero removes a minus zero, which would count as a change.
    plain(text).parse().ok().filter(|number: &f64| number.is_finite()).map(|number| number + 0.0)
}

fn plain(text: &str) -> String {
    text.chars()
        .filter(|c| !c.is_whitespace())
        .map(|c| match c {
            ',' => '.',
            '\u{2212}' => '-',
            other => other,
        })
        .collect()
}

/// Reads a number within the range, rounded to three decimal places as controllers take it.
fn decimal(text: &str, min: f64, max: f64) -> Option<f64> {
    let rounded = number(text).map(|number| (number * 1000.0).round() / 1000.0 + 0.0);
    rounded.filter(|number| (min..=max).contains(number))
}

fn place(text: &str, max: f64, [plus, minus]: [char; 2]) -> Option<f64> {
    let letter = text.chars().next_back()?.to_ascii_uppercase();
    let (digits, sign) = match letter {
        letter if letter == plus => (text.strip_suffix(|_| true)?, 1.0),
        letter if letter == minus => (text.strip_suffix(|_| true)?, -1.0),
        _ => (text, 1.0),
    };
    let has_letter = letter == plus || letter == minus;
    let min = if has_letter { 0.0 } else { -max };
    decimal(digits, min, max).map(|angle| angle * sign)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LATITUDE: Kind = Kind::Place { max: 90.0, letters: ['N', 'S'] };
    const OFFSET: Kind = Kind::Decimal { min: -10.0, max: 10.0, places: 2 };

    #[test]
    fn numbers_are_read_as_people_type_them() {
        assert_eq!(OFFSET.read(" \u{2212}0,15 "), Ok(Value::Decimal(-0.15)));
        assert_eq!(OFFSET.read("-0"), Ok(Value::Decimal(0.0)));
        for bad in ["NaN", "10.01", "", "1e999"] {
            assert_eq!(OFFSET.read(bad), Err(Unfit::Number { min: -10.0, max: 10.0 }), "{bad}");
        }
        let lead = Kind::Integer { min: 0, max: 3_600_000 };
        assert_eq!(lead.read("90\u{2009}000"), Ok(Value::Integer(90_000)));
        assert_eq!(lead.read("1.5"), Err(Unfit::Integer { min: 0, max: 3_600_000 }));
        let exact = Kind::Number { min: -90.0, max: 90.0 };
        assert_eq!(exact.read("41,0234567"), Ok(Value::Decimal(41.023_456_7)));
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
        assert_eq!(Kind::Time.read("2026-02-30 11:30:00"), Err(Unfit::Time));
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
        assert_eq!(kind.read("unknown (7)"), Err(Unfit::Choice("Off, On".to_owned())));
        assert!(kind.same(&Value::Choice(7), &Value::Choice(7)));
    }

    #[test]
    fn what_the_unit_reports_finer_is_not_hidden() {
        assert_eq!(OFFSET.text(&Value::Decimal(0.125)), "0.125");
        assert_eq!(OFFSET.text(&Value::Decimal(1.0)), "1.00");
    }
}
