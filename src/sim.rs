//! Simulators of the controllers on real sockets and pseudo-terminals.

mod names;
mod port;
mod prng;
pub mod rc2000c;
pub mod rotator_genius;
pub mod satrak;

pub use names::UnknownName;
