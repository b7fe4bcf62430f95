//! A unit that stops answering while Azel has metal moving.
//!
//! A single lost or late reply is not silence: during a motion the controllers ask again at
//! once, and only a second missing reply counts.

use std::time::Duration;

use crate::clock::Instant;

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
    /// Azel has reported silence, and no reply has come since.
    is_reported: bool,
}

impl Silence {
    /// Bytes were written when `replies` replies had come.
    pub(super) fn wrote(&mut self, replies: u64, now: Instant) {
        self.count(replies);
        if self.first.is_none() {
            self.first = Some(now);
        } else {
            self.second.get_or_insert(now);
        }
    }

    /// Any reply ends the silence.
    fn count(&mut self, replies: u64) {
        if replies != self.replies {
            *self = Self { replies, is_watched: self.is_watched, ..Self::default() };
        }
    }

    /// Questions asked before the motion count as missing only from now on.
    pub(super) fn watch(&mut self, is_watched: bool, replies: u64, now: Instant) {
        self.count(replies);
        if is_watched && !self.is_watched {
            self.first = self.first.map(|_| now);
            self.second = None;
        }
        self.is_watched = is_watched;
    }

    /// When to report silence if nothing that was asked is answered.
    pub(super) fn due(&self, prompt: Duration) -> Option<Instant> {
        if !self.is_watched || self.is_reported {
            return None;
        }
        let first = self.first?;
        let latest = first + prompt + TOLD_WITHIN;
        let again = self.second.map(|second| (second + prompt).max(first + prompt * 2));
        Some(again.map_or(latest, |again| again.min(latest)))
    }

    /// Returns `true` once until the unit answers.
    pub(super) fn report(&mut self) -> bool {
        !std::mem::replace(&mut self.is_reported, true)
    }

    /// Returns `true` if silence was reported and no reply has come since.
    pub(super) fn is_reported(&self) -> bool {
        self.is_reported
    }

    /// The operator has looked at the antenna, or leaves it to others.
    pub(super) fn forget(&mut self) {
        self.is_reported = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PROMPT: Duration = Duration::from_millis(600);

    #[test]
    fn a_second_missing_reply_is_silence_and_any_reply_ends_it() {
        let start = Instant::now();
        let mut silence = Silence::default();
        silence.watch(true, 0, start);
        assert_eq!(silence.due(PROMPT), None, "nothing was asked");
        silence.wrote(0, start);
        assert_eq!(silence.due(PROMPT), Some(start + PROMPT + TOLD_WITHIN));
        silence.wrote(0, start + PROMPT);
        assert_eq!(silence.due(PROMPT), Some(start + PROMPT * 2));
        assert!(silence.report() && !silence.report(), "once");
        silence.watch(true, 1, start + PROMPT);
        assert!(!silence.is_reported());
    }

    #[test]
    fn a_question_from_before_the_motion_is_missing_only_from_the_motion_on() {
        let start = Instant::now();
        let later = start + Duration::from_secs(30);
        let mut silence = Silence::default();
        silence.wrote(0, start);
        assert_eq!(silence.due(PROMPT), None, "nothing moves");
        silence.watch(true, 0, later);
        assert_eq!(silence.due(PROMPT), Some(later + PROMPT + TOLD_WITHIN));
    }
}
