//! Simulated Rotator Genius.
//!
//! On its TCP port, the simulator behaves like a real unit. It speaks rev. 4 of the vendor's
//! protocol and turns two rotators that ramp and coast. Its replies equal byte for byte the ones
//! recorded at two stations. Quirks and faults make it misbehave.
//!
//! Where the document is silent, the simulator takes the worst case for a client. It keeps moving
//! when its client leaves, and a rotator without drive still coasts.

mod command;
mod command_line;
mod connection;
mod options;
mod quirks;
mod report;
mod rotor;
mod travel;
mod unit;

pub use command_line::COMMAND;
pub use options::{Options, RotatorOptions};
pub use quirks::{Fault, Quirk};
pub use unit::{RotatorState, Snapshot};

use super::harness;

/// Handle of a simulated Rotator Genius; clones control the same unit.
pub type Control = harness::Control<unit::RotatorGenius>;

/// Rotator Genius that listens on a TCP port.
pub type Simulator = harness::Simulator<unit::RotatorGenius>;
