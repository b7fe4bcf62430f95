//! Link to a unit: its desired state, its current state, and the memory across outages.

use std::time::Duration;

use super::{clocks::SessionClocks, likeness::Comparison, silence::Silence};
use crate::{
    clock::Instant,
    contract::driver::{LinkLoss, LinkState},
    device::AntennaState,
    driver::{Dial, link::Dialling},
    station::Antenna,
};

/// Max delay of a reply from a healthy unit.
const LATE_REPLY: Duration = Duration::from_secs(1);
/// Max age of received noise that still explains a silent unit.
const HEARD: Duration = Duration::from_secs(30);

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum LinkNeed {
    No,
    /// Link only for a STOP: the session releases the unit once standstill is proved.
    ForStop,
    Yes,
}

/// Poll period and silence limit of a unit.
#[derive(Debug, Clone, Copy)]
pub(super) struct PollPace {
    pub(super) poll_period: Duration,
    pub(super) patience: Duration,
}

/// Outage of the unit before its first new reading.
#[derive(Debug, Clone, Copy)]
pub(super) struct Outage {
    /// Time of the loss of an established link.
    pub(super) away_since: Option<Instant>,
    /// Sleep of the computer during the outage.
    pub(super) slept: Duration,
}

/// State of the link, and the memory across outages.
pub(super) struct Contact {
    dial: Dial,
    need: LinkNeed,
    link: LinkState,
    /// Time of the loss of an established link.
    away_since: Option<Instant>,
    /// `true` if the operator knows of the lost link.
    loss_is_reported: bool,
    /// `true` until the first reading on this link.
    unread: bool,
    /// `true` if the unit's own program was on at the last reading.
    program_was_on: bool,
    /// Sleep of the computer since the last reading of the unit.
    slept: Duration,
    pub(super) clocks: SessionClocks,
    pub(super) silence: Silence,
    pub(super) comparison: Comparison,
}

/// Returns the initial link request of a new session, and its initial link state.
pub(super) fn first_link(antenna: &Antenna, now: Instant) -> (LinkNeed, LinkState) {
    let waits = antenna.connection.variant().capabilities.waits_for_word;
    if waits && !antenna.connects_at_start {
        return (LinkNeed::No, LinkState::Off);
    }
    (LinkNeed::Yes, LinkState::Connecting { start: now })
}

impl Contact {
    pub(super) fn new(antenna: &Antenna, dial: Dial, now: Instant) -> Self {
        let (need, link) = first_link(antenna, now);
        Self {
            dial,
            need,
            link,
            away_since: None,
            loss_is_reported: false,
            unread: true,
            program_was_on: false,
            slept: Duration::ZERO,
            clocks: SessionClocks::default(),
            silence: Silence::default(),
            comparison: Comparison::default(),
        }
    }

    /// Starts an attempt to connect.
    pub(super) fn dial(&mut self) -> Dialling {
        (self.dial)()
    }

    pub(super) fn link_need(&self) -> LinkNeed {
        self.need
    }

    pub(super) fn want(&mut self, need: LinkNeed) {
        self.need = need;
    }

    pub(super) fn link(&self) -> &LinkState {
        &self.link
    }

    pub(super) fn is_open(&self) -> bool {
        self.link.is_open()
    }

    /// Leaves the unit to others: a later outage starts a new count.
    pub(super) fn release(&mut self) {
        self.link = LinkState::Off;
        self.away_since = None;
        self.loss_is_reported = false;
    }

    pub(super) fn set_connecting(&mut self, now: Instant) {
        self.link = LinkState::Connecting { start: now };
    }

    pub(super) fn set_connected(&mut self, now: Instant) {
        self.link = LinkState::Up { start: now };
    }

    /// Closes the link finally.
    pub(super) fn close(&mut self) {
        self.link = LinkState::Off;
    }

    /// Records a reply on this link: the next loss is news again.
    pub(super) fn note_reply(&mut self) {
        self.loss_is_reported = false;
    }

    /// Records a lost link; the next attempt is at `retry_at`. Returns `true` if the loss is news.
    pub(super) fn lose(
        &mut self,
        reason: LinkLoss,
        retry_at: Instant,
        last_reply: Option<Instant>,
        now: Instant,
    ) -> bool {
        let lost_at = self.away_since.or(last_reply).unwrap_or(now);
        if last_reply.is_some() {
            self.away_since.get_or_insert(lost_at);
        }
        // Every failed attempt loses the link again; only the first loss is news.
        let is_news = !matches!(self.link, LinkState::Lost { .. }) && !self.loss_is_reported;
        self.loss_is_reported = true;
        self.link = LinkState::Lost { start: lost_at, reason, retry_at };
        is_news
    }

    /// Moves the next attempt to `time`.
    pub(super) fn retry_at(&mut self, time: Instant) {
        if let LinkState::Lost { retry_at, .. } = &mut self.link {
            *retry_at = time;
        }
    }

    /// Starts a link on which the unit is still unread.
    pub(super) fn begin_link(&mut self) {
        self.unread = true;
    }

    pub(super) fn is_unread(&self) -> bool {
        self.unread
    }

    /// Records the first reading on this link, which ends the outage. Returns that outage.
    pub(super) fn note_reading(&mut self, program_is_on: bool) -> Outage {
        self.unread = false;
        self.program_was_on = program_is_on;
        Outage { away_since: self.away_since.take(), slept: std::mem::take(&mut self.slept) }
    }

    /// Returns `true` if the unit's own program has started since the last reading.
    pub(super) fn program_has_started(&mut self, is_on: bool) -> bool {
        let was_on = std::mem::replace(&mut self.program_was_on, is_on);
        is_on && !was_on
    }

    pub(super) fn add_sleep(&mut self, lasted: Duration) {
        self.slept += lasted;
    }

    /// Updates the link state from the age of the last reply on a link that began at `start`.
    /// Returns the reason if the link counts as lost.
    pub(super) fn follow_age(
        &mut self,
        state: &AntennaState,
        pace: PollPace,
        now: Instant,
        start: Instant,
    ) -> Option<LinkLoss> {
        if state.is_other_device {
            return Some(LinkLoss::OtherDevice);
        }
        let last = state.traffic.last_reply.map_or(start, |reply| reply.max(start));
        let age = now.saturating_duration_since(last);
        if age >= pace.patience {
            let is_unreadable = state.traffic.last_unreadable.is_some_and(|noise| {
                // Not every attempt hears as much noise.
                let is_young = now.saturating_duration_since(noise) < HEARD;
                noise > last || self.away_since.is_some_and(|lost| noise > lost && is_young)
            });
            return Some(if is_unreadable { LinkLoss::Unreadable } else { LinkLoss::Silent });
        }
        // A single reply may get lost, so one poll period without a reply is normal.
        let max_age = pace.poll_period * 2;
        let requested = state.measured_on_link().map(|measured| measured.requested);
        // The age of a position starts at its query, and the reply may be late.
        let is_old = |requested| now.saturating_duration_since(requested) > max_age + LATE_REPLY;
        let is_late = age > max_age || requested.is_some_and(is_old);
        match (&self.link, is_late) {
            (LinkState::Up { .. } | LinkState::Stale { .. }, true) => {
                let as_of = requested.map_or(last, |requested| requested.min(last));
                self.link = LinkState::Stale { as_of };
            }
            (LinkState::Stale { .. }, false) => self.link = LinkState::Up { start },
            (LinkState::Off | LinkState::Connecting { .. } | LinkState::Lost { .. }, _)
            | (LinkState::Up { .. }, false) => {}
        }
        None
    }

    /// Returns the time at which the age of the last reply changes the link state.
    pub(super) fn due(&self, state: &AntennaState, pace: PollPace) -> Option<Instant> {
        let last = state.traffic.last_reply.max(state.link_since)?;
        let requested = state.measured_on_link().map(|measured| measured.requested + LATE_REPLY);
        let wait = match self.link {
            // A link becomes stale only beyond its limit, not at the limit itself.
            LinkState::Up { .. } => pace.poll_period * 2 + Duration::from_millis(1),
            _ => return Some(last + pace.patience),
        };
        Some(requested.map_or(last, |requested| requested.min(last)) + wait)
    }
}
