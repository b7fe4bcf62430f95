//! Links over TCP.

use std::{io, sync::Arc};

use tokio::net::TcpStream;

use super::{
    Dial, Duplicate, Stream, UnitLock, duplicate_of,
    endpoint::Lookup,
    parity::{Heard, WithParity},
};
use crate::protocol::Parity;

impl Stream for TcpStream {
    fn duplicate(&self) -> io::Result<Option<Duplicate>> {
        duplicate_of(self)
    }
}

/// Opens TCP links to `address` (host and port), once `lock` has all that the address leads to.
pub(super) fn dial_tcp(address: &str, lock: Arc<dyn UnitLock>) -> Dial {
    let lookup = Lookup::new(address, lock);
    Box::new(move || {
        let lookup = lookup.clone();
        Box::pin(async move { Ok(Box::new(open(&lookup).await?) as Box<dyn Stream>) })
    })
}

/// Opens links to the serial server at `address`.
///
/// A server set to seven bits and even parity adds the parity; one set to eight bits passes
/// bytes on, and this end must add it. A wrong guess shows in a unit that stays silent or
/// sends the eighth bit. After a link on which nothing fitted, the next one uses the other
/// guess.
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
            listener.opened();
            Ok(Box::new(WithParity::new(stream, guess, listener)) as Box<dyn Stream>)
        })
    })
}

/// Connects to a locked address. Looking the name up again could lead to one that is not locked.
async fn open(lookup: &Lookup) -> io::Result<TcpStream> {
    let addresses = lookup.locked_addresses().await?;
    let stream = TcpStream::connect(addresses.as_slice()).await?;
    // A STOP must not wait for a fuller packet.
    stream.set_nodelay(true)?;
    Ok(stream)
}
