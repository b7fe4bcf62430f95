//! Offer, for a limited time, to resume a track that STOP has ended.

use jiff::Timestamp;

use super::{Engine, Hold, control::Rules as _, handle::Stopped};
use crate::{
    astro::time::add_seconds,
    contract::{
        Command,
        antenna::{AntennaModel, TrackAgain},
        closing::CloseHow,
        driver::{self, Intent},
    },
    plan::ProgramTrack,
    station::AntennaId,
};

/// Duration of the offer, seconds.
const OFFERED_S: f64 = 600.0;

impl Engine {
    /// Stores the track that a client ordered for an antenna. Any other choice ends the offer.
    pub(super) fn note_track(&mut self, command: &Command) {
        let (id, ordered) = match command {
            Command::Track { antenna, pass, is_agreed: false }
            | Command::ProgramTrackPass { antenna, pass } => {
                let Some(predicted) = self.pass_lists.find(*pass) else { return };
                let name = predicted.satellite.short_name().to_owned();
                let end = predicted.pass.los.time;
                (*antenna, Some(TrackAgain { name, command: command.clone(), end }))
            }
            Command::Antenna(antenna, driver::Command::ProgramTrack(follow)) => {
                let name = follow.target.name().into_owned();
                let end = end_of(follow, self.now);
                (*antenna, Some(TrackAgain { name, command: command.clone(), end }))
            }
            Command::Antenna(antenna, other) if chooses_something_else(other) => (*antenna, None),
            _ => return,
        };
        if let Some(antenna) = self.shown_mut(id) {
            antenna.ordered_track = ordered;
            antenna.track_again = None;
        }
    }

    fn shown_mut(&mut self, id: AntennaId) -> Option<&mut AntennaModel> {
        let place = self.place(id)?;
        self.antennas.get_mut(place).map(|antenna| &mut antenna.shown)
    }

    /// Offers to resume a target that waits for the operator's decision, like a track that STOP has
    /// ended.
    pub(super) fn offer_resume(&mut self, index: usize, name: &str) {
        let end = add_seconds(self.now, OFFERED_S);
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        let command = Command::Antenna(antenna.shown.id(), driver::Command::Resume);
        antenna.shown.track_again = Some(TrackAgain { name: name.to_owned(), command, end });
    }

    /// Applies a STOP that was sent to the sessions to the rest of the station.
    pub(super) fn note_stop(&mut self, stopped: &Stopped) {
        self.note_pressed_stop(stopped);
        self.upload_runner.stopped();
        let mut elsewhere = stopped.elsewhere.clone();
        elsewhere.extend(self.antennas_left_since(stopped));
        self.stop_elsewhere(&elsewhere);
        self.drop_waiting_settings();
        self.end_automatic_by_stop(stopped);
        // STOP also ends parking for the close: the operator must decide.
        self.closing.take_if(|closing| closing.choice == CloseHow::Park);
        let latest = add_seconds(self.now, OFFERED_S);
        let now = self.moment();
        for antenna in &mut self.antennas {
            let id = antenna.shown.id();
            let is_new = antenna.session > stopped.newest_session;
            let is_meant = stopped.antennas.contains(&id)
                || stopped.is_for_all && antenna.handle.stopper().is_wanted();
            if is_new && is_meant {
                // The session opened after the STOP, so send STOP again.
                antenna.handle.stop();
            }
            if !stopped.antennas.contains(&id) {
                continue;
            }
            antenna.shown.control.give_by_stop(stopped.origin, now);
            let shown = &mut antenna.shown;
            shown.asks_unseen = None;
            shown.stop_pressed = Some(stopped.instant);
            shown.last_stop = Some(stopped.instant);
            shown.tally.stops.press(stopped.instant);
            if !stopped.tracked.contains(&id) {
                continue;
            }
            shown.track_again = shown.ordered_track.take().map(|ordered| {
                let end = ordered.end.min(latest);
                TrackAgain { end, ..ordered }
            });
        }
    }

    /// Returns the antennas that this STOP was meant for and that moved to another process after
    /// the press.
    fn antennas_left_since(&self, stopped: &Stopped) -> impl Iterator<Item = AntennaId> {
        let left = self.antennas.iter().filter(|antenna| match antenna.hold {
            Hold::Ours(_) => false,
            Hold::Elsewhere(_) => antenna.session > stopped.newest_session,
        });
        left.map(|antenna| antenna.shown.id()).filter(|id| {
            let is_meant = stopped.is_for_all || stopped.antennas.contains(id);
            is_meant && !stopped.elsewhere.contains(id)
        })
    }

    /// Drops offers that are no longer valid.
    pub(super) fn forget_tracks(&mut self) {
        let (now, pass_lists) = (self.now, &self.pass_lists);
        for antenna in &mut self.antennas {
            let antenna = &mut antenna.shown;
            let snapshot = &antenna.snapshot;
            let chosen = !matches!(snapshot.intent, Intent::Standby | Intent::Track);
            let is_locked_out = snapshot.lock_out.is_some();
            antenna.track_again.take_if(|again| {
                let is_gone = match again.command {
                    Command::Track { pass, .. } => pass_lists.find(pass).is_none(),
                    _ => false,
                };
                now >= again.end || chosen || is_locked_out || is_gone
            });
        }
    }
}

/// Returns the end of the current or next pass; `Timestamp::MAX` for a target that does not set.
fn end_of(follow: &ProgramTrack, now: Timestamp) -> Timestamp {
    let passes = follow.passes.iter();
    passes.map(|(_, los)| *los).find(|los| *los > now).unwrap_or(Timestamp::MAX)
}

fn chooses_something_else(command: &driver::Command) -> bool {
    matches!(
        command,
        driver::Command::Standby
            | driver::Command::Manual
            | driver::Command::Hold
            | driver::Command::Jog { .. }
            | driver::Command::Step { .. }
            | driver::Command::Position { .. }
            | driver::Command::MoveAway
            | driver::Command::ProgramTrackIntoSun(_)
            | driver::Command::Track(_)
            | driver::Command::TakeOver
            | driver::Command::Park
            | driver::Command::Resume
            | driver::Command::Act(_)
            | driver::Command::ActUnseen(_)
            | driver::Command::LockOut(_)
            | driver::Command::Disconnect
    )
}
