//! One antenna: a controller on a link, and what its metal can do.

use std::time::Duration;

use serde::Serialize;

use crate::astro::{Angle, AzEl};

/// One controller on one link, with its mount, limits and park position.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Antenna {
    /// Shown on its chip.
    pub name: String,
    /// Which controller, and where it answers.
    pub connection: Connection,
    /// How the axes are arranged.
    pub mount: Mount,
    /// Full width of the beam at half power, degrees, 0.01 to 180.
    pub beam_width_deg: f64,
    /// Where Park sends the antenna.
    pub park: Direction,
    /// What the mount can do.
    pub limits: MotionLimits,
    /// How often the controller is asked.
    pub poll: PollRates,
}

/// A direction in a file.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Direction {
    /// From north over east, degrees, 0 to 360.
    pub azimuth_deg: f64,
    /// From the horizon, degrees, 0 to 90.
    pub elevation_deg: f64,
}

/// Which controller, and where it answers.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(tag = "controller", rename_all = "lowercase")]
pub enum Connection {
    /// SVS Satrak on TCP.
    Satrak {
        /// Host and port, such as `192.168.10.21:4001`.
        address: String,
        /// The element file on the unit from which satellites are chosen;
        /// empty for the one that the unit uses already.
        #[serde(skip_serializing_if = "String::is_empty")]
        element_file: String,
    },
}

impl Connection {
    /// Where the controller answers, for the operator's eyes.
    pub fn address(&self) -> &str {
        match self {
            Self::Satrak { address, .. } => address,
        }
    }
}

/// How the axes are arranged.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(tag = "type", rename_all = "lowercase")]
pub enum Mount {
    /// Two crossed axes, the lower one horizontal; the keyholes lie at its ends.
    Xy {
        /// Azimuth to which the lower axis points, degrees, 0 to 180.
        lower_axis_azimuth_deg: f64,
        /// Lower end of the travel of both axes as the controller counts
        /// (90 at the zenith), degrees.
        travel_from_deg: f64,
        /// Upper end of the travel, degrees.
        travel_to_deg: f64,
    },
}

/// What the mount can do and what the operator allows it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MotionLimits {
    /// Lowest elevation that is commanded, degrees, 0 to 90.
    pub minimum_elevation_deg: f64,
    /// Fastest jog of an axis, degrees a second, above 0 to 30.
    pub maximum_rate_deg_s: f64,
    /// Largest single step of an axis, degrees, above 0 to 90.
    pub maximum_step_deg: f64,
}

/// How often the controller is asked for its state.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PollRates {
    /// While the antenna stands, per second, 2 to 10: a motion by hand needs a
    /// position younger than a second.
    pub idle_hz: f64,
    /// While it moves or tracks, per second, 2 to 10.
    pub moving_hz: f64,
}

impl PollRates {
    /// The time between two questions.
    pub fn period(&self, moving: bool) -> Duration {
        let rate = if moving { self.moving_hz } else { self.idle_hz };
        // A rate that is out of range or not a number must not stop polling.
        Duration::try_from_secs_f64(1.0 / rate.clamp(2.0, 10.0)).unwrap_or(Duration::from_secs(1))
    }
}

impl Antenna {
    /// A Satrak at `address` with the factory figures of its document.
    pub fn satrak(name: &str, address: &str) -> Self {
        Self {
            name: name.to_owned(),
            connection: Connection::Satrak {
                address: address.to_owned(),
                element_file: String::new(),
            },
            mount: Mount::Xy {
                lower_axis_azimuth_deg: 0.0,
                travel_from_deg: 5.0,
                travel_to_deg: 175.0,
            },
            beam_width_deg: 0.88,
            park: Direction { azimuth_deg: 0.0, elevation_deg: 90.0 },
            limits: MotionLimits {
                minimum_elevation_deg: 5.0,
                maximum_rate_deg_s: 3.0,
                maximum_step_deg: 5.0,
            },
            poll: PollRates { idle_hz: 2.0, moving_hz: 5.0 },
        }
    }

    /// Whether two names are too alike for the operator to tell two antennas
    /// apart.
    pub fn same_name(a: &str, b: &str) -> bool {
        a.trim().to_lowercase() == b.trim().to_lowercase()
    }

    /// `name`, with the first number behind it that tells it from all others
    /// where another antenna has it.
    pub fn free_name(name: &str, others: &[&str]) -> String {
        let is_free = |name: &String| others.iter().all(|other| !Self::same_name(name, other));
        let numbered = (2_u32..).map(|number| format!("{name} {number}"));
        std::iter::once(name.to_owned()).chain(numbered).find(is_free).unwrap_or_default()
    }

    /// The width of the beam.
    pub fn beam_width(&self) -> Angle {
        Angle::from_degrees(self.beam_width_deg)
    }

    /// Where Park sends the antenna.
    pub fn park_direction(&self) -> AzEl {
        AzEl::from_degrees(self.park.azimuth_deg, self.park.elevation_deg)
    }
}
