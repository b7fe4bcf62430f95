//! Groups of satellites that the operator has made.

use serde::{Deserialize, Serialize};

use super::{PassLimits, Priority};

/// Satellites that share a priority and limits. A satellite's own priority and limits take
/// precedence.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SatelliteGroup {
    /// Name, not empty, and unique among the groups of the station.
    pub name: String,
    /// Catalog numbers of the satellites.
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
