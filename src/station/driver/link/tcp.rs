//! Links over TCP.

use std::{io, sync::Arc};

use tokio::net::TcpStream;

use super::{
    Dial, Duplicate, Stream, duplicate_of,
    parity::{Heard, WithParity},
};
use crate::protocol::Parity;

impl Stream for TcpStream {
    fn duplicate(&self) -> io::Result<Option<Duplicate>> {
        duplicate_of(self)
    }
}

/// Opens TCP links to `address` (host and port).
pub fn dial_tcp(address: String) -> Dial {
    Box::new(move || {
        let address = address.clone();
        Box::pin(async move { Ok(Box::new(open(&address).await?) as Box<dyn Stream>) })
    })
}

/// Opens links to the serial server at `address`.
///
/// A server set to seven bits and even parity adds the parity; one set to eight bits passes
/// bytes on, and this end must add it. A wrong guess shows in a unit that stays silent or
/// sends the eighth bit. After a link on which nothing fitted, the next one uses the other
/// guess.
pub(super) fn dial_line_server(address: String) -> Dial {
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
        let address = address.clone();
        let (guess, listener) = (parity, Arc::clone(&newest));
        heard = Some(newest);
        Box::pin(async move {
            let stream = open(&address).await?;
            listener.opened();
            Ok(Box::new(WithParity::new(stream, guess, listener)) as Box<dyn Stream>)
        })
    })
}

async fn open(address: &str) -> io::Result<TcpStream> {
    let stream = TcpStream::connect(address).await?;
    // A STOP must not wait for a fuller packet.
    stream.set_nodelay(true)?;
    Ok(stream)
}
