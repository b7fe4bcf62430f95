//! One antenna: a controller on a link, with its mount, limits and settings.

use std::time::Duration;

use serde::Serialize;

use super::{
    Automatic, Connection, DEFAULT_RESUME_AFTER_S, DEFAULT_SWAY_DEG, Monitor, Mount, Resume,
    TrackSettings, Upkeep, is_default,
};
use crate::{
    astro::{Angle, AzEl, PointingModel},
    device::Controller,
};

/// A whole turn of an azimuth axis, degrees.
const TURN_DEG: f64 = 360.0;

/// Permanent id of an antenna in the station file, unique in the station. It stays when the name or
/// address changes.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, serde::Deserialize,
)]
#[serde(transparent)]
pub struct AntennaId(pub u32);

impl AntennaId {
    /// Id of a station's first antenna.
    pub const FIRST: Self = Self(1);

    /// Returns the first id from `first` on that is not in `used`.
    #[must_use]
    pub fn free(first: Self, used: &[Self]) -> Self {
        let mut id = first;
        while used.contains(&id) {
            id = Self(id.0.wrapping_add(1));
        }
        id
    }
}

/// One controller on one link, with its mount, limits and park position.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Antenna {
    pub id: AntennaId,
    /// Name on the chip of the antenna.
    pub name: String,
    pub connection: Connection,
    /// `true` to connect at every start to a unit that otherwise waits for Connect. Connecting
    /// interrupts anyone at the panel of the unit.
    #[serde(skip_serializing_if = "is_default")]
    pub connects_at_start: bool,
    pub mount: Mount,
    /// Full width of the beam at half power, degrees, 0.01 to 180.
    pub beam_width_deg: f64,
    pub park: Direction,
    pub limits: MotionLimits,
    pub poll: PollRates,
    /// Settings for program track.
    pub follow: TrackSettings,
    /// Pointing model of an az/el mount, for program track and for the bounds.
    #[serde(skip_serializing_if = "PointingModel::is_none")]
    pub pointing_model: PointingModel,
    /// Reaction of the monitor when another operator drives the antenna into a forbidden direction.
    #[serde(skip_serializing_if = "is_default")]
    pub monitor: Monitor,
    /// Max sway between two positions of a standing antenna, degrees, 0 to 2.
    #[serde(skip_serializing_if = "is_default_sway")]
    pub sway_deg: f64,
    /// Action on an intent when the link returns after an outage.
    #[serde(skip_serializing_if = "is_default")]
    pub resume: Resume,
    /// Outage after which Azel asks the operator in any case, seconds, 0 to 600.
    #[serde(skip_serializing_if = "is_default_outage")]
    pub resume_after_s: f64,
    #[serde(flatten)]
    pub automatic: Automatic,
    /// Upkeep of the unit between passes.
    #[serde(skip_serializing_if = "is_default")]
    pub upkeep: Upkeep,
}

// serde prescribes the signatures.
#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_default_sway(sway_deg: &f64) -> bool {
    sway_deg.total_cmp(&DEFAULT_SWAY_DEG).is_eq()
}

#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_default_outage(resume_after_s: &f64) -> bool {
    resume_after_s.total_cmp(&DEFAULT_RESUME_AFTER_S).is_eq()
}

/// A direction in the station file.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Direction {
    /// Azimuth from north over east, degrees, 0 to 360.
    pub azimuth_deg: f64,
    /// Elevation from the horizon, degrees, 0 to 90.
    pub elevation_deg: f64,
}

/// Motion limits that the operator sets for a mount.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MotionLimits {
    /// Min commanded elevation, degrees, 0 to 90.
    pub minimum_elevation_deg: f64,
    /// Max jog rate of an axis, degrees a second, above 0 to 30.
    pub maximum_rate_deg_s: f64,
    /// Max single step of an axis, degrees, above 0 to 90.
    pub maximum_step_deg: f64,
}

/// Rates at which a controller asks for the state.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PollRates {
    /// Rate while the antenna stands, per second, 2 to 10. Motion by hand needs a position younger
    /// than a second.
    pub idle_hz: f64,
    /// Rate while the antenna moves or tracks, per second, 2 to 10.
    pub moving_hz: f64,
}

impl PollRates {
    /// Returns the time between two questions.
    pub fn period(&self, moving: bool) -> Duration {
        let rate = if moving { self.moving_hz } else { self.idle_hz };
        // A rate that is out of range or not a number must not stop polling.
        Duration::try_from_secs_f64(1.0 / rate.clamp(2.0, 10.0)).unwrap_or(Duration::from_secs(1))
    }
}

impl Antenna {
    /// Returns the longer time in which an axis travels from one end to the other, seconds.
    pub fn longest_slew_s(&self) -> f64 {
        let spans = self.mount.travel_deg().map(|(from_deg, to_deg)| to_deg - from_deg);
        spans.into_iter().fold(0.0, f64::max) / self.limits.maximum_rate_deg_s
    }

    /// Returns the mount for program track. A pointing model is valid only on this side of the
    /// zenith. Targets keep away from ends past which the azimuth would wrap.
    pub fn track_mount(&self) -> Mount {
        let Mount::AzEl { azimuth_from_deg, azimuth_to_deg, .. } = self.mount else {
            return self.mount;
        };
        let margin_deg = self.wrap_margin_deg(azimuth_to_deg - azimuth_from_deg);
        let azimuth_deg = (azimuth_from_deg + margin_deg, azimuth_to_deg - margin_deg);
        let top_deg = if self.pointing_model.is_none() { f64::MAX } else { 90.0 };
        self.mount.clipped([Some(azimuth_deg), Some((f64::MIN, top_deg))])
    }

    /// Returns the margin between a target and either end, degrees. With this margin, an axis that
    /// rests past its target still reads as being at this end. Directions outside the travel add to
    /// it.
    fn wrap_margin_deg(&self, travel_deg: f64) -> f64 {
        let can = self.connection.variant().capabilities;
        let room_deg = (TURN_DEG - travel_deg).max(0.0) / 2.0;
        if can.azimuth_wraps { (can.rests_within_deg() - room_deg).max(0.0) } else { 0.0 }
    }

    /// Returns the pointing model that program track and the bounds apply.
    pub fn track_model(&self) -> PointingModel {
        match self.mount {
            Mount::AzEl { .. } if self.connection.variant().capabilities.has_elevation() => {
                self.pointing_model
            }
            // Without an elevation axis, the other terms are unknown.
            Mount::AzEl { .. } => PointingModel {
                azimuth_offset_deg: self.pointing_model.azimuth_offset_deg,
                ..PointingModel::default()
            },
            Mount::Xy { .. } => PointingModel::default(),
        }
    }

    /// Returns the time from the end of one pass until the antenna can go to the next, seconds.
    pub fn set_up_s(&self) -> f64 {
        self.automatic.set_up_s.unwrap_or(self.connection.spec().defaults.set_up_s)
    }

    /// Creates the controller, which is silent until its link is up.
    pub fn controller(&self) -> Box<dyn Controller> {
        (self.connection.spec().open)(self)
    }

    /// Returns `true` if two names are too similar for the operator to distinguish the antennas.
    pub fn same_name(a: &str, b: &str) -> bool {
        a.trim().to_lowercase() == b.trim().to_lowercase()
    }

    /// Returns `name`, or `name` with the first free number from 2 if another antenna has the name.
    pub fn free_name(name: &str, others: &[&str]) -> String {
        let is_free = |name: &String| others.iter().all(|other| !Self::same_name(name, other));
        let numbered = (2_u32..).map(|number| format!("{name} {number}"));
        std::iter::once(name.to_owned()).chain(numbered).find(is_free).unwrap_or_default()
    }

    pub fn beam_width(&self) -> Angle {
        Angle::from_degrees(self.beam_width_deg)
    }

    pub fn park_direction(&self) -> AzEl {
        AzEl::from_degrees(self.park.azimuth_deg, self.park.elevation_deg)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn targets_keep_away_from_ends_where_the_azimuth_wraps() {
        let azimuth_deg = |antenna: Antenna, travel_deg: (f64, f64)| {
            let mount = Mount::AzEl {
                azimuth_from_deg: travel_deg.0,
                azimuth_to_deg: travel_deg.1,
                elevation_from_deg: 0.0,
                elevation_to_deg: 90.0,
            };
            Antenna { mount, ..antenna }.track_mount().travel_deg()[0]
        };
        let genius = || Antenna::genius("", "");
        assert_eq!(azimuth_deg(genius(), (0.0, 360.0)), (2.5, 357.5));
        assert_eq!(azimuth_deg(genius(), (-180.0, 180.0)), (-177.5, 177.5));
        assert_eq!(azimuth_deg(genius(), (0.0, 358.0)), (1.5, 356.5));
        assert_eq!(azimuth_deg(genius(), (10.0, 350.0)), (10.0, 350.0));
        assert_eq!(azimuth_deg(Antenna::rc2000c("", ""), (0.0, 360.0)), (0.0, 360.0));
    }
}
