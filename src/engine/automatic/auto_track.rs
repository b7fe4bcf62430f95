//! Auto-track: a unit starts the pass that it holds by itself, while automatic operation is on.

use std::time::Duration;

use crate::{
    clock::Instant,
    driver,
    engine::{Antenna, Engine},
};

/// A unit that still has auto-track on is told again after this time.
const AUTO_TRACK_AGAIN: Duration = Duration::from_secs(10);

/// Auto-track of a unit, as far as automatic operation has to do with it.
#[derive(Default)]
pub(super) enum AutoTrack {
    /// As the operator has it.
    #[default]
    Untouched,
    /// Switched on for a pass that the unit holds.
    On,
    /// To be switched off, once the unit can be reached. When that was sent last.
    ToBeOff { sent: Option<Instant> },
}

impl Antenna {
    /// Has auto-track switched off where automatic operation uses it, in this run or one before.
    pub(super) fn end_auto_track(&mut self) {
        let is_chosen = self.shown.config.automatic.uses_auto_track;
        let is_used = is_chosen && self.shown.variant().capabilities.has_program;
        if is_used || matches!(self.at_work.auto_track, AutoTrack::On) {
            self.at_work.auto_track = AutoTrack::ToBeOff { sent: None };
        }
    }
}

impl Engine {
    /// The unit starts what it holds by itself, where the operator wants that.
    pub(super) fn switch_auto_track_on(&mut self, index: usize) {
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        let shown = &antenna.shown;
        if shown.config.automatic.uses_auto_track && shown.variant().capabilities.has_program {
            antenna.at_work.auto_track = AutoTrack::On;
            self.send(index, driver::Command::AutoTrack(true));
        }
    }

    /// Switches auto-track off where that is owed, until the unit says so.
    pub(super) fn switch_auto_track_off(&mut self, index: usize) {
        let now = self.steady;
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        let AutoTrack::ToBeOff { sent } = &mut antenna.at_work.auto_track else { return };
        if antenna.shown.snapshot.lock_out.is_some() {
            // The lock-out has switched it off.
            antenna.at_work.auto_track = AutoTrack::Untouched;
            return;
        }
        if !antenna.shown.is_live() {
            return;
        }
        let state = &antenna.shown.snapshot.state;
        let is_off = state.program.is_some_and(|program| program.auto != Some(true));
        let is_answer = |sent| state.measured.is_some_and(|measured| measured.asked > sent);
        if is_off && sent.is_some_and(is_answer) {
            antenna.at_work.auto_track = AutoTrack::Untouched;
        } else if sent.is_none_or(|at| now.saturating_duration_since(at) >= AUTO_TRACK_AGAIN) {
            *sent = Some(now);
            self.send(index, driver::Command::AutoTrack(false));
        }
    }
}
