//! Closing while antennas move.

use serde::{Deserialize, Serialize};

use crate::{
    clock::Instant,
    station::{AntennaId, OnClose, Station},
};

/// Treatment of antennas that move or track when the station closes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum CloseHow {
    /// Azel stops the antennas.
    Hold,
    /// Azel parks the antennas, and stops antennas that cannot park.
    Park,
    /// On-board track goes on; Azel stops every other motion.
    Leave,
}

/// A closing in progress. The program ends when all these antennas are done.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Closing {
    /// The operator's choice.
    #[serde(rename = "how")]
    pub choice: CloseHow,
    pub waits_for: Vec<(AntennaId, CloseCondition)>,
    /// Start of the closing.
    #[serde(rename = "since")]
    pub start: Instant,
}

/// Condition on an antenna that the closing waits for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum CloseCondition {
    /// Proved standstill.
    Still,
    /// Arrival at the park position.
    Parked,
}

impl CloseHow {
    /// Returns the choice in the station file; `None` if Azel has to ask the operator.
    pub fn from_station(station: &Station) -> Option<Self> {
        Some(match station.on_close? {
            OnClose::Hold => Self::Hold,
            OnClose::Park => Self::Park,
            OnClose::Leave => Self::Leave,
        })
    }
}
