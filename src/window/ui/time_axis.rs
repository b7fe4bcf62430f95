//! The time axis of every plot, lane and strip: a linear map from a span of time to a range of x.

use egui::{Rangef, lerp};
use jiff::{Timestamp, tz::TimeZone};

use crate::astro::time::{add_seconds, seconds_between};

/// Min width of a range, points, so that a short pass stays visible.
const MIN_RANGE: f32 = 3.0;

/// A map from a span of time to a range of x.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TimeAxis {
    start: Timestamp,
    /// Length of the axis, seconds, positive.
    seconds: f64,
    x: Rangef,
}

impl TimeAxis {
    /// Returns the axis from `start` to `end`; `None` if no time lies between them.
    pub(super) fn new(start: Timestamp, end: Timestamp, x: impl Into<Rangef>) -> Option<Self> {
        (end > start).then(|| Self { start, seconds: seconds_between(start, end), x: x.into() })
    }

    /// Returns the axis of `seconds` from `start` on, at least one second long.
    pub(super) fn lasting(start: Timestamp, seconds: f64, x: impl Into<Rangef>) -> Self {
        Self { start, seconds: seconds.max(1.0), x: x.into() }
    }

    /// Returns the time at the left end of the axis.
    pub(super) fn start(&self) -> Timestamp {
        self.start
    }

    /// Returns the time at the right end of the axis.
    pub(super) fn end(&self) -> Timestamp {
        add_seconds(self.start, self.seconds)
    }

    /// Returns the length of the axis, seconds.
    pub(super) fn seconds(&self) -> f64 {
        self.seconds
    }

    pub(super) fn contains(&self, time: Timestamp) -> bool {
        (self.start..=self.end()).contains(&time)
    }

    /// Returns the x of a time, which may lie outside the axis.
    pub(super) fn x(&self, time: Timestamp) -> f32 {
        self.x_of_part(seconds_between(self.start, time) / self.seconds)
    }

    /// Returns the x of a time, clamped to the axis.
    pub(super) fn x_within(&self, time: Timestamp) -> f32 {
        self.x_of_part((seconds_between(self.start, time) / self.seconds).clamp(0.0, 1.0))
    }

    fn x_of_part(&self, part: f64) -> f32 {
        lerp(self.x.min..=self.x.max, part as f32)
    }

    /// Returns the time at `x`, clamped to the axis.
    pub(super) fn time(&self, x: f32) -> Timestamp {
        let part = f64::from((x - self.x.min) / self.x.span()).clamp(0.0, 1.0);
        add_seconds(self.start, part * self.seconds)
    }

    /// Returns the time for a distance in points, seconds.
    pub(super) fn seconds_across(&self, points: f32) -> f64 {
        f64::from(points / self.x.span()) * self.seconds
    }

    /// Returns the width of one hour, points.
    pub(super) fn hour_width(&self) -> f32 {
        self.x.span() * (3600.0 / self.seconds) as f32
    }

    /// Returns the x range from `start` to `end`, cut at the axis and at least [`MIN_RANGE`] wide.
    /// `None` if it lies outside the axis.
    pub(super) fn range(&self, start: Timestamp, end: Timestamp) -> Option<Rangef> {
        if end <= self.start || start >= self.end() || end < start {
            return None;
        }
        let (left, right) = (self.x(start).max(self.x.min), self.x(end).min(self.x.max));
        let width = (right - left).max(MIN_RANGE);
        let last_left = (self.x.max - width).max(self.x.min);
        let left = ((left + right - width) / 2.0).clamp(self.x.min, last_left);
        Some(Rangef::new(left, left + width))
    }

    /// Returns the times on the axis that are whole multiples of `step_s` from midnight UTC, in
    /// order.
    pub(super) fn multiples(&self, step_s: i64) -> impl Iterator<Item = Timestamp> + use<> {
        let step_s = step_s.max(1);
        let start = self.start.as_second();
        let first = start + (-start).rem_euclid(step_s);
        let end = self.end();
        (0..)
            .map_while(move |step| Timestamp::from_second(first + step * step_s).ok())
            .take_while(move |time| *time <= end)
    }
}

/// Returns `true` for a full hour in UTC.
pub(super) fn is_full_hour(time: Timestamp) -> bool {
    let civil = time.to_zoned(TimeZone::UTC);
    civil.minute() == 0 && civil.second() == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn time(text: &str) -> Timestamp {
        text.parse().unwrap()
    }

    fn near(a: f32, b: f32) -> bool {
        (a - b).abs() < 1e-3
    }

    fn half_a_day() -> TimeAxis {
        TimeAxis::lasting(time("2026-11-14T10:56:00Z"), 43_200.0, Rangef::new(100.0, 820.0))
    }

    #[test]
    fn a_span_of_time_fills_the_width() {
        let axis = half_a_day();
        assert!(near(axis.x(time("2026-11-14T10:56:00Z")), 100.0));
        assert!(near(axis.x(time("2026-11-14T11:56:00Z")), 160.0));
        assert!(near(axis.x(time("2026-11-14T22:56:00Z")), 820.0));
        assert!(near(axis.hour_width(), 60.0));
        assert!((axis.seconds_across(-60.0) + 3600.0).abs() < 1e-3);
        let later = time("2026-11-15T00:56:00Z");
        assert!(near(axis.x(later), 940.0) && near(axis.x_within(later), 820.0));
        assert!(!axis.contains(later) && axis.contains(axis.end()));
        assert_eq!(axis.time(460.0), time("2026-11-14T16:56:00Z"));
        assert_eq!((axis.time(0.0), axis.time(900.0)), (axis.start(), axis.end()));
    }

    #[test]
    fn no_time_has_no_axis() {
        let time = time("2026-11-14T11:00:00Z");
        assert!(TimeAxis::new(time, time, Rangef::new(0.0, 1.0)).is_none());
    }

    #[test]
    fn ranges_are_cut_at_the_axis_and_stay_visible() {
        let axis = half_a_day();
        let half = axis.range(time("2026-11-14T10:26:00Z"), time("2026-11-14T11:26:00Z")).unwrap();
        assert!(near(half.min, 100.0) && near(half.max, 130.0), "{half:?}");
        let short = axis.range(time("2026-11-14T13:00:00Z"), time("2026-11-14T13:00:20Z")).unwrap();
        assert!(near(short.span(), 3.0), "{short:?}");
        let last = axis.range(time("2026-11-14T22:55:59Z"), time("2026-11-14T23:10:00Z")).unwrap();
        assert!(last.max <= 820.001 && last.span() > 2.99, "{last:?}");
        assert_eq!(axis.range(time("2026-11-14T09:00:00Z"), time("2026-11-14T10:56:00Z")), None);
        assert_eq!(axis.range(time("2026-11-14T22:56:00Z"), time("2026-11-14T23:00:00Z")), None);
    }

    #[test]
    fn full_hours_on_the_axis() {
        let hours: Vec<_> = half_a_day().multiples(3600).collect();
        assert_eq!(hours.first(), Some(&time("2026-11-14T11:00:00Z")));
        assert_eq!(hours.last(), Some(&time("2026-11-14T22:00:00Z")));
        assert_eq!(hours.len(), 12);
        assert!(hours.iter().all(|hour| is_full_hour(*hour)));
        assert!(!is_full_hour(time("2026-11-14T11:30:00Z")));
    }
}
