//! The values of a command: changes, and the unit's values for the rest.

use jiff::Timestamp;

use super::unfit;
use crate::{
    device::settings::{Key, Unfit, Values, WriteError},
    protocol::satrak::{TextValue, ValueError},
};

pub(in crate::controller::satrak) struct Desired<'a> {
    pub new: &'a Values,
    /// Values that the unit holds.
    pub(in crate::controller::satrak) unit_values: &'a Values,
    /// The computer's UTC.
    pub(in crate::controller::satrak) utc: Timestamp,
}

impl Desired<'_> {
    fn find<T>(&self, key: &Key<T>) -> Option<T> {
        key.get(self.new).or_else(|| key.get(self.unit_values))
    }

    /// Returns a flag; `false` if it is unknown.
    pub(super) fn is_on(&self, key: &Key<bool>) -> bool {
        self.find(key) == Some(true)
    }

    pub(super) fn get<T>(&self, key: &Key<T>) -> Result<T, WriteError> {
        self.find(key).ok_or_else(|| missing(key.name))
    }

    /// Returns a whole number that fits into `N`.
    pub(super) fn whole<N: TryFrom<i64>>(&self, key: &Key<i64>) -> Result<N, WriteError> {
        N::try_from(self.get(key)?).map_err(|_| missing(key.name))
    }

    pub(super) fn text(&self, key: &Key<String>) -> Result<TextValue, WriteError> {
        TextValue::new(key.name, &self.get(key)?).map_err(cannot(key.name))
    }
}

/// Returns the conversion of an error of `field`.
pub(super) fn cannot(field: &'static str) -> impl Fn(ValueError) -> WriteError {
    move |error| WriteError::CannotBeSent { field, reason: unfit(error) }
}

/// Returns the error for a value that neither the unit reports nor the operator has entered.
fn missing(field: &'static str) -> WriteError {
    WriteError::CannotBeSent { field, reason: Unfit::Text("has no value yet".to_owned()) }
}
