//! The values that a command is made from: changes over what the unit holds.

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

    /// A flag; off if it is unknown.
    pub(super) fn is_on(&self, key: &Key<bool>) -> bool {
        self.find(key) == Some(true)
    }

    pub(super) fn get<T>(&self, key: &Key<T>) -> Result<T, WriteError> {
        self.find(key).ok_or_else(|| missing(key.name))
    }

    /// A whole number that fits into `N`.
    pub(super) fn whole<N: TryFrom<i64>>(&self, key: &Key<i64>) -> Result<N, WriteError> {
        N::try_from(self.get(key)?).map_err(|_| missing(key.name))
    }

    pub(super) fn text(&self, key: &Key<String>) -> Result<TextValue, WriteError> {
        TextValue::new(key.name, &self.get(key)?).map_err(cannot(key.name))
    }
}

/// Maps an error of the field `key`.
pub(super) fn cannot(field: &'static str) -> impl Fn(ValueError) -> WriteError {
    move |error| WriteError::CannotBeSent { field, reason: unfit(error) }
}

/// The unit does not report the value, and nobody gave one.
fn missing(field: &'static str) -> WriteError {
    WriteError::CannotBeSent { field, reason: Unfit::Text("has no value yet".to_owned()) }
}
