//! Reminders of passes.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{astro::Angle, passes::PassListKey, station::AntennaId};

/// A reminder of a pass. It appears some minutes before AOS and lasts until LOS.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Reminder {
    /// Key of the pass in the list that caused the reminder.
    pub pass: PassListKey,
    /// Short name of the satellite.
    pub name: String,
    pub los: Timestamp,
    pub max_elevation: Angle,
    /// Antennas that can track at least a part of the pass.
    pub can_track: Vec<AntennaId>,
}

impl Reminder {
    pub fn aos(&self) -> Timestamp {
        self.pass.1
    }
}
