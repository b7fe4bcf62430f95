//! Judgement of the way to a direction before the operator asks for the motion.

use serde::{Deserialize, Serialize};

use super::Refusal;
use crate::{astro::AzEl, device::Pointing};

/// Outcome of going to a direction now.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Preview {
    /// Direction as the operator entered it.
    #[serde(rename = "to")]
    pub target: Pointing,
    pub way: Result<Way, Refusal>,
}

/// The way of both axes to a direction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Way {
    /// Directions along the way, with both ends; empty if the antenna has no direction.
    pub path: Vec<AzEl>,
    /// Duration at the maximum rate, seconds; `None` if an angle is unknown.
    pub arrives_s: Option<f64>,
    /// One axis turns after the other, so that the antenna stays clear of a barrier.
    pub is_round_a_corner: bool,
}
