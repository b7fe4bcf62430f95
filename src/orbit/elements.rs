//! The elements of one orbit.

use jiff::Timestamp;

use crate::astro::{Angle, time};

/// Seconds of a sidereal day.
const SIDEREAL_DAY_S: f64 = 86_164.090_5;

/// One orbit: SGP4 mean elements with the name and number of their object.
///
/// Values of this type can be handed to the propagator: all numbers are
/// finite, the eccentricity lies in `0.0..1.0`, the mean motion is positive and
/// the epoch lies within [`EPOCH_YEARS`].
#[derive(Debug, Clone, PartialEq)]
pub struct Elements {
    inner: sgp4::Elements,
    catalog_number: u32,
    epoch: Timestamp,
}

/// The calendar years an epoch may lie in: from the first satellite to what two
/// digits and every known file need.
pub const EPOCH_YEARS: std::ops::RangeInclusive<i16> = 1957..=2156;

/// Why numbers are no orbit.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ElementsError {
    /// Made for another theory than SGP4 (4 is SGP4-XP).
    #[error("ephemeris type {0} is not SGP4")]
    EphemerisType(u8),
    /// More than nine digits.
    #[error("catalogue number {0} has more than nine digits")]
    CatalogNumber(u64),
    /// A number is infinite or not a number.
    #[error("a number is not finite")]
    NotFinite,
    /// No ellipse.
    #[error("eccentricity {0} is not from 0 to below 1")]
    Eccentricity(f64),
    /// No revolution.
    #[error("mean motion {0} is not positive")]
    MeanMotion(f64),
    /// Outside [`EPOCH_YEARS`].
    #[error("the epoch is out of range")]
    Epoch,
}

impl Elements {
    /// Takes what a reader found, once it is sure to be an orbit.
    pub(super) fn new(inner: sgp4::Elements) -> Result<Self, ElementsError> {
        // 2 and 3 are old marks for SGP4 and SDP4; all sources now write 0.
        if !matches!(inner.ephemeris_type, 0 | 2 | 3) {
            return Err(ElementsError::EphemerisType(inner.ephemeris_type));
        }
        let catalog_number = u32::try_from(inner.norad_id)
            .ok()
            .filter(|number| *number <= 999_999_999)
            .ok_or(ElementsError::CatalogNumber(inner.norad_id))?;
        let numbers = [
            inner.mean_motion,
            inner.mean_motion_dot,
            inner.mean_motion_ddot,
            inner.drag_term,
            inner.inclination,
            inner.right_ascension,
            inner.eccentricity,
            inner.argument_of_perigee,
            inner.mean_anomaly,
        ];
        if !numbers.iter().all(|number| number.is_finite()) {
            return Err(ElementsError::NotFinite);
        }
        if !(0.0..1.0).contains(&inner.eccentricity) {
            return Err(ElementsError::Eccentricity(inner.eccentricity));
        }
        if inner.mean_motion <= 0.0 {
            return Err(ElementsError::MeanMotion(inner.mean_motion));
        }
        let utc = inner.datetime.and_utc();
        let utc_ns =
            i128::from(utc.timestamp()) * 1_000_000_000 + i128::from(utc.timestamp_subsec_nanos());
        let epoch = Timestamp::from_nanosecond(utc_ns)
            .ok()
            // A TLE's fraction of a day leaves noise below what an OMM writes.
            // Without it both forms of one set have the same epoch.
            .and_then(|epoch| epoch.round(jiff::Unit::Microsecond).ok())
            // The library computes with unsigned years, so years before 1 would end it.
            .filter(|epoch| EPOCH_YEARS.contains(&epoch.to_zoned(jiff::tz::TimeZone::UTC).year()))
            .ok_or(ElementsError::Epoch)?;
        Ok(Self { inner, catalog_number, epoch })
    }

    /// The name, empty when the source gave none.
    pub fn name(&self) -> &str {
        self.inner.object_name.as_deref().unwrap_or_default()
    }

    /// The catalogue number, up to nine digits.
    pub fn catalog_number(&self) -> u32 {
        self.catalog_number
    }

    /// The international designator, such as `1998-067A`.
    pub fn international_designator(&self) -> Option<&str> {
        self.inner.international_designator.as_deref()
    }

    /// The instant the elements describe best.
    pub fn epoch(&self) -> Timestamp {
        self.epoch
    }

    /// Mean motion (Kozai) in revolutions per day, above 0.
    pub fn mean_motion_rev_day(&self) -> f64 {
        self.inner.mean_motion
    }

    /// Inclination to the equator.
    pub fn inclination(&self) -> Angle {
        Angle::from_degrees(self.inner.inclination)
    }

    /// Eccentricity, from 0 to below 1.
    pub fn eccentricity(&self) -> f64 {
        self.inner.eccentricity
    }

    /// Time of one revolution in seconds.
    pub fn period_s(&self) -> f64 {
        time::DAY_S / self.inner.mean_motion
    }

    /// Age at `now` in seconds, negative while the epoch lies ahead.
    pub fn age_s(&self, now: Timestamp) -> f64 {
        time::seconds_between(self.epoch, now)
    }

    /// Whether the satellite keeps its place in the sky: the period within 2 %
    /// of a sidereal day and a nearly round orbit, whatever its inclination.
    pub fn is_geosynchronous(&self) -> bool {
        (self.period_s() / SIDEREAL_DAY_S - 1.0).abs() < 0.02 && self.eccentricity() < 0.1
    }

    /// What the propagator computes with.
    pub(super) fn sgp4(&self) -> &sgp4::Elements {
        &self.inner
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::orbit::{Propagator, RefusalReason, bundled, read_elements};

    #[test]
    fn geosynchronous_is_what_goes_around_once_a_day_on_a_round_orbit() {
        let catalog = bundled().unwrap();
        for (number, expected) in
            [(54_743, true), (44_204, true), (25_544, false), (24_876, false), (25_867, false)]
        {
            let elements = catalog.get(number).unwrap();
            assert_eq!(elements.is_geosynchronous(), expected, "{}", elements.name());
        }
    }

    #[test]
    fn period_and_age_follow_from_the_elements() {
        let catalog = bundled().unwrap();
        let iss = catalog.get(25_544).unwrap();
        assert!((iss.period_s() / 60.0 - 92.9).abs() < 0.2, "{}", iss.period_s());
        assert!((iss.age_s(time::add_seconds(iss.epoch(), 90.5)) - 90.5).abs() < 1e-6);
        assert!((iss.inclination().degrees() - 51.63).abs() < 0.02);
    }

    #[test]
    fn catalogue_numbers_have_nine_digits_at_most() {
        let text = message(1_000_000_000, [15.0, 0.001, 51.6, 0.0, 0.0, 0.0, 0.0]);
        let report = read_elements(&text);
        let reason = RefusalReason::Orbit(ElementsError::CatalogNumber(1_000_000_000));
        assert_eq!(report.refused[0].reason, reason);
    }

    fn message(number: u64, numbers: [f64; 7]) -> String {
        let [motion, eccentricity, inclination, node, perigee, anomaly, bstar] = numbers;
        serde_json::json!({
            "NORAD_CAT_ID": number, "EPOCH": "2026-08-11T01:21:00", "MEAN_MOTION": motion,
            "ECCENTRICITY": eccentricity, "INCLINATION": inclination, "RA_OF_ASC_NODE": node,
            "ARG_OF_PERICENTER": perigee, "MEAN_ANOMALY": anomaly, "BSTAR": bstar
        })
        .to_string()
    }

    proptest! {
        #[test]
        fn whatever_is_accepted_can_be_propagated_without_harm(
            motion in prop_oneof![any::<f64>(), 0.5..17.0],
            eccentricity in prop_oneof![any::<f64>(), 0.0..1.0],
            angles in any::<[f64; 4]>(),
            bstar in any::<f64>(),
            since_s in -1e8..1e8_f64,
        ) {
            let [inclination, node, perigee, anomaly] = angles;
            let numbers = [motion, eccentricity, inclination, node, perigee, anomaly, bstar];
            for elements in read_elements(&message(5, numbers)).elements {
                if let Ok(propagator) = Propagator::new(&elements)
                    && let Ok(state) =
                        propagator.state_at(time::add_seconds(elements.epoch(), since_s))
                {
                    prop_assert!(state.position_km.is_finite());
                }
            }
        }
    }
}
