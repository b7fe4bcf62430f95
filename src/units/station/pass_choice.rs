//! Single passes that the operator has chosen for the schedule, or against it.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

/// Operator's choice for one pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct PassChoice {
    /// Catalog number.
    pub satellite: u32,
    /// A moment of the pass. Newer elements move AOS and LOS, but not past the middle.
    pub tca: Timestamp,
    pub take: Take,
    /// When the operator chose.
    pub chosen_at: Timestamp,
}

/// Decision to take a pass or not, whatever its priority.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Take {
    /// Before all passes that are not always taken.
    Always,
    Never,
}
