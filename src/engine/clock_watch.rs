//! Asks now and then whether the clock of this computer is kept right.

use std::time::Duration;

use crate::{clock::Instant, job::Job};
use crate::{
    driver::{TimeSync, time_sync},
    job::Wake,
};

/// A clock that nobody keeps drifts by some milliseconds in this time.
const PERIOD: Duration = Duration::from_mins(2);

/// The question that is under way, and when the next one is due.
#[derive(Default)]
pub(super) struct ClockWatch {
    asked: Option<Instant>,
    job: Option<Job<TimeSync>>,
}

impl ClockWatch {
    /// The newest answer, once it has come.
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
