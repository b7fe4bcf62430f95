//! A simulated RC2000C antenna controller.
//!
//! On its raw TCP port or pseudo-terminal it is an ordinary peer: it speaks the protocol
//! of the vendor's manual, turns a modelled mount and feed, stores satellites, tracks one
//! of them and can be told to misbehave. Where the manual is silent it takes the case that
//! is worst for a client: any command takes the panel from a local operator, an axis that
//! coasts after a stop is not reported as moving, and a command for a drive in alarm is
//! acknowledged.

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

/// Handle of a simulated RC2000C; clones control the same one.
pub type Control = harness::Control<unit::Rc2000c>;

/// An RC2000C on a raw TCP port, as behind a serial server.
pub type Simulator = harness::Simulator<unit::Rc2000c>;
