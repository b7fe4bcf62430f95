//! How long a station keeps its record.

use serde::Serialize;

/// How long the parts of the record are kept.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Retention {
    /// Measured positions and lines on the links, days.
    pub raw_days: f64,
    /// Everything else, years.
    pub years: f64,
}

impl Default for Retention {
    fn default() -> Self {
        Self { raw_days: 7.0, years: 5.0 }
    }
}
