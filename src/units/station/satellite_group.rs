//! Groups of satellites that the operator has made.

use serde::{Deserialize, Serialize};

use super::{PassLimits, Priority};

/// Satellites with a priority and limits for those that have none of their own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SatelliteGroup {
    /// Not empty, and unique among the groups of the station.
    pub name: String,
    /// Catalog numbers.
    pub satellites: Vec<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub priority: Option<Priority>,
    #[serde(flatten)]
    pub limits: PassLimits,
}

impl SatelliteGroup {
    pub fn contains(&self, satellite: u32) -> bool {
        self.satellites.contains(&satellite)
    }
}
