//! Times for the operator. A time carries its day unless that is the day of its reference: the
//! present, or the time before it in the same sentence. The day carries its year by the same rule.

use jiff::{Timestamp, Zoned, tz::TimeZone};

fn utc(time: Timestamp) -> Zoned {
    time.to_zoned(TimeZone::UTC)
}

/// Formats the time of day by `form`, after its day if that is not the day of `now`.
fn on_its_day(time: Timestamp, now: Timestamp, form: &str) -> String {
    let (time, now) = (utc(time), utc(now));
    let day = match time.date() {
        date if date == now.date() => "",
        date if date.year() == now.year() => "%-d %b ",
        _ => "%-d %b %Y ",
    };
    time.strftime(&format!("{day}{form}")).to_string()
}

/// Formats UTC as hh:mm:ssZ, after its day if that is not the day of `now`.
pub fn moment(time: Timestamp, now: Timestamp) -> String {
    on_its_day(time, now, "%H:%M:%SZ")
}

/// Formats a [`moment`] to the minute, as hh:mmZ.
pub fn minute(time: Timestamp, now: Timestamp) -> String {
    on_its_day(time, now, "%H:%MZ")
}

/// Formats a [`moment`] to the minute in a plot, whose times are all UTC: hh:mm.
pub fn minute_in_plot(time: Timestamp, now: Timestamp) -> String {
    on_its_day(time, now, "%H:%M")
}

/// Formats a mark of a time axis: UTC as hh:mm, and at midnight the day that begins.
pub fn on_axis(time: Timestamp) -> String {
    let time = utc(time);
    time.strftime(if time.hour() == 0 && time.minute() == 0 { "%-d %b" } else { "%H:%M" })
        .to_string()
}

/// Returns `true` if both times are on the same UTC day.
pub fn is_today(time: Timestamp, now: Timestamp) -> bool {
    utc(time).date() == utc(now).date()
}

/// Formats a [`moment`] with milliseconds. On another day it ends at the second, which takes the
/// same room.
pub fn millisecond(time: Timestamp, now: Timestamp) -> String {
    on_its_day(time, now, if is_today(time, now) { "%H:%M:%S.%3f" } else { "%H:%M:%S" })
}

/// Formats two moments, such as 11:06:12Z to 11:18:40Z.
pub fn stretch(start: Timestamp, end: Timestamp, now: Timestamp) -> String {
    format!("{} to {}", moment(start, now), moment(end, start))
}

/// Formats a [`stretch`] to the minute, such as 11:06Z to 11:18Z.
pub fn minutes(start: Timestamp, end: Timestamp, now: Timestamp) -> String {
    format!("{} to {}", minute(start, now), minute(end, start))
}

/// Formats UTC with weekday and date, such as Sat 2026-11-14 11:06:12Z.
pub fn dated(time: Timestamp) -> String {
    utc(time).strftime("%a %Y-%m-%d %H:%M:%SZ").to_string()
}

/// Formats UTC with its date for other programs, such as 2026-11-14 11:06:12Z.
pub fn copied(time: Timestamp) -> String {
    utc(time).strftime("%Y-%m-%d %H:%M:%SZ").to_string()
}

/// Formats UTC as weekday and ISO date, such as Sat 2026-11-14.
pub fn date(time: Timestamp) -> String {
    utc(time).strftime("%a %Y-%m-%d").to_string()
}

/// Formats UTC as ISO date, such as 2026-11-14.
pub fn iso_date(time: Timestamp) -> String {
    utc(time).strftime("%Y-%m-%d").to_string()
}

/// Formats a day, such as 14 Nov.
pub fn day(time: Timestamp) -> String {
    utc(time).strftime("%-d %b").to_string()
}

/// Formats a day with its weekday, such as Sat 14 Nov.
pub fn weekday(time: Timestamp) -> String {
    utc(time).strftime("%a %-d %b").to_string()
}

/// Formats the time of the clock: UTC as hh:mm:ss.
pub fn clock(now: Timestamp) -> String {
    second_of_day(now)
}

/// Formats the local time of the clock, with its zone.
pub fn local_clock(now: Timestamp) -> String {
    now.to_zoned(TimeZone::system()).strftime("%H:%M:%S local, %Z").to_string()
}

/// Formats UTC as hh:mm:ss, only below a heading or an axis that names the day.
pub fn second_of_day(time: Timestamp) -> String {
    utc(time).strftime("%H:%M:%S").to_string()
}

/// Formats UTC as hh:mm, only below a heading or an axis that names the day.
pub fn minute_of_day(time: Timestamp) -> String {
    utc(time).strftime("%H:%M").to_string()
}

/// Formats UTC as hh, only below a heading or an axis that names the day.
pub fn hour_of_day(time: Timestamp) -> String {
    utc(time).strftime("%H").to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Timestamp {
        text.parse().unwrap()
    }

    #[test]
    fn a_time_carries_its_day_unless_that_is_today() {
        let time = parsed("2026-11-14T11:06:12.9Z");
        let (today, later) = (parsed("2026-11-14T23:59:59Z"), parsed("2026-11-15T00:00:00Z"));
        assert_eq!([moment(time, today), minute(time, today)], ["11:06:12Z", "11:06Z"]);
        assert_eq!(
            [moment(time, later), minute(time, later)],
            ["14 Nov 11:06:12Z", "14 Nov 11:06Z"]
        );
        let next_year = parsed("2027-01-01T00:00:00Z");
        assert_eq!(moment(time, next_year), "14 Nov 2026 11:06:12Z");
        assert_eq!(millisecond(time, today), "11:06:12.900");
        assert_eq!(millisecond(time, later), "14 Nov 11:06:12");
        assert_eq!(dated(time), "Sat 2026-11-14 11:06:12Z");
        assert_eq!(copied(time), "2026-11-14 11:06:12Z");
        assert_eq!([minute_in_plot(time, today), on_axis(time)], ["11:06", "11:06"]);
        assert_eq!([minute_in_plot(time, later), on_axis(later)], ["14 Nov 11:06", "15 Nov"]);
    }

    #[test]
    fn a_stretch_names_each_day_once() {
        let (start, end) = (parsed("2026-11-14T23:50:00Z"), parsed("2026-11-15T00:02:00Z"));
        assert_eq!(stretch(start, end, start), "23:50:00Z to 15 Nov 00:02:00Z");
        assert_eq!(stretch(start, end, end), "14 Nov 23:50:00Z to 15 Nov 00:02:00Z");
        assert_eq!(stretch(start, start, end), "14 Nov 23:50:00Z to 23:50:00Z");
        assert_eq!(minutes(start, end, start), "23:50Z to 15 Nov 00:02Z");
    }
}
