//! What a command is made from: the changes over what the unit holds.

use jiff::Timestamp;

use super::unfit;
use crate::{
    device::settings::{SettleError, Unfit, Value, Values},
    protocol::satrak::{TextValue, ValueError},
};

/// The new values of a group over those that the unit holds.
pub(in crate::controller::satrak) struct Wish<'a> {
    /// What is to be changed.
    pub(in crate::controller::satrak) new: &'a Values,
    /// What the unit holds.
    pub(in crate::controller::satrak) held: &'a Values,
    /// Our UTC.
    pub(in crate::controller::satrak) utc: Timestamp,
}

impl Wish<'_> {
    fn value(&self, key: &str) -> Option<&Value> {
        self.new.get(key).or_else(|| self.held.get(key))
    }

    /// A flag, off where nothing is said.
    pub(super) fn flag(&self, key: &str) -> bool {
        matches!(self.value(key), Some(Value::Flag(true)))
    }

    pub(super) fn code(&self, key: &'static str) -> Result<i64, SettleError> {
        match self.value(key) {
            Some(Value::Choice(code)) => Ok(*code),
            _ => Err(missing(key)),
        }
    }

    /// A whole number that fits into `N`.
    pub(super) fn integer<N: TryFrom<i64>>(&self, key: &'static str) -> Result<N, SettleError> {
        match self.value(key) {
            Some(Value::Integer(number)) => N::try_from(*number).map_err(|_| missing(key)),
            _ => Err(missing(key)),
        }
    }

    pub(super) fn decimal(&self, key: &'static str) -> Result<f64, SettleError> {
        match self.value(key) {
            Some(Value::Decimal(number)) => Ok(*number),
            _ => Err(missing(key)),
        }
    }

    pub(super) fn time(&self, key: &'static str) -> Result<Timestamp, SettleError> {
        match self.value(key) {
            Some(Value::Time(time)) => Ok(*time),
            _ => Err(missing(key)),
        }
    }

    pub(super) fn str(&self, key: &'static str) -> Result<&str, SettleError> {
        match self.value(key) {
            Some(Value::Text(text)) => Ok(text),
            Some(Value::Secret(secret)) => Ok(secret.reveal()),
            _ => Err(missing(key)),
        }
    }

    pub(super) fn text(&self, key: &'static str) -> Result<TextValue, SettleError> {
        TextValue::new(key, self.str(key)?).map_err(cannot(key))
    }
}

/// What becomes of an error of the field `key`.
pub(super) fn cannot(field: &'static str) -> impl Fn(ValueError) -> SettleError {
    move |error| SettleError::CannotBeSent { field, reason: unfit(error) }
}

/// The unit does not report the value, and nobody gave one.
fn missing(field: &'static str) -> SettleError {
    SettleError::CannotBeSent { field, reason: Unfit::Text("has no value yet".to_owned()) }
}
