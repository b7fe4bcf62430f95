//! The clock of a request that waits for its reply. Each make recognises the reply by the words of
//! its protocol.

use std::time::Duration;

use crate::clock::{Instant, Moment};

/// When a request went out, and from when on its reply is missing.
#[derive(Debug, Clone, Copy)]
pub(super) struct ReplyClock {
    /// The last time.
    pub(super) sent: Moment,
    /// When a question is repeated, its answer may be to the first one.
    pub(super) first_sent: Moment,
    /// How often, with those that it stands for.
    pub(super) tries: u8,
    /// How long the reply may take.
    pub(super) patience: Duration,
}

impl ReplyClock {
    pub(super) fn new(sent: Moment, patience: Duration) -> Self {
        Self { sent, first_sent: sent, tries: 1, patience }
    }

    /// Returns the clock of a question that stands for one asked at `missing` and given up. Azel
    /// cannot tell their answers apart, so it does not repeat the question.
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

    /// For how long the reply has been waited for.
    pub(super) fn waited(&self, now: Moment) -> Duration {
        now.steady.saturating_duration_since(self.sent.steady)
    }
}
