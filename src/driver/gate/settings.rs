//! Settings that decide where the antenna points, and targets, on their way to the controller.

use super::{Check, Gate, Refusal, Situation};
use crate::{
    clock::Moment,
    device::{
        Motion, TrackTarget,
        settings::{Change, WriteError},
    },
    driver::Intent,
};

impl Gate {
    /// Writes a change of settings to the unit, or returns the reason not to: a setting that
    /// decides where the antenna points waits until it stands and would not start by itself. A
    /// refusal also appears among the outcomes of the settings. `may_move`: a motion was
    /// requested, whatever the antenna does.
    pub(in crate::driver) fn write_settings(
        &mut self,
        change: Change,
        may_move: bool,
        stopping: bool,
        now: Moment,
    ) -> Result<(), Refusal> {
        let situation = self.situation(Intent::Standby, stopping, now);
        let allowed = self.ask_rules(|check| match check {
            Check::AnySetting(check) => check(&situation),
            _ => Ok(()),
        });
        if let Err(refusal) = allowed {
            self.controller.refuse_change(change, WriteError::LockedOut, now);
            return Err(refusal);
        }
        let group = self.variant.groups.iter().find(|group| group.key == change.group);
        let field = group.and_then(|group| group.moving_field(&change.values));
        let hindrance = || {
            let asked = self.situation(Intent::Standby, stopping, now);
            let situation = Situation { may_move, ..asked };
            self.rules.iter().find_map(|rule| match rule.check {
                Check::Setting(check) => check(&situation),
                _ => None,
            })
        };
        let Some((field, why)) = field.and_then(|field| Some((field, hindrance()?))) else {
            self.controller.write_settings(change, now);
            return Ok(());
        };
        let error = WriteError::Hindered { field: field.key, hindrance: why };
        self.controller.refuse_change(change, error, now);
        Err(Refusal::Setting { field: field.label, why })
    }

    /// Puts a target on the unit, or returns the reason not to: with auto-track on, the
    /// antenna may start on it.
    pub(in crate::driver) fn prepare(
        &mut self,
        target: TrackTarget,
        intent: Intent,
        now: Moment,
    ) -> Result<(), Refusal> {
        self.check(Motion::StartProgram, intent, now)?;
        self.controller.prepare(target);
        Ok(())
    }
}
