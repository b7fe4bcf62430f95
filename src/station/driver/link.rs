//! Links to units.

mod endpoint;
mod parity;
mod serial;
mod tcp;

use std::{future::Future, io, pin::Pin, sync::Arc};

use tokio::io::{AsyncRead, AsyncWrite, DuplexStream};

pub use endpoint::{Endpoint, UnitLock, endpoints, known_endpoints};

use crate::station::{Antenna, Link, check_address};

/// Second handle of an open link, for the dead-man.
#[cfg(unix)]
pub(super) type Duplicate = std::os::fd::OwnedFd;
/// Placeholder for a system that cannot pass handles to other processes.
#[cfg(not(unix))]
pub(super) type Duplicate = std::convert::Infallible;

pub trait Stream: AsyncRead + AsyncWrite + Send + Unpin {
    /// Duplicates the handle of the connection, for another process to write to. Returns `None` if
    /// the far end lives in this process and ends with it.
    fn duplicate(&self) -> io::Result<Option<Duplicate>>;

    /// Returns `bytes` in the form of the lowest layer of the link, parity included.
    fn encode(&self, bytes: &[u8]) -> Vec<u8> {
        bytes.to_vec()
    }
}

/// Simulated link: the far end is another task of this process.
impl Stream for DuplexStream {
    fn duplicate(&self) -> io::Result<Option<Duplicate>> {
        Ok(None)
    }
}

#[cfg(unix)]
fn duplicate_handle(link: &impl std::os::fd::AsFd) -> io::Result<Option<Duplicate>> {
    link.as_fd().try_clone_to_owned().map(Some)
}

#[cfg(not(unix))]
fn duplicate_handle<T>(_: &T) -> io::Result<Option<Duplicate>> {
    Err(io::ErrorKind::Unsupported.into())
}

/// Pending attempt to open a link.
pub(super) type Dialling = Pin<Box<dyn Future<Output = io::Result<Box<dyn Stream>>> + Send>>;

/// Function that opens a link, any number of times.
pub type Dial = Box<dyn FnMut() -> Dialling + Send>;

/// Returns a dialler for the links of an antenna, to endpoints that `lock` owns.
pub(super) fn dial(antenna: &Antenna, lock: Arc<dyn UnitLock>) -> Dial {
    let connection = &antenna.connection;
    match connection.spec().link {
        Link::Tcp => tcp::dial_tcp(&connection.address, lock),
        Link::Line { baud } => dial_line(&connection.address, connection.whole(baud), lock),
    }
}

/// Returns a dialler for a serial line of seven bits and even parity. Uses a serial server if
/// `address` is a host and a port, otherwise a serial port of this computer at `baud` bits a
/// second. Callers read and write bytes of seven bits.
pub fn dial_line(address: &str, baud: u32, lock: Arc<dyn UnitLock>) -> Dial {
    if check_address(address).is_ok() {
        tcp::dial_line_server(address, lock)
    } else {
        serial::dial_serial(address, baud, lock)
    }
}
