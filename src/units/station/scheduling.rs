//! How the station plans its passes and takes them by itself.

use serde::{Deserialize, Serialize};

/// Settings for the schedule of the whole station.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Scheduling {
    pub choose_by: ChooseBy,
    /// Hours ahead that are planned, 12 to 168.
    pub span_h: f64,
    /// `None` takes passes whole or not at all.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub partly: Option<Partly>,
    /// One antenna may hand a pass over to another in its middle.
    pub hand_over: bool,
    /// Passes with older elements are not taken, days; `None` takes them however old.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_element_age_d: Option<f64>,
    /// Rest after which a motion of automatic operation is announced, minutes.
    pub warn_after_rest_min: f64,
    /// How long it is announced, seconds, at least 30.
    pub warning_s: f64,
}

/// Quantity that the schedule maximizes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ChooseBy {
    /// Priority by priority, the seconds times the sine of the maximum elevation.
    #[default]
    Elevation,
    /// Priority by priority, the seconds.
    Duration,
    MostPasses,
    MostMinutes,
}

/// Minimum part of a pass that is worth taking.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Partly {
    /// Share of the seconds that count, per cent, 1 to 100.
    #[serde(rename = "least_percent")]
    pub min_percent: f64,
    #[serde(rename = "least_s")]
    pub min_s: f64,
}

/// Automatic operation of one antenna.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Automatic {
    /// Automatic operation is on from an orderly start.
    #[serde(rename = "automatic_operation_at_start", skip_serializing_if = "super::is_default")]
    pub is_on_at_start: bool,
    /// Automatic operation resumes after a crash or a power cut, if it was on.
    #[serde(rename = "automatic_operation_after_crash", skip_serializing_if = "super::is_default")]
    pub resumes_after_crash: bool,
    /// Where the antenna is between two passes.
    #[serde(rename = "between_passes", skip_serializing_if = "super::is_default")]
    pub between_passes: BetweenPasses,
    /// A unit with a program of its own is left to start the next pass without this computer.
    #[serde(rename = "uses_auto_track", skip_serializing_if = "super::is_default")]
    pub uses_auto_track: bool,
    /// Time from the end of one pass until the antenna can go to the next, seconds; `None` for
    /// that of its make.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub set_up_s: Option<f64>,
}

/// Where an antenna is between two passes of the schedule.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum BetweenPasses {
    /// Where the last pass ended, until it has to go to the next.
    #[default]
    Stay,
    /// Where the next pass begins.
    Wait,
    /// At its park position, where the time is enough for both ways.
    Park,
}

impl Default for Scheduling {
    fn default() -> Self {
        Self {
            choose_by: ChooseBy::default(),
            span_h: 24.0,
            partly: None,
            hand_over: false,
            max_element_age_d: None,
            warn_after_rest_min: 60.0,
            warning_s: 30.0,
        }
    }
}
