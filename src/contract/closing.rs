//! Closing while antennas move.

use serde::{Deserialize, Serialize};

use crate::{
    clock::Instant,
    station::{AntennaId, OnClose, Station},
};

/// Treatment of antennas that move or track at the end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum CloseHow {
    /// They are stopped and hold.
    Hold,
    /// They are parked; those that cannot be parked are stopped.
    Park,
    /// On-board track goes on; everything else that moves is stopped.
    Leave,
}

/// A closing under way: the program ends when these antennas are done.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Closing {
    /// The operator's choice.
    #[serde(rename = "how")]
    pub choice: CloseHow,
    pub waits_for: Vec<(AntennaId, CloseCondition)>,
    /// When it began.
    #[serde(rename = "since")]
    pub start: Instant,
}

/// Condition that a closing waits for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum CloseCondition {
    /// Proved standstill.
    Still,
    /// Arrival at the park position.
    Parked,
}

impl CloseHow {
    /// The choice in the station file; `None` where the operator is asked.
    pub fn from_station(station: &Station) -> Option<Self> {
        Some(match station.on_close? {
            OnClose::Hold => Self::Hold,
            OnClose::Park => Self::Park,
            OnClose::Leave => Self::Leave,
        })
    }
}
