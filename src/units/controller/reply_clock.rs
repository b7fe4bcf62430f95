//! The clock of a request that waits for its reply. Each make matches the reply by the words of its
//! protocol.

use std::time::Duration;

use crate::clock::{Instant, Moment};

/// Times of a request and the time limit for its reply.
#[derive(Debug, Clone, Copy)]
pub(super) struct ReplyClock {
    /// Time of the last transmission.
    pub(super) sent: Moment,
    /// Time of the first transmission. The answer to a repeated question may belong to it.
    pub(super) first_sent: Moment,
    /// Number of transmissions; `u8::MAX` for a question that replaces a missing one.
    pub(super) tries: u8,
    /// Time limit for the reply.
    pub(super) patience: Duration,
}

impl ReplyClock {
    pub(super) fn new(sent: Moment, patience: Duration) -> Self {
        Self { sent, first_sent: sent, tries: 1, patience }
    }

    /// Returns the clock of a question that replaces a question asked at `missing` and given up.
    /// Azel cannot distinguish their answers, so it does not repeat the question.
    pub(super) fn standing_for(self, missing: Moment) -> Self {
        Self { first_sent: missing, tries: u8::MAX, ..self }
    }

    pub(super) fn deadline(&self) -> Instant {
        self.sent.steady + self.patience
    }

    pub(super) fn is_repeated(&self) -> bool {
        self.tries > 1
    }

    pub(super) fn repeat(&mut self, now: Moment) {
        self.tries = self.tries.saturating_add(1);
        self.sent = now;
    }

    /// Returns the time since the last transmission.
    pub(super) fn waited(&self, now: Moment) -> Duration {
        now.steady.saturating_duration_since(self.sent.steady)
    }
}
