//! The state of the link, by the age of the last good reply and of the position.

use std::time::Duration;

use super::Session;
use crate::{
    clock::{Instant, Moment},
    contract::driver::{Event, LinkLoss, LinkState},
};

/// A unit that answers in time answers within this time.
const LATE_REPLY: Duration = Duration::from_secs(1);
/// Noise that is older than this says nothing of a unit that is silent now.
const HEARD: Duration = Duration::from_secs(30);

impl Session {
    /// The link is gone; the next attempt is at `retry_at`.
    pub(super) fn lose(&mut self, reason: LinkLoss, retry_at: Instant) {
        let now = self.now();
        let last_reply = self.gate.state().traffic.last_reply;
        let had_been_up = last_reply.is_some();
        let since = self.contact.away_since.or(last_reply).unwrap_or(now.steady);
        if had_been_up && self.contact.away_since.is_none() {
            self.contact.away_since = Some(since);
        }
        let news =
            !matches!(self.contact.link, LinkState::Lost { .. }) && !self.contact.loss_is_told;
        self.contact.loss_is_told = true;
        self.contact.link = LinkState::Lost { since, reason: reason.clone(), retry_at };
        if news {
            self.tell(Event::LinkLost(reason));
        }
    }

    /// Follows the age of the last reply.
    pub(super) fn watch_link(&mut self, now: Moment, start: Instant) -> Option<LinkLoss> {
        if self.gate.state().is_other_device {
            return Some(LinkLoss::OtherDevice);
        }
        let last = self.gate.state().traffic.last_reply.map_or(start, |reply| reply.max(start));
        let age = now.steady.saturating_duration_since(last);
        if age >= self.gate.device().patience() {
            let unreadable = self.gate.state().traffic.last_unreadable;
            let heard = unreadable.is_some_and(|heard| {
                // Not every try hears as much.
                let is_young = now.steady.saturating_duration_since(heard) < HEARD;
                heard > last || self.contact.away_since.is_some_and(|away| heard > away && is_young)
            });
            return Some(if heard { LinkLoss::Unreadable } else { LinkLoss::Silent });
        }
        let patience = self.gate.device().poll_period() * 2;
        let asked = self.gate.state().measured_on_link().map(|measured| measured.asked);
        let is_old = |asked| now.steady.saturating_duration_since(asked) > patience + LATE_REPLY;
        let late = age > patience || asked.is_some_and(is_old);
        match (&self.contact.link, late) {
            (LinkState::Up { .. } | LinkState::Stale { .. }, true) => {
                let as_of = asked.map_or(last, |asked| asked.min(last));
                self.contact.link = LinkState::Stale { as_of };
            }
            (LinkState::Stale { .. }, false) => {
                self.contact.link = LinkState::Up { since: start };
            }
            _ => {}
        }
        None
    }

    /// When the age of the last reply changes the state of the link.
    pub(super) fn link_due(&mut self) -> Option<Instant> {
        let state = self.gate.state();
        let last = state.traffic.last_reply.max(state.link_since)?;
        let asked = state.measured_on_link().map(|measured| measured.asked + LATE_REPLY);
        let wait = match self.contact.link {
            LinkState::Up { .. } => self.gate.device().poll_period() * 2 + Duration::from_millis(1),
            _ => return Some(last + self.gate.device().patience()),
        };
        Some(asked.map_or(last, |asked| asked.min(last)) + wait)
    }
}
