//! Reasons why a setting that decides where the antenna points has to wait.

use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::{
    clock::Instant,
    device::{AntennaState, Capabilities},
};

/// Age from which a position says nothing about an antenna that may move.
const RECENT: Duration = Duration::from_secs(5);

/// Reason not to send a setting now that decides where the antenna points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error, Serialize, Deserialize)]
pub enum Hindrance {
    #[error("a stop is under way: wait until the antenna has stopped")]
    Stopping,
    /// A link on which Azel has not recently read the position, or has not read the unit's program.
    #[error("it is not known whether the antenna is at rest: wait until its position is read")]
    Unknown,
    /// On-board track that is under way.
    #[error("the unit tracks: stop it first")]
    Tracks,
    /// Auto-track that is on.
    #[error("auto-track is on: switch it off first")]
    AutoTrack,
    /// An antenna that moves, or may move.
    #[error("the antenna moves: stop it first")]
    Moves,
}

impl Hindrance {
    /// Returns the reason not to send such a setting at `now`, according to the state of a unit.
    pub fn from_state(state: &AntennaState, can: Capabilities, now: Instant) -> Option<Self> {
        let link_since = state.link_since;
        let measured = state
            .measured
            .filter(|measured| link_since.is_some_and(|start| measured.requested >= start))
            .filter(|measured| now.saturating_duration_since(measured.requested) < RECENT);
        let Some(measured) = measured else { return Some(Self::Unknown) };
        match state.program {
            None if can.has_program => Some(Self::Unknown),
            Some(program) if program.enabled => Some(Self::Tracks),
            Some(program) if program.auto == Some(true) => Some(Self::AutoTrack),
            _ => measured.moving().then_some(Self::Moves),
        }
    }
}
