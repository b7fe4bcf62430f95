//! Codec of Hamlib's rotctld protocol (TCP port 4533), for a server and for a client.
//!
//! A server cuts bytes into [`Line`]s, reads each line as a [`Command`] and answers it with a
//! [`Reply`]. A client sends [`Request`]s, one at a time, and reads the lines of each answer with a
//! [`Reader`]. This module does no I/O, uses no time and accepts any input without a failure.
//!
//! Facts come from tests of rotctld 4.5.4 byte by byte, and from the source of Hamlib 4.7. Hamlib
//! reads characters, but this codec reads lines: no known client sends a command without its line
//! feed. Hamlib also carries out surplus arguments as further commands.

mod command;
mod error_code;
mod lines;
mod position;
mod reader;
mod reply;
mod request;

pub use command::{Command, Format};
pub use error_code::ErrorCode;
pub use lines::{Line, Lines, MAX_LINE_BYTES};
pub use position::{Limits, Position, PositionError};
pub use reader::{Answer, MAX_STATE_LINES, Reader, UnreadableAnswer};
pub use reply::Reply;
pub use request::{Motion, Request, Sense, Speed, StatusWord};
