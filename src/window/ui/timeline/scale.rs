//! The scales of the strip: times to x, elevations to bar heights.

use std::ops::RangeInclusive;

use egui::{Rangef, lerp};
use jiff::{Timestamp, tz::TimeZone};

use crate::astro::time::{add_seconds, seconds_between};

/// Past time in the strip, so that a pass in progress keeps its bar.
const PAST_S: f64 = 600.0;
const MINUTE_S: i64 = 60;
const HOUR_S: f64 = 3600.0;
/// Minimum width of a bar, in points, so that a short pass stays visible.
const MIN_BAR_WIDTH: f32 = 3.0;

/// A linear map from a span of time to a span of x.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scale {
    from: Timestamp,
    seconds: f64,
    x: Rangef,
}

impl Scale {
    /// The window of `hours` around `now`. It begins at a whole minute, so that it stands still
    /// for a minute.
    pub(super) fn new(now: Timestamp, hours: f64, x: Rangef) -> Self {
        let second = now.as_second();
        let minute = second - second.rem_euclid(MINUTE_S);
        let from = Timestamp::from_second(minute).unwrap_or(now);
        let hours = if hours.is_finite() { hours.max(1.0) } else { 1.0 };
        Self { from: add_seconds(from, -PAST_S), seconds: hours * HOUR_S, x }
    }

    /// The first time shown.
    pub(super) fn from(&self) -> Timestamp {
        self.from
    }

    /// The last time shown.
    pub(super) fn to(&self) -> Timestamp {
        add_seconds(self.from, self.seconds)
    }

    /// The x of a time, which may lie outside the window.
    pub(super) fn x(&self, at: Timestamp) -> f32 {
        let share = seconds_between(self.from, at) / self.seconds;
        lerp(self.x.min..=self.x.max, share as f32)
    }

    /// Points for one hour.
    pub(super) fn hour_width(&self) -> f32 {
        self.x.span() * (HOUR_S / self.seconds) as f32
    }

    /// The x range of the time `from` to `to`, cut at the window and never narrower than
    /// visible. `None` if it lies outside the window.
    pub(super) fn span(&self, from: Timestamp, to: Timestamp) -> Option<Rangef> {
        if to <= self.from || from >= self.to() || to < from {
            return None;
        }
        let (left, right) = (self.x(from).max(self.x.min), self.x(to).min(self.x.max));
        let width = (right - left).max(MIN_BAR_WIDTH);
        let last_left = (self.x.max - width).max(self.x.min);
        let left = ((left + right - width) / 2.0).clamp(self.x.min, last_left);
        Some(Rangef::new(left, left + width))
    }

    /// The times in the window that are whole multiples of `step_s` from
    /// midnight UTC, in order.
    pub(super) fn multiples(&self, step_s: i64) -> impl Iterator<Item = Timestamp> {
        let step_s = step_s.max(1);
        let start = self.from.as_second();
        let first = start + (-start).rem_euclid(step_s);
        let end = self.to();
        (0..)
            .map_while(move |step| Timestamp::from_second(first + step * step_s).ok())
            .take_while(move |at| *at <= end)
    }
}

pub(super) fn is_full_hour(at: Timestamp) -> bool {
    let civil = at.to_zoned(TimeZone::UTC);
    civil.minute() == 0 && civil.second() == 0
}

/// Height of a bar for a maximum elevation, in points.
pub(super) fn bar_height(max_elevation_deg: f64, heights: &RangeInclusive<f32>) -> f32 {
    let share = (max_elevation_deg / 90.0).clamp(0.0, 1.0) as f32;
    if share.is_nan() { *heights.start() } else { lerp(heights.clone(), share) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(text: &str) -> Timestamp {
        text.parse().unwrap()
    }

    fn scale() -> Scale {
        Scale::new(at("2026-11-14T11:06:12.9Z"), 12.0, Rangef::new(100.0, 820.0))
    }

    #[test]
    fn the_window_begins_ten_minutes_before_the_minute() {
        assert_eq!(scale().from(), at("2026-11-14T10:56:00Z"));
        assert_eq!(scale().to(), at("2026-11-14T22:56:00Z"));
        let later = Scale::new(at("2026-11-14T11:06:59Z"), 12.0, Rangef::new(100.0, 820.0));
        assert_eq!(later, scale());
    }

    #[test]
    fn time_to_x() {
        assert!((scale().x(at("2026-11-14T10:56:00Z")) - 100.0).abs() < 1e-3);
        assert!((scale().x(at("2026-11-14T11:56:00Z")) - 160.0).abs() < 1e-3);
        assert!((scale().x(at("2026-11-14T22:56:00Z")) - 820.0).abs() < 1e-3);
        assert!((scale().hour_width() - 60.0).abs() < 1e-3);
    }

    #[test]
    fn spans_are_cut_at_the_window_and_stay_visible() {
        let s = scale();
        let half = s.span(at("2026-11-14T10:26:00Z"), at("2026-11-14T11:26:00Z")).unwrap();
        assert!((half.min - 100.0).abs() < 1e-3 && (half.max - 130.0).abs() < 1e-3, "{half:?}");
        let short = s.span(at("2026-11-14T13:00:00Z"), at("2026-11-14T13:00:20Z")).unwrap();
        assert!((short.span() - 3.0).abs() < 1e-3, "{short:?}");
        let last = s.span(at("2026-11-14T22:55:59Z"), at("2026-11-14T23:10:00Z")).unwrap();
        assert!(last.max <= 820.001 && last.span() > 2.99, "{last:?}");
        assert_eq!(s.span(at("2026-11-14T09:00:00Z"), at("2026-11-14T10:56:00Z")), None);
        assert_eq!(s.span(at("2026-11-14T22:56:00Z"), at("2026-11-14T23:00:00Z")), None);
    }

    #[test]
    fn bars_grow_with_the_highest_elevation() {
        let heights = 14.0..=44.0;
        let height = |deg| bar_height(deg, &heights);
        assert!((height(0.0) - 14.0).abs() < 1e-3);
        assert!((height(45.0) - 29.0).abs() < 1e-3);
        assert!((height(90.0) - 44.0).abs() < 1e-3);
        assert!((height(-3.0) - 14.0).abs() < 1e-3);
        assert!((height(f64::NAN) - 14.0).abs() < 1e-3);
    }

    #[test]
    fn hours_of_the_window() {
        let hours: Vec<_> = scale().multiples(3600).collect();
        assert_eq!(hours.first(), Some(&at("2026-11-14T11:00:00Z")));
        assert_eq!(hours.last(), Some(&at("2026-11-14T22:00:00Z")));
        assert_eq!(hours.len(), 12);
        assert!(hours.iter().all(|hour| is_full_hour(*hour)));
        assert!(!is_full_hour(at("2026-11-14T11:30:00Z")));
    }
}
