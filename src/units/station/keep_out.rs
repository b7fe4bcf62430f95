//! Keep-outs and Sun avoidance: directions into which antennas must not point.

use serde::{Serialize, Serializer};

use super::{Antenna, Station};
use crate::astro::{Angle, AzEl, Zone};

/// A zone of the sky into which antennas must not point.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct KeepOut {
    /// Name, not empty, and unique among the keep-outs of the station.
    pub name: String,
    /// Reason in the operator's words; may be empty.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub reason: String,
    pub entered: Entered,
    /// Name of the antenna to which the keep-out applies; `None` for the whole site.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub antenna: Option<String>,
    /// Margin that the operator adds to half the beamwidth and to the overrun of the drives,
    /// degrees, 0 to 30.
    pub margin_deg: f64,
    /// Edges of the zone. The file has a list of corners, each an azimuth and an elevation.
    #[serde(rename = "corners", serialize_with = "as_corners")]
    pub zone: Zone,
}

/// Consequence when an antenna enters a keep-out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Entered {
    /// Refusal of the motion. Azel stops an antenna that enters nevertheless.
    #[default]
    Hard,
    /// An alarm.
    Warn,
    /// A detour along the margin, or refusal of the motion without a detour.
    GoRound,
}

/// Distance that antennas keep from the Sun.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SunAvoidance {
    /// Min angle between the Sun and the direction of an antenna, degrees, 0.1 to 60.
    pub radius_deg: f64,
    /// Time ahead for which antennas avoid the Sun's path, minutes, 0 to 120.
    pub ahead_min: f64,
}

impl SunAvoidance {
    /// Default of [`Self::ahead_min`], minutes.
    pub const DEFAULT_AHEAD_MIN: f64 = 10.0;
}

impl KeepOut {
    /// Max number of keep-outs of a station: each takes time whenever Azel judges a position.
    pub const MAX_NUMBER: usize = 32;
    /// Max number of corners of all keep-outs of a station, for the same reason.
    pub const MAX_CORNERS_IN_ALL: usize = 800;

    /// Default of [`Self::margin_deg`], degrees.
    pub const DEFAULT_MARGIN_DEG: f64 = 1.0;

    /// Returns the reason why a keep-out with this many corners exceeds a max. `before` contains
    /// the numbers of corners of the keep-outs before it.
    pub fn excess(before: impl Iterator<Item = usize>, corners: usize) -> Option<String> {
        let (number, all) =
            before.fold((1, corners), |(number, all), corners| (number + 1, all + corners));
        if number > Self::MAX_NUMBER {
            return Some(format!("a station has {} keep-outs at most", Self::MAX_NUMBER));
        }
        (all > Self::MAX_CORNERS_IN_ALL)
            .then(|| format!("all keep-outs have {} corners at most", Self::MAX_CORNERS_IN_ALL))
    }

    /// Returns `true` if the keep-out applies to the antenna of that name.
    pub fn holds_for(&self, antenna: &str) -> bool {
        self.antenna.as_deref().is_none_or(|name| Antenna::same_name(name, antenna))
    }

    /// Returns `true` if this keep-out covers all of `other`, at least as strictly.
    pub fn holds_all_of(&self, other: &Self) -> bool {
        const STEP: Angle = Angle::from_degrees(0.25);
        let same_antennas = match (&self.antenna, &other.antenna) {
            (None, _) => true,
            (Some(_), None) => false,
            (Some(own), Some(others)) => Antenna::same_name(own, others),
        };
        let is_strict = self.entered != Entered::Warn || other.entered == Entered::Warn;
        // Around each point of the edge, this margin must contain the whole margin of `other`.
        let room = self.margin() - other.margin() + Angle::from_degrees(1e-6);
        let is_within = |point: AzEl| self.zone.clearance(point) <= room;
        let same_zone = self.zone == other.zone && self.margin_deg >= other.margin_deg;
        same_antennas && is_strict && (same_zone || other.zone.edges_sampled(STEP).all(is_within))
    }

    pub fn margin(&self) -> Angle {
        Angle::from_degrees(self.margin_deg)
    }

    /// Returns azimuth and elevation of the corners, degrees rounded to nine decimals, because an
    /// angle in radians does not keep the last digit of its degrees.
    pub fn corners_deg(zone: &Zone) -> Vec<(f64, f64)> {
        let rounded = |angle: Angle| (angle.degrees() * 1e9).round() / 1e9;
        zone.corners()
            .iter()
            .map(|direction| (rounded(direction.azimuth), rounded(direction.elevation)))
            .collect()
    }

    /// Returns the zone with these corners (azimuth, elevation), degrees.
    pub fn zone_of(corners_deg: &[(f64, f64)]) -> Result<Zone, crate::astro::ZoneError> {
        Zone::new(corners_deg.iter().map(|(az, el)| AzEl::from_degrees(*az, *el)).collect())
    }
}

impl Station {
    /// Returns the name of a keep-out, or of the Sun avoidance, that is weaker or missing in
    /// `after`. A larger or new keep-out does not count.
    pub fn loosened_in(&self, after: &Self) -> Option<&str> {
        let is_held = |old: &&KeepOut| after.keep_outs.iter().any(|new| new.holds_all_of(old));
        let sun = self.sun_avoidance.filter(|old| {
            after
                .sun_avoidance
                .is_none_or(|new| new.radius_deg < old.radius_deg || new.ahead_min < old.ahead_min)
        });
        let keep_out = self.keep_outs.iter().find(|old| !is_held(old));
        keep_out.map(|old| old.name.as_str()).or(sun.map(|_| "Sun avoidance"))
    }
}

fn as_corners<S: Serializer>(zone: &Zone, out: S) -> Result<S::Ok, S::Error> {
    KeepOut::corners_deg(zone).serialize(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keep_out(corners: &[(f64, f64)]) -> KeepOut {
        KeepOut {
            name: "mast".to_owned(),
            reason: String::new(),
            entered: Entered::Hard,
            antenna: None,
            margin_deg: 2.0,
            zone: KeepOut::zone_of(corners).unwrap(),
        }
    }

    fn mast() -> KeepOut {
        keep_out(&[(100.0, 0.0), (100.0, 20.0), (120.0, 20.0), (120.0, 0.0)])
    }

    #[test]
    fn what_grows_is_tightened_and_what_shrinks_is_loosened() {
        let site = |keep_out: Vec<KeepOut>| Station { keep_outs: keep_out, ..Station::default() };
        let before = site(vec![mast()]);
        let higher = keep_out(&[(99.0, -1.0), (99.0, 30.0), (121.0, 30.0), (121.0, -1.0)]);
        let lower = keep_out(&[(100.0, 0.0), (100.0, 19.5), (120.0, 19.5), (120.0, 0.0)]);
        for (after, is_loosened) in [
            (vec![mast()], false),
            (vec![mast(), lower.clone()], false),
            (vec![higher.clone()], false),
            (vec![KeepOut { name: "tower".to_owned(), ..higher.clone() }], false),
            (vec![KeepOut { margin_deg: 2.5, ..lower.clone() }], false),
            (vec![KeepOut { margin_deg: 1.9, ..mast() }], true),
            (vec![KeepOut { entered: Entered::GoRound, ..mast() }], false),
            (vec![KeepOut { entered: Entered::Warn, ..mast() }], true),
            (vec![KeepOut { antenna: Some("Satrak".to_owned()), ..mast() }], true),
            (vec![lower], true),
            (Vec::new(), true),
        ] {
            let loosened = before.loosened_in(&site(after.clone()));
            assert_eq!(loosened, is_loosened.then_some("mast"), "{after:?}");
        }
        assert_eq!(site(Vec::new()).loosened_in(&before), None);
        let sun = |radius_deg| Station {
            sun_avoidance: Some(SunAvoidance { radius_deg, ahead_min: 10.0 }),
            ..Station::default()
        };
        assert_eq!(sun(5.0).loosened_in(&sun(4.0)), Some("Sun avoidance"));
        assert_eq!(sun(5.0).loosened_in(&sun(6.0)), None);
    }
}
