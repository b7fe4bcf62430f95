//! Pure codecs of the controllers: typed requests and replies, bytes in and out.

mod parity;
pub mod rc2000c;
pub mod rotator_genius;
pub mod satrak;

pub use parity::Parity;
