//! Silence of a unit during a motion of Azel.
//!
//! A single lost or late reply is no silence: during a motion, the controllers repeat the query at
//! once. Only a second missing reply counts.

use std::time::Duration;

use crate::clock::Instant;

/// Max time from the first overdue reply to the report.
const TOLD_WITHIN: Duration = Duration::from_secs(1);

/// Times of the writes since the unit last answered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Silence {
    replies: u64,
    first: Option<Instant>,
    second: Option<Instant>,
    /// `true` while a motion of Azel runs.
    is_watched: bool,
    /// `true` if Azel has reported silence and no reply has come since.
    is_reported: bool,
}

impl Silence {
    /// Records written bytes, after the total of `replies` replies.
    pub(super) fn note_write(&mut self, replies: u64, now: Instant) {
        self.count(replies);
        if self.first.is_none() {
            self.first = Some(now);
        } else {
            self.second.get_or_insert(now);
        }
    }

    /// Resets the silence after any reply.
    fn count(&mut self, replies: u64) {
        if replies != self.replies {
            *self = Self { replies, is_watched: self.is_watched, ..Self::default() };
        }
    }

    /// Starts or ends the watch. Queries from before the motion count as missing only from now on.
    pub(super) fn watch(&mut self, is_watched: bool, replies: u64, now: Instant) {
        self.count(replies);
        if is_watched && !self.is_watched {
            self.first = self.first.map(|_| now);
            self.second = None;
        }
        self.is_watched = is_watched;
    }

    /// Returns the time at which silence must be reported if no reply arrives.
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

    /// Forgets the silence: the operator has checked the antenna, or leaves it to others.
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
        silence.note_write(0, start);
        assert_eq!(silence.due(PROMPT), Some(start + PROMPT + TOLD_WITHIN));
        silence.note_write(0, start + PROMPT);
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
        silence.note_write(0, start);
        assert_eq!(silence.due(PROMPT), None, "nothing moves");
        silence.watch(true, 0, later);
        assert_eq!(silence.due(PROMPT), Some(later + PROMPT + TOLD_WITHIN));
    }
}
