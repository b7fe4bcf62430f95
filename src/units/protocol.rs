//! Codecs of the controllers: typed requests and replies to bytes and back, without I/O.

mod parity;
pub mod rc2000c;
pub mod rotator_genius;
pub mod rotctld;
pub mod satrak;

pub use parity::Parity;
