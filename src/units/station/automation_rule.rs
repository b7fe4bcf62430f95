//! Automation rules: decisions of the schedule about passes, by antenna, satellite, Sun and hour.

use jiff::{Timestamp, tz::TimeZone};
use serde::{Deserialize, Serialize};

use super::{AntennaId, HoursOfDay};

/// A rule. The first enabled rule with matching conditions decides.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AutomationRule {
    #[serde(rename = "on", default = "enabled_by_default", skip_serializing_if = "is_enabled")]
    pub is_on: bool,
    /// Antenna of the rule; `None` for all antennas.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub antenna: Option<AntennaId>,
    /// Satellites of the rule; `None` for all satellites.
    #[serde(flatten)]
    pub subject: Option<RuleSubject>,
    /// Position of the Sun; `None` for any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sun: Option<SunIs>,
    /// Hours in UTC; `None` for all hours.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hours: Option<HoursOfDay>,
    #[serde(rename = "then")]
    pub action: RuleAction,
}

/// The satellites of a rule.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RuleSubject {
    /// Catalog number.
    Satellite(u32),
    /// Name of a group.
    Group(String),
}

/// Position of the Sun at the site.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SunIs {
    Up,
    Down,
}

/// Action of a rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RuleAction {
    /// Permission to take the pass, even outside the limits of its satellite.
    Take,
    /// Refusal of the pass.
    Leave,
    /// Refusal of all passes; the antenna stays parked.
    Park,
}

fn enabled_by_default() -> bool {
    true
}

// serde prescribes the signature.
#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_enabled(is_on: &bool) -> bool {
    *is_on == enabled_by_default()
}

impl AutomationRule {
    /// Returns `true` if the rule applies at `time` with the Sun at `sun`.
    pub fn holds_at(&self, time: Timestamp, sun: SunIs) -> bool {
        self.is_on
            && self.sun.is_none_or(|side| side == sun)
            && self.hours.is_none_or(|hours| hours.contain(time, &TimeZone::UTC))
    }

    /// Returns `true` if the rule covers this antenna.
    pub fn is_for(&self, antenna: AntennaId) -> bool {
        self.antenna.is_none_or(|antenna_id| antenna_id == antenna)
    }
}
