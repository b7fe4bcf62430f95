//! Automatic reactions of the station for an antenna.

use serde::{Serialize, Serializer};

/// Reaction of the monitor when another operator drives the antenna into a forbidden direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Monitor {
    /// STOP and an alarm.
    #[default]
    Stop,
    /// An alarm only.
    Alarm,
}

/// Action on an intent when the link returns after an outage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Resume {
    /// A question to the operator.
    #[default]
    Ask,
    /// Continuation of the intent, unless the outage was longer than the station allows.
    Continue,
}

/// Writes `true` for [`Self::Continue`], else `false`.
impl Serialize for Resume {
    fn serialize<S: Serializer>(&self, out: S) -> Result<S::Ok, S::Error> {
        (*self == Self::Continue).serialize(out)
    }
}

/// Action on the antennas when Azel closes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum OnClose {
    /// Standstill of the antennas.
    Hold,
    /// Move of the antennas to their park positions.
    Park,
    /// Continuation of the current activity.
    Leave,
}

/// Default sway of a standing antenna between two positions, degrees.
pub const DEFAULT_SWAY_DEG: f64 = 0.1;
/// Default max outage after which an antenna continues without a question, seconds.
pub const DEFAULT_RESUME_AFTER_S: f64 = 5.0;
