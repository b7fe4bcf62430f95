//! Time that an antenna has been off its target.

use std::time::Duration;

use crate::{astro::Angle, clock::Instant};

/// Time off target after which Azel raises an alarm.
const ALARM_AFTER: Duration = Duration::from_secs(10);
/// Time off target after which Azel gives up the pass.
const GIVE_UP_AFTER: Duration = Duration::from_secs(30);

/// Duration of the current pointing error.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct OffTarget {
    /// Start of the error, last measured error, and time of that measurement.
    error: Option<(Instant, Angle, Instant)>,
}

impl OffTarget {
    /// Takes the angle off target; `None` on target, or while the antenna cannot have arrived yet.
    pub(super) fn take(&mut self, error: Option<Angle>, time: Instant) {
        let began = self.error.map_or(time, |(began, ..)| began);
        self.error = error.map(|error| (began, error, time));
    }

    /// Returns the angle off target once it has lasted [`ALARM_AFTER`].
    pub(super) fn missing(&self) -> Option<Angle> {
        self.error_after(ALARM_AFTER)
    }

    /// Returns the angle off target once it has lasted [`GIVE_UP_AFTER`].
    pub(super) fn hopeless(&self) -> Option<Angle> {
        self.error_after(GIVE_UP_AFTER)
    }

    fn error_after(&self, min: Duration) -> Option<Angle> {
        let (began, error, time) = self.error?;
        (time.saturating_duration_since(began) >= min).then_some(error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lasting_error_raises_an_alarm_and_then_ends_the_pass() {
        let start = Instant::now();
        let after = |s| start + Duration::from_secs(s);
        let error = Some(Angle::from_degrees(5.0));
        let mut off_target = OffTarget::default();
        let mut states = Vec::new();
        for second in 0..40 {
            // A short return to the target restarts the count.
            off_target.take(error.filter(|_| second != 4), after(second));
            states.push((off_target.missing().is_some(), off_target.hopeless().is_some()));
        }
        assert_eq!(states.iter().position(|(missing, _)| *missing), Some(15));
        assert_eq!(states.iter().position(|(_, hopeless)| *hopeless), Some(35));
        off_target.take(None, after(41));
        assert_eq!((off_target.missing(), off_target.hopeless()), (None, None));
    }
}
