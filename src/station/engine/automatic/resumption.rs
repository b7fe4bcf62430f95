//! Resumption of automatic operation after a crash or a power cut, if the station file allows it
//! and the station is unchanged.

use std::time::Duration;

use super::LastRun;
use crate::{
    clock::Instant,
    contract::{
        automatic::{OffBecause, Operation},
        driver::{Event, Intent, Safety, StopState, TimeSync, Unit},
        transfer::FileHash,
    },
    engine::{Antenna, Engine},
    station::Station,
};

/// Min time at rest before automatic operation resumes.
const RESTS_FOR: Duration = Duration::from_secs(10);

/// Automatic operation that waits to resume.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Resumption {
    /// Time since which all conditions have been met.
    ready_since: Option<Instant>,
}

/// Returns a hash of the station's content; `None` if the station cannot be written.
pub(super) fn fingerprint(station: &Station) -> Option<FileHash> {
    toml::to_string(station).ok().map(|text| FileHash::new(text.as_bytes()))
}

/// Returns `true` for an event that would end or suspend automatic operation.
pub(super) fn ends_with(event: &Event) -> bool {
    match event {
        Event::Safety(matter) => match matter {
            Safety::DeadManFired
            | Safety::LeftMoving { .. }
            | Safety::SessionBroke
            | Safety::FlagsContradict { .. }
            | Safety::ForeignHands { .. }
            | Safety::SilentInMotion
            | Safety::NoEffect { .. }
            | Safety::OffTarget { .. }
            | Safety::ClockStepped { .. }
            | Safety::AsksToResume { .. }
            | Safety::UnitDiffers { .. }
            | Safety::Forbidden { .. } => true,
            Safety::NoMark
            | Safety::StoppedByFlags { .. }
            | Safety::EndedForSleep
            | Safety::Slept { .. } => false,
        },
        Event::StartedByItself
        | Event::Back { is_explained: false, .. }
        | Event::StopNotConfirmed
        | Event::StopRefused(_)
        | Event::AutoTrackStillOn
        | Event::AutoStaysOn
        | Event::AutoTrackNotKnown
        | Event::LockOutUnproved => true,
        // A unit that answers badly keeps automatic operation on: its next pass decides.
        Event::LinkLost(_)
        | Event::Connected(_)
        | Event::Back { is_explained: true, .. }
        | Event::NotSent(_)
        | Event::Refused(..)
        | Event::OffsetRefused(_)
        | Event::OffsetNotTaken(_)
        | Event::Unanswered(_)
        | Event::CannotTrack(..)
        | Event::WouldMiss { .. }
        | Event::Tracking(_)
        | Event::TrackingEnded { .. }
        | Event::Awaits { .. }
        | Event::ProgramTracks(_)
        | Event::ProgramTrackOver { .. }
        | Event::CannotProgramTrack(..)
        | Event::Arrived(_)
        | Event::EndedShort { .. }
        | Event::JogLeaseOver
        | Event::JogPositionOld
        | Event::Stopped => false,
    }
}

impl Engine {
    /// Stores the fingerprint of the changed station, so that Azel recognises it after a crash.
    pub(in crate::engine) fn keep_fingerprint(&mut self) {
        if self.last_run.station.is_some() {
            self.last_run.station = fingerprint(&self.station);
            self.keep_last_run();
        }
    }

    /// Marks the antennas whose automatic operation may resume after a run that did not end in order.
    pub(super) fn prepare_resumption(&mut self, last: &LastRun) {
        let is_same = last.station.is_some() && last.station == fingerprint(&self.station);
        let debts = self.driver.debts();
        let owed = debts.units();
        for antenna in &mut self.antennas {
            let config = &antenna.shown.config;
            let unit = Unit::new(config);
            // Somebody moved the antenna by hand, or pressed STOP.
            let is_marked = owed.contains(&unit) || debts.is_marked(&unit);
            let is_free = antenna.shown.held_by.is_none()
                && self.lock_outs.find(&config.connection).is_none()
                && !is_marked;
            let is_allowed =
                is_free && config.automatic.resumes_after_crash && last.was_on_at_crash(config.id);
            let resumption = (is_same && is_allowed).then(Resumption::default);
            antenna.at_work.resumption = resumption;
            // Power may fail again before automatic operation resumes.
            if resumption.is_some() {
                self.last_run.note_switch(antenna.shown.id(), true);
                self.last_run.station = last.station;
            }
        }
    }

    /// Switches automatic operation on once the antenna has been ready for long enough. The first
    /// motion is announced like any motion after a rest.
    pub(super) fn resume_after_crash(&mut self, index: usize) {
        let is_kept = self.time_sync == TimeSync::Synchronised && !self.clock_watch.is_in_doubt;
        let Some(antenna) = self.antennas.get(index) else { return };
        let Some(resumption) = antenna.at_work.resumption else { return };
        let shown = &antenna.shown;
        let is_taken = shown.held_by.is_some() || shown.snapshot.lock_out.is_some();
        if is_taken || shown.operation != Operation::Off(OffBecause::NotSwitchedOn) {
            return self.cancel_resumption(index);
        }
        let is_ready = is_kept && self.is_ready(antenna);
        let ready_since = is_ready.then_some(resumption.ready_since.unwrap_or(self.steady));
        let is_due = shown.is_live()
            && ready_since
                .is_some_and(|start| self.steady.saturating_duration_since(start) >= RESTS_FOR);
        if let Some(antenna) = self.antennas.get_mut(index) {
            antenna.at_work.resumption = Some(Resumption { ready_since });
        }
        if is_due {
            let name = self.antennas.get(index).map(|antenna| antenna.shown.config.name.clone());
            tracing::warn!(antenna = name, "automatic operation goes on after a crash");
            self.set_automatic(index, true);
        }
    }

    /// Cancels a pending resumption: only the operator switches automatic operation on.
    pub(in crate::engine) fn cancel_resumption(&mut self, index: usize) {
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        if antenna.at_work.resumption.take().is_some() {
            let id = antenna.shown.id();
            self.keep_switched_off(id, true);
        }
    }

    /// Returns `true` if the unit is at rest, owed nothing, and controlled by nobody else.
    fn is_ready(&self, antenna: &Antenna) -> bool {
        let (shown, snapshot) = (&antenna.shown, &antenna.shown.snapshot);
        let unit = Unit::new(&shown.config);
        let debts = self.driver.debts();
        let is_stopped = match snapshot.stop {
            StopState::Ready | StopState::Stopped { .. } => true,
            StopState::Stopping { .. } | StopState::NotConfirmed { .. } => false,
        };
        let program_is_off = snapshot.state.program.is_none_or(|program| !program.enabled);
        let stands = snapshot.state.measured.is_some_and(|measured| !measured.moving());
        is_stopped
            && program_is_off
            && stands
            && !shown.is_silent(self.steady)
            && snapshot.intent == Intent::Standby
            && snapshot.left_moving.is_none()
            && !snapshot.being_compared
            && snapshot.lock_out.is_none()
            && shown.held_by.is_none()
            && !debts.is_marked(&unit)
            && !debts.units().contains(&unit)
            && !self.station.unread.iter().any(|unread| unread.concerns(shown.id()))
    }
}
