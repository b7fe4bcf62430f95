//! A simulated Rotator Genius.
//!
//! On its TCP port it is an ordinary peer: it speaks rev. 4 of the vendor's protocol,
//! turns two rotators that ramp and coast, and can be told to misbehave. Its replies are
//! byte for byte those recorded at two stations. Where the document is silent it takes the
//! case that is worst for a client: it goes on moving when its client leaves, and a
//! rotator that is no longer driven still coasts.

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

/// Handle of a simulated Rotator Genius; clones control the same one.
pub type Control = harness::Control<unit::RotatorGenius>;

/// A Rotator Genius that listens on a TCP port.
pub type Simulator = harness::Simulator<unit::RotatorGenius>;
