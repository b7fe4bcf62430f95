//! Single passes that the operator has chosen for the schedule, or excluded from it.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

/// Operator's choice for one pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct PassChoice {
    /// Catalog number of the satellite.
    pub satellite: u32,
    /// Time inside the pass. Newer elements move AOS and LOS, but not past the TCA.
    pub tca: Timestamp,
    pub take: Take,
    /// Time of the operator's choice.
    pub chosen_at: Timestamp,
}

/// Decision to take a pass or not, independent of its priority.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Take {
    /// Precedence over all passes that are not always taken.
    Always,
    Never,
}
