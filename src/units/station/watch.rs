//! Automatic reactions of the station for an antenna.

use serde::{Serialize, Serializer};

/// Reaction of the monitor when somebody else drives the antenna into a forbidden
/// direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Monitor {
    /// STOP and an alarm.
    #[default]
    Stop,
    /// An alarm only.
    Alarm,
}

/// Action on an intent when the link is back after an outage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Resume {
    /// The operator is asked.
    #[default]
    Ask,
    /// The intent goes on, unless the outage was longer than the station allows.
    Continue,
}

/// In the file: `true` for [`Self::Continue`].
impl Serialize for Resume {
    fn serialize<S: Serializer>(&self, out: S) -> Result<S::Ok, S::Error> {
        (*self == Self::Continue).serialize(out)
    }
}

/// Action on the antennas when the program ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum OnClose {
    /// They stop and stay.
    Hold,
    /// They go to their park positions.
    Park,
    /// They go on with their present activity.
    Leave,
}

/// Default sway of a standing antenna between two positions, degrees.
pub const DEFAULT_SWAY_DEG: f64 = 0.1;
/// Default longest outage after which an antenna goes on, seconds.
pub const DEFAULT_RESUME_AFTER_S: f64 = 5.0;
