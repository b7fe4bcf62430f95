//! Directions along a path, by time.

use jiff::Timestamp;

use crate::{
    astro::{AzEl, time::seconds_between},
    plan::Sample,
};

/// Returns the direction on a path at `time`; `None` beyond its ends and where the direction is not
/// finite.
pub fn sample_at(path: &[Sample], time: Timestamp) -> Option<Sample> {
    let next = path.partition_point(|sample| sample.time < time);
    let end = path.get(next)?;
    if end.time == time {
        return finite(*end);
    }
    let start = path.get(next.checked_sub(1)?)?;
    let part = seconds_between(start.time, time) / seconds_between(start.time, end.time);
    // Interpolate between vectors: angles would jump at north and at the zenith.
    let middle = start.direction.to_enu().lerp(end.direction.to_enu(), part);
    finite(Sample { time, direction: AzEl::from_enu(middle) })
}

fn finite(sample: Sample) -> Option<Sample> {
    let direction = sample.direction;
    (direction.azimuth.is_finite() && direction.elevation.is_finite()).then_some(sample)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(time: &str, azimuth_deg: f64, elevation_deg: f64) -> Sample {
        let direction = AzEl::from_degrees(azimuth_deg, elevation_deg);
        Sample { time: time.parse().unwrap(), direction }
    }

    #[test]
    fn a_path_across_north_is_followed_through_north() {
        let path = [
            sample("2026-11-14T11:00:00Z", 358.0, 20.0),
            sample("2026-11-14T11:00:04Z", 2.0, 20.0),
        ];
        let time = |text: &str| text.parse::<Timestamp>().unwrap();
        let middle = sample_at(&path, time("2026-11-14T11:00:02Z")).unwrap().direction;
        assert!(middle.azimuth.wrapped_180().degrees().abs() < 1e-6, "{middle:?}");
        assert!((middle.elevation_deg() - 20.0).abs() < 0.1);
        assert_eq!(sample_at(&path, path[0].time), Some(path[0]));
        assert_eq!(sample_at(&path, path[1].time), Some(path[1]));
        assert_eq!(sample_at(&path, time("2026-11-14T10:59:59Z")), None);
        assert_eq!(sample_at(&path, time("2026-11-14T11:00:05Z")), None);
        assert_eq!(sample_at(&[], path[0].time), None);
    }

    #[test]
    fn a_path_that_is_not_finite_has_no_direction() {
        let path = [
            sample("2026-11-14T11:00:00Z", f64::NAN, 20.0),
            sample("2026-11-14T11:00:04Z", 2.0, 20.0),
        ];
        assert_eq!(sample_at(&path, path[0].time), None);
        assert_eq!(sample_at(&path, "2026-11-14T11:00:02Z".parse().unwrap()), None);
    }
}
