//! A unit that no longer answers while metal moves on this program's word.
//!
//! One reply that is lost or late is no silence: while something moves, the
//! controllers ask again at once, and the unit is silent when that is not answered
//! either.

use std::time::Duration;

use super::{Event, Session};
use crate::{
    clock::{Instant, Moment},
    driver::{LinkState, Safety},
};

/// The operator is told this long after the first reply that is missing at the
/// latest.
const TOLD_WITHIN: Duration = Duration::from_secs(1);

/// What was written since the unit was heard last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Silence {
    replies: u64,
    first: Option<Instant>,
    second: Option<Instant>,
    /// Metal moves on this program's word.
    is_watched: bool,
    /// The operator was told, and no reply has come since.
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

    /// What was asked before anything moved is missing from now on only.
    fn watch(&mut self, is_watched: bool, now: Instant) {
        if is_watched && !self.is_watched {
            self.first = self.first.map(|_| now);
            self.second = None;
        }
        self.is_watched = is_watched;
    }

    /// When nothing that was asked has been answered in its time.
    fn due(&self, prompt: Duration) -> Option<Instant> {
        let first = self.first?;
        let latest = first + prompt + TOLD_WITHIN;
        let again = self.second.map(|second| (second + prompt).max(first + prompt * 2));
        Some(again.map_or(latest, |again| again.min(latest)))
    }
}

impl Session {
    /// Bytes went to the unit.
    pub(super) fn wrote(&mut self, now: Moment) {
        self.contact.silence.heard(self.gate.state().traffic.replies);
        self.contact.silence.wrote(now.steady);
    }

    /// Whether metal moves on this program's word, as far as is known: it may until STOP is
    /// proved, though the last look shows it at rest.
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

    /// Tells of a unit that does not answer while it moves; once, until it does.
    pub(super) fn watch_silence(&mut self, now: Moment) {
        self.contact.silence.heard(self.gate.state().traffic.replies);
        let is_watched = self.is_in_motion();
        self.contact.silence.watch(is_watched, now.steady);
        self.gate.device().watch_closely(self.contact.silence.is_watched);
        if self.silence_due().is_some_and(|at| now.steady >= at) {
            self.tell_silence();
        }
    }

    /// The link is gone in the middle of a motion.
    pub(super) fn tell_silence_of_lost_link(&mut self) {
        if self.is_in_motion() {
            self.tell_silence();
        }
    }

    /// The operator has looked at it, or leaves it to others.
    pub(super) fn forget_silence(&mut self) {
        self.contact.silence.is_told = false;
    }

    fn tell_silence(&mut self) {
        if !std::mem::replace(&mut self.contact.silence.is_told, true) {
            self.tell(Event::Safety(Safety::SilentInMotion));
        }
    }

    /// The operator was told that it does not answer, and it has not answered since.
    pub(super) fn is_silent(&self) -> bool {
        self.contact.silence.is_told
    }

    /// When a silence is to be told.
    pub(super) fn silence_due(&mut self) -> Option<Instant> {
        let prompt = self.gate.device().prompt();
        let is_open = matches!(self.contact.link, LinkState::Up { .. } | LinkState::Stale { .. });
        let is_watched = self.contact.silence.is_watched && !self.contact.silence.is_told;
        self.contact.silence.due(prompt).filter(|_| is_open && is_watched)
    }
}
