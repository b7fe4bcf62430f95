//! Automation rules: what the schedule does with passes by antenna, satellite, Sun and hour.

use jiff::{Timestamp, tz::TimeZone};
use serde::{Deserialize, Serialize};

use super::{AntennaId, HoursOfDay};

/// A rule. The first rule that is on and whose conditions all hold decides.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AutomationRule {
    #[serde(rename = "on", default = "enabled_by_default", skip_serializing_if = "is_enabled")]
    pub is_on: bool,
    /// `None` for all antennas.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub antenna: Option<AntennaId>,
    /// `None` for all satellites.
    #[serde(flatten)]
    pub subject: Option<RuleSubject>,
    /// `None` whatever the Sun does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sun: Option<SunIs>,
    /// By UTC; `None` for all hours.
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

/// The Sun at the site.
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
    /// The pass may be taken, whatever the limits of its satellite say.
    Take,
    /// The antenna does not take the pass.
    Leave,
    /// The antenna takes no pass and stays parked.
    Park,
}

fn enabled_by_default() -> bool {
    true
}

// The signature is serde's.
#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_enabled(is_on: &bool) -> bool {
    *is_on == enabled_by_default()
}

impl AutomationRule {
    /// Returns `true` if it holds at a moment, where the Sun stands as given.
    pub fn holds_at(&self, time: Timestamp, sun: SunIs) -> bool {
        self.is_on
            && self.sun.is_none_or(|side| side == sun)
            && self.hours.is_none_or(|hours| hours.contain(time, &TimeZone::UTC))
    }

    /// Returns `true` if it is about this antenna.
    pub fn is_for(&self, antenna: AntennaId) -> bool {
        self.antenna.is_none_or(|antenna_id| antenna_id == antenna)
    }
}
