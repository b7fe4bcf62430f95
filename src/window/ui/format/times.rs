//! Times for the operator. A time carries its day unless that is the day of the time it is read
//! against: the present, or the time before it in the same sentence. The day carries its year
//! in the same way.

use jiff::{Timestamp, Zoned, tz::TimeZone};

fn utc(at: Timestamp) -> Zoned {
    at.to_zoned(TimeZone::UTC)
}

/// `form` of the time of day, after its day where that is not the day of `now`.
fn on_its_day(at: Timestamp, now: Timestamp, form: &str) -> String {
    let (at, now) = (utc(at), utc(now));
    let day = match at.date() {
        date if date == now.date() => "",
        date if date.year() == now.year() => "%-d %b ",
        _ => "%-d %b %Y ",
    };
    at.strftime(&format!("{day}{form}")).to_string()
}

/// UTC as hh:mm:ssZ, with its day before it where that is not the day of `now`.
pub fn moment(at: Timestamp, now: Timestamp) -> String {
    on_its_day(at, now, "%H:%M:%SZ")
}

/// A [`moment`] to the minute, as hh:mmZ.
pub fn minute(at: Timestamp, now: Timestamp) -> String {
    on_its_day(at, now, "%H:%MZ")
}

/// A [`moment`] to the minute within a plot, whose times are all UTC: hh:mm.
pub fn minute_in_plot(at: Timestamp, now: Timestamp) -> String {
    on_its_day(at, now, "%H:%M")
}

/// A mark of a time axis: UTC as hh:mm, and at midnight the day that begins.
pub fn on_axis(at: Timestamp) -> String {
    let at = utc(at);
    at.strftime(if at.hour() == 0 && at.minute() == 0 { "%-d %b" } else { "%H:%M" }).to_string()
}

/// Returns `true` if both are on the same day of UTC.
pub fn is_today(at: Timestamp, now: Timestamp) -> bool {
    utc(at).date() == utc(now).date()
}

/// A [`moment`] with milliseconds; on another day to the second, which takes the same room.
pub fn millisecond(at: Timestamp, now: Timestamp) -> String {
    on_its_day(at, now, if is_today(at, now) { "%H:%M:%S.%3f" } else { "%H:%M:%S" })
}

/// Two moments, such as 11:06:12Z to 11:18:40Z.
pub fn stretch(from: Timestamp, to: Timestamp, now: Timestamp) -> String {
    format!("{} to {}", moment(from, now), moment(to, from))
}

/// A [`stretch`] to the minute, such as 11:06Z to 11:18Z.
pub fn minutes(from: Timestamp, to: Timestamp, now: Timestamp) -> String {
    format!("{} to {}", minute(from, now), minute(to, from))
}

/// UTC with weekday and date, such as Sat 2026-11-14 11:06:12Z.
pub fn dated(at: Timestamp) -> String {
    utc(at).strftime("%a %Y-%m-%d %H:%M:%SZ").to_string()
}

/// UTC with its date, such as 2026-11-14 11:06:12Z, for other programs.
pub fn copied(at: Timestamp) -> String {
    utc(at).strftime("%Y-%m-%d %H:%M:%SZ").to_string()
}

/// UTC as weekday and ISO date, such as Sat 2026-11-14.
pub fn date(at: Timestamp) -> String {
    utc(at).strftime("%a %Y-%m-%d").to_string()
}

/// UTC as ISO date, such as 2026-11-14.
pub fn iso_date(at: Timestamp) -> String {
    utc(at).strftime("%Y-%m-%d").to_string()
}

/// A day such as 14 Nov.
pub fn day(at: Timestamp) -> String {
    utc(at).strftime("%-d %b").to_string()
}

/// A day such as Sat 14 Nov.
pub fn weekday(at: Timestamp) -> String {
    utc(at).strftime("%a %-d %b").to_string()
}

/// The time of the clock: UTC as hh:mm:ss.
pub fn clock(now: Timestamp) -> String {
    second_of_day(now)
}

/// The local time of the clock, with its zone.
pub fn local_clock(now: Timestamp) -> String {
    now.to_zoned(TimeZone::system()).strftime("%H:%M:%S local, %Z").to_string()
}

/// UTC as hh:mm:ss, only below a heading or an axis that names the day.
pub fn second_of_day(at: Timestamp) -> String {
    utc(at).strftime("%H:%M:%S").to_string()
}

/// UTC as hh:mm, only below a heading or an axis that names the day.
pub fn minute_of_day(at: Timestamp) -> String {
    utc(at).strftime("%H:%M").to_string()
}

/// UTC as hh, only below a heading or an axis that names the day.
pub fn hour_of_day(at: Timestamp) -> String {
    utc(at).strftime("%H").to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(text: &str) -> Timestamp {
        text.parse().unwrap()
    }

    #[test]
    fn a_time_carries_its_day_unless_that_is_today() {
        let time = at("2026-11-14T11:06:12.9Z");
        let (today, later) = (at("2026-11-14T23:59:59Z"), at("2026-11-15T00:00:00Z"));
        assert_eq!([moment(time, today), minute(time, today)], ["11:06:12Z", "11:06Z"]);
        assert_eq!(
            [moment(time, later), minute(time, later)],
            ["14 Nov 11:06:12Z", "14 Nov 11:06Z"]
        );
        let next_year = at("2027-01-01T00:00:00Z");
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
        let (from, to) = (at("2026-11-14T23:50:00Z"), at("2026-11-15T00:02:00Z"));
        assert_eq!(stretch(from, to, from), "23:50:00Z to 15 Nov 00:02:00Z");
        assert_eq!(stretch(from, to, to), "14 Nov 23:50:00Z to 15 Nov 00:02:00Z");
        assert_eq!(stretch(from, from, to), "14 Nov 23:50:00Z to 23:50:00Z");
        assert_eq!(minutes(from, to, from), "23:50Z to 15 Nov 00:02Z");
    }
}
