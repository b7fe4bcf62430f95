//! The end of the window while antennas move: first what the operator has said, then
//! the end.

use std::{
    sync::atomic::Ordering,
    time::{Duration, Instant},
};

use super::{App, antenna::Stake};
use crate::{
    driver::{Command, Event, Intent, StopState},
    station::{OnClose, Station},
};

/// A STOP is told as not proved before that.
const STOPPED_IN: Duration = Duration::from_secs(6);
/// By then a session has taken up what it was asked.
const TAKEN_IN: Duration = Duration::from_secs(2);

/// What becomes of antennas that move or are tracked when the window closes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CloseHow {
    /// They are stopped and hold.
    Hold,
    /// They are parked; what cannot be parked is stopped.
    Park,
    /// What a unit tracks by itself goes on; what else moves is stopped.
    Leave,
}

/// The window closes when these antennas are done.
#[derive(Debug, Clone, PartialEq)]
pub struct Closing {
    /// What the operator has said.
    pub how: CloseHow,
    /// The antennas that are waited for, by their index.
    pub waits_for: Vec<(usize, Wanted)>,
    since: Instant,
}

/// What is waited for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wanted {
    /// Proved standstill.
    Still,
    /// Arrival at the park position.
    Parked,
}

impl CloseHow {
    /// What the station says; `None` where the operator is asked.
    pub fn of(station: &Station) -> Option<Self> {
        Some(match station.on_close? {
            OnClose::Hold => Self::Hold,
            OnClose::Park => Self::Park,
            OnClose::Leave => Self::Leave,
        })
    }
}

impl App {
    /// Does what the operator has said and closes when it is done.
    pub(super) fn close_after(&mut self, how: CloseHow) {
        let mut waits_for = Vec::new();
        for index in 0..self.model.antennas.len() {
            let Some(antenna) = self.model.antennas.get(index) else { continue };
            let Some(stake) = antenna.stake() else { continue };
            if how == CloseHow::Leave && matches!(stake, Stake::OnBoard(_)) {
                continue;
            }
            if how == CloseHow::Park && antenna.can_park() {
                self.send(index, Command::Park);
                waits_for.push((index, Wanted::Parked));
                continue;
            }
            // What was told as not proved once is not waited for again: a unit that
            // cannot be reached must not keep the window open.
            let was_told = matches!(antenna.snapshot.stop, StopState::NotConfirmed { .. });
            self.stop_one(index);
            if !was_told {
                waits_for.push((index, Wanted::Still));
            }
        }
        self.model.closing = Some(Closing { how, waits_for, since: self.model.steady });
    }

    /// STOP while the antennas are parked for the end: the operator is needed here.
    pub(super) fn stay_open_after_stop(&mut self) {
        self.model.closing.take_if(|closing| closing.how == CloseHow::Park);
    }

    /// Takes what an antenna has told while it is waited for.
    pub(super) fn take_closing_event(&mut self, index: usize, event: &Event) {
        let Some(closing) = &mut self.model.closing else { return };
        let Some(place) = closing.waits_for.iter().position(|(of, _)| *of == index) else { return };
        let Some((_, wanted)) = closing.waits_for.get(place) else { return };
        let is_done = match (wanted, event) {
            (Wanted::Still, Event::Stopped) | (Wanted::Parked, Event::Arrived(_)) => true,
            (_, Event::StopNotConfirmed)
            | (
                Wanted::Parked,
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
            // What went wrong stands on its card and in the alarms.
            self.model.closing = None;
        }
    }

    /// Ends a closing that does not come to its end.
    pub(super) fn watch_closing(&mut self) {
        let Some(closing) = &self.model.closing else { return };
        let age = self.model.steady.saturating_duration_since(closing.since);
        let fails = |(index, wanted): &(usize, Wanted)| {
            let Some(antenna) = self.model.antennas.get(*index) else { return false };
            match wanted {
                Wanted::Still => age > STOPPED_IN,
                Wanted::Parked => age > TAKEN_IN && antenna.snapshot.intent != Intent::Park,
            }
        };
        if closing.waits_for.iter().any(fails) {
            self.model.closing = None;
        }
    }

    /// Whether everything is done and the window may close.
    pub(super) fn closes_now(&mut self) -> bool {
        let is_done =
            self.model.closing.as_ref().is_some_and(|closing| closing.waits_for.is_empty());
        if is_done {
            self.model.closing = None;
            self.may_close.store(true, Ordering::Relaxed);
        }
        is_done
    }

    /// The program ends and nobody can be asked.
    pub(super) fn end_unasked(&mut self) {
        match CloseHow::of(&self.model.station) {
            // Parking takes longer than the operating system waits.
            None | Some(CloseHow::Hold | CloseHow::Park) => {
                for antenna in &self.model.antennas {
                    if antenna.stake().is_some() {
                        antenna.handle.stop();
                    }
                }
            }
            Some(CloseHow::Leave) => {}
        }
    }
}
