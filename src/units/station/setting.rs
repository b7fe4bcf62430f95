//! A setting of a connection that only one make of controller has, described once for the
//! station file and for the form.

use serde::{Deserialize, Serialize, Serializer};

use crate::device::{
    CountPoint,
    settings::{Field, Kind, Unfit, Value},
};

/// One setting of a connection.
#[derive(Debug)]
pub struct Setting {
    /// Its key in the station file, what it can hold and its label in the form.
    pub field: Field,
    /// The table of the station file that it stands in, within that of the connection; `None`
    /// where it stands in that one itself. Settings of one table follow on each other.
    pub table: Option<Table>,
    pub default: fn() -> Value,
    /// A sentence about a value, to stand below it.
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

impl Setting {
    /// A default that says nothing (an empty text, no points) is not written to the file.
    pub const fn new(field: Field, default: fn() -> Value) -> Self {
        Self { field, table: None, default, note: |_| None }
    }

    /// With a table of its own, or that of its neighbours.
    #[must_use]
    pub const fn in_table(self, table: Table) -> Self {
        Self { table: Some(table), ..self }
    }

    #[must_use]
    pub const fn noted(self, note: fn(&Value) -> Option<&'static str>) -> Self {
        Self { note, ..self }
    }

    /// Reads the value of the station file; a reason reads on from the key.
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

    /// As the station file spells its values.
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

/// The station file does not spell its values as the form does.
fn has_own_spelling(kind: &Kind) -> bool {
    matches!(kind, Kind::Choice(_) | Kind::Word(_))
}

fn points(value: toml::Value) -> Result<Value, Unfit> {
    let points = Vec::<CountPoint>::deserialize(value);
    points.map(Value::Points).map_err(|error| Unfit::Text(error.message().to_owned()))
}

/// Says nothing, and is left out of the station file.
pub(super) fn is_empty(value: &Value) -> bool {
    match value {
        Value::Text(text) => text.is_empty(),
        Value::Points(points) => points.is_empty(),
        _ => false,
    }
}

/// A value as the station file spells it.
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
