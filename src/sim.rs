//! Simulators of the controllers on real sockets.

mod names;
mod port;
mod prng;
pub mod rotator_genius;
pub mod satrak;

pub use names::UnknownName;
