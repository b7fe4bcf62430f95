//! The changes that a device was asked for: one is under way, the others wait.

use std::collections::VecDeque;

use super::{Change, Group, SettleError, SettleStep, Settling};
use crate::{clock::Moment, device::AntennaState};

/// The changes of one device. How far each is stands in [`AntennaState::held`].
#[derive(Debug)]
pub(crate) struct ChangeQueue {
    groups: &'static [&'static Group],
    under_way: Option<Settling>,
    waiting: VecDeque<Change>,
    /// The unit is locked out: no setting goes to it.
    are_locked: bool,
}

impl ChangeQueue {
    /// Of a device with these groups.
    pub(crate) fn new(groups: &'static [&'static Group]) -> Self {
        Self { groups, under_way: None, waiting: VecDeque::new(), are_locked: false }
    }

    pub(crate) fn lock(&mut self, are_locked: bool) {
        self.are_locked = are_locked;
    }

    pub(crate) fn are_locked(&self) -> bool {
        self.are_locked
    }

    pub(crate) fn under_way(&self) -> Option<&Settling> {
        self.under_way.as_ref()
    }

    /// None is under way, and none waits.
    pub(crate) fn is_empty(&self) -> bool {
        self.under_way.is_none() && self.waiting.is_empty()
    }

    pub(crate) fn push(&mut self, change: Change, state: &mut AntennaState) {
        state.group(change.group).step = Some(SettleStep::Waiting);
        self.waiting.push_back(change);
    }

    /// Takes up the next change when none is under way.
    pub(crate) fn begin(&mut self, state: &mut AntennaState, now: Moment) {
        while self.under_way.is_none()
            && let Some(change) = self.waiting.pop_front()
        {
            match Settling::new(&change, self.groups) {
                Ok(settling) => {
                    self.under_way = Some(settling);
                    self.show(state);
                }
                Err(error) => self.settled(change, Err(error), state, now),
            }
        }
    }

    /// Takes the change under way a step on; an error ends it. Returns whether it ended.
    pub(crate) fn advance(
        &mut self,
        state: &mut AntennaState,
        now: Moment,
        step: impl FnOnce(&mut Settling) -> Result<(), SettleError>,
    ) -> bool {
        let Some(settling) = &mut self.under_way else { return false };
        let result = step(settling);
        let is_over = result.is_err();
        if is_over {
            self.end(result, state, now);
        } else {
            self.show(state);
        }
        is_over
    }

    /// The change under way is over.
    pub(crate) fn end(
        &mut self,
        result: Result<(), SettleError>,
        state: &mut AntennaState,
        now: Moment,
    ) {
        if let Some(settling) = self.under_way.take() {
            self.settled(settling.change, result, state, now);
        }
    }

    /// `change` is not sent.
    pub(crate) fn refuse(
        &self,
        change: Change,
        why: SettleError,
        state: &mut AntennaState,
        now: Moment,
    ) {
        self.settled(change, Err(why), state, now);
    }

    /// The link is gone: what may be on the device is not known.
    pub(crate) fn abandon(&mut self, state: &mut AntennaState, now: Moment) {
        if let Some(settling) = self.under_way.take() {
            let is_lost = settling.may_be_sent();
            let error = if is_lost { SettleError::LinkLost } else { SettleError::NoLink };
            self.settled(settling.change, Err(error), state, now);
        }
        while let Some(change) = self.waiting.pop_front() {
            self.settled(change, Err(SettleError::NoLink), state, now);
        }
    }

    fn settled(
        &self,
        change: Change,
        result: Result<(), SettleError>,
        state: &mut AntennaState,
        now: Moment,
    ) {
        let is_followed = self.waiting.iter().any(|other| other.group == change.group);
        state.end_change(change, result, is_followed, now);
    }

    fn show(&self, state: &mut AntennaState) {
        if let Some(settling) = &self.under_way {
            state.group(settling.group.key).step = Some(settling.shown());
        }
    }
}
