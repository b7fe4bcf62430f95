//! Detection of clock changes and sleep of the computer.

use std::time::Duration;

use crate::{astro::time::seconds_between, clock::Moment};

/// Max difference between two comparisons of a correct clock, seconds.
const STEP_S: f64 = 0.5;
/// Min duration of a sleep that counts.
const NAP: Duration = Duration::from_secs(1);

#[derive(Debug, Clone, Copy)]
struct Clocks {
    moment: Moment,
    asleep: Duration,
}

/// Clock values at the last comparison.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct SessionClocks {
    last: Option<Clocks>,
}

/// Difference between two comparisons of the clocks.
#[derive(Debug, Clone, Copy)]
pub(super) struct ClockAdvance {
    /// Steady time between the comparisons.
    pub(super) steady: Duration,
    /// Step of UTC, seconds.
    pub(super) stepped_s: Option<f64>,
    /// Duration of the computer's sleep.
    pub(super) slept: Option<Duration>,
}

impl SessionClocks {
    /// Compares the clocks with their last values. `asleep`: total sleep of the computer.
    pub(super) fn compare(&mut self, now: Moment, asleep: Duration) -> Option<ClockAdvance> {
        let before = self.last.replace(Clocks { moment: now, asleep })?;
        let slept = asleep.saturating_sub(before.asleep);
        let steady = now.steady.saturating_duration_since(before.moment.steady);
        // The steady clock pauses while the computer sleeps.
        let expected_s = (steady + slept).as_secs_f64();
        let by_s = seconds_between(before.moment.utc, now.utc) - expected_s;
        Some(ClockAdvance {
            steady,
            stepped_s: Some(by_s).filter(|by_s| by_s.abs() > STEP_S),
            slept: Some(slept).filter(|slept| *slept >= NAP),
        })
    }
}

#[cfg(test)]
mod tests {
    use jiff::Timestamp;

    use super::*;
    use crate::{astro::time::add_seconds, clock::Instant};

    #[test]
    fn a_clock_that_was_set_and_a_sleep_are_told_apart() {
        let start = Instant::now();
        let moment = |steady_s: f64, utc_s: f64| Moment {
            steady: start + Duration::try_from_secs_f64(steady_s).unwrap(),
            utc: add_seconds(Timestamp::UNIX_EPOCH, utc_s),
        };
        let look = |now, asleep_s: u64| {
            let mut clocks = SessionClocks::default();
            assert!(clocks.compare(moment(0.0, 0.0), Duration::ZERO).is_none(), "the first look");
            let change = clocks.compare(now, Duration::from_secs(asleep_s)).unwrap();
            (change.stepped_s.map(f64::round), change.slept)
        };
        assert_eq!(look(moment(10.0, 10.2), 0), (None, None));
        assert_eq!(look(moment(10.0, 70.0), 0), (Some(60.0), None));
        assert_eq!(look(moment(10.0, 70.0), 60), (None, Some(Duration::from_mins(1))));
        assert_eq!(look(moment(10.0, 10.0), 60), (Some(-60.0), Some(Duration::from_mins(1))));
    }
}
