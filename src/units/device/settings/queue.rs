//! Queue of setting changes for a unit: one change is under way, the others wait.

use std::collections::VecDeque;

use super::{Change, Group, SettingsWrite, WriteAction, WriteError, WriteStep};
use crate::{clock::Moment, device::AntennaState};

/// The changes of one unit. [`AntennaState::groups`] shows the step of each.
#[derive(Debug)]
pub(crate) struct ChangeQueue {
    groups: &'static [&'static Group],
    under_way: Option<SettingsWrite>,
    waiting: VecDeque<Waiting>,
    /// `true` while the unit is locked out: Azel sends it no setting.
    are_locked: bool,
}

#[derive(Debug)]
struct Waiting {
    change: Change,
    /// `true` for a change that the gate has judged as a motion, see [`SettingsWrite::is_judged`].
    is_judged: bool,
}

impl ChangeQueue {
    /// Returns a queue for a unit with these groups.
    pub(crate) fn new(groups: &'static [&'static Group]) -> Self {
        Self { groups, under_way: None, waiting: VecDeque::new(), are_locked: false }
    }

    pub(crate) fn lock(&mut self, are_locked: bool) {
        self.are_locked = are_locked;
    }

    pub(crate) fn are_locked(&self) -> bool {
        self.are_locked
    }

    pub(crate) fn under_way(&self) -> Option<&SettingsWrite> {
        self.under_way.as_ref()
    }

    /// Returns `true` if no change is under way or pending.
    pub(crate) fn is_empty(&self) -> bool {
        self.under_way.is_none() && self.waiting.is_empty()
    }

    pub(crate) fn push(&mut self, change: Change, state: &mut AntennaState) {
        self.push_back(Waiting { change, is_judged: false }, state);
    }

    /// Queues a change that the gate has judged as a motion.
    pub(crate) fn push_judged(&mut self, change: Change, state: &mut AntennaState) {
        self.push_back(Waiting { change, is_judged: true }, state);
    }

    fn push_back(&mut self, waiting: Waiting, state: &mut AntennaState) {
        state.group(waiting.change.group).step = Some(WriteStep::Waiting);
        self.waiting.push_back(waiting);
    }

    /// Ends the unsent changes that the gate has judged as motions, because of a halt. `is_sent` is
    /// `true` if the unit owes an answer to the change under way. Returns `true` if that change
    /// ended.
    pub(crate) fn void_judged(
        &mut self,
        is_sent: bool,
        state: &mut AntennaState,
        now: Moment,
    ) -> bool {
        let is_void = |write: &mut SettingsWrite| {
            let waits = write.step() == WriteAction::Send && !is_sent;
            write.is_judged() && (waits || !write.may_be_sent())
        };
        let begun = self.under_way.take_if(is_void).map(|write| write.change);
        let was_under_way = begun.is_some();
        let (void, others): (VecDeque<_>, _) =
            self.waiting.drain(..).partition(|waiting| waiting.is_judged);
        self.waiting = others;
        for change in begun.into_iter().chain(void.into_iter().map(|waiting| waiting.change)) {
            self.written(change, Err(WriteError::Stopped), state, now);
        }
        was_under_way
    }

    /// Starts the next change if none is under way.
    pub(crate) fn begin(&mut self, state: &mut AntennaState, now: Moment) {
        while self.under_way.is_none()
            && let Some(Waiting { change, is_judged }) = self.waiting.pop_front()
        {
            match SettingsWrite::new(&change, self.groups, is_judged) {
                Ok(settings_write) => {
                    self.under_way = Some(settings_write);
                    self.show(state);
                }
                Err(error) => self.written(change, Err(error), state, now),
            }
        }
    }

    /// Applies `step` to the change under way; an error ends the change. Returns `true` if it
    /// ended.
    pub(crate) fn advance(
        &mut self,
        state: &mut AntennaState,
        now: Moment,
        step: impl FnOnce(&mut SettingsWrite) -> Result<(), WriteError>,
    ) -> bool {
        let Some(settings_write) = &mut self.under_way else { return false };
        let result = step(settings_write);
        let is_over = result.is_err();
        if is_over {
            self.end(result, state, now);
        } else {
            self.show(state);
        }
        is_over
    }

    /// Ends the change under way with `result`.
    pub(crate) fn end(
        &mut self,
        result: Result<(), WriteError>,
        state: &mut AntennaState,
        now: Moment,
    ) {
        if let Some(settings_write) = self.under_way.take() {
            self.written(settings_write.change, result, state, now);
        }
    }

    /// Records `change` as not sent, with the error.
    pub(crate) fn refuse(
        &self,
        change: Change,
        write_error: WriteError,
        state: &mut AntennaState,
        now: Moment,
    ) {
        self.written(change, Err(write_error), state, now);
    }

    /// Ends all changes because the link is lost. A change that was sent may be on the unit.
    pub(crate) fn abandon(&mut self, state: &mut AntennaState, now: Moment) {
        if let Some(settings_write) = self.under_way.take() {
            let is_lost = settings_write.may_be_sent();
            let error = if is_lost { WriteError::LinkLost } else { WriteError::NoLink };
            self.written(settings_write.change, Err(error), state, now);
        }
        while let Some(Waiting { change, .. }) = self.waiting.pop_front() {
            self.written(change, Err(WriteError::NoLink), state, now);
        }
    }

    fn written(
        &self,
        change: Change,
        result: Result<(), WriteError>,
        state: &mut AntennaState,
        now: Moment,
    ) {
        let is_followed = self.waiting.iter().any(|other| other.change.group == change.group);
        state.end_change(change, result, is_followed, now);
    }

    fn show(&self, state: &mut AntennaState) {
        if let Some(settings_write) = &self.under_way {
            state.group(settings_write.group.key).step = Some(settings_write.shown());
        }
    }
}
