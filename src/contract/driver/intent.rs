use serde::{Deserialize, Serialize};

/// The operator's intent for an antenna. A state of the driver: it holds with or without a window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Intent {
    /// Nothing is to move.
    #[default]
    Standby,
    /// The operator moves it by hand.
    Manual,
    /// Go to a direction and stay there.
    Position,
    /// Track a target.
    Track,
    /// Go to the park position and stay there.
    Park,
}
