//! Checks periodically that the clock of this computer is synchronised.

use std::time::Duration;

use crate::{clock::Instant, job::Job};
use crate::{
    driver::{TimeSync, time_sync},
    job::Wake,
};

/// Time between two checks: an unsynchronised clock drifts by some milliseconds in it.
const PERIOD: Duration = Duration::from_mins(2);

/// The check under way, and the time of the last one.
#[derive(Default)]
pub(super) struct ClockWatch {
    asked: Option<Instant>,
    job: Option<Job<TimeSync>>,
}

impl ClockWatch {
    /// Returns a new answer once it has come, and starts the next check when it is due.
    pub(super) fn poll(&mut self, now: Instant, wake: &Wake) -> Option<TimeSync> {
        let answer = Job::take(&mut self.job).map(|end| end.unwrap_or(TimeSync::NotKnown));
        let due = self.asked.is_none_or(|asked| now.saturating_duration_since(asked) >= PERIOD);
        if due && self.job.is_none() {
            self.asked = Some(now);
            match Job::start("azel-clock-watch", Wake::clone(wake), |_| time_sync()) {
                Ok(job) => self.job = Some(job),
                Err(error) => tracing::warn!(%error, "no thread to watch the clock"),
            }
        }
        answer
    }
}
