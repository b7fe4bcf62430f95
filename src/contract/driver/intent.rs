use serde::{Deserialize, Serialize};

/// Operator's intent for an antenna. The driver keeps the intent, with or without a window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Intent {
    /// Standstill.
    #[default]
    Standby,
    /// Motion by hand.
    Manual,
    /// Motion to a direction, and stay there.
    Position,
    /// Track of a target.
    Track,
    /// Motion to the park position, and stay there.
    Park,
}
