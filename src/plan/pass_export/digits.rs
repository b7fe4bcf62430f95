//! Numbers and times as text, appended to a buffer: several times faster than by `format!`, which
//! goes over a string and the general code for all kinds of numbers.

use jiff::{Timestamp, fmt::temporal::DateTimePrinter};

const PRINTER: DateTimePrinter = DateTimePrinter::new().precision(Some(3));

/// Appends `time` in RFC 3339, UTC, with milliseconds.
pub(super) fn push_time(text: &mut Vec<u8>, time: Timestamp) {
    // Appending to a buffer cannot fail.
    let _ = PRINTER.print_timestamp(&to_millisecond(time), text);
}

/// The nearest millisecond; half of one is rounded away from 1970.
fn to_millisecond(time: Timestamp) -> Timestamp {
    let nanoseconds = time.subsec_nanosecond();
    let milliseconds = (nanoseconds.abs() + 500_000) / 1_000_000 * nanoseconds.signum();
    let since_1970 = time.as_second() * 1000 + i64::from(milliseconds);
    Timestamp::from_millisecond(since_1970).unwrap_or(time)
}

pub(super) fn push_whole(text: &mut Vec<u8>, number: u32) {
    push_digits(text, u64::from(number), 0);
}

/// Appends `value`, rounded to this number of decimals.
pub(super) fn push_fixed(text: &mut Vec<u8>, value: f64, decimals: u32) {
    let parts = parts(text, value, decimals);
    push_digits(text, parts, decimals);
}

/// Appends `value`, rounded to this number of decimals, without zeros at its end.
pub(super) fn push_shortest(text: &mut Vec<u8>, value: f64, decimals: u32) {
    let (mut parts, mut decimals) = (parts(text, value, decimals), decimals);
    while decimals > 0 && parts.is_multiple_of(10) {
        (parts, decimals) = (parts / 10, decimals - 1);
    }
    push_digits(text, parts, decimals);
}

/// The size of `value` in units of its last decimal. Appends a minus if one belongs before it.
fn parts(text: &mut Vec<u8>, value: f64, decimals: u32) -> u64 {
    let parts = (value * 10_u64.pow(decimals) as f64).round() as i64;
    if parts < 0 {
        text.push(b'-');
    }
    parts.unsigned_abs()
}

/// Appends the digits of `parts`, with a point before the last `decimals` of them.
fn push_digits(text: &mut Vec<u8>, parts: u64, decimals: u32) {
    let start = text.len();
    let mut rest = parts;
    let mut push_last = |text: &mut Vec<u8>| {
        text.push(b'0' + (rest % 10) as u8);
        rest /= 10;
        rest
    };
    for _ in 0..decimals {
        push_last(text);
    }
    if decimals > 0 {
        text.push(b'.');
    }
    while push_last(text) > 0 {}
    if let Some(digits) = text.get_mut(start..) {
        digits.reverse();
    }
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
        let shortest = |value| pushed(|text| push_shortest(text, value, 6));
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
        assert_eq!(pushed(|text| push_fixed(text, 0.04, 3)), "0.040");
        assert_eq!(pushed(|text| push_fixed(text, 3_600.0, 3)), "3600.000");
        assert_eq!(pushed(|text| push_whole(text, 799_501_621)), "799501621");
        assert_eq!(pushed(|text| push_whole(text, 0)), "0");
    }

    proptest! {
        #[test]
        fn numbers_are_those_of_the_standard_library(value in -1e6..1e6_f64, decimals in 0..7_u32) {
            let expected = rounded(value, 10_u64.pow(decimals) as f64).to_string();
            prop_assert_eq!(pushed(|text| push_shortest(text, value, decimals)), expected);
        }

        #[test]
        fn times_are_those_of_their_library(
            second in -377_705_023_201..253_402_207_200_i64,
            nanosecond in prop_oneof![0..1_000_000_000, Just(500_000), Just(999_500_000)],
        ) {
            let time = Timestamp::new(second, nanosecond).unwrap();
            let expected = format!("{:.3}", time.round(Unit::Millisecond).unwrap_or(time));
            prop_assert_eq!(pushed(|text| push_time(text, time)), expected);
        }
    }
}
