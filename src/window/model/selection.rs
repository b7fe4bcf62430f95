//! The selected pass: the operator's choice, or else the pass of the selected antenna.

use super::Model;
use crate::{
    astro::time::seconds_between,
    contract::{
        antenna::AntennaModel,
        passes::{PassListKey, PredictedPass},
    },
};

/// Max time between the begin of a track and the AOS of its pass, seconds. The time between two
/// passes of a satellite is much longer.
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

    /// Selects the antenna at this index of the list. The selected pass follows unless the operator
    /// has chosen one.
    pub fn select_antenna(&mut self, place: usize) {
        let is_another = self.selected_antenna != place;
        self.selected_antenna = place;
        if self.chosen.is_none() && is_another {
            let planned = self.antenna().and_then(|antenna| self.next_planned_pass(antenna));
            self.selected = planned.map(PredictedPass::key);
        }
        self.follow_antenna();
    }

    /// Updates the selected pass. The operator's choice stays until the pass is over. Without a
    /// choice, the selection is the pass that the selected antenna takes. While the antenna takes
    /// none, the selection stays until its pass is over, then the next planned pass follows.
    /// Otherwise the next pass of any favourite is selected.
    pub fn follow_antenna(&mut self) {
        let chosen = self.chosen.and_then(|key| self.pass_lists.find(key));
        let is_over = chosen.is_some_and(|predicted| predicted.pass.los.time <= self.now);
        let chosen = chosen.filter(|_| !is_over);
        let antenna = self.antenna();
        let taken_pass = || self.pass_taken_by(antenna?);
        // At the start, the operator may still track a current pass by hand.
        let follows_another = self.selected.is_some();
        let planned = || self.next_planned_pass(antenna?).filter(|_| follows_another);
        let selected = chosen
            .or_else(taken_pass)
            .or_else(|| self.selected_pass())
            .or_else(planned)
            .or_else(|| self.next_pass());
        // Keep the selection without any pass, as during a new search; the next list contains it
        // again.
        self.selected = selected.map(PredictedPass::key).or(self.selected);
        if is_over {
            self.chosen = None;
        }
    }

    /// Returns the pass that an antenna tracks or waits for, by command or by automatic operation.
    fn pass_taken_by(&self, antenna: &AntennaModel) -> Option<&PredictedPass> {
        let commanded = || {
            let number = antenna.commanded_number()?;
            let listed = self.pass_lists.all.upcoming(self.now);
            let find = || listed.iter().find(|predicted| predicted.number() == number);
            let predicted = self.pass_of(number).or_else(find)?;
            // Right after LOS the snapshot still holds the past track; the next pass is a different
            // one.
            let begins = antenna.track_begins(self.now);
            let aos = predicted.pass.aos.time;
            begins.is_none_or(|time| seconds_between(time, aos) < EARLY_S).then_some(predicted)
        };
        let is_on = antenna.operation.is_on();
        commanded().or_else(|| self.next_planned_pass(antenna).filter(|_| is_on))
    }

    /// Returns the current or future pass that the plan assigns to an antenna next.
    fn next_planned_pass(&self, antenna: &AntennaModel) -> Option<&PredictedPass> {
        let next = self.next_entry(antenna.id())?;
        self.pass_ahead((next.pass.satellite, next.pass.aos))
    }

    /// Returns the pass of `key` until it is over.
    pub(super) fn pass_ahead(&self, key: PassListKey) -> Option<&PredictedPass> {
        let predicted = self.pass_lists.find(key)?;
        (predicted.pass.los.time > self.now).then_some(predicted)
    }
}
