//! A setting of a connection that only one make of controller has. One description serves the
//! station file and the form.

use serde::{Deserialize, Serialize, Serializer};

use crate::device::{
    CountPoint,
    settings::{Field, Kind, Unfit, Value},
};

/// One setting of a connection.
#[derive(Debug)]
pub struct Setting {
    /// Key in the station file, valid values and label in the form.
    pub field: Field,
    /// Table of the setting within the connection's table of the station file; `None` for the
    /// connection's own table. Settings of one table follow each other.
    pub table: Option<Table>,
    pub default: fn() -> Value,
    /// Function that returns a sentence about a value, to show below the value.
    pub note: fn(&Value) -> Option<&'static str>,
}

/// A table of settings within the connection's table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Table {
    /// Name of the table in the station file.
    pub key: &'static str,
    /// Title above its settings in the form.
    pub title: &'static str,
}

impl Setting {
    /// Returns a setting. The file omits an empty default (an empty text, no points).
    pub const fn new(field: Field, default: fn() -> Value) -> Self {
        Self { field, table: None, default, note: |_| None }
    }

    /// Returns the setting in this table, which its neighbours may share.
    #[must_use]
    pub const fn in_table(self, table: Table) -> Self {
        Self { table: Some(table), ..self }
    }

    #[must_use]
    pub const fn noted(self, note: fn(&Value) -> Option<&'static str>) -> Self {
        Self { note, ..self }
    }

    /// Reads the value of the station file. The reason in an error completes the key.
    pub(super) fn read(&self, value: toml::Value) -> Result<Value, Unfit> {
        let kind = &self.field.kind;
        let read = match (kind, value) {
            (Kind::Points, value) => points(value)?,
            (Kind::Flag, toml::Value::Boolean(on)) => Value::Flag(on),
            (Kind::Choice(_), toml::Value::Integer(code)) => Value::Choice(code),
            (Kind::Integer { .. }, toml::Value::Integer(number)) => Value::Integer(number),
            (Kind::Decimal { .. } | Kind::Number { .. }, toml::Value::Float(number)) => {
                Value::Decimal(number)
            }
            (Kind::Decimal { .. } | Kind::Number { .. }, toml::Value::Integer(number)) => {
                Value::Decimal(number as f64)
            }
            (Kind::Word(_), toml::Value::String(word)) => Value::Text(word),
            (_, toml::Value::String(text)) if !text.trim().is_empty() => kind.read(&text)?,
            _ => return Err(self.unfit()),
        };
        kind.check(&read)
            .map_err(|unfit| if has_own_spelling(kind) { self.unfit() } else { unfit })?;
        Ok(read)
    }

    /// Returns the reason to refuse a value, in the spelling of the station file.
    fn unfit(&self) -> Unfit {
        let kind = &self.field.kind;
        match kind {
            Kind::Choice(choices) => {
                let codes: Vec<String> = choices.iter().map(|(code, _)| code.to_string()).collect();
                Unfit::Choice(codes.join(", "))
            }
            Kind::Word(choices) => {
                let words: Vec<String> =
                    choices.iter().map(|(word, _)| format!("{word:?}")).collect();
                Unfit::Choice(words.join(", "))
            }
            Kind::Flag => Unfit::Choice("true, false".to_owned()),
            Kind::Text(_) => Unfit::Text("must be a text that is not empty".to_owned()),
            _ => kind.unfit(),
        }
    }
}

/// Returns `true` if the station file spells the values of this kind differently from the form.
fn has_own_spelling(kind: &Kind) -> bool {
    matches!(kind, Kind::Choice(_) | Kind::Word(_))
}

fn points(value: toml::Value) -> Result<Value, Unfit> {
    let points = Vec::<CountPoint>::deserialize(value);
    points.map(Value::Points).map_err(|error| Unfit::Text(error.message().to_owned()))
}

/// Returns `true` for an empty value, which the station file omits.
pub(super) fn is_empty(value: &Value) -> bool {
    match value {
        Value::Text(text) => text.is_empty(),
        Value::Points(points) => points.is_empty(),
        _ => false,
    }
}

/// A value in the spelling of the station file.
pub(super) struct Spelled<'a>(pub(super) &'a Setting, pub(super) &'a Value);

impl Serialize for Spelled<'_> {
    fn serialize<S: Serializer>(&self, out: S) -> Result<S::Ok, S::Error> {
        let Self(setting, value) = self;
        match value {
            Value::Flag(on) => on.serialize(out),
            Value::Choice(number) | Value::Integer(number) => number.serialize(out),
            Value::Decimal(number) => number.serialize(out),
            Value::Text(text) => text.serialize(out),
            Value::Points(points) => points.serialize(out),
            Value::Secret(_) | Value::Time(_) => setting.field.kind.text(value).serialize(out),
        }
    }
}
