//! Settings and targets that decide where the antenna points, before they reach the controller.

use std::sync::Arc;

use super::{Gate, RuleCheck, Situation};
use crate::{
    clock::Moment,
    contract::driver::{Intent, Refusal},
    device::{
        Motion, OnBoard, TrackTarget,
        settings::{Change, WriteError},
    },
    plan::on_board::Judge,
};

/// Motion of a unit that tracks on its own, with other offsets.
#[derive(Debug, Clone)]
pub(in crate::driver) struct Shift {
    /// Pass from now on.
    pub(in crate::driver) judge: Arc<Judge>,
    /// State that the unit would report.
    pub(in crate::driver) axes: OnBoard,
    /// The same state without Azel's offsets: the beam direction, if the offsets correct errors of
    /// the mount.
    pub(in crate::driver) sky: OnBoard,
}

impl Gate {
    /// Checks whether a tracking unit may get other offsets. Checks the whole path from now on, by
    /// the axes and on the sky.
    pub(in crate::driver) fn shift_is_clear(
        &self,
        shift: &Shift,
        stopping: bool,
        now: Moment,
    ) -> Result<(), Refusal> {
        let situation = self.situation(Intent::Track, stopping, now);
        self.ask_rules(|check| match check {
            RuleCheck::Moving(check) => check(&Motion::StartProgram.into(), &situation),
            RuleCheck::AnySetting(check) => check(&situation),
            _ => Ok(()),
        })?;
        self.unit_path_is_clear(&shift.judge, &shift.axes, now)?;
        self.whole_path_is_clear(&shift.judge, &shift.sky)
    }

    /// Writes offsets of the unit's own track, or returns the reason not to. `shift` is the
    /// resulting motion; `None` if the unit does not track and the offsets move no axis.
    pub(in crate::driver) fn shift_track(
        &mut self,
        change: Change,
        shift: Option<&Shift>,
        stopping: bool,
        now: Moment,
    ) -> Result<(), Refusal> {
        let situation = self.situation(Intent::Track, stopping, now);
        self.ask_rules(|check| match check {
            RuleCheck::AnySetting(check) => check(&situation),
            _ => Ok(()),
        })?;
        // STOP voids a change of offsets, even a change that would move nothing.
        if stopping {
            return Err(Refusal::Stopping);
        }
        if let Some(shift) = shift {
            self.shift_is_clear(shift, stopping, now)?;
        }
        self.controller.shift_track(change, now);
        Ok(())
    }

    /// Writes a setting change to the unit, or returns the reason not to. A setting that decides
    /// where the antenna points waits until the unit stands and would not start on its own. A
    /// refusal also appears among the setting outcomes. `may_move`: the request includes a motion,
    /// even while the antenna stands.
    pub(in crate::driver) fn write_settings(
        &mut self,
        change: Change,
        may_move: bool,
        stopping: bool,
        now: Moment,
    ) -> Result<(), Refusal> {
        let situation = self.situation(Intent::Standby, stopping, now);
        let allowed = self.ask_rules(|check| match check {
            RuleCheck::AnySetting(check) => check(&situation),
            _ => Ok(()),
        });
        if let Err(refusal) = allowed {
            self.controller.refuse_change(change, WriteError::LockedOut, now);
            return Err(refusal);
        }
        let group = self.variant.groups.iter().find(|group| group.key == change.group);
        let field = group.and_then(|group| group.moving_field(&change.values));
        let look_for_hindrance = || {
            let situation = self.situation(Intent::Standby, stopping, now);
            let situation = Situation { may_move, ..situation };
            self.rules.iter().find_map(|rule| match rule.check {
                RuleCheck::Setting(check) => check(&situation),
                _ => None,
            })
        };
        let Some((field, hindrance)) = field.and_then(|field| Some((field, look_for_hindrance()?)))
        else {
            self.controller.write_settings(change, now);
            return Ok(());
        };
        let error = WriteError::Hindered { field: field.key, hindrance };
        self.controller.refuse_change(change, error, now);
        Err(Refusal::Setting { field: field.label, hindrance })
    }

    /// Sends a target to the unit, or returns the reason not to: with auto-track on, the antenna
    /// may start tracking the target.
    pub(in crate::driver) fn prepare(
        &mut self,
        target: TrackTarget,
        intent: Intent,
        now: Moment,
    ) -> Result<(), Refusal> {
        // The unit could move as soon as it has the target, so judge its start first.
        self.check(Motion::StartProgram, intent, now)?;
        self.controller.prepare(target);
        Ok(())
    }
}
