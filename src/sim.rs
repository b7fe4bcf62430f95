//! Simulators of the controllers on real sockets.

pub mod satrak;
