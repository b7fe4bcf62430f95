//! Simulated RC2000C antenna controller.
//!
//! On its raw TCP port or pseudo-terminal, the simulator behaves like a real unit. It speaks the
//! protocol of the vendor's manual, turns a modelled mount and feed, stores satellites and tracks
//! one of them. Quirks and faults make it misbehave.
//!
//! Where the manual is silent, the simulator takes the worst case for a client. Any command takes
//! the panel from a local operator. An axis that coasts after a stop is reported as still, and a
//! command for a drive in alarm is acknowledged.

mod axis;
mod command_line;
mod connection;
mod feed;
mod options;
#[cfg(unix)]
mod pty;
mod quirks;
mod satellites;
mod tracking;
mod unit;

pub use command_line::COMMAND;
pub use options::{AxisOptions, Options};
#[cfg(unix)]
pub use pty::PtySimulator;
pub use quirks::{Fault, Quirk};
pub use satellites::StoredSatellite;
pub use unit::{Mode, Snapshot};

use super::harness;

/// Handle of a simulated RC2000C; clones control the same unit.
pub type Control = harness::Control<unit::Rc2000c>;

/// RC2000C on a raw TCP port, like a unit behind a serial server.
pub type Simulator = harness::Simulator<unit::Rc2000c>;
