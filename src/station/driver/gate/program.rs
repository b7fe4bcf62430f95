//! Check of a pass before a unit that tracks on its own starts it.

use std::sync::Arc;

use super::{Gate, NoRoute};
use crate::{
    astro::Angle,
    clock::Moment,
    contract::driver::{Intent, Refusal},
    device::{Motion, OnBoard},
    plan::on_board::Judge,
};

/// Pass that a unit would track on its own.
#[derive(Debug, Clone)]
pub(in crate::driver) enum NextPass {
    /// Unread state of the unit.
    Unread,
    /// No pass: the unit has no satellite, or its window is over.
    Nothing,
    /// Known pass, from now on.
    Pass(Arc<Judge>),
    /// Satellite in a tracking window that is too long to check.
    TooLong { hours: f64 },
    /// Satellite whose orbit Azel does not know.
    Unknown { name: String },
}

impl Gate {
    /// Sets the pass against which the gate checks [`Motion::EnableAuto`].
    pub(in crate::driver) fn set_next_pass(&mut self, pass: NextPass) {
        self.next_pass = pass;
    }

    /// Checks whether the unit may track its stored pass.
    pub(super) fn next_pass_is_clear(&self, now: Moment) -> Result<(), Refusal> {
        match &self.next_pass {
            // With auto-track on and no target, the unit stands.
            NextPass::Nothing => Ok(()),
            NextPass::Pass(judge) => self.path_is_clear(judge, now),
            NextPass::Unread => Err(Refusal::PassUnknown),
            NextPass::TooLong { hours } => Err(Refusal::WindowTooLong { hours: *hours }),
            NextPass::Unknown { name } => Err(Refusal::OrbitUnknown { name: name.clone() }),
        }
    }

    /// Checks whether the unit may track this pass on its own. If so, the gate checks
    /// [`Motion::StartProgram`] against this pass from now on.
    pub(in crate::driver) fn check_pass(
        &mut self,
        judge: &Arc<Judge>,
        now: Moment,
    ) -> Result<(), Refusal> {
        // The rule checks the pass in `self.program`, so set it before the check.
        let before = self.program.replace(Arc::clone(judge));
        let checked = self.check(Motion::StartProgram, Intent::Track, now);
        if checked.is_err() {
            self.program = before;
        }
        checked
    }

    /// Checks a pass like [`Self::check_pass`]. If only the unit's own path to the start of the
    /// pass is blocked, returns a motion that takes the antenna there first.
    pub(in crate::driver) fn way_to_pass(
        &mut self,
        judge: &Arc<Judge>,
        now: Moment,
    ) -> Result<Option<Motion>, NoRoute> {
        let refusal = match self.check_pass(judge, now) {
            Ok(()) => return Ok(None),
            Err(refusal @ Refusal::Forbidden { .. }) => refusal,
            Err(other) => return Err(other.into()),
        };
        let Some(start) = judge.start(&self.state().on_board, now.utc) else {
            return Err(refusal.into());
        };
        let lowest = Angle::from_degrees(self.limits.minimum_elevation_deg);
        // A pass may begin below the minimum elevation, where the gate sends no antenna.
        let elevation = if start.elevation < lowest { lowest } else { start.elevation };
        let motion = Motion::Position { azimuth: Some(start.azimuth), elevation: Some(elevation) };
        let nearest = self.nearest(motion).map_err(|_| refusal.clone())?;
        self.route(nearest, Intent::Track, now).map_err(|no_route| match no_route {
            NoRoute::Refused(_) => refusal.into(),
            open @ NoRoute::Open(_) => open,
        })?;
        // Only the unit's own path to the start was blocked, not the pass. The rule checks that
        // path again at the start.
        self.program = Some(Arc::clone(judge));
        Ok(Some(motion))
    }

    /// Checks whether the whole path of the unit's program keeps to the bounds, with the unit's
    /// current report. Includes everything that the axes can sweep on the way to the start of the
    /// pass.
    pub(super) fn program_is_clear(&self, now: Moment) -> Result<(), Refusal> {
        self.path_is_clear(self.program.as_ref().ok_or(Refusal::PassUnknown)?, now)
    }

    fn path_is_clear(&self, judge: &Arc<Judge>, now: Moment) -> Result<(), Refusal> {
        self.unit_path_is_clear(judge, &self.state().on_board, now)
    }

    /// Does the same as [`Self::path_is_clear`] for a unit that would report `unit`.
    pub(super) fn unit_path_is_clear(
        &self,
        judge: &Arc<Judge>,
        unit: &OnBoard,
        now: Moment,
    ) -> Result<(), Refusal> {
        self.whole_path_is_clear(judge, unit)?;
        let start = judge.start(unit, now.utc).ok_or(Refusal::NoDirection { time: now.utc })?;
        self.slew_is_clear(start, now)
    }
}
