//! Spans of day and night.

use jiff::Timestamp;

use crate::astro::{Site, sun_moon, time::add_seconds};

const SPAN_MIN: (i32, i32) = (-60, 25 * 60);

/// A stretch of day or of night.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SunSpan {
    /// Sunrise or sunset, except for the first span.
    pub from: Timestamp,
    pub to: Timestamp,
    /// `false` for night.
    pub up: bool,
}

/// Day and night from an hour before `now` to 25 h after it, to the minute.
pub fn spans(site: Site, now: Timestamp) -> Vec<SunSpan> {
    let (from, to) = SPAN_MIN;
    let mut spans: Vec<SunSpan> = Vec::new();
    for minute in from..=to {
        let time = add_seconds(now, f64::from(minute) * 60.0);
        let up = sun_moon::sun(site, time).elevation_deg() > sun_moon::RISE_DEG;
        match spans.last_mut() {
            Some(last) if last.up == up => last.to = time,
            last => {
                if let Some(last) = last {
                    last.to = time;
                }
                spans.push(SunSpan { from: time, to: time, up });
            }
        }
    }
    spans
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sun_sets_in_istanbul_when_the_almanac_says() {
        // 2026-08-12: sunset 20:10 local time, UTC+3, to a minute or two.
        let site = Site::new(41.02, 29.17, 100.0).unwrap();
        let noon: Timestamp = "2026-08-12T10:00:00Z".parse().unwrap();
        let spans = spans(site, noon);
        assert!(spans[0].up && !spans[1].up);
        let sunset: Timestamp = "2026-08-12T17:08:00Z".parse().unwrap();
        let off_s = crate::astro::time::seconds_between(sunset, spans[1].from);
        assert!(off_s.abs() < 300.0, "{off_s}");
    }
}
