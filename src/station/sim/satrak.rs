//! Simulated Satrak antenna controller unit.
//!
//! On its TCP port, the simulator behaves like a real unit. It speaks the protocol of the vendor's
//! document, turns a modelled X/Y mount and tracks with its own SGP4. Quirks and faults make it
//! misbehave.
//!
//! Where the document is silent, the simulator takes the worst case for a client. A move has no
//! timeout, and a stop leaves tracking switched on.

mod answer;
mod command_line;
mod connection;
mod folder;
mod mount;
mod options;
mod quirks;
mod tracking;
mod unit;

pub use answer::ErrorCode;
pub use azel_units::demo::BUNDLED_FILE;
pub use command_line::COMMAND;
pub use options::Options;
pub use quirks::{Fault, Quirk};
pub use unit::Snapshot;

use super::harness;

/// Handle of a simulated Satrak; clones control the same unit.
pub type Control = harness::Control<unit::Satrak>;

/// Satrak that listens on a TCP port.
pub type Simulator = harness::Simulator<unit::Satrak>;
