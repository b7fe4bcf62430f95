//! The way to a direction, judged before anybody asks for it.

use serde::{Deserialize, Serialize};

use super::Refusal;
use crate::{astro::AzEl, device::Pointing};

/// Outcome of going to a direction now.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Preview {
    /// The direction, as it was asked for.
    #[serde(rename = "to")]
    pub target: Pointing,
    pub way: Result<Way, Refusal>,
}

/// The way of both axes to a direction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Way {
    /// Directions along it, with its ends; empty where the antenna has no direction.
    pub path: Vec<AzEl>,
    /// How long it takes at the maximum rate, seconds; `None` where an angle is unknown.
    pub arrives_s: Option<f64>,
    /// One axis turns after the other, to stay clear of a barrier.
    pub is_round_a_corner: bool,
}
