//! What the station tells through the desktop, and of which passes it reminds.

use std::collections::BTreeSet;

use jiff::{Timestamp, civil::Time, tz::TimeZone};
use serde::{Serialize, Serializer};

/// Settings for notices: alarms and reminders that the desktop shows and sounds. Alarms of the
/// first rank ignore them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Notices {
    /// The desktop shows new alarms and reminders.
    pub notifications: bool,
    /// New alarms and reminders make a sound.
    pub sounds: bool,
    /// `None` where no hours are quiet.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub quiet: Option<QuietHours>,
    /// Time from a reminder to AOS, minutes, 1 to 60.
    pub reminder_min: f64,
    /// Catalog numbers of the favourites whose passes have a reminder.
    pub reminders: BTreeSet<u32>,
}

impl Default for Notices {
    fn default() -> Self {
        Self {
            notifications: true,
            sounds: true,
            quiet: None,
            reminder_min: 5.0,
            reminders: BTreeSet::new(),
        }
    }
}

impl Notices {
    pub(super) fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

/// A part of each day in local time, which may contain midnight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct QuietHours {
    #[serde(serialize_with = "as_text")]
    pub from: Time,
    #[serde(serialize_with = "as_text")]
    pub to: Time,
}

impl QuietHours {
    /// From ten in the evening to six in the morning.
    pub const USUAL: Self =
        Self { from: Time::constant(22, 0, 0, 0), to: Time::constant(6, 0, 0, 0) };

    /// Reads a time of the day, such as 22:00.
    pub fn read_time(text: &str) -> Option<Time> {
        Time::strptime("%H:%M", text.trim()).ok()
    }

    /// Writes a time as [`Self::read_time`] reads it.
    pub fn time_text(time: Time) -> String {
        time.strftime("%H:%M").to_string()
    }

    /// Returns `true` if the clock of `zone` shows a quiet hour.
    pub fn contain(&self, at: Timestamp, zone: &TimeZone) -> bool {
        let time = zone.to_datetime(at).time();
        let Self { from, to } = *self;
        if from <= to { (from..to).contains(&time) } else { from <= time || time < to }
    }
}

// The signature is serde's.
#[allow(clippy::trivially_copy_pass_by_ref)]
fn as_text<S: Serializer>(time: &Time, out: S) -> Result<S::Ok, S::Error> {
    QuietHours::time_text(*time).serialize(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quiet_hours_go_across_midnight_by_the_local_clock() {
        let istanbul = TimeZone::fixed(jiff::tz::offset(3));
        let is_quiet = |hours: QuietHours, at: &str| hours.contain(at.parse().unwrap(), &istanbul);
        for (at, quiet) in [
            ("2026-08-12T18:59:59Z", false),
            ("2026-08-12T19:00:00Z", true),
            ("2026-08-12T21:30:00Z", true),
            ("2026-08-13T02:59:59Z", true),
            ("2026-08-13T03:00:00Z", false),
        ] {
            assert_eq!(is_quiet(QuietHours::USUAL, at), quiet, "{at}");
        }
        let QuietHours { from: to, to: from } = QuietHours::USUAL;
        let by_day = QuietHours { from, to };
        assert!(is_quiet(by_day, "2026-08-12T09:00:00Z"));
        assert!(!is_quiet(by_day, "2026-08-12T20:00:00Z"));
    }
}
