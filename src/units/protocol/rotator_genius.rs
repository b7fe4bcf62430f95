//! Codec of the Rotator Genius (4O3A, TCP port 9006), protocol "rev. 4".
//!
//! A [`Decoder`] turns bytes into [`Received`]s on the console's side; a
//! [`Request`] becomes bytes there and is read back by [`Request::parse`] on the
//! simulator's side. Nothing here does I/O, knows the time or fails on any input.
//!
//! Facts come from the vendor's document "4O3A Signature Rotator Genius TCP
//! protocol, rev. 4", cited as "section 1.1", and from status replies recorded
//! at two stations. The stream has no lengths and no terminators, and holds raw
//! zero bytes. Units send a status of 72 bytes where the document's example
//! has 64, so its form is decided by what stands at fixed places.

mod configuration;
mod decoder;
mod degrees;
mod layout;
mod name;
mod reply;
mod request;
mod request_parse;
mod status;

pub use configuration::{Configuration, MAX_STOP_OFFSET_DEG};
pub use decoder::{Decoder, MAX_NOISE_BYTES, Received};
pub use degrees::WholeDegrees;
pub use layout::Layout;
pub use name::{MAX_NAME_BYTES, NameProblem, RotatorName};
pub use reply::{Acknowledgement, Reply};
pub use request::{Direction, Motion, Request, RotatorNumber, ValueError};
pub use request_parse::RequestError;
pub use status::{Moving, NoPosition, Rotator, RotatorKind, Status};
