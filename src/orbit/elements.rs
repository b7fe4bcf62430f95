//! The elements of one orbit.

use jiff::{Timestamp, civil, tz::Offset};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error as _};
use sgp4::chrono::{DateTime, TimeDelta};
use smol_str::SmolStr;

use super::Propagator;
use crate::{
    astro::{Angle, time},
    name::{self, Name},
};

/// Heights of an orbit above the equator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Heights {
    pub apogee_km: f64,
    pub perigee_km: f64,
}

/// Constants of WGS72, which SGP4 uses.
const EARTH_MU_KM3_S2: f64 = 398_600.8;
const EARTH_RADIUS_KM: f64 = 6_378.135;
const SIDEREAL_DAY_S: f64 = 86_164.090_5;

/// One orbit: SGP4 mean elements with the name and number of their object.
///
/// The propagator accepts every value of this type. All numbers are finite. The eccentricity is in
/// `0.0..1.0`, the mean motion is positive, and the inclination is from 0 to 180 degrees. Other
/// angles are within one turn either way, and B* is within 10 either way. The epoch is within
/// [`EPOCH_YEARS`]. The orbit does not lead through the Earth, and SGP4 finds the object above the
/// ground at its epoch.
///
/// A value takes 152 bytes, and nothing on the heap if each of its texts has at most 23 bytes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self")]
pub struct Elements {
    /// Name of the object; empty if the source gave none.
    pub(super) name: SmolStr,
    /// International designator, such as `1998-067A`; empty if the source gave none.
    pub(super) international_designator: SmolStr,
    pub(super) catalog_number: u32,
    /// Epoch in whole microseconds.
    pub(super) epoch: Timestamp,
    /// Kozai mean motion, revolutions per day.
    pub(super) mean_motion_rev_day: f64,
    /// Half the first derivative of the mean motion, rev/day^2.
    pub(super) mean_motion_dot: f64,
    /// A sixth of the second derivative of the mean motion, rev/day^3.
    pub(super) mean_motion_ddot: f64,
    /// Drag term B*, per Earth radius.
    pub(super) bstar: f64,
    pub(super) inclination_deg: f64,
    /// Right ascension of the ascending node, degrees.
    pub(super) node_deg: f64,
    pub(super) eccentricity: f64,
    /// Argument of perigee, degrees.
    pub(super) perigee_deg: f64,
    pub(super) mean_anomaly_deg: f64,
    pub(super) set_number: u32,
    pub(super) revolution_number: u32,
    pub(super) ephemeris_type: u8,
    pub(super) classification: Classification,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(super) enum Classification {
    #[default]
    Unclassified,
    Classified,
    Secret,
}

/// Valid calendar years of an epoch: from the first satellite onwards, the years that two digits
/// can express.
pub const EPOCH_YEARS: std::ops::RangeInclusive<i16> = 1957..=2056;

/// Min mean perigee, km above the ground. The mean perigee of a real orbit may lie just below the
/// ground: 50 km for a decaying object, and 11 km for an object that the Moon lifts at each
/// perigee.
const MIN_PERIGEE_KM: f64 = -500.0;

const MAX_CATALOG_NUMBER: u32 = 999_999_999;

/// Reason why numbers do not make an orbit.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error, Serialize, Deserialize)]
pub enum ElementsError {
    /// Elements for a theory other than SGP4 (4 is SGP4-XP).
    #[error("ephemeris type {0} is not SGP4")]
    EphemerisType(u8),
    #[error("catalogue number {0} has more than nine digits")]
    CatalogNumber(u64),
    /// A number is infinite or NaN.
    #[error("a number is not finite")]
    NotFinite,
    #[error("eccentricity {0} is not from 0 to below 1")]
    Eccentricity(f64),
    #[error("mean motion {0} is not positive")]
    MeanMotion(f64),
    /// An angle or B* that no orbit has. Beyond one turn, the fraction of a degree soon becomes
    /// rounding noise, and the passes with it.
    #[error("{name} {value:?} is not from {min} to {max}")]
    OutOfRange {
        #[serde(deserialize_with = "name::one")]
        name: Name,
        /// Degrees, or B* per Earth radius.
        value: f64,
        #[serde(rename = "least")]
        min: f64,
        #[serde(rename = "most")]
        max: f64,
    },
    #[error("epoch {0} is not from {first} to {last}", first = EPOCH_YEARS.start(), last = EPOCH_YEARS.end())]
    Epoch(civil::DateTime),
    /// The orbit leads through the Earth, and SGP4 gives no physical state for it, even above the
    /// ground. The number is the height of its perigee, km.
    #[error("the perigee at a height of {0:.0} km is inside the Earth")]
    Perigee(f64),
    /// The object is below the ground at the epoch, or SGP4 cannot start at all.
    #[error("the object is not above the ground at its epoch")]
    Decayed,
}

impl Classification {
    /// Returns the classification for the letter of a source; unclassified for other letters and
    /// for none.
    pub(super) fn from_letter(letter: &str) -> Self {
        match letter {
            "C" => Self::Classified,
            "S" => Self::Secret,
            _ => Self::Unclassified,
        }
    }

    /// Returns the letter that all forms use for this classification.
    pub(super) fn letter(self) -> char {
        match self {
            Self::Unclassified => 'U',
            Self::Classified => 'C',
            Self::Secret => 'S',
        }
    }
}

impl Serialize for Elements {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Self::serialize(self, serializer)
    }
}

impl<'de> Deserialize<'de> for Elements {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Self::deserialize(deserializer)?.checked().map_err(D::Error::custom)
    }
}

/// Returns the catalog number that a source wrote, if it has at most nine digits.
pub(super) fn catalog_number(number: u64) -> Result<u32, ElementsError> {
    u32::try_from(number)
        .ok()
        .filter(|number| *number <= MAX_CATALOG_NUMBER)
        .ok_or(ElementsError::CatalogNumber(number))
}

impl Elements {
    /// Checks the values that a reader found.
    pub(super) fn checked(mut self) -> Result<Self, ElementsError> {
        // The values 2 and 3 are old marks for SGP4 and SDP4; all sources now write 0.
        if !matches!(self.ephemeris_type, 0 | 2 | 3) {
            return Err(ElementsError::EphemerisType(self.ephemeris_type));
        }
        let numbers = [
            self.mean_motion_rev_day,
            self.mean_motion_dot,
            self.mean_motion_ddot,
            self.bstar,
            self.inclination_deg,
            self.node_deg,
            self.eccentricity,
            self.perigee_deg,
            self.mean_anomaly_deg,
        ];
        if !numbers.iter().all(|number| number.is_finite()) {
            return Err(ElementsError::NotFinite);
        }
        if !(0.0..1.0).contains(&self.eccentricity) {
            return Err(ElementsError::Eccentricity(self.eccentricity));
        }
        if self.mean_motion_rev_day <= 0.0 {
            return Err(ElementsError::MeanMotion(self.mean_motion_rev_day));
        }
        for (name, value, min, max) in [
            ("inclination", self.inclination_deg, 0.0, 180.0),
            ("right ascension of the node", self.node_deg, -360.0, 360.0),
            ("argument of perigee", self.perigee_deg, -360.0, 360.0),
            ("mean anomaly", self.mean_anomaly_deg, -360.0, 360.0),
            // Real sets of manoeuvring objects reach 3.6.
            ("B*", self.bstar, -10.0, 10.0),
        ] {
            if !(min..=max).contains(&value) {
                return Err(ElementsError::OutOfRange { name, value, min, max });
            }
        }
        // The fraction of a day in a TLE leaves noise below the digits that an OMM writes. Without
        // the noise, both forms of one set have the same epoch.
        let utc = |time| Offset::UTC.to_datetime(time);
        let as_written = utc(self.epoch);
        self.epoch = self
            .epoch
            .round(jiff::Unit::Microsecond)
            .ok()
            // The library computes with unsigned years, so a year before 1 would crash the program.
            .filter(|epoch| EPOCH_YEARS.contains(&utc(*epoch).year()))
            .ok_or(ElementsError::Epoch(as_written))?;
        let Heights { perigee_km, .. } = self.heights();
        if perigee_km < MIN_PERIGEE_KM {
            return Err(ElementsError::Perigee(perigee_km));
        }
        if Propagator::is_up_at_epoch(&self) { Ok(self) } else { Err(ElementsError::Decayed) }
    }

    /// Returns the name; empty if the source gave none.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the name up to the first opening bracket.
    pub fn short_name(&self) -> &str {
        self.name.split_once(" (").map_or(&*self.name, |(short, _)| short)
    }

    /// Returns the name, or the catalog number if there is no name.
    pub fn label(&self) -> String {
        if self.name.is_empty() { self.catalog_number.to_string() } else { self.name.to_string() }
    }

    /// Returns the catalog number, up to nine digits.
    pub fn catalog_number(&self) -> u32 {
        self.catalog_number
    }

    /// Returns the international designator, such as `1998-067A`.
    pub fn international_designator(&self) -> Option<&str> {
        Some(self.international_designator.as_str()).filter(|text| !text.is_empty())
    }

    /// Returns the instant that the elements describe best.
    pub fn epoch(&self) -> Timestamp {
        self.epoch
    }

    /// Returns the Kozai mean motion in revolutions per day, above 0.
    pub fn mean_motion_rev_day(&self) -> f64 {
        self.mean_motion_rev_day
    }

    pub fn inclination(&self) -> Angle {
        Angle::from_degrees(self.inclination_deg)
    }

    /// Returns the right ascension of the ascending node.
    pub fn node(&self) -> Angle {
        Angle::from_degrees(self.node_deg)
    }

    pub fn argument_of_perigee(&self) -> Angle {
        Angle::from_degrees(self.perigee_deg)
    }

    pub fn mean_anomaly(&self) -> Angle {
        Angle::from_degrees(self.mean_anomaly_deg)
    }

    /// Returns the drag term B*, per Earth radius.
    pub fn bstar(&self) -> f64 {
        self.bstar
    }

    /// Returns the eccentricity, from 0 to below 1.
    pub fn eccentricity(&self) -> f64 {
        self.eccentricity
    }

    pub fn period_s(&self) -> f64 {
        time::DAY_S / self.mean_motion_rev_day
    }

    /// Returns the heights of the mean orbit above the equator.
    pub fn heights(&self) -> Heights {
        let rate_rad_s = self.mean_motion_rev_day * std::f64::consts::TAU / time::DAY_S;
        let axis_km = (EARTH_MU_KM3_S2 / (rate_rad_s * rate_rad_s)).cbrt();
        Heights {
            apogee_km: axis_km * (1.0 + self.eccentricity) - EARTH_RADIUS_KM,
            perigee_km: axis_km * (1.0 - self.eccentricity) - EARTH_RADIUS_KM,
        }
    }

    /// Returns the age at `now` in seconds, negative before the epoch.
    pub fn age_s(&self, now: Timestamp) -> f64 {
        time::seconds_between(self.epoch, now)
    }

    /// Returns the time between the epoch and `time` in seconds, in either order. Elements are as
    /// wrong before their epoch as after it.
    pub fn epoch_distance_s(&self, time: Timestamp) -> f64 {
        self.age_s(time).abs()
    }

    /// Returns `true` if the satellite keeps its place in the sky, with any inclination. Its period
    /// is within 2 % of a sidereal day, and its orbit is near-circular.
    pub fn is_geosynchronous(&self) -> bool {
        (self.period_s() / SIDEREAL_DAY_S - 1.0).abs() < 0.02 && self.eccentricity() < 0.1
    }

    /// Returns `true` if the source gave no name or no designator.
    pub(super) fn lacks_name(&self) -> bool {
        self.name.is_empty() || self.international_designator.is_empty()
    }

    /// Takes the name and designator from `other` if this set has none.
    pub(super) fn take_name(&mut self, other: &Self) {
        for (own, other) in [
            (&mut self.name, &other.name),
            (&mut self.international_designator, &other.international_designator),
        ] {
            if own.is_empty() {
                own.clone_from(other);
            }
        }
    }

    /// Returns the elements in the form of the SGP4 library, without name and designator.
    pub(super) fn sgp4(&self) -> sgp4::Elements {
        sgp4::Elements {
            object_name: None,
            international_designator: None,
            norad_id: u64::from(self.catalog_number),
            classification: match self.classification {
                Classification::Unclassified => sgp4::Classification::Unclassified,
                Classification::Classified => sgp4::Classification::Classified,
                Classification::Secret => sgp4::Classification::Secret,
            },
            datetime: (DateTime::UNIX_EPOCH + TimeDelta::microseconds(self.epoch.as_microsecond()))
                .naive_utc(),
            mean_motion_dot: self.mean_motion_dot,
            mean_motion_ddot: self.mean_motion_ddot,
            drag_term: self.bstar,
            element_set_number: u64::from(self.set_number),
            inclination: self.inclination_deg,
            right_ascension: self.node_deg,
            eccentricity: self.eccentricity,
            argument_of_perigee: self.perigee_deg,
            mean_anomaly: self.mean_anomaly_deg,
            mean_motion: self.mean_motion_rev_day,
            revolution_number: u64::from(self.revolution_number),
            ephemeris_type: self.ephemeris_type,
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{Propagator, RefusalReason, bundled, read_elements};

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
        let Heights { apogee_km, perigee_km } = iss.heights();
        assert!(perigee_km < apogee_km && (400.0..440.0).contains(&apogee_km), "{apogee_km}");
    }

    #[test]
    fn catalog_numbers_have_nine_digits_at_most() {
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
            angles in prop::array::uniform4(prop_oneof![any::<f64>(), -360.0..=360.0]),
            bstar in prop_oneof![any::<f64>(), -10.0..=10.0],
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
