//! Settings for program track.

use std::time::Duration;

use serde::Serialize;

/// Settings for program track with one antenna.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TrackSettings {
    /// Time between two checks of the position, seconds, 0.05 to 600.
    pub period_s: f64,
    /// Position error below which Azel sends no new position, degrees, 0 to 90. This dead band
    /// spares the relays of the drives.
    pub dead_band_deg: f64,
    /// Time from a command until the antenna moves, seconds, 0 to 60.
    pub latency_s: f64,
    pub after: AfterPass,
}

/// Action of an antenna when a pass is over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum AfterPass {
    /// Standstill at the last position.
    Hold,
    /// Move to the park position.
    Park,
    /// Move to the point where the next pass of the target rises.
    Next,
}

impl TrackSettings {
    /// Returns the time between two checks of the position.
    pub fn period(&self) -> Duration {
        Duration::try_from_secs_f64(self.period_s.clamp(0.05, 600.0))
            .unwrap_or(Duration::from_secs(1))
    }
}
