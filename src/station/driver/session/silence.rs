//! A unit that stops answering while Azel has metal moving.
//!
//! A single lost or late reply is not silence: during a motion the controllers ask again at
//! once, and only a second missing reply counts.

use std::time::Duration;

use super::Session;
use crate::{
    clock::{Instant, Moment},
    contract::driver::{Event, LinkState, Safety},
};

/// Maximum time from the first overdue reply to the report.
const TOLD_WITHIN: Duration = Duration::from_secs(1);

/// Times of the writes since the unit last answered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Silence {
    replies: u64,
    first: Option<Instant>,
    second: Option<Instant>,
    /// Azel has metal moving.
    is_watched: bool,
    /// The operator has been told, and no reply has come since.
    is_told: bool,
}

impl Silence {
    fn wrote(&mut self, now: Instant) {
        if self.first.is_none() {
            self.first = Some(now);
        } else {
            self.second.get_or_insert(now);
        }
    }

    fn heard(&mut self, replies: u64) {
        if replies != self.replies {
            *self = Self { replies, is_watched: self.is_watched, ..Self::default() };
        }
    }

    /// Questions asked before the motion count as missing only from now on.
    fn watch(&mut self, is_watched: bool, now: Instant) {
        if is_watched && !self.is_watched {
            self.first = self.first.map(|_| now);
            self.second = None;
        }
        self.is_watched = is_watched;
    }

    /// When to report silence if nothing that was asked is answered.
    fn due(&self, prompt: Duration) -> Option<Instant> {
        let first = self.first?;
        let latest = first + prompt + TOLD_WITHIN;
        let again = self.second.map(|second| (second + prompt).max(first + prompt * 2));
        Some(again.map_or(latest, |again| again.min(latest)))
    }
}

impl Session {
    pub(super) fn wrote(&mut self, now: Moment) {
        self.contact.silence.heard(self.gate.state().traffic.replies);
        self.contact.silence.wrote(now.steady);
    }

    /// Returns `true` while metal moves on Azel's command as far as is known: until STOP is
    /// proved it may, even if the last position shows it at rest.
    fn is_in_motion(&mut self) -> bool {
        self.is_unproved()
            && (self.follows_now()
                || self.stop.is_under_way()
                || self.turns()
                || self.gate.state().program.is_some_and(|program| program.enabled)
                || self.activity.is_pending()
                || self.key.held().is_some()
                || self.stepping.is_some()
                || self.gate.device().motion_under_way())
    }

    /// Reports a unit that does not answer while it moves, once until it answers.
    pub(super) fn watch_silence(&mut self, now: Moment) {
        self.contact.silence.heard(self.gate.state().traffic.replies);
        let is_watched = self.is_in_motion();
        self.contact.silence.watch(is_watched, now.steady);
        // A jog that has not begun waits for its position.
        self.gate.device().watch_closely(is_watched || self.key.held().is_some());
        if self.silence_due().is_some_and(|at| now.steady >= at) {
            self.tell_silence();
        }
    }

    /// The link was lost in the middle of a motion.
    pub(super) fn tell_silence_of_lost_link(&mut self) {
        if self.is_in_motion() {
            self.tell_silence();
        }
    }

    /// The operator has looked at the antenna, or leaves it to others.
    pub(super) fn forget_silence(&mut self) {
        self.contact.silence.is_told = false;
    }

    fn tell_silence(&mut self) {
        if !std::mem::replace(&mut self.contact.silence.is_told, true) {
            self.tell(Event::Safety(Safety::SilentInMotion));
        }
    }

    /// Returns `true` if silence was reported and no reply has come since.
    pub(super) fn is_silent(&self) -> bool {
        self.contact.silence.is_told
    }

    /// When silence must be reported.
    pub(super) fn silence_due(&mut self) -> Option<Instant> {
        let prompt = self.gate.device().prompt();
        let is_open = matches!(self.contact.link, LinkState::Up { .. } | LinkState::Stale { .. });
        let is_watched = self.contact.silence.is_watched && !self.contact.silence.is_told;
        self.contact.silence.due(prompt).filter(|_| is_open && is_watched)
    }
}
