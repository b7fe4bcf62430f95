//! Warning about elements too far from the requested time.

use jiff::Timestamp;

use crate::{astro::time, orbit::Elements};

/// Period beyond which SGP4 uses its deep-space theory.
const DEEP_SPACE_PERIOD_S: f64 = 225.0 * 60.0;
/// Days from the epoch for which elements are reliable.
const NEAR_EARTH_DAYS: f64 = 14.0;
const DEEP_SPACE_DAYS: f64 = 60.0;

/// Sentence about elements whose epoch is too far from the time between `from` and `to`.
pub(super) fn caution<'a>(
    elements: impl Iterator<Item = &'a Elements>,
    from: Timestamp,
    to: Timestamp,
) -> Option<String> {
    let farthest_days = |elements: &Elements| {
        elements.epoch_distance_s(from).max(elements.epoch_distance_s(to)) / time::DAY_S
    };
    let (mut all, mut old) = (0, 0);
    let mut worst: Option<(f64, &Elements)> = None;
    for elements in elements {
        all += 1;
        let is_near = elements.period_s() < DEEP_SPACE_PERIOD_S;
        let most_days = if is_near { NEAR_EARTH_DAYS } else { DEEP_SPACE_DAYS };
        let days = farthest_days(elements);
        if days > most_days {
            old += 1;
            if worst.is_none_or(|(most, _)| days > most) {
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
        let both = || [25_544, 54_743].map(|number| catalog.get(number).unwrap());
        let after = |days: f64| time::add_seconds(both()[0].epoch(), days * time::DAY_S);
        let said = |days: f64| caution(both().into_iter(), after(days), after(days + 0.5));
        assert_eq!(said(-13.0), None);
        assert_eq!(said(13.0), None);
        for days in [-15.0, 15.0, 50.0] {
            let said = said(days).unwrap();
            assert!(said.starts_with("Caution: 1 of 2 satellites"), "{said}");
            assert!(said.contains("ISS (ZARYA)"), "{said}");
        }
        assert!(said(70.0).unwrap().starts_with("Caution: 2 of 2"));
    }
}
