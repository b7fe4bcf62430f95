//! A Rotator Genius that exists only in memory.
//!
//! An ordinary peer on a TCP port: it speaks rev. 4 of the vendor's protocol,
//! turns two rotators that ramp and coast, and can be told to misbehave. Its
//! replies are byte for byte those recorded at two stations. Where the document
//! is silent it takes the case that is worst for a client: it goes on moving when
//! its client leaves, and a rotator that is no longer driven still coasts.

mod command;
mod command_line;
mod connection;
mod control;
mod quirks;
mod report;
mod rotor;
mod server;
mod travel;
mod unit;

pub use command_line::COMMAND;
pub use control::{Control, RotatorState, Snapshot};
pub use quirks::{Fault, Quirk};
pub use server::{Options, RotatorOptions, Simulator};
