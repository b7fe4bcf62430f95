//! Activity of an antenna that ends, or goes on unwatched, when the operator locks the antenna out
//! or the station ends.

use crate::{
    antenna::AntennaModel,
    driver::{Intent, StopState},
};

/// Activity of an antenna that is at stake.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Stake {
    /// On-board track of the satellite with this name.
    OnBoard(Option<String>),
    /// Program track of the target with this name.
    ProgramTracked(String),
    Moves,
    /// A STOP is not yet proved.
    OwesStop,
    /// Azel has moved the antenna, and standstill is not yet proved.
    Unproved,
}

impl AntennaModel {
    /// Returns the activity at stake; `None` if the antenna stands and has no request.
    pub fn stake(&self) -> Option<Stake> {
        let (snapshot, state) = (&self.snapshot, &self.snapshot.state);
        if matches!(snapshot.stop, StopState::Stopping { .. } | StopState::NotConfirmed { .. }) {
            return Some(Stake::OwesStop);
        }
        if let Some(following) = &snapshot.program_track {
            return Some(Stake::ProgramTracked(following.name.clone()));
        }
        if state.program.is_some_and(|program| program.enabled) {
            let satellite = state.on_board.satellite.as_ref();
            return Some(Stake::OnBoard(satellite.map(|satellite| satellite.name.clone())));
        }
        if snapshot.intent == Intent::Track {
            return Some(Stake::OnBoard(
                snapshot.target.as_ref().map(|target| target.name.clone()),
            ));
        }
        let moves = state.measured.is_some_and(|measured| measured.moving());
        if moves || snapshot.jog.is_some() || snapshot.step.is_some() {
            return Some(Stake::Moves);
        }
        snapshot.unproved.then_some(Stake::Unproved)
    }
}
