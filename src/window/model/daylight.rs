//! Computation of the spans of day and night.

use jiff::Timestamp;

use crate::astro::{
    Site, sun_moon,
    time::{add_seconds, seconds_between},
};

/// Time before now at which the spans begin, seconds.
const PAST_S: f64 = 3600.0;
/// Interval between two computed positions of the Sun, seconds. A search then finds each change to
/// the minute.
const STEP_S: f64 = 600.0;
const EXACT_S: f64 = 60.0;

/// A period of day or of night.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SunSpan {
    /// Time of sunrise or sunset, except in the first span.
    pub start: Timestamp,
    pub end: Timestamp,
    /// `true` for day, `false` for night.
    pub up: bool,
}

/// Returns day and night from an hour before `now` to `ahead_s` after it, to the minute. The search
/// may miss a day or a night of less than ten minutes.
pub fn spans(site: Site, now: Timestamp, ahead_s: f64) -> Vec<SunSpan> {
    let is_up =
        |time: Timestamp| sun_moon::sun(site.airless(), time).elevation_deg() > sun_moon::RISE_DEG;
    let mut time = add_seconds(now, -PAST_S);
    let end = add_seconds(now, ahead_s);
    let mut last = SunSpan { start: time, end: time, up: is_up(time) };
    let mut spans = Vec::new();
    while time < end {
        let next = add_seconds(time, STEP_S).min(end);
        if is_up(next) != last.up {
            let change = change(time, next, |time| is_up(time) == last.up);
            spans.push(SunSpan { end: change, ..last });
            last = SunSpan { start: change, end: change, up: !last.up };
        }
        time = next;
    }
    spans.push(SunSpan { end, ..last });
    spans
}

/// Returns the time at which `is_same` turns false. It is true at `same` and false at the later
/// time `other`.
fn change(
    mut same: Timestamp,
    mut other: Timestamp,
    is_same: impl Fn(Timestamp) -> bool,
) -> Timestamp {
    while seconds_between(same, other) > EXACT_S {
        let middle = add_seconds(same, seconds_between(same, other) / 2.0);
        if is_same(middle) {
            same = middle;
        } else {
            other = middle;
        }
    }
    other
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sun_sets_in_istanbul_when_the_almanac_says() {
        // 2026-08-12: sunset at 20:10 local time, UTC+3, to a minute or two.
        let site = Site::new(41.02, 29.17, 100.0).unwrap();
        let noon: Timestamp = "2026-08-12T10:00:00Z".parse().unwrap();
        let spans = spans(site, noon, 25.0 * 3600.0);
        assert!(spans[0].up && !spans[1].up);
        let sunset: Timestamp = "2026-08-12T17:08:00Z".parse().unwrap();
        let off_s = crate::astro::time::seconds_between(sunset, spans[1].start);
        assert!(off_s.abs() < 300.0, "{off_s}");
    }

    #[test]
    fn the_spans_of_a_week_follow_each_other_without_a_gap() {
        let site = Site::new(41.02, 29.17, 100.0).unwrap();
        let now: Timestamp = "2026-08-12T10:00:00Z".parse().unwrap();
        let spans = spans(site, now, 168.0 * 3600.0);
        assert_eq!(spans.len(), 15, "seven nights between eight days");
        for pair in spans.windows(2) {
            assert_eq!(pair[0].end, pair[1].start);
            assert_ne!(pair[0].up, pair[1].up);
            let hours = seconds_between(pair[1].start, pair[1].end) / 3600.0;
            assert!(hours < 14.5, "{hours}");
        }
        assert_eq!(spans[14].end, add_seconds(now, 168.0 * 3600.0));
    }
}
