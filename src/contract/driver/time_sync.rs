//! Synchronisation of the computer's clock.

use serde::{Deserialize, Serialize};

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum TimeSync {
    /// A time service has set it and keeps it.
    Synchronised,
    /// No service keeps it, or the service has lost its sources.
    NotSynchronised,
    /// The operating system does not tell.
    #[default]
    NotKnown,
}
