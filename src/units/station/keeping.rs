//! Retention of a station's record.

use serde::Serialize;

/// Time for which Azel keeps the parts of the record.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Retention {
    /// Retention of measured positions and lines on the links, days.
    pub raw_days: f64,
    /// Retention of all other data, years.
    pub years: f64,
}

impl Default for Retention {
    fn default() -> Self {
        Self { raw_days: 7.0, years: 5.0 }
    }
}
