//! Opens links.

mod parity;
mod serial;
mod tcp;

use std::{future::Future, io, pin::Pin};

use tokio::io::{AsyncRead, AsyncWrite};

pub use tcp::dial_tcp;

use crate::station::check_address;

/// An open link.
pub trait Stream: AsyncRead + AsyncWrite + Send + Unpin {}
impl<T: AsyncRead + AsyncWrite + Send + Unpin> Stream for T {}

/// Opens the link, as often as asked.
pub type Dial =
    Box<dyn FnMut() -> Pin<Box<dyn Future<Output = io::Result<Box<dyn Stream>>> + Send>> + Send>;

/// Opens a serial line of seven bits and even parity: where `address` is a host
/// and a port through the serial server there, else as a serial port of this
/// computer at `baud` bits a second. Bytes of seven bits go in and come out.
pub fn dial_line(address: &str, baud: u32) -> Dial {
    if check_address(address).is_ok() {
        tcp::dial_line_server(address.to_owned())
    } else {
        serial::dial_serial(address.to_owned(), baud)
    }
}
