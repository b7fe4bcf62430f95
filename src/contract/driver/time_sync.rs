//! Synchronisation of the computer's clock.

use serde::{Deserialize, Serialize};

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum TimeSync {
    /// A time service has set the clock and keeps it synchronised.
    Synchronised,
    /// No service keeps the clock, or the service has lost its sources.
    NotSynchronised,
    /// The operating system reports no state.
    #[default]
    NotKnown,
}
