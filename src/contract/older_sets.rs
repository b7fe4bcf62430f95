//! Older sets of elements of an object.

use serde::{Deserialize, Serialize};

use crate::orbit::Elements;

/// A set of elements that is not in use any more.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OlderSet {
    pub elements: Elements,
    /// Name of the source that gave it.
    pub source: String,
}
