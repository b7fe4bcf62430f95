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
    pub how: CloseHow,
    pub waits_for: Vec<(AntennaId, Wanted)>,
    /// When it began.
    pub since: Instant,
}

/// Condition that a closing waits for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Wanted {
    /// Proved standstill.
    Still,
    /// Arrival at the park position.
    Parked,
}

impl CloseHow {
    /// The choice in the station file; `None` where the operator is asked.
    pub fn of(station: &Station) -> Option<Self> {
        Some(match station.on_close? {
            OnClose::Hold => Self::Hold,
            OnClose::Park => Self::Park,
            OnClose::Leave => Self::Leave,
        })
    }
}
