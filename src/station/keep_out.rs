//! Where no antenna of the site may point.

use serde::{Serialize, Serializer};

use super::Antenna;
use crate::astro::{Angle, AzEl, Zone};

/// A region of the sky in which metal must not point.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct KeepOut {
    /// Not empty, and no other keep-out of the station has it.
    pub name: String,
    /// What happens when an antenna comes in.
    pub entered: Entered,
    /// The antenna it holds for, by name; `None` for the whole site.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub antenna: Option<String>,
    /// What the operator adds to half of the beam and to the overshoot of the
    /// drives, degrees, 0 to 30.
    pub margin_deg: f64,
    /// Its edges. In the file a list of corners, each an azimuth and an elevation.
    #[serde(rename = "corners", serialize_with = "as_corners")]
    pub zone: Zone,
}

/// What happens when an antenna enters a keep-out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Entered {
    /// The motion is refused; an antenna that gets in all the same is stopped.
    #[default]
    Hard,
    /// An alarm is raised.
    Warn,
    /// The way leads along the margin; refused where there is none.
    GoRound,
}

/// How far antennas stay away from the Sun.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SunAvoidance {
    /// Angle between the Sun and the direction of an antenna, degrees, 0.1 to 60.
    pub radius_deg: f64,
    /// For how long ahead the way of the Sun is kept free, minutes, 0 to 120.
    pub ahead_min: f64,
}

impl SunAvoidance {
    /// The usual time ahead, minutes.
    pub const USUAL_AHEAD_MIN: f64 = 10.0;
}

impl KeepOut {
    /// The usual margin, degrees.
    pub const USUAL_MARGIN_DEG: f64 = 1.0;

    /// Whether it holds for the antenna of that name.
    pub fn holds_for(&self, antenna: &str) -> bool {
        self.antenna.as_deref().is_none_or(|name| Antenna::same_name(name, antenna))
    }

    /// What the operator adds.
    pub fn margin(&self) -> Angle {
        Angle::from_degrees(self.margin_deg)
    }

    /// Azimuth and elevation of the corners, degrees to nine decimals: an angle in
    /// radians does not keep the last digit of its degrees.
    pub fn corners_deg(zone: &Zone) -> Vec<(f64, f64)> {
        let rounded = |angle: Angle| (angle.degrees() * 1e9).round() / 1e9;
        zone.corners().iter().map(|at| (rounded(at.azimuth), rounded(at.elevation))).collect()
    }

    /// The zone of corners of azimuth and elevation in degrees; the reason where
    /// they make none.
    pub fn zone_of(corners_deg: &[(f64, f64)]) -> Result<Zone, crate::astro::ZoneError> {
        Zone::new(corners_deg.iter().map(|(az, el)| AzEl::from_degrees(*az, *el)).collect())
    }
}

fn as_corners<S: Serializer>(zone: &Zone, out: S) -> Result<S::Ok, S::Error> {
    KeepOut::corners_deg(zone).serialize(out)
}
