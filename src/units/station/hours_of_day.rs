//! Hours of the day, for settings that only apply at some hours.

use jiff::{Timestamp, civil::Time, tz::TimeZone};
use serde::{Deserialize, Serialize, Serializer};

/// A part of each day, which may contain midnight. The owner of the value defines the clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct HoursOfDay {
    #[serde(rename = "from", serialize_with = "as_text")]
    pub start: Time,
    #[serde(rename = "to", serialize_with = "as_text")]
    pub end: Time,
}

impl HoursOfDay {
    /// Night hours: 22:00 to 06:00.
    pub const NIGHT: Self =
        Self { start: Time::constant(22, 0, 0, 0), end: Time::constant(6, 0, 0, 0) };

    /// Reads a time of the day, such as 22:00.
    pub fn read_time(text: &str) -> Option<Time> {
        Time::strptime("%H:%M", text.trim()).ok()
    }

    /// Returns a time in the form that [`Self::read_time`] reads.
    pub fn time_text(time: Time) -> String {
        time.strftime("%H:%M").to_string()
    }

    /// Returns `true` if the clock of `zone` shows one of these hours.
    pub fn contain(&self, utc: Timestamp, zone: &TimeZone) -> bool {
        let time = zone.to_datetime(utc).time();
        let Self { start, end } = *self;
        if start <= end { (start..end).contains(&time) } else { start <= time || time < end }
    }
}

// serde prescribes the signature.
#[allow(clippy::trivially_copy_pass_by_ref)]
fn as_text<S: Serializer>(time: &Time, out: S) -> Result<S::Ok, S::Error> {
    HoursOfDay::time_text(*time).serialize(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hours_go_across_midnight_by_the_clock_of_the_zone() {
        let istanbul = TimeZone::fixed(jiff::tz::offset(3));
        let is_quiet =
            |hours: HoursOfDay, text: &str| hours.contain(text.parse().unwrap(), &istanbul);
        for (hour, quiet) in [
            ("2026-08-12T18:59:59Z", false),
            ("2026-08-12T19:00:00Z", true),
            ("2026-08-12T21:30:00Z", true),
            ("2026-08-13T02:59:59Z", true),
            ("2026-08-13T03:00:00Z", false),
        ] {
            assert_eq!(is_quiet(HoursOfDay::NIGHT, hour), quiet, "{hour}");
        }
        let HoursOfDay { start: end, end: start } = HoursOfDay::NIGHT;
        let by_day = HoursOfDay { start, end };
        assert!(is_quiet(by_day, "2026-08-12T09:00:00Z"));
        assert!(!is_quiet(by_day, "2026-08-12T20:00:00Z"));
    }
}
