//! Reminders of passes.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::{astro::Angle, passes::PassListKey, station::AntennaId};

/// A reminder of a pass. It comes some minutes before AOS and lasts until LOS.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Reminder {
    /// The pass, as it was listed when the reminder came.
    pub pass: PassListKey,
    /// Short name of the satellite.
    pub name: String,
    pub los: Timestamp,
    pub max_elevation: Angle,
    /// The antennas that can track the pass or a part of it.
    pub can_track: Vec<AntennaId>,
}

impl Reminder {
    pub fn aos(&self) -> Timestamp {
        self.pass.1
    }
}
