//! Identity of a unit in debts and alarms.

use serde::{Deserialize, Serialize};

use crate::station::Antenna;

/// Identity of a unit. A new name of its antenna does not change it.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Unit {
    /// Key of the unit's make, as in the station file.
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
