//! The scales of the strip, which map times to x and elevations to bar heights.

use std::ops::RangeInclusive;

use egui::{Rangef, lerp};
use jiff::Timestamp;

use crate::{astro::time::add_seconds, ui::time_axis::TimeAxis};

/// Past time in the strip, seconds, so that a current pass keeps its bar.
const PAST_S: f64 = 600.0;
const MINUTE_S: i64 = 60;
const HOUR_S: f64 = 3600.0;

/// Returns the axis of `hours` around `now`. The axis begins at a whole minute, so that it stands
/// still for a minute.
pub(super) fn axis(now: Timestamp, hours: f64, x: Rangef) -> TimeAxis {
    let second = now.as_second();
    let minute = second - second.rem_euclid(MINUTE_S);
    let start = Timestamp::from_second(minute).unwrap_or(now);
    let hours = if hours.is_finite() { hours.max(1.0) } else { 1.0 };
    TimeAxis::lasting(add_seconds(start, -PAST_S), hours * HOUR_S, x)
}

/// Returns the height of a bar for a maximum elevation, points.
pub(super) fn bar_height(max_elevation_deg: f64, heights: &RangeInclusive<f32>) -> f32 {
    let share = (max_elevation_deg / 90.0).clamp(0.0, 1.0) as f32;
    if share.is_nan() { *heights.start() } else { lerp(heights.clone(), share) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn time(text: &str) -> Timestamp {
        text.parse().unwrap()
    }

    fn half_a_day(now: &str) -> TimeAxis {
        axis(time(now), 12.0, Rangef::new(100.0, 820.0))
    }

    #[test]
    fn the_axis_begins_ten_minutes_before_the_minute() {
        let shown = half_a_day("2026-11-14T11:06:12.9Z");
        assert_eq!(shown.start(), time("2026-11-14T10:56:00Z"));
        assert_eq!(shown.end(), time("2026-11-14T22:56:00Z"));
        assert_eq!(half_a_day("2026-11-14T11:06:59Z"), shown);
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
}
