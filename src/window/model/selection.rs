//! The selected pass: the operator's choice, or else the pass of the selected antenna.

use super::Model;
use crate::{
    astro::time::seconds_between,
    contract::{
        antenna::AntennaModel,
        passes::{PassListKey, PredictedPass},
    },
};

/// A track begins at most so long before AOS of its pass, seconds: much less than the time between
/// two passes of a satellite.
const EARLY_S: f64 = 600.0;

impl Model {
    /// Selects a pass until it is over or the operator chooses another one.
    pub fn choose_pass(&mut self, pass: PassListKey) {
        (self.chosen, self.selected) = (Some(pass), Some(pass));
    }

    /// Drops the operator's choice, so that the selection follows the antenna.
    pub fn drop_choice(&mut self) {
        (self.chosen, self.selected) = (None, None);
    }

    /// Selects the antenna at this place of the list, with its own pass unless the operator chose
    /// one.
    pub fn select_antenna(&mut self, place: usize) {
        let is_another = self.selected_antenna != place;
        self.selected_antenna = place;
        if self.chosen.is_none() && is_another {
            let planned = self.antenna().and_then(|antenna| self.next_planned_pass(antenna));
            self.selected = planned.map(PredictedPass::key);
        }
        self.follow_antenna();
    }

    /// Brings the selection up to date: the operator's choice until it is over, or else the pass
    /// that the selected antenna takes. While it takes none, the selection stays until that pass is
    /// over; then its next pass of the plan follows. Without any of them the next pass of any
    /// favourite is selected.
    pub fn follow_antenna(&mut self) {
        let chosen = self.chosen.and_then(|key| self.pass_lists.find(key));
        let is_over = chosen.is_some_and(|predicted| predicted.pass.los.time <= self.now);
        let chosen = chosen.filter(|_| !is_over);
        let antenna = self.antenna();
        let taken_pass = || self.pass_taken_by(antenna?);
        // At the start a pass under way may still be tracked by hand.
        let follows_another = self.selected.is_some();
        let planned = || self.next_planned_pass(antenna?).filter(|_| follows_another);
        let selected = chosen
            .or_else(taken_pass)
            .or_else(|| self.selected_pass())
            .or_else(planned)
            .or_else(|| self.next_pass());
        // Without any pass, as during a new search, the selection comes back with the list.
        self.selected = selected.map(PredictedPass::key).or(self.selected);
        if is_over {
            self.chosen = None;
        }
    }

    /// The pass that an antenna tracks or waits for, by command or by automatic operation.
    fn pass_taken_by(&self, antenna: &AntennaModel) -> Option<&PredictedPass> {
        let commanded = || {
            let number = antenna.commanded_number()?;
            let listed = self.pass_lists.all.upcoming(self.now);
            let find = || listed.iter().find(|predicted| predicted.number() == number);
            let predicted = self.pass_of(number).or_else(find)?;
            // Right after LOS the snapshot still holds the past track; the next pass is another one.
            let begins = antenna.track_begins(self.now);
            let aos = predicted.pass.aos.time;
            begins.is_none_or(|time| seconds_between(time, aos) < EARLY_S).then_some(predicted)
        };
        let is_on = antenna.operation.is_on();
        commanded().or_else(|| self.next_planned_pass(antenna).filter(|_| is_on))
    }

    /// The pass under way or to come that the plan gives to an antenna next.
    fn next_planned_pass(&self, antenna: &AntennaModel) -> Option<&PredictedPass> {
        let next = self.next_entry(antenna.id())?;
        self.pass_ahead((next.pass.satellite, next.pass.aos))
    }

    /// The pass of `key`, until it is over.
    pub(super) fn pass_ahead(&self, key: PassListKey) -> Option<&PredictedPass> {
        let predicted = self.pass_lists.find(key)?;
        (predicted.pass.los.time > self.now).then_some(predicted)
    }
}
