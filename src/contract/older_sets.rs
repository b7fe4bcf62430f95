//! Older sets of elements of an object.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::orbit::Elements;

/// A set of elements that is not in use any more.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OlderSet {
    pub elements: Elements,
    /// Name of the source that gave it.
    pub source: String,
}

/// The older sets of one object.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OlderSets {
    pub catalog_number: u32,
    /// The newest first.
    pub sets: Vec<OlderSet>,
}

/// The set of elements that an object is to have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum SetChoice {
    /// The held set with this epoch, until one comes that is newer than all held.
    Older { catalog_number: u32, epoch: Timestamp },
    /// The newest set, as all objects have without a choice.
    Newest { catalog_number: u32 },
}
