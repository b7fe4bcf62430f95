//! How this program follows a target with an antenna.

use std::time::Duration;

use serde::Serialize;

/// How this program follows a target with an antenna whose controller does not
/// do so by itself.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TrackSettings {
    /// Between two looks at where the antenna should be, seconds, 0.05 to 600.
    pub period_s: f64,
    /// No new position is sent while the last one is off by less, degrees, 0 to
    /// 90: it spares the relays of the drives.
    pub dead_band_deg: f64,
    /// From a command until the metal moves, seconds, 0 to 60.
    pub latency_s: f64,
    /// What the antenna does when a pass is over.
    pub after: AfterPass,
}

/// What an antenna does when a pass is over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum AfterPass {
    /// It stays where it is.
    Hold,
    /// It goes to its park position.
    Park,
    /// It waits for the next pass of its target at the place where it rises.
    Next,
}

impl TrackSettings {
    /// Between two looks at where the antenna should be.
    pub fn period(&self) -> Duration {
        Duration::try_from_secs_f64(self.period_s.clamp(0.05, 600.0))
            .unwrap_or(Duration::from_secs(1))
    }
}
