//! Numbers and times as text, appended to a buffer: ten times faster than by `format!`, which goes
//! over a string and the general code for all kinds of numbers.

use jiff::{Timestamp, fmt::temporal::DateTimePrinter, tz::Offset};

/// Appends `time` in RFC 3339, UTC, with milliseconds.
pub(super) fn push_time(text: &mut Vec<u8>, time: Timestamp) {
    push_timestamp::<3>(text, to_millisecond(time));
}

/// Appends `time` in RFC 3339, UTC, with microseconds; it has no digits beyond them.
pub(super) fn push_time_us(text: &mut Vec<u8>, time: Timestamp) {
    push_timestamp::<6>(text, time);
}

fn push_timestamp<const DECIMALS: usize>(text: &mut Vec<u8>, time: Timestamp) {
    let at = Offset::UTC.to_datetime(time);
    let Ok(year) = u16::try_from(at.year()) else {
        // A year before 0 has a sign and six digits. Appending to a buffer cannot fail.
        let printer = DateTimePrinter::new().precision(Some(DECIMALS as u8));
        let _ = printer.print_timestamp(&time, text);
        return;
    };
    let [y1, y2, y3, y4] = digits(u32::from(year));
    let [mo1, mo2] = two_digits(at.month());
    let [d1, d2] = two_digits(at.day());
    let [h1, h2] = two_digits(at.hour());
    let [mi1, mi2] = two_digits(at.minute());
    let [s1, s2] = two_digits(at.second());
    text.extend_from_slice(&[
        y1, y2, y3, y4, b'-', mo1, mo2, b'-', d1, d2, b'T', h1, h2, b':', mi1, mi2, b':', s1, s2,
        b'.',
    ]);
    let parts = at.subsec_nanosecond().unsigned_abs() / 10_u32.pow(9 - DECIMALS as u32);
    text.extend_from_slice(&digits::<DECIMALS>(parts));
    text.push(b'Z');
}

/// The nearest millisecond; half of one is rounded away from 1970.
fn to_millisecond(time: Timestamp) -> Timestamp {
    let nanoseconds = time.subsec_nanosecond();
    let milliseconds = (nanoseconds.abs() + 500_000) / 1_000_000 * nanoseconds.signum();
    let since_1970 = time.as_second() * 1000 + i64::from(milliseconds);
    Timestamp::from_millisecond(since_1970).unwrap_or(time)
}

/// The last digits of `number`.
fn digits<const COUNT: usize>(number: u32) -> [u8; COUNT] {
    let mut digits = [b'0'; COUNT];
    let mut rest = number;
    for digit in digits.iter_mut().rev() {
        *digit += (rest % 10) as u8;
        rest /= 10;
    }
    digits
}

fn two_digits(number: i8) -> [u8; 2] {
    let number = number.unsigned_abs();
    [b'0' + number / 10, b'0' + number % 10]
}

/// Appends the digits of `number`.
pub(super) fn push_whole(text: &mut Vec<u8>, number: u64) {
    if number >= 10 {
        push_whole(text, number / 10);
    }
    text.push(b'0' + (number % 10) as u8);
}

/// Appends `value`, rounded to this number of decimals.
pub(super) fn push_fixed<const DECIMALS: usize>(text: &mut Vec<u8>, value: f64) {
    push_at_least::<DECIMALS>(text, value, DECIMALS);
}

/// Appends `value`, rounded to this number of decimals, without zeros at its end.
pub(super) fn push_shortest<const DECIMALS: usize>(text: &mut Vec<u8>, value: f64) {
    push_at_least::<DECIMALS>(text, value, 0);
}

/// Appends `value`, rounded to this number of decimals, of which zeros at the end are left out
/// beyond the first `least`.
pub(super) fn push_at_least<const DECIMALS: usize>(text: &mut Vec<u8>, value: f64, least: usize) {
    let parts = parts::<DECIMALS>(value);
    if parts < 0 {
        text.push(b'-');
    }
    let (parts, unit) = (parts.unsigned_abs(), 10_u64.pow(DECIMALS as u32));
    push_whole(text, parts / unit);
    let decimals: [u8; DECIMALS] = digits((parts % unit) as u32);
    let last = decimals.iter().rposition(|digit| *digit != b'0');
    let kept = last.map_or(0, |last| last + 1).max(least);
    if kept > 0 {
        text.push(b'.');
        let start = text.len();
        // All of them, whose number is known beforehand, are appended faster than some.
        text.extend_from_slice(&decimals);
        text.truncate(start + kept);
    }
}

/// `value` in units of its last decimal, to the nearest; halves are rounded away from zero, as
/// `round` does, which takes three times as long on many processors.
pub(super) fn parts<const DECIMALS: usize>(value: f64) -> i64 {
    let value = value * 10_u64.pow(DECIMALS as u32) as f64;
    let whole = value as i64;
    let rest = value - whole as f64;
    whole.saturating_add(i64::from(rest >= 0.5) - i64::from(rest <= -0.5))
}

#[cfg(test)]
mod tests {
    use jiff::Unit;
    use proptest::prelude::*;

    use super::{super::rounded, *};

    fn pushed(push: impl FnOnce(&mut Vec<u8>)) -> String {
        let mut text = b"before,".to_vec();
        push(&mut text);
        String::from_utf8(text).unwrap().strip_prefix("before,").unwrap().to_owned()
    }

    #[test]
    fn zeros_and_signs_are_written_as_they_are_read() {
        let shortest = |value| pushed(|text| push_shortest::<6>(text, value));
        for (value, expected) in [
            (0.0, "0"),
            (-0.0, "0"),
            (-4e-7, "0"),
            (-6e-7, "-0.000001"),
            (350.5, "350.5"),
            (-170.0, "-170"),
            (0.000_010_4, "0.00001"),
        ] {
            assert_eq!(shortest(value), expected);
        }
        assert_eq!(pushed(|text| push_fixed::<3>(text, 0.04)), "0.040");
        assert_eq!(pushed(|text| push_fixed::<3>(text, 3_600.0)), "3600.000");
        assert_eq!(pushed(|text| push_whole(text, 799_501_621)), "799501621");
        assert_eq!(pushed(|text| push_whole(text, 0)), "0");
        assert_eq!(pushed(|text| push_at_least::<6>(text, 3_600.0, 1)), "3600.0");
        for odd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX] {
            pushed(|text| push_fixed::<6>(text, odd));
        }
    }

    proptest! {
        #[test]
        fn numbers_are_those_of_the_standard_library(
            value in prop_oneof![-1e6..1e6_f64, (-1_000_000..1_000_000).prop_map(|half| f64::from(half) / 2e6)],
        ) {
            let expected = |parts: f64| rounded(value, parts).to_string();
            prop_assert_eq!(pushed(|text| push_shortest::<0>(text, value)), expected(1.0));
            prop_assert_eq!(pushed(|text| push_shortest::<3>(text, value)), expected(1e3));
            prop_assert_eq!(pushed(|text| push_shortest::<6>(text, value)), expected(1e6));
        }

        #[test]
        fn times_are_those_of_their_library(
            second in -377_705_023_201..253_402_207_200_i64,
            nanosecond in prop_oneof![0..1_000_000_000, Just(500_000), Just(999_500_000)],
        ) {
            let time = Timestamp::new(second, nanosecond).unwrap();
            let expected = format!("{:.3}", time.round(Unit::Millisecond).unwrap_or(time));
            prop_assert_eq!(pushed(|text| push_time(text, time)), expected);
            let micro = Timestamp::from_microsecond(time.as_microsecond()).unwrap();
            prop_assert_eq!(pushed(|text| push_time_us(text, micro)), format!("{micro:.6}"));
        }
    }
}
