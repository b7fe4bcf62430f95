//! Formats of numbers and times.

mod distances;
mod times;

use jiff::Timestamp;

use crate::{
    astro::{Angle, AzEl},
    device::{Capabilities, Pointing},
};
pub use distances::{distance, distance_number, distance_unit, range_rate, speed};
pub use times::{
    clock, copied, date, dated, day, hour_of_day, is_today, iso_date, local_clock, millisecond,
    minute, minute_in_plot, minute_of_day, minutes, moment, on_axis, second_of_day, stretch,
    weekday,
};

/// Length of a mean year, seconds.
const YEAR: u64 = 31_556_952;
const MANY_YEARS: u64 = 2 * YEAR;
/// Typographic minus sign.
const MINUS: char = '\u{2212}';
/// Separator of thousands.
const THIN_SPACE: char = '\u{2009}';

/// Formats a number with `decimals` places and the typographic minus sign. A value that rounds to
/// zero has no sign.
pub fn number(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return "–".to_owned();
    }
    let digits = format!("{:.decimals$}", value.abs());
    let negative = value < 0.0 && digits.bytes().any(|byte| (b'1'..=b'9').contains(&byte));
    let digits = group_thousands(&digits);
    if negative { format!("{MINUS}{digits}") } else { digits }
}

/// Formats a [`number`] with a plus sign if it is not negative.
pub fn signed(value: f64, decimals: usize) -> String {
    let text = number(value, decimals);
    if text.starts_with(MINUS) || !value.is_finite() { text } else { format!("+{text}") }
}

/// Groups the digits in threes, from five digits on.
fn group_thousands(digits: &str) -> String {
    let whole = digits.find('.').unwrap_or(digits.len());
    if whole < 5 {
        return digits.to_owned();
    }
    let mut grouped = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && place < whole && (whole - place).is_multiple_of(3) {
            grouped.push(THIN_SPACE);
        }
        grouped.push(digit);
    }
    grouped
}

/// Formats an angle with the degree sign.
pub fn degrees(value_deg: f64, decimals: usize) -> String {
    format!("{}°", number(value_deg, decimals))
}

/// Formats the known azimuth and elevation of an antenna with these capabilities.
pub fn pointing(pointing: Pointing, can: Capabilities) -> String {
    let azimuth = pointing.azimuth.map(|azimuth| azimuth.wrapped_360().degrees());
    let angles = [azimuth, pointing.elevation.map(Angle::degrees)];
    let decimals = decimals(can, 1);
    let numbers = angles.into_iter().flatten().map(|deg| degrees(deg, decimals));
    numbers.collect::<Vec<_>>().join(", ")
}

/// Formats a direction in the sky as azimuth and elevation.
pub fn pointing_at(direction: AzEl) -> String {
    let (azimuth, elevation) = (direction.azimuth_deg(), direction.elevation_deg());
    format!("{}, {}", degrees(azimuth, 1), degrees(elevation, 1))
}

/// Formats a latitude with its side of the equator, such as 41.2° N.
pub fn latitude(value_deg: f64, decimals: usize) -> String {
    lettered(value_deg, decimals, 'N', 'S')
}

/// Formats a longitude with its side of Greenwich, such as 29.6° E.
pub fn longitude(value_deg: f64, decimals: usize) -> String {
    lettered(value_deg, decimals, 'E', 'W')
}

fn lettered(value_deg: f64, decimals: usize, plus: char, minus: char) -> String {
    let digits = format!("{:.decimals$}", value_deg.abs());
    let is_zero = !digits.bytes().any(|byte| (b'1'..=b'9').contains(&byte));
    let letter = if value_deg < 0.0 && !is_zero { minus } else { plus };
    format!("{digits}° {letter}")
}

/// Returns the significant decimals of a degree for a controller with these capabilities, at most
/// `max`.
pub fn decimals(can: Capabilities, max: usize) -> usize {
    match can.position_step_deg {
        0.0 => max,
        step_deg if step_deg.fract() == 0.0 => 0,
        step_deg if (step_deg * 10.0).fract() == 0.0 => max.min(1),
        _ => max.min(2),
    }
}

/// Formats an azimuth as three digits with the degree sign; 359.6 becomes 000.
pub fn azimuth(value_deg: f64) -> String {
    if !value_deg.is_finite() {
        return "–".to_owned();
    }
    format!("{:03}°", (value_deg.rem_euclid(360.0).round() as u32) % 360)
}

/// Returns the side of the sky at an azimuth, such as NE.
pub fn side_of_sky(azimuth_deg: f64) -> &'static str {
    const SIDES: [&str; 8] = ["N", "NE", "E", "SE", "S", "SW", "W", "NW"];
    let eighth = (azimuth_deg / 45.0).round().rem_euclid(8.0);
    SIDES.get(eighth as usize).copied().unwrap_or("N")
}

/// Formats the size of a file, such as 12.3 MB.
pub fn bytes(count: u64) -> String {
    let count = count as f64;
    match count {
        _ if count < 1e5 => format!("{:.0} kB", count / 1e3),
        _ if count < 1e9 => format!("{:.1} MB", count / 1e6),
        _ => format!("{:.1} GB", count / 1e9),
    }
}

/// Formats a duration as m:ss, from one hour as h:mm:ss, from 100 hours in days.
pub fn duration(seconds: f64) -> String {
    let seconds = seconds.abs().round() as u64;
    let (hours, minutes, rest) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    match hours {
        0 => format!("{minutes}:{rest:02}"),
        1..100 => format!("{hours}:{minutes:02}:{rest:02}"),
        _ => format!("{} d", hours / 24),
    }
}

/// Returns the seconds from the clock display at `now` to the display of `time`. Both times are cut
/// to whole seconds: the clock and a countdown add up to the time beside them.
fn seconds_left(now: Timestamp, time: Timestamp) -> i64 {
    time.as_second() - now.as_second()
}

/// Formats the time until `time` as a [`duration`] that agrees with its [`countdown`].
pub fn time_left(now: Timestamp, time: Timestamp) -> String {
    duration(seconds_left(now, time).max(0) as f64)
}

/// Formats a countdown as T−mm:ss, from one hour as T−h:mm:ss; T+ follows once the time is past.
pub fn countdown(now: Timestamp, time: Timestamp) -> String {
    let left = seconds_left(now, time);
    let sign = if left < 0 { '+' } else { MINUS };
    let whole = left.unsigned_abs();
    let (hours, minutes, rest) = (whole / 3600, whole / 60 % 60, whole % 60);
    if hours == 0 {
        format!("T{sign}{minutes:02}:{rest:02}")
    } else {
        format!("T{sign}{hours}:{minutes:02}:{rest:02}")
    }
}

/// Formats an age: 0.3 s, 14 s, 3 min, 8 h 52 min, 1 d 3 h, 12 d.
pub fn age(seconds: f64) -> String {
    let seconds = seconds.max(0.0);
    let whole = seconds as u64;
    match whole {
        0..10 => format!("{seconds:.1} s"),
        10..120 => format!("{whole} s"),
        120..7200 => format!("{} min", whole / 60),
        7200..86_400 => format!("{} h {} min", whole / 3600, whole / 60 % 60),
        86_400..604_800 => format!("{} d {} h", whole / 86_400, whole / 3600 % 24),
        604_800..MANY_YEARS => format!("{} d", whole / 86_400),
        _ => format!("{} years", group_thousands(&(whole / YEAR).to_string())),
    }
}

/// Formats a count with its noun, such as "1 source" and "3 sources".
pub fn counted(count: usize, noun: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{} {noun}{plural}", number(count as f64, 0))
}

/// Joins names into a list, such as "Satrak, Genius and RC2000C".
pub fn list(names: &[impl AsRef<str>]) -> String {
    let mut text = String::new();
    for (index, name) in names.iter().enumerate() {
        text += match index {
            0 => "",
            _ if index + 1 == names.len() => " and ",
            _ => ", ",
        };
        text += name.as_ref();
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_direction_has_the_decimals_of_its_unit() {
        let position = Pointing::from(crate::astro::AzEl::from_degrees(43.0, 12.0));
        let satrak = crate::controller::satrak::VARIANT.capabilities;
        let text = |position_step_deg| {
            let can = Capabilities { position_step_deg, ..satrak };
            (pointing(position, can), decimals(can, 3))
        };
        assert_eq!(text(0.0), ("43.0°, 12.0°".to_owned(), 3));
        assert_eq!(text(1.0), ("43°, 12°".to_owned(), 0));
        assert_eq!(text(0.5), ("43.0°, 12.0°".to_owned(), 1));
        assert_eq!(text(0.25).1, 2);
    }

    #[test]
    fn numbers() {
        assert_eq!(number(-0.04, 2), "−0.04");
        assert_eq!(number(-0.004, 2), "0.00");
        assert_eq!(signed(0.0, 2), "+0.00");
        assert_eq!(signed(-4.99, 2), "−4.99");
        assert_eq!(number(9999.0, 0), "9999");
        assert_eq!(number(-42_123_456.5, 1), "−42\u{2009}123\u{2009}456.5");
        assert_eq!(number(f64::NAN, 2), "–");
        assert_eq!(degrees(-5.25, 1), "−5.2°");
    }

    #[test]
    fn places_have_their_side_of_the_equator_and_of_greenwich() {
        assert_eq!((latitude(41.176, 1), latitude(-0.04, 1)), ("41.2° N".into(), "0.0° N".into()));
        assert_eq!((longitude(-70.9, 1), longitude(29.6, 0)), ("70.9° W".into(), "30° E".into()));
    }

    #[test]
    fn azimuths_have_three_digits() {
        assert_eq!(azimuth(5.4), "005°");
        assert_eq!(azimuth(359.6), "000°");
        assert_eq!(azimuth(-1.0), "359°");
    }

    #[test]
    fn sides_of_the_sky_are_the_nearest_of_eight() {
        for (azimuth_deg, side) in [(0.0, "N"), (22.0, "N"), (23.0, "NE"), (359.0, "N")] {
            assert_eq!(side_of_sky(azimuth_deg), side);
        }
        assert_eq!(
            [side_of_sky(450.0), side_of_sky(-90.0), side_of_sky(f64::NAN)],
            ["E", "W", "N"]
        );
    }

    #[test]
    fn times_left_and_passed() {
        let now = Timestamp::UNIX_EPOCH;
        let text = |left_s| {
            let time = Timestamp::from_second(left_s).unwrap();
            (countdown(now, time), time_left(now, time))
        };
        assert_eq!(text(513), ("T−08:33".to_owned(), "8:33".to_owned()));
        assert_eq!(text(5395), ("T−1:29:55".to_owned(), "1:29:55".to_owned()));
        assert_eq!(text(86_399).0, "T−23:59:59");
        assert_eq!(text(0), ("T−00:00".to_owned(), "0:00".to_owned()));
        assert_eq!(text(-61), ("T+01:01".to_owned(), "0:00".to_owned()));
        assert_eq!(duration(772.0), "12:52");
        assert_eq!(duration(3600.0), "1:00:00");
        assert_eq!(duration(48.0), "0:48");
    }

    #[test]
    fn the_clock_and_a_countdown_add_up_to_the_time_written_beside_them() {
        let midnight: Timestamp = "2026-11-14T00:00:00Z".parse().unwrap();
        let after = |ms: i64| midnight + std::time::Duration::from_millis(ms.unsigned_abs());
        let written_s = |text: &str| -> i64 {
            let parts = text.trim_end_matches('Z').split(':');
            parts.fold(0, |sum, part| 60 * sum + part.parse::<i64>().unwrap())
        };
        for (now_ms, at_ms) in [(600, 12_900), (900, 12_100), (0, 12_999), (12_950, 12_050)] {
            let (now, time) = (after(now_ms), after(at_ms));
            let (shown, left) = (countdown(now, time), time_left(now, time));
            let left_s = written_s(shown.trim_start_matches("T−"));
            assert_eq!(written_s(&clock(now)) + left_s, written_s(&moment(time, now)));
            assert_eq!(left_s, written_s(&left));
        }
        assert_eq!(countdown(after(13_000), after(12_999)), "T+00:01");
    }

    #[test]
    fn ages() {
        assert_eq!(age(0.34), "0.3 s");
        assert_eq!(age(14.9), "14 s");
        assert_eq!(age(31_920.0), "8 h 52 min");
        assert_eq!(age(99_600.0), "1 d 3 h");
        assert_eq!(age(7.0 * 86_400.0), "7 d");
        assert_eq!(age(102.0 * 86_400.0), "102 d");
        assert_eq!(age(63_221.0 * 86_400.0), "173 years");
        assert_eq!(age(-1.0), "0.0 s");
    }
}
