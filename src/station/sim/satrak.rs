//! A simulated Satrak antenna controller unit.
//!
//! On its TCP port it is an ordinary peer: it speaks the protocol of the vendor's
//! document, turns a modelled X/Y mount, tracks with its own SGP4 and can be told to
//! misbehave. Where the document is silent it takes the case that is worst for a client: a
//! move has no time-out, and stopping leaves tracking switched on.

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

/// Handle of a simulated Satrak; clones control the same one.
pub type Control = harness::Control<unit::Satrak>;

/// A Satrak that listens on a TCP port.
pub type Simulator = harness::Simulator<unit::Satrak>;
