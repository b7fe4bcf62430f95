//! What a device that tracks by itself may be started on.

use std::sync::Arc;

use super::{Gate, Refusal};
use crate::{clock::Moment, device::Motion, driver::Intent, plan::on_board::Judge};

/// What a device would follow by itself.
#[derive(Debug, Clone)]
pub(in crate::driver) enum Held {
    /// It was not read yet.
    Unread,
    /// Nothing: it holds no satellite, or its window is over.
    Nothing,
    /// This, from now on.
    Pass(Arc<Judge>),
    /// A satellite whose orbit is not known here.
    Unknown {
        /// Its name.
        name: String,
    },
}

impl Gate {
    /// What [`Motion::EnableAuto`] is checked by from here on.
    pub(in crate::driver) fn will_hold(&mut self, held: Held) {
        self.held = held;
    }

    /// Whether the device may follow by itself what it holds.
    pub(super) fn held_is_clear(&self, now: Moment) -> Result<(), Refusal> {
        match &self.held {
            Held::Nothing => Ok(()),
            Held::Pass(judge) => self.path_is_clear(judge, now),
            Held::Unread => Err(Refusal::PassUnknown),
            Held::Unknown { name } => Err(Refusal::OrbitUnknown { name: name.clone() }),
        }
    }

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
        self.path_is_clear(self.program.as_ref().ok_or(Refusal::PassUnknown)?, now)
    }

    fn path_is_clear(&self, judge: &Judge, now: Moment) -> Result<(), Refusal> {
        let unit = &self.state().on_board;
        judge.is_clear(unit, &self.bounds).map_err(Refusal::Path)?;
        judge.start(unit).map_or(Ok(()), |start| self.slew_is_clear(start, now))
    }
}
