//! On-board track of a unit, as the unit reports it.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::settings::{Value, Values};
use crate::astro::{Angle, GroundPoint, Offset, Site, TrackOffsets, frames::MEAN_RADIUS_KM};

/// Max tracking window that Azel writes to a unit or checks, seconds. No pass of a moving satellite
/// is longer, and the time of the check grows with the window.
pub const LONGEST_WINDOW_S: i64 = 86_400;

/// On-board track of a unit, each part as last read. `None` means not read, or not reported.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct OnBoard {
    /// Location that the unit uses.
    pub place: Option<Place>,
    pub clock: Option<UnitClock>,
    /// Offsets that the unit adds to the path it computes.
    pub offsets: Option<Offsets>,
    pub satellite: Option<HeldSatellite>,
    /// Start and end of tracking.
    pub window: Option<(Timestamp, Timestamp)>,
}

/// A unit's clock compared with the computer's.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct UnitClock {
    /// Lead of the unit's clock over the computer's, seconds, corrected by half the round trip over
    /// the link.
    pub ahead_s: f64,
    /// Maximum error of `ahead_s`: half the round trip, seconds.
    #[serde(default)]
    pub error_s: f64,
    /// `true` if somebody has set the clock.
    pub is_set: bool,
    /// Time of the reading, by the computer's clock.
    pub read_at: Timestamp,
}

/// Max clock error that an operator should accept, seconds. A satellite in a low orbit moves
/// through a beam of one degree in about this time.
const OFF_S: f64 = 1.0;

impl UnitClock {
    /// Returns the min lead of the unit's clock, seconds: negative if it is certainly behind, zero
    /// if it may be right.
    pub fn surely_ahead_s(self) -> f64 {
        (self.ahead_s.abs() - self.error_s).max(0.0).copysign(self.ahead_s)
    }

    /// Returns `true` if the clock error certainly exceeds the acceptable max.
    pub fn is_surely_off(self) -> bool {
        self.surely_ahead_s().abs() > OFF_S
    }

    /// Returns `true` if the clock error may exceed the acceptable max.
    pub fn may_be_off(self) -> bool {
        self.ahead_s.abs() + self.error_s > OFF_S
    }
}

/// A location as a unit reports it, without altitude.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Place {
    /// Latitude, north positive.
    pub latitude_deg: f64,
    /// Longitude, east positive.
    pub longitude_deg: f64,
    /// Step of both angles as reported, degrees.
    pub step_deg: f64,
}

impl Place {
    /// Returns the distance over the ground from the site, km.
    pub fn km_from(self, site: Site) -> f64 {
        let ground_point = GroundPoint::from_degrees(self.latitude_deg, self.longitude_deg);
        let here = GroundPoint::new(site.latitude(), site.longitude());
        here.distance(ground_point).radians() * MEAN_RADIUS_KM
    }

    /// Returns this place at the altitude of `site`, or `site` if the reported step hides the
    /// difference; `None` if no such place exists.
    pub fn as_site(self, site: Site) -> Option<Site> {
        let away_deg = [
            self.latitude_deg - site.latitude().degrees(),
            self.longitude_deg - site.longitude().degrees(),
        ];
        if away_deg.iter().all(|away_deg| away_deg.abs() <= self.step_deg + 1e-9) {
            return Some(site);
        }
        let station_site =
            Site::new(self.latitude_deg, self.longitude_deg, site.altitude_m()).ok()?;
        station_site.with_refraction(site.refraction()).ok()
    }
}

/// Offsets that a unit adds to the path it computes.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Offsets {
    /// Time along the track, seconds. The direction of its sign is unknown.
    pub time_s: f64,
    pub azimuth_deg: f64,
    pub elevation_deg: f64,
    /// Angle between the zero of the mount and north, degrees.
    pub north_deg: f64,
    /// Min elevation at which the unit points, degrees.
    pub minimum_elevation_deg: f64,
    /// Time before the window at which the unit goes to the start of the track, seconds.
    pub lead_s: f64,
}

impl Offsets {
    /// Returns the offsets in azimuth and elevation; `None` if they exceed the range of an offset.
    pub fn of_the_axes(&self) -> Option<TrackOffsets> {
        let azimuth = Offset::Azimuth(Angle::from_degrees(self.azimuth_deg));
        let elevation = Offset::Elevation(Angle::from_degrees(self.elevation_deg));
        TrackOffsets::NONE.plus(azimuth)?.plus(elevation)
    }

    /// Returns the same offsets with `offsets` in azimuth and elevation.
    #[must_use]
    pub fn with_axes_of(self, offsets: TrackOffsets) -> Self {
        Self {
            azimuth_deg: offsets.azimuth().degrees(),
            elevation_deg: offsets.elevation().degrees(),
            ..self
        }
    }
}

impl OnBoard {
    /// Returns the same track without the intended `offsets` in azimuth and elevation.
    #[must_use]
    pub fn without_offsets(&self, offsets: TrackOffsets) -> Self {
        let less = |unit: Offsets| Some(unit.with_axes_of(unit.of_the_axes()?.less(offsets)?));
        Self { offsets: self.offsets.map(|unit| less(unit).unwrap_or(unit)), ..self.clone() }
    }
}

/// Settings with which the operator shifts the tracks that a unit computes: the key of their group,
/// and of each setting.
#[derive(Debug)]
pub struct TrackOffsetFields {
    pub group: &'static str,
    /// Key of an integer, milliseconds.
    pub time_ms: &'static str,
    /// Key of a decimal, degrees, added to the azimuth.
    pub azimuth_deg: &'static str,
    /// Key of a decimal, degrees, added to the elevation.
    pub elevation_deg: &'static str,
}

impl TrackOffsetFields {
    /// Returns the values that change the offsets in azimuth and elevation from `previous` to
    /// `new`.
    pub fn values(&self, previous: TrackOffsets, new: TrackOffsets) -> Values {
        let rows = [
            (self.azimuth_deg, previous.azimuth(), new.azimuth()),
            (self.elevation_deg, previous.elevation(), new.elevation()),
        ];
        let changed = rows.into_iter().filter(|(_, start, end)| start != end);
        // Rounding to thousandths removes the error of radians, so the read-back equals the sent
        // value.
        let decimal = |angle: Angle| Value::Decimal((angle.degrees() * 1000.0).round() / 1000.0);
        changed.map(|(key, _, last)| (key, decimal(last))).collect()
    }
}

/// A satellite that a unit holds. The unit does not report the epoch of its elements.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HeldSatellite {
    /// Catalog number of up to nine digits; 0 for none.
    pub catalog_number: u32,
    /// Name as in its elements.
    pub name: String,
    /// Max elevation of the pass as the unit predicts it, degrees; `None` if not reported.
    pub maximum_elevation_deg: Option<f64>,
}
