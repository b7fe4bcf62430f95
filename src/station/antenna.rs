//! One antenna: a controller on a link, and what its metal can do.

use std::time::Duration;

use serde::Serialize;

use super::{AfterPass, Calibration, Connection, Following, Mount, Rotators};
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
    /// How this program follows a target with it.
    pub follow: Following,
}

/// A direction in a file.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Direction {
    /// From north over east, degrees, 0 to 360.
    pub azimuth_deg: f64,
    /// From the horizon, degrees, 0 to 90.
    pub elevation_deg: f64,
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
            follow: Following {
                period_s: 1.0,
                dead_band_deg: 0.1,
                latency_s: 0.3,
                after: AfterPass::Hold,
            },
        }
    }

    /// A Rotator Genius at `address` that turns azimuth and elevation.
    pub fn genius(name: &str, address: &str) -> Self {
        Self {
            connection: Connection::Genius {
                address: address.to_owned(),
                rotators: Rotators::Pair,
            },
            mount: Mount::AzEl {
                azimuth_from_deg: 0.0,
                azimuth_to_deg: 360.0,
                elevation_from_deg: 0.0,
                elevation_to_deg: 180.0,
            },
            beam_width_deg: 20.0,
            limits: MotionLimits {
                minimum_elevation_deg: 0.0,
                maximum_rate_deg_s: 4.0,
                maximum_step_deg: 10.0,
            },
            park: Direction { azimuth_deg: 0.0, elevation_deg: 0.0 },
            poll: PollRates { idle_hz: 2.0, moving_hz: 4.0 },
            follow: Following {
                period_s: 1.0,
                dead_band_deg: 0.5,
                latency_s: 0.5,
                after: AfterPass::Hold,
            },
            ..Self::satrak(name, "")
        }
    }

    /// An RC2000C at `address` on the bus address of the factory, not calibrated.
    pub fn rc2000c(name: &str, address: &str) -> Self {
        Self {
            connection: Connection::Rc2000c {
                address: address.to_owned(),
                baud: 9600,
                bus_address: 50,
                calibration: Calibration::default(),
            },
            mount: Mount::AzEl {
                azimuth_from_deg: 0.0,
                azimuth_to_deg: 360.0,
                elevation_from_deg: 0.0,
                elevation_to_deg: 90.0,
            },
            beam_width_deg: 1.5,
            limits: MotionLimits {
                minimum_elevation_deg: 5.0,
                maximum_rate_deg_s: 2.0,
                maximum_step_deg: 5.0,
            },
            park: Direction { azimuth_deg: 180.0, elevation_deg: 45.0 },
            poll: PollRates { idle_hz: 2.0, moving_hz: 4.0 },
            follow: Following {
                period_s: 2.0,
                dead_band_deg: 0.2,
                latency_s: 0.5,
                after: AfterPass::Hold,
            },
            ..Self::satrak(name, "")
        }
    }

    /// An antenna with the controller that has this key in the station file, the
    /// usual figures and name of its make; `None` where there is no such.
    pub fn of_controller(key: &str, address: &str) -> Option<Self> {
        Some(match key {
            "satrak" => Self::satrak("Satrak", address),
            "genius" => Self::genius("Genius", address),
            "rc2000c" => Self::rc2000c("RC2000C", address),
            _ => return None,
        })
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
