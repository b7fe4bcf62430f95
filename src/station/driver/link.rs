//! Opens links.

mod endpoint;
mod parity;
mod serial;
mod tcp;

use std::{future::Future, io, pin::Pin, sync::Arc};

use tokio::io::{AsyncRead, AsyncWrite, DuplexStream};

pub use endpoint::{Endpoint, UnitLock, endpoints, known_endpoints};

use crate::station::{Antenna, Link, check_address};

/// A second handle of an open link, for the dead-man.
#[cfg(unix)]
pub(super) type Duplicate = std::os::fd::OwnedFd;
/// Handles cannot be given to other processes here.
#[cfg(not(unix))]
pub(super) type Duplicate = std::convert::Infallible;

pub trait Stream: AsyncRead + AsyncWrite + Send + Unpin {
    /// Another handle of the same connection, for another process to write to. `None` where
    /// the far end lives in this process and ends with it.
    fn duplicate(&self) -> io::Result<Option<Duplicate>>;

    /// `bytes` as they leave the lowest layer of the link, parity included.
    fn on_wire(&self, bytes: &[u8]) -> Vec<u8> {
        bytes.to_vec()
    }
}

/// The far end is another task of this process.
impl Stream for DuplexStream {
    fn duplicate(&self) -> io::Result<Option<Duplicate>> {
        Ok(None)
    }
}

#[cfg(unix)]
fn duplicate_of(link: &impl std::os::fd::AsFd) -> io::Result<Option<Duplicate>> {
    link.as_fd().try_clone_to_owned().map(Some)
}

#[cfg(not(unix))]
fn duplicate_of<T>(_: &T) -> io::Result<Option<Duplicate>> {
    Err(io::ErrorKind::Unsupported.into())
}

/// An attempt to open a link.
pub(super) type Dialling = Pin<Box<dyn Future<Output = io::Result<Box<dyn Stream>>> + Send>>;

/// Opens a link, any number of times.
pub type Dial = Box<dyn FnMut() -> Dialling + Send>;

/// Opens the links of an antenna, to places that `lock` has.
pub(super) fn dial(antenna: &Antenna, lock: Arc<dyn UnitLock>) -> Dial {
    let connection = &antenna.connection;
    match connection.spec().link {
        Link::Tcp => tcp::dial_tcp(&connection.address, lock),
        Link::Line { baud } => dial_line(&connection.address, connection.whole(baud), lock),
    }
}

/// Opens a serial line of seven bits and even parity: through a serial server if `address` is
/// a host and a port, otherwise as a serial port of this computer at `baud` bits a second.
/// Callers read and write bytes of seven bits.
pub fn dial_line(address: &str, baud: u32, lock: Arc<dyn UnitLock>) -> Dial {
    if check_address(address).is_ok() {
        tcp::dial_line_server(address, lock)
    } else {
        serial::dial_serial(address, baud, lock)
    }
}
