//! Closing while antennas move: Azel carries out the operator's choice, then ends.

use std::time::Duration;

use super::Engine;
use crate::{
    contract::{
        Event as Told,
        antenna::Stake,
        automatic::Interruption,
        closing::{CloseCondition, CloseHow, Closing},
        driver::{Command, Event, Intent, StopState},
    },
    engine::automatic::Operate,
    station::AntennaId,
};

/// Max time for a session to prove or report a STOP; after it, the closing fails.
const STOPPED_IN: Duration = Duration::from_secs(6);
/// Max time for a session to start a parking command; after it, the closing fails.
const TAKEN_IN: Duration = Duration::from_secs(2);

impl Engine {
    /// Carries out the operator's choice, and closes once it is done.
    pub(super) fn close_after(&mut self, choice: CloseHow) {
        let mut waits_for = Vec::new();
        for index in 0..self.antennas.len() {
            let Some(antenna) = self.antennas.get_mut(index) else { continue };
            let antenna = &mut antenna.shown;
            let id = antenna.id();
            let Some(stake) = antenna.stake() else { continue };
            if choice == CloseHow::Leave && matches!(stake, Stake::OnBoard(_)) {
                continue;
            }
            // Suspend even if the closing fails later: the operator has ended the track.
            antenna.operation.suspend(Interruption::ByHand, self.now);
            if choice == CloseHow::Park && antenna.can_park() {
                self.send(index, Command::Park);
                waits_for.push((id, CloseCondition::Parked));
                continue;
            }
            // Do not wait again for an antenna already reported as not stopped: an unreachable unit
            // must not delay the end.
            let was_told = matches!(antenna.snapshot.stop, StopState::NotConfirmed { .. });
            self.stop_one(index);
            if !was_told {
                waits_for.push((id, CloseCondition::Still));
            }
        }
        self.closing = Some(Closing { choice, waits_for, start: self.steady });
    }

    /// Handles an event of an antenna that the closing waits for.
    pub(super) fn take_closing_event(&mut self, id: AntennaId, event: &Event) {
        let Some(closing) = &mut self.closing else { return };
        let Some(place) = closing.waits_for.iter().position(|(antenna, _)| *antenna == id) else {
            return;
        };
        let Some((_, condition)) = closing.waits_for.get(place) else { return };
        let is_done = match (condition, event) {
            (CloseCondition::Still, Event::Stopped)
            | (CloseCondition::Parked, Event::Arrived(_)) => true,
            (_, Event::StopNotConfirmed)
            | (
                CloseCondition::Parked,
                Event::NotSent(_)
                | Event::Refused(..)
                | Event::Unanswered(_)
                | Event::EndedShort { .. }
                | Event::LinkLost(_),
            ) => false,
            _ => return,
        };
        if is_done {
            closing.waits_for.remove(place);
        } else {
            // The antenna's card and the alarms show what went wrong.
            self.closing = None;
        }
    }

    /// Drops a closing that fails, and reports one that is done.
    pub(super) fn watch_closing(&mut self) {
        let Some(closing) = &self.closing else { return };
        let age = self.steady.saturating_duration_since(closing.start);
        let fails = |(id, condition): &(AntennaId, CloseCondition)| {
            let Some(antenna) = self.place(*id).and_then(|place| self.antennas.get(place)) else {
                return false;
            };
            match condition {
                CloseCondition::Still => age > STOPPED_IN,
                CloseCondition::Parked => {
                    age > TAKEN_IN && antenna.shown.snapshot.intent != Intent::Park
                }
            }
        };
        if closing.waits_for.iter().any(fails) {
            self.closing = None;
        } else if closing.waits_for.is_empty() {
            self.closing = None;
            self.tell(Told::MayEnd);
        }
    }

    /// Ends without asking the operator: stops active antennas unless the station file says to
    /// leave them.
    pub(super) fn end_unasked(&mut self) {
        match CloseHow::from_station(&self.station) {
            // Parking takes longer than the operating system permits.
            None | Some(CloseHow::Hold | CloseHow::Park) => {
                for antenna in &self.antennas {
                    if antenna.shown.stake().is_some() {
                        antenna.handle.stop();
                    }
                }
            }
            Some(CloseHow::Leave) => {}
        }
    }
}
