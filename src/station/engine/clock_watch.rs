//! Periodic checks that this computer's clock is synchronised, and detection of clock steps at each
//! turn.

use std::time::Duration;

use crate::{
    astro::time::seconds_between,
    clock::{Instant, Moment},
    contract::driver::TimeSync,
    job::{Job, Wake},
};

/// Time between two checks. An unsynchronised clock drifts by some milliseconds in that time.
const PERIOD: Duration = Duration::from_mins(2);

/// Min change of the clock that makes UTC implausible, seconds.
const STEP_S: f64 = 1.0;

/// Current check, and the time of the last one.
#[derive(Default)]
pub(super) struct ClockWatch {
    checked: Option<Instant>,
    job: Option<Job<TimeSync>>,
    /// `true` from a clock step until the time service answers; automatic operation waits.
    pub(super) is_in_doubt: bool,
    /// Both clocks and the total sleep time at the previous turn.
    previous: Option<(Moment, Duration)>,
}

impl ClockWatch {
    /// Returns `true` if the clock was set since the last call, which makes UTC implausible.
    pub(super) fn was_set(&mut self, now: Moment, asleep: Duration) -> bool {
        let Some((before, slept)) = self.previous.replace((now, asleep)) else { return false };
        let steady = now.steady.saturating_duration_since(before.steady);
        let expected_s = (steady + asleep.saturating_sub(slept)).as_secs_f64();
        (seconds_between(before.utc, now.utc) - expected_s).abs() >= STEP_S
    }

    /// Discards the earlier check, so that the next poll starts a new one.
    pub(super) fn ask_again(&mut self) {
        (self.checked, self.job) = (None, None);
    }

    /// Returns a new answer of the time service, and starts the next check when due.
    pub(super) fn poll(
        &mut self,
        now: Instant,
        time_sync: fn() -> TimeSync,
        wake: &Wake,
    ) -> Option<TimeSync> {
        let answer = Job::take(&mut self.job).map(|end| end.unwrap_or(TimeSync::NotKnown));
        let due =
            self.checked.is_none_or(|checked| now.saturating_duration_since(checked) >= PERIOD);
        if due && self.job.is_none() {
            self.checked = Some(now);
            let ask = move |_: &(dyn Fn() -> bool + Sync)| time_sync();
            self.job = Some(Job::start("azel-clock-watch", Wake::clone(wake), ask));
        }
        answer
    }
}
