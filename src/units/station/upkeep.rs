//! Rules for the maintenance of a unit between passes.

use serde::Serialize;

use super::is_default;

/// Rules for the maintenance of a unit between passes, during automatic operation. Off by default.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Upkeep {
    /// `true` to set the unit's clock when its error exceeds the limit.
    #[serde(skip_serializing_if = "is_default")]
    pub sets_clock: bool,
    /// Clock error above which Azel sets the unit's clock, seconds, 0.2 to 60. A low satellite
    /// crosses a beam of one degree in a second.
    pub clock_limit_s: f64,
    /// `true` to upload newer elements when the unit's elements are older than the limit.
    #[serde(skip_serializing_if = "is_default")]
    pub uploads_elements: bool,
    /// Age of the unit's elements above which Azel uploads newer elements, days, 0.1 to 1000.
    pub element_limit_d: f64,
}

impl Default for Upkeep {
    fn default() -> Self {
        Self {
            sets_clock: false,
            clock_limit_s: 0.3,
            uploads_elements: false,
            element_limit_d: 2.0,
        }
    }
}
