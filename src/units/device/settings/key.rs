//! Keys of fields. A misspelled key, or one read as another type, does not compile.

use jiff::Timestamp;

use super::{Kind, Secret, Unfit, Value, Values};
use crate::device::CountPoint;

/// The key of a field with values of type `T`, and the values that the field can hold.
#[derive(Debug)]
pub struct Key<T: 'static> {
    /// Name of the field within its group.
    pub name: &'static str,
    /// Values that the field can hold.
    pub kind: Kind,
    wrap: fn(T) -> Value,
    unwrap: fn(&Value) -> Option<T>,
}

impl<T> Clone for Key<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Key<T> {}

impl<T> Key<T> {
    /// Returns the value among `values`; `None` if unknown.
    pub fn get(&self, values: &Values) -> Option<T> {
        values.get(self.name).and_then(self.unwrap)
    }

    /// Returns an entry of [`Values`].
    pub fn entry(&self, value: T) -> (&'static str, Value) {
        (self.name, (self.wrap)(value))
    }
}

impl Key<bool> {
    /// Returns the key of a flag, on or off.
    pub const fn flag(name: &'static str) -> Self {
        let unwrap = |value: &Value| match value {
            Value::Flag(on) => Some(*on),
            _ => None,
        };
        Self { name, kind: Kind::Flag, wrap: Value::Flag, unwrap }
    }
}

impl Key<i64> {
    /// Returns the key of a whole number from `min` to `max`.
    pub const fn integer(name: &'static str, min: i64, max: i64) -> Self {
        let unwrap = |value: &Value| match value {
            Value::Integer(number) => Some(*number),
            _ => None,
        };
        Self { name, kind: Kind::Integer { min, max }, wrap: Value::Integer, unwrap }
    }

    /// Returns the key of one of these codes, each with its name.
    pub const fn choice(name: &'static str, choices: &'static [(i64, &'static str)]) -> Self {
        let unwrap = |value: &Value| match value {
            Value::Choice(code) => Some(*code),
            _ => None,
        };
        Self { name, kind: Kind::Choice(choices), wrap: Value::Choice, unwrap }
    }
}

impl Key<f64> {
    /// Returns the key of a number from `min` to `max` with this number of decimal places.
    pub const fn decimal(name: &'static str, min: f64, max: f64, places: usize) -> Self {
        Self::of_kind(name, Kind::Decimal { min, max, places })
    }

    /// Returns the key of an angle up to this magnitude, degrees, with a letter for each sign.
    pub const fn place(name: &'static str, max: f64, letters: [char; 2]) -> Self {
        Self::of_kind(name, Kind::Place { max, letters })
    }

    const fn of_kind(name: &'static str, kind: Kind) -> Self {
        let unwrap = |value: &Value| match value {
            Value::Decimal(number) => Some(*number),
            _ => None,
        };
        Self { name, kind, wrap: Value::Decimal, unwrap }
    }
}

impl Key<String> {
    /// Returns the key of a text that passes this check.
    pub const fn text(name: &'static str, check: fn(&str) -> Result<(), Unfit>) -> Self {
        Self::of_kind(name, Kind::Text(check))
    }

    /// Returns the key of one of these words, each with its name.
    pub const fn word(
        name: &'static str,
        choices: &'static [(&'static str, &'static str)],
    ) -> Self {
        Self::of_kind(name, Kind::Word(choices))
    }

    const fn of_kind(name: &'static str, kind: Kind) -> Self {
        let unwrap = |value: &Value| match value {
            Value::Text(text) => Some(text.clone()),
            _ => None,
        };
        Self { name, kind, wrap: Value::Text, unwrap }
    }
}

impl Key<Vec<CountPoint>> {
    /// Returns the key of measured points that make a scale.
    pub const fn points(name: &'static str) -> Self {
        let unwrap = |value: &Value| match value {
            Value::Points(points) => Some(points.clone()),
            _ => None,
        };
        Self { name, kind: Kind::Points, wrap: Value::Points, unwrap }
    }
}

impl Key<Secret> {
    /// Returns the key of a secret that passes this check.
    pub const fn password(name: &'static str, check: fn(&str) -> Result<(), Unfit>) -> Self {
        let unwrap = |value: &Value| match value {
            Value::Secret(secret) => Some(secret.clone()),
            _ => None,
        };
        Self { name, kind: Kind::Password(check), wrap: Value::Secret, unwrap }
    }
}

impl Key<Timestamp> {
    /// Returns the key of a UTC time to the second.
    pub const fn time(name: &'static str) -> Self {
        let unwrap = |value: &Value| match value {
            Value::Time(time) => Some(*time),
            _ => None,
        };
        Self { name, kind: Kind::Time, wrap: Value::Time, unwrap }
    }
}
