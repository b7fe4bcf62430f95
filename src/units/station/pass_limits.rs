//! Limits on the passes of a satellite or group that the schedule takes.

use serde::{Deserialize, Serialize};

use super::AntennaId;

/// Limits on the passes of a satellite or group that the schedule takes; `None` sets no limit.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PassLimits {
    /// Min of the max elevation of a pass, degrees, 0 to 90.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min_max_elevation_deg: Option<f64>,
    /// Min time above the horizon mask and the AOS elevation, seconds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min_duration_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub light: Option<Light>,
    /// The antennas that may take the passes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub antennas: Option<Vec<AntennaId>>,
    /// Max number of passes in a UTC day, by AOS; at least 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_per_day: Option<u32>,
}

/// Light at TCA.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Light {
    /// Sun above the horizon of the site.
    Day,
    /// Sun below the horizon of the site.
    Night,
    /// Sunlight on the satellite.
    Sunlit,
}

impl PassLimits {
    /// Returns these limits, with the limits of `others` in place of missing ones.
    #[must_use]
    pub fn or(&self, others: &Self) -> Self {
        Self {
            min_max_elevation_deg: self.min_max_elevation_deg.or(others.min_max_elevation_deg),
            min_duration_s: self.min_duration_s.or(others.min_duration_s),
            light: self.light.or(others.light),
            antennas: self.antennas.clone().or_else(|| others.antennas.clone()),
            max_per_day: self.max_per_day.or(others.max_per_day),
        }
    }
}
