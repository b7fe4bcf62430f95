//! Activity of an antenna that ends, or goes on unwatched, when the antenna is locked out
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
    /// A stop is owed.
    OwesStop,
    /// It was moved from here and has not been proved to stand since.
    Unproved,
}

impl AntennaModel {
    /// The activity at stake; `None` where the antenna stands and nothing is asked of it.
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
