//! What a device that tracks by itself may be started on.

use std::sync::Arc;

use super::{Gate, Refusal};
use crate::{
    controller::{Moment, Motion},
    driver::Intent,
    plan::on_board::Judge,
};

impl Gate {
    /// Whether the device may track the pass of `judge` by itself. If so, that pass
    /// is what [`Motion::StartProgram`] is checked by from here on.
    pub(in crate::driver) fn check_pass(
        &mut self,
        judge: &Arc<Judge>,
        now: Moment,
    ) -> Result<(), Refusal> {
        let before = self.program.replace(Arc::clone(judge));
        let checked = self.check(Motion::StartProgram, Intent::Track, now);
        if checked.is_err() {
            self.program = before;
        }
        checked
    }

    /// Whether the whole way of the device's program, by what the device tells of
    /// itself now, is where the antenna may point.
    /// So is all that its axes can sweep on the way to where the pass begins.
    pub(super) fn program_is_clear(&self, now: Moment) -> Result<(), Refusal> {
        let judge = self.program.as_ref().ok_or(Refusal::PassUnknown)?;
        let unit = &self.state().on_board;
        judge.is_clear(unit, &self.bounds).map_err(Refusal::Path)?;
        judge.start(unit).map_or(Ok(()), |start| self.slew_is_clear(start, now))
    }
}
