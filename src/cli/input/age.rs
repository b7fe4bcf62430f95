//! Warning about elements too far from the requested time.

use jiff::Timestamp;

use crate::{astro::time, orbit::Elements};

/// Period beyond which SGP4 uses its deep-space theory.
const DEEP_SPACE_PERIOD_S: f64 = 225.0 * 60.0;
/// Days from the epoch for which elements are reliable.
const NEAR_EARTH_DAYS: f64 = 14.0;
const DEEP_SPACE_DAYS: f64 = 60.0;

/// Sentence about elements whose epoch is too far from the time between `start` and `end`.
pub(super) fn caution<'a>(
    elements: impl Iterator<Item = &'a Elements>,
    start: Timestamp,
    end: Timestamp,
) -> Option<String> {
    let farthest_days = |elements: &Elements| {
        elements.epoch_distance_s(start).max(elements.epoch_distance_s(end)) / time::DAY_S
    };
    let (mut all, mut old) = (0, 0);
    let mut worst: Option<(f64, &Elements)> = None;
    for elements in elements {
        all += 1;
        let is_near = elements.period_s() < DEEP_SPACE_PERIOD_S;
        let max_days = if is_near { NEAR_EARTH_DAYS } else { DEEP_SPACE_DAYS };
        let days = farthest_days(elements);
        if days > max_days {
            old += 1;
            if worst.is_none_or(|(max, _)| days > max) {
                worst = Some((days, elements));
            }
        }
    }
    let (days, worst) = worst?;
    Some(format!(
        "Caution: {old} of {all} satellites have elements too far from this time to be relied on \
         (more than {NEAR_EARTH_DAYS} days, from 225 minutes of period on {DEEP_SPACE_DAYS}); the \
         worst is {} with {days:.0} days.",
        worst.label()
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orbit::bundled;

    #[test]
    fn old_elements_are_counted_and_the_worst_is_named() {
        let catalog = bundled().unwrap();
        // A low and a geosynchronous satellite.
        let pair = || [25_544, 54_743].map(|number| catalog.get(number).unwrap());
        let after = |days: f64| time::add_seconds(pair()[0].epoch(), days * time::DAY_S);
        let text = |days: f64| caution(pair().into_iter(), after(days), after(days + 0.5));
        assert_eq!(text(-13.0), None);
        assert_eq!(text(13.0), None);
        for days in [-15.0, 15.0, 50.0] {
            let spoken = text(days).unwrap();
            assert!(spoken.starts_with("Caution: 1 of 2 satellites"), "{spoken}");
            assert!(spoken.contains("ISS (ZARYA)"), "{spoken}");
        }
        assert!(text(70.0).unwrap().starts_with("Caution: 2 of 2"));
    }
}
