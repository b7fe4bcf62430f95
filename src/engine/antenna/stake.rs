//! What goes on with an antenna: it ends, or goes on unwatched, when the antenna is
//! locked out or the station ends.

use super::AntennaModel;
use crate::driver::{Intent, StopState};

/// What goes on with an antenna.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Stake {
    /// The unit tracks this by itself.
    OnBoard(Option<String>),
    /// This program follows the target of this name with it.
    ProgramTracked(String),
    /// It moves.
    Moves,
    /// A stop is owed to it.
    OwesStop,
    /// It was moved from here and is not known to stand since.
    Unproved,
}

impl AntennaModel {
    /// What goes on; `None` where it is known to stand and nothing is asked of it.
    pub fn stake(&self) -> Option<Stake> {
        let (snapshot, state) = (&self.snapshot, &self.snapshot.state);
        if matches!(snapshot.stop, StopState::Stopping { .. } | StopState::NotConfirmed { .. }) {
            return Some(Stake::OwesStop);
        }
        if let Some(following) = &snapshot.program_track {
            return Some(Stake::ProgramTracked(following.name.clone()));
        }
        if state.program.is_some_and(|program| program.enabled) {
            let held = state.on_board.satellite.as_ref();
            return Some(Stake::OnBoard(held.map(|held| held.name.clone())));
        }
        if snapshot.intent == Intent::Track {
            return Some(Stake::OnBoard(snapshot.target.as_ref().map(|it| it.name.clone())));
        }
        let moves = state.measured.is_some_and(|measured| measured.moving());
        if moves || snapshot.jog.is_some() || snapshot.step.is_some() {
            return Some(Stake::Moves);
        }
        snapshot.unproved.then_some(Stake::Unproved)
    }
}
