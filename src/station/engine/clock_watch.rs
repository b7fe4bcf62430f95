//! Checks periodically that the clock of this computer is synchronised, and detects clock steps at
//! each turn.

use std::time::Duration;

use crate::{
    astro::time::seconds_between,
    clock::{Instant, Moment},
    contract::driver::TimeSync,
    job::{Job, Wake},
};

/// Time between two checks: an unsynchronised clock drifts by some milliseconds in it.
const PERIOD: Duration = Duration::from_mins(2);

/// A clock that is set by less stays plausible, seconds.
const STEP_S: f64 = 1.0;

/// The check under way, and the time of the last one.
#[derive(Default)]
pub(super) struct ClockWatch {
    checked: Option<Instant>,
    job: Option<Job<TimeSync>>,
    /// Set from a clock step until the time service answers: automatic operation waits.
    pub(super) is_in_doubt: bool,
    /// Both clocks and the total sleep time at the previous turn.
    previous: Option<(Moment, Duration)>,
}

impl ClockWatch {
    /// Returns `true` if the clock was set since the last call, so that UTC is not plausible.
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

    /// Returns a new answer once it has come, and starts the next check when it is due.
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
