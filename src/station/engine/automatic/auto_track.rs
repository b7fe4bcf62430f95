//! Auto-track: a unit starts its loaded pass on its own, while automatic operation is on.

use crate::{
    contract::driver,
    engine::{Antenna, Engine},
};

impl Antenna {
    /// Returns `true` if automatic operation uses the unit's auto-track.
    fn uses_auto_track(&self) -> bool {
        let is_chosen = self.shown.config.automatic.uses_auto_track;
        is_chosen && self.shown.variant().capabilities.has_program
    }

    /// Returns `true` if automatic operation may have left auto-track on, in this run or an earlier
    /// one.
    pub(in crate::engine) fn may_have_auto_track(&self) -> bool {
        let program = self.shown.snapshot.state.program;
        let is_read_off = program.is_some_and(|program| program.auto == Some(false));
        self.at_work.has_auto_track_on || self.uses_auto_track() && !is_read_off
    }
}

impl Engine {
    /// Switches auto-track on if the operator wants it, so that the unit starts its loaded pass.
    pub(super) fn switch_auto_track_on(&mut self, index: usize) {
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        if antenna.uses_auto_track() {
            antenna.at_work.has_auto_track_on = true;
            self.send(index, driver::Command::AutoTrack(true));
        }
    }

    /// Switches auto-track off if automatic operation uses it, in this run or an earlier one.
    pub(super) fn end_auto_track(&mut self, index: usize) {
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        let was_on = std::mem::take(&mut antenna.at_work.has_auto_track_on);
        // A lock-out switches auto-track off too.
        let is_free = antenna.shown.snapshot.lock_out.is_none() && antenna.shown.held_by.is_none();
        if is_free && (was_on || antenna.uses_auto_track()) {
            self.send(index, driver::Command::AutoTrack(false));
        }
    }
}
