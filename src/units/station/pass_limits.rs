//! Limits on the passes of a satellite or group that the schedule takes.

use serde::{Deserialize, Serialize};

use super::AntennaId;

/// Limits on the passes of a satellite or group that are taken; `None` sets no limit.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PassLimits {
    /// Smallest maximum elevation, degrees, 0 to 90.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min_max_elevation_deg: Option<f64>,
    /// Shortest time above the horizon mask and the AOS elevation, seconds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min_duration_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub light: Option<Light>,
    /// The antennas that may take them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub antennas: Option<Vec<AntennaId>>,
    /// Most passes a day of UTC, by AOS; at least 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_per_day: Option<u32>,
}

/// Light at TCA.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Light {
    /// The Sun is above the horizon of the site.
    Day,
    /// The Sun is below the horizon of the site.
    Night,
    /// The Sun shines on the satellite.
    Sunlit,
}

impl PassLimits {
    /// These limits, and where one is not set, that of `others`.
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
