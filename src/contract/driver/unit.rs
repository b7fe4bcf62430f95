//! A unit, as debts and alarms name it.

use serde::{Deserialize, Serialize};

use crate::station::Antenna;

/// A unit, by what does not change when the operator renames its antenna.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Unit {
    /// Key of its make, as in the station file.
    pub make: String,
    /// Address in lower case, because host names ignore case.
    pub address: String,
}

impl Unit {
    pub fn new(antenna: &Antenna) -> Self {
        Self {
            make: antenna.connection.spec().key.to_owned(),
            address: antenna.connection.address.trim().to_lowercase(),
        }
    }
}
