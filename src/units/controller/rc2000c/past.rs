//! The last statuses. An axis that coasts after a stop, or moves without a command, shows only in
//! its positions.

use std::{collections::VecDeque, time::Duration};

use crate::{clock::Instant, protocol::rc2000c::Status};

/// Time in which even the slowest axis shows another number. Replies to commands may follow each
/// other much faster.
const LONG_ENOUGH: Duration = Duration::from_millis(250);

/// The last statuses with their times, oldest first.
#[derive(Debug, Default)]
pub(super) struct Past(VecDeque<(Instant, Status)>);

impl Past {
    pub(super) fn push(&mut self, status: Status, now: Instant) {
        // The second status is old enough, so the first is no longer needed.
        while self.0.get(1).is_some_and(|(instant, _)| is_old(*instant, now)) {
            self.0.pop_front();
        }
        self.0.push_back((now, status));
    }

    /// Returns the newest status that is old enough to compare with, or else the oldest.
    pub(super) fn before(&self, now: Instant) -> Option<&Status> {
        let old = self.0.iter().rev().find(|(instant, _)| is_old(*instant, now));
        old.or(self.0.front()).map(|(_, status)| status)
    }
}

fn is_old(instant: Instant, now: Instant) -> bool {
    now.saturating_duration_since(instant) >= LONG_ENOUGH
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        controller::rc2000c::axes::tests::{IDLE, status},
        protocol::rc2000c::Position,
    };

    #[test]
    fn a_status_is_compared_with_one_that_is_old_enough() {
        let start = Instant::now();
        let time = |ms| start + Duration::from_millis(ms);
        let idle = status(IDLE);
        let mut past = Past::default();
        assert_eq!(past.before(start), None);
        for ms in (0..1000).step_by(60) {
            past.push(Status { azimuth: Position::Counts(ms), ..idle }, time(ms.into()));
        }
        let counts = |ms| past.before(time(ms)).map(|status| status.azimuth);
        assert_eq!(counts(1020), Some(Position::Counts(720)));
        assert_eq!(counts(5000), Some(Position::Counts(960)));
        assert!(past.0.len() < 8, "{}", past.0.len());
    }
}
