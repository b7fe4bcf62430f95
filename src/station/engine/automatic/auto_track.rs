//! Auto-track: a unit starts the pass that it holds by itself, while automatic operation is on.

use crate::{
    contract::driver,
    engine::{Antenna, Engine},
};

impl Antenna {
    /// Automatic operation uses auto-track of the unit.
    fn uses_auto_track(&self) -> bool {
        let is_chosen = self.shown.config.automatic.uses_auto_track;
        is_chosen && self.shown.variant().capabilities.has_program
    }

    /// Automatic operation may have left auto-track on, in this run or one before.
    pub(in crate::engine) fn may_have_auto_track(&self) -> bool {
        let program = self.shown.snapshot.state.program;
        let is_read_off = program.is_some_and(|program| program.auto == Some(false));
        self.at_work.has_auto_track_on || self.uses_auto_track() && !is_read_off
    }
}

impl Engine {
    /// The unit starts what it holds by itself, where the operator wants that.
    pub(super) fn switch_auto_track_on(&mut self, index: usize) {
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        if antenna.uses_auto_track() {
            antenna.at_work.has_auto_track_on = true;
            self.send(index, driver::Command::AutoTrack(true));
        }
    }

    /// Has auto-track switched off where automatic operation uses it, in this run or one before.
    pub(super) fn end_auto_track(&mut self, index: usize) {
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        let was_on = std::mem::take(&mut antenna.at_work.has_auto_track_on);
        // A lock-out switches it off by itself.
        let is_free = antenna.shown.snapshot.lock_out.is_none() && antenna.shown.held_by.is_none();
        if is_free && (was_on || antenna.uses_auto_track()) {
            self.send(index, driver::Command::AutoTrack(false));
        }
    }
}
