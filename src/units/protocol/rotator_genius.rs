//! Codec of the Rotator Genius (4O3A, TCP port 9006), protocol "rev. 4".
//!
//! On the console's side, a [`Decoder`] converts bytes to [`Received`]s, and a [`Request`] becomes
//! bytes. On the simulator's side, [`Request::parse`] reads a request. This module does no I/O,
//! uses no time and accepts any input without a failure.
//!
//! Facts come from the vendor's document "4O3A Signature Rotator Genius TCP protocol, rev. 4",
//! cited as "section 1.1", and from status replies recorded at two stations. The stream has no
//! lengths and no terminators, and contains raw zero bytes. Units send a status of 72 bytes, but
//! the document's example has 64, so the decoder recognises the form by the bytes at fixed places.

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
