//! A setting of a connection that one make of controller alone has, described
//! once: the station file and the form are driven by the same description.

use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

use super::CountPoint;

/// One setting of a connection.
#[derive(Debug)]
pub struct Setting {
    /// Names it in its table of the station file.
    pub key: &'static str,
    /// The table in which it stands within that of the connection; `None` where
    /// it stands there itself. Settings of one table follow on each other.
    pub table: Option<Table>,
    /// Before its value in the form.
    pub label: &'static str,
    /// What it can hold.
    pub holds: Holds,
    /// What it holds where nothing is said.
    pub usual: &'static Value,
    /// What is to be said of a value, in a sentence.
    pub note: fn(&Value) -> Option<&'static str>,
}

/// A table of settings within that of the connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Table {
    /// Names it in the station file.
    pub key: &'static str,
    /// Above its settings in the form.
    pub title: &'static str,
}

/// What a setting can hold.
#[derive(Debug)]
pub enum Holds {
    /// Any text; an empty one, which is the usual one, is not written to the file.
    Text,
    /// One of these words or whole numbers, each with its name in the form.
    OneOf(&'static [(Value, &'static str)]),
    /// A whole number within these ends.
    Whole(RangeInclusive<u32>),
    /// Two measured points or more that make a scale, or none; none, which is
    /// usual, are not written to the file.
    Points,
}

/// The value of a setting.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Value {
    /// Of [`Holds::Text`].
    Text(String),
    /// Of [`Holds::OneOf`].
    Word(&'static str),
    /// Of [`Holds::Whole`] or [`Holds::OneOf`].
    Whole(u32),
    /// Of [`Holds::Points`].
    Points(Vec<CountPoint>),
}

static NO_TEXT: Value = Value::Text(String::new());
static NO_POINTS: Value = Value::Points(Vec::new());

impl Value {
    /// It holds nothing that could be written.
    pub(crate) fn is_empty(&self) -> bool {
        match self {
            Self::Text(text) => text.is_empty(),
            Self::Points(points) => points.is_empty(),
            Self::Word(_) | Self::Whole(_) => false,
        }
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<u32> for Value {
    fn from(number: u32) -> Self {
        Self::Whole(number)
    }
}

impl From<Vec<CountPoint>> for Value {
    fn from(points: Vec<CountPoint>) -> Self {
        Self::Points(points)
    }
}

impl Setting {
    const fn new(
        key: &'static str,
        label: &'static str,
        holds: Holds,
        usual: &'static Value,
    ) -> Self {
        Self { key, table: None, label, holds, usual, note: |_| None }
    }

    /// Any text; usually none.
    pub const fn text(key: &'static str, label: &'static str) -> Self {
        Self::new(key, label, Holds::Text, &NO_TEXT)
    }

    /// One of `choices`, each with its name in the form.
    pub const fn one_of(
        key: &'static str,
        label: &'static str,
        choices: &'static [(Value, &'static str)],
        usual: &'static Value,
    ) -> Self {
        Self::new(key, label, Holds::OneOf(choices), usual)
    }

    /// A whole number within these ends.
    pub const fn whole(
        key: &'static str,
        label: &'static str,
        range: RangeInclusive<u32>,
        usual: &'static Value,
    ) -> Self {
        Self::new(key, label, Holds::Whole(range), usual)
    }

    /// Measured points that make a scale; usually none.
    pub const fn points(key: &'static str, label: &'static str) -> Self {
        Self::new(key, label, Holds::Points, &NO_POINTS)
    }

    /// Within a table of its own.
    #[must_use]
    pub const fn in_table(self, table: Table) -> Self {
        Self { table: Some(table), ..self }
    }

    /// With what is to be said of a value.
    #[must_use]
    pub const fn noted(self, note: fn(&Value) -> Option<&'static str>) -> Self {
        Self { note, ..self }
    }

    /// Whether it can hold `value`; the reason, to stand behind its name, when it
    /// cannot.
    pub fn check(&self, value: &Value) -> Result<(), String> {
        match (&self.holds, value) {
            (Holds::Text, Value::Text(_)) => Ok(()),
            (Holds::Points, Value::Points(points)) => CountPoint::check(points),
            (Holds::OneOf(choices), value) if choices.iter().any(|(of, _)| of == value) => Ok(()),
            (Holds::Whole(range), Value::Whole(number)) if range.contains(number) => Ok(()),
            _ => Err(self.wanted()),
        }
    }

    /// What stands for it in the station file, not yet checked.
    pub(super) fn read(&self, value: toml::Value) -> Result<Value, String> {
        let read = match &self.holds {
            Holds::Text => value.as_str().filter(|text| !text.trim().is_empty()).map(Value::from),
            Holds::OneOf(choices) => {
                let found = choices.iter().find(|(choice, _)| choice.stands_for(&value));
                found.map(|(choice, _)| choice.clone())
            }
            Holds::Whole(_) => {
                let number = value.as_integer().and_then(|number| u32::try_from(number).ok());
                number.map(Value::Whole)
            }
            Holds::Points => Some(Value::Points(points(value)?)),
        };
        read.ok_or_else(|| self.wanted())
    }

    /// What is wanted where something else stands, to stand behind its name.
    pub fn wanted(&self) -> String {
        match &self.holds {
            Holds::Text => "must be a text that is not empty".to_owned(),
            Holds::OneOf(choices) => {
                let written = |(choice, name): &(Value, &str)| match choice {
                    Value::Word(word) => format!("{word:?}"),
                    Value::Whole(number) => number.to_string(),
                    Value::Text(_) | Value::Points(_) => (*name).to_owned(),
                };
                let all: Vec<String> = choices.iter().map(written).collect();
                format!("must be one of {}", all.join(", "))
            }
            Holds::Whole(range) => {
                format!("must be a whole number from {} to {}", range.start(), range.end())
            }
            Holds::Points => "must be measured points".to_owned(),
        }
    }
}

impl Value {
    fn stands_for(&self, written: &toml::Value) -> bool {
        match self {
            Self::Word(word) => written.as_str() == Some(word),
            Self::Whole(number) => written.as_integer() == Some(i64::from(*number)),
            Self::Text(_) | Self::Points(_) => false,
        }
    }
}

fn points(value: toml::Value) -> Result<Vec<CountPoint>, String> {
    #[derive(Deserialize)]
    struct Point {
        counts: u16,
        degrees: f64,
    }
    let points: Result<Vec<Point>, toml::de::Error> = value.try_into();
    let points = points.map_err(|error| error.message().to_owned())?;
    Ok(points.iter().map(|&Point { counts, degrees }| CountPoint { counts, degrees }).collect())
}
