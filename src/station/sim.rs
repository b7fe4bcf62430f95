//! Simulated units on real sockets and pseudo-terminals.

mod command_line;
mod harness;
mod mechanics;
mod names;
mod prng;
pub mod rc2000c;
pub mod rotator_genius;
pub mod satrak;

pub use command_line::{Command, Serving, StartError, Starting};
pub use harness::{Control, InMemory, Misreading, Simulator, Trouble, Unit};
pub use mechanics::Mechanics;
pub use names::UnknownName;
