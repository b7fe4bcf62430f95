//! Settings for the schedule of the station and for automatic operation.

use serde::{Deserialize, Serialize};

/// Settings for the schedule of the whole station.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Scheduling {
    pub choose_by: ChooseBy,
    /// Time ahead that the schedule covers, hours, 12 to 168.
    pub span_h: f64,
    /// Min part of a pass; `None` for whole passes only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub partly: Option<Partly>,
    /// `true` if one antenna may hand a pass over to another in its middle.
    pub hand_over: bool,
    /// Max age of the elements of a pass, days; `None` for any age.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_element_age_d: Option<f64>,
    /// Rest after which Azel announces a motion of automatic operation, minutes.
    pub warn_after_rest_min: f64,
    /// Duration of this announcement, seconds, at least 30.
    pub warning_s: f64,
}

/// Quantity that the schedule maximizes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ChooseBy {
    /// Seconds times the sine of the max elevation, one priority after another.
    #[default]
    Elevation,
    /// Seconds of the taken passes, one priority after another.
    Duration,
    MostPasses,
    MostMinutes,
}

/// Min part of a pass that the schedule takes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Partly {
    /// Min share of the seconds that count, per cent, 1 to 100.
    #[serde(rename = "least_percent")]
    pub min_percent: f64,
    #[serde(rename = "least_s")]
    pub min_s: f64,
}

/// Automatic operation of one antenna.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Automatic {
    /// `true` if automatic operation is on after an orderly start.
    #[serde(rename = "automatic_operation_at_start", skip_serializing_if = "super::is_default")]
    pub is_on_at_start: bool,
    /// `true` if automatic operation resumes after a crash or a power cut, if it was on.
    #[serde(rename = "automatic_operation_after_crash", skip_serializing_if = "super::is_default")]
    pub resumes_after_crash: bool,
    /// Position of the antenna between two passes.
    #[serde(rename = "between_passes", skip_serializing_if = "super::is_default")]
    pub between_passes: BetweenPasses,
    /// `true` if a unit with a program of its own starts the next pass without this computer.
    #[serde(rename = "uses_auto_track", skip_serializing_if = "super::is_default")]
    pub uses_auto_track: bool,
    /// Time from the end of one pass until the antenna can go to the next, seconds; `None` for the
    /// default of its make.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub set_up_s: Option<f64>,
}

/// Position of an antenna between two passes of the schedule.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum BetweenPasses {
    /// End of the last pass, until the antenna has to go to the next.
    #[default]
    Stay,
    /// Start of the next pass.
    Wait,
    /// Park position, if the time suffices for both ways.
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
