//! A track that STOP has ended is offered again for a while.

use jiff::Timestamp;

use super::{App, UiCommand};
use crate::{
    astro::time::add_seconds,
    driver::{Command, Intent},
    plan::Follow,
};

/// For so long it is offered, seconds.
const OFFERED_S: f64 = 600.0;

/// A track, and what begins it.
#[derive(Debug, Clone, PartialEq)]
pub struct TrackAgain {
    /// Name of the target.
    pub name: String,
    /// What the operator asked for.
    pub command: UiCommand,
    /// When there is nothing more to track.
    pub until: Timestamp,
}

impl App {
    /// Keeps in mind what an antenna was asked to track. Whatever else is chosen ends
    /// the offer.
    pub(super) fn note_track(&mut self, command: &UiCommand) {
        let (index, ordered) = match command {
            UiCommand::Track { antenna, pass } => {
                let Some(forecast) = self.model.forecasts.find(*pass) else { return };
                let name = forecast.satellite.short_name().to_owned();
                let until = forecast.pass.los.time;
                (*antenna, Some(TrackAgain { name, command: command.clone(), until }))
            }
            UiCommand::Antenna(antenna, Command::Follow(follow)) => {
                let name = follow.target.name().into_owned();
                let until = end_of(follow, self.model.now);
                (*antenna, Some(TrackAgain { name, command: command.clone(), until }))
            }
            UiCommand::Antenna(antenna, other) if chooses_something_else(other) => (*antenna, None),
            _ => return,
        };
        if let Some(antenna) = self.model.antennas.get_mut(index) {
            antenna.ordered_track = ordered;
            antenna.track_again = None;
        }
    }

    /// A target that waits for the operator's word is offered as one that STOP has
    /// ended.
    pub(super) fn offer_resume(&mut self, index: usize, name: &str) {
        let until = add_seconds(self.model.now, OFFERED_S);
        let Some(antenna) = self.model.antennas.get_mut(index) else { return };
        let command = UiCommand::Antenna(index, Command::Resume);
        antenna.track_again = Some(TrackAgain { name: name.to_owned(), command, until });
    }

    /// A STOP goes to this antenna now.
    pub(super) fn note_stop(&mut self, index: usize) {
        let latest = add_seconds(self.model.now, OFFERED_S);
        let Some(antenna) = self.model.antennas.get_mut(index) else { return };
        let told = antenna.handle.snapshot();
        if told.intent != Intent::Track {
            return;
        }
        antenna.track_again = antenna.ordered_track.take().map(|ordered| {
            let until = ordered.until.min(latest);
            TrackAgain { until, ..ordered }
        });
    }

    /// Ends the offers whose time is over.
    pub(super) fn forget_tracks(&mut self) {
        let (now, forecasts) = (self.model.now, &self.model.forecasts);
        for antenna in &mut self.model.antennas {
            let snapshot = &antenna.snapshot;
            let chosen = !matches!(snapshot.intent, Intent::Standby | Intent::Track);
            let is_locked_out = snapshot.lock_out.is_some();
            antenna.track_again.take_if(|again| {
                let is_gone = match again.command {
                    UiCommand::Track { pass, .. } => forecasts.find(pass).is_none(),
                    _ => false,
                };
                now >= again.until || chosen || is_locked_out || is_gone
            });
        }
    }
}

/// When the pass that is followed is over; never for what does not set.
fn end_of(follow: &Follow, now: Timestamp) -> Timestamp {
    let passes = follow.passes.iter();
    passes.map(|(_, los)| *los).find(|los| *los > now).unwrap_or(Timestamp::MAX)
}

fn chooses_something_else(command: &Command) -> bool {
    matches!(
        command,
        Command::Standby
            | Command::Manual
            | Command::Hold
            | Command::Jog { .. }
            | Command::Step { .. }
            | Command::Position { .. }
            | Command::MoveAway
            | Command::FollowIntoSun(_)
            | Command::Track(_)
            | Command::Park
            | Command::Resume
            | Command::Act(_)
            | Command::ActUnseen(_)
            | Command::LockOut(_)
            | Command::Disconnect
    )
}
