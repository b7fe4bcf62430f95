//! What the station does by itself for an antenna.

use serde::{Serialize, Serializer};

/// What the monitor does when somebody else drives the antenna into what is
/// forbidden.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Monitor {
    /// STOP and an alarm.
    #[default]
    Stop,
    /// An alarm alone.
    Alarm,
}

/// What becomes of an intent when the link is back after an outage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Resume {
    /// The operator is asked.
    #[default]
    Ask,
    /// It goes on, unless the outage was longer than the station allows.
    Continue,
}

/// In the file: whether it resumes.
impl Serialize for Resume {
    fn serialize<S: Serializer>(&self, out: S) -> Result<S::Ok, S::Error> {
        (*self == Self::Continue).serialize(out)
    }
}

/// What becomes of the antennas when the program ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum OnClose {
    /// They stop and stay.
    Hold,
    /// They go to their park positions.
    Park,
    /// They go on with what they do.
    Leave,
}

/// How far a standing antenna usually sways between two looks, degrees.
pub const DEFAULT_SWAY_DEG: f64 = 0.1;
/// The usual longest outage after which an antenna goes on, seconds.
pub const DEFAULT_RESUME_AFTER_S: f64 = 5.0;
