//! Words for differences between clocks.

use jiff::Timestamp;

use crate::{
    astro::time::{DAY_S, add_seconds},
    ui::format,
};

/// Max difference of a clock that the link can cause, seconds.
const AGREES_S: f64 = 0.05;

/// Describes a clock that is `ahead_s` seconds ahead, such as "4.0 s behind".
pub(super) fn side(ahead_s: f64) -> String {
    let side = if ahead_s < 0.0 { "behind" } else { "ahead" };
    format!("{} {side}", format::age(ahead_s.abs()))
}

/// Compares a unit's clock with the clock of this computer.
pub fn compared_clock(ahead_s: f64) -> String {
    if agrees(ahead_s) { "agrees".to_owned() } else { side(ahead_s) }
}

pub(super) fn agrees(ahead_s: f64) -> bool {
    ahead_s.abs() < AGREES_S
}

/// Describes a difference like [`side`], with the date of the clock if it shows another day.
pub(super) fn difference(ahead_s: f64, now: Timestamp) -> String {
    if ahead_s.abs() < DAY_S {
        return side(ahead_s);
    }
    format!("at {}, {}", format::iso_date(add_seconds(now, ahead_s)), side(ahead_s))
}

/// Describes the change of a clock by `by_s` seconds to `time`.
pub(super) fn step(by_s: f64, time: Option<Timestamp>) -> String {
    match time {
        _ if by_s.abs() < DAY_S => format!("by {} s", format::signed(by_s, 1)),
        Some(time) => {
            let previous = format::iso_date(add_seconds(time, -by_s));
            format!("from {previous} to {}", format::iso_date(time))
        }
        None => {
            let word = if by_s < 0.0 { "back" } else { "forward" };
            format!("{word} by {}", format::age(by_s.abs()))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_differences_are_dates_and_years() {
        let now = "2026-11-29T12:00:00Z".parse().unwrap();
        let days = |days: f64| days * 86_400.0;
        assert_eq!(difference(-4.0, now), "4.0 s behind");
        assert_eq!(difference(days(0.9), now), "21 h 36 min ahead");
        assert_eq!(difference(days(-3.0), now), "at 2026-11-26, 3 d 0 h behind");
        assert_eq!(difference(days(63_221.0), now), "at 2200-01-02, 173 years ahead");
        assert_eq!(step(2.0, Some(now)), "by +2.0 s");
        assert_eq!(step(days(-20_784.0), Some(now)), "from 2083-10-25 to 2026-11-29");
        assert_eq!(step(days(20_784.0), None), "forward by 56 years");
    }
}
