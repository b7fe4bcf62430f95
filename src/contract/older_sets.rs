//! Older sets of elements of an object.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use crate::orbit::Elements;

/// A set of elements that is no longer in use.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OlderSet {
    pub elements: Elements,
    /// Name of the set's source.
    pub source: String,
}

/// The older sets of one object, as requested by a client.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OlderSets {
    pub catalog_number: u32,
    /// Sets, newest first.
    pub sets: Vec<OlderSet>,
}

/// Choice of the set of elements for an object.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum SetChoice {
    /// The stored set with this epoch, until a set arrives that is newer than all stored sets.
    Older { catalog_number: u32, epoch: Timestamp },
    /// The newest set, which is the default.
    Newest { catalog_number: u32 },
}
