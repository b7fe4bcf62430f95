//! Links over TCP.

use std::{io, sync::Arc};

use tokio::net::TcpStream;

use super::{
    Dial, Duplicate, Stream, UnitLock, duplicate_handle,
    endpoint::Lookup,
    parity::{Heard, WithParity},
};
use crate::protocol::Parity;

impl Stream for TcpStream {
    fn duplicate(&self) -> io::Result<Option<Duplicate>> {
        duplicate_handle(self)
    }
}

/// Returns a dialler for TCP links to `address` (host and port). The dialler locks all endpoints of
/// the address first.
pub(super) fn dial_tcp(address: &str, lock: Arc<dyn UnitLock>) -> Dial {
    let lookup = Lookup::new(address, lock);
    Box::new(move || {
        let lookup = lookup.clone();
        Box::pin(async move { Ok(Box::new(open(&lookup).await?) as Box<dyn Stream>) })
    })
}

/// Returns a dialler for links to the serial server at `address`.
///
/// A server set to seven bits and even parity adds the parity. A server set to eight bits forwards
/// bytes unchanged, so Azel must add the parity. After a wrong guess, the unit stays silent or
/// sends the eighth bit. After a link without any fitting byte, the next link uses the other guess.
pub(super) fn dial_line_server(address: &str, lock: Arc<dyn UnitLock>) -> Dial {
    let lookup = Lookup::new(address, lock);
    let mut parity = Parity::Port;
    let mut heard: Option<Arc<Heard>> = None;
    Box::new(move || {
        if heard.take().is_some_and(|heard| !heard.fits()) {
            parity = match parity {
                Parity::Port => Parity::Software,
                Parity::Software => Parity::Port,
            };
        }
        let newest = Arc::new(Heard::default());
        let lookup = lookup.clone();
        let (guess, listener) = (parity, Arc::clone(&newest));
        heard = Some(newest);
        Box::pin(async move {
            let stream = open(&lookup).await?;
            listener.note_open();
            Ok(Box::new(WithParity::new(stream, guess, listener)) as Box<dyn Stream>)
        })
    })
}

/// Connects to a locked address. A second name lookup could return an address without a lock.
async fn open(lookup: &Lookup) -> io::Result<TcpStream> {
    let addresses = lookup.locked_addresses().await?;
    let stream = TcpStream::connect(addresses.as_slice()).await?;
    // STOP must not wait for a fuller packet.
    stream.set_nodelay(true)?;
    Ok(stream)
}
