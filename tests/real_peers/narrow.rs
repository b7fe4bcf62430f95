//! Link that breaks or stalls after a number of bytes from the client.

use std::{
    io::{Read as _, Write as _},
    net::{Shutdown, SocketAddr, TcpListener, TcpStream},
    sync::mpsc,
    thread,
};

/// Behaviour after the last byte that goes through.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Then {
    /// Close of both ends.
    Cut,
    /// Silence on a link that stays open.
    Stall,
}

/// Relay to another address.
pub(crate) struct Narrow {
    address: SocketAddr,
    /// Sender that drops at the end of the test, which also ends a stalled link.
    _ends: mpsc::SyncSender<()>,
}

impl Narrow {
    /// Starts a relay that lets `bytes` from the client through to `peer`.
    pub(crate) fn new(peer: SocketAddr, bytes: usize, then: Then) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap();
        let (ends, ended) = mpsc::sync_channel(0);
        let link = move || {
            let (client, _) = listener.accept().unwrap();
            let server = TcpStream::connect(peer).unwrap();
            let (mut answers, mut back) =
                (server.try_clone().unwrap(), client.try_clone().unwrap());
            let answer = move || {
                // The copy ends with either side.
                let _ = std::io::copy(&mut answers, &mut back);
            };
            thread::Builder::new().name("answers".to_owned()).spawn(answer).unwrap();
            pass(&client, &server, bytes);
            if then == Then::Stall {
                // The channel never carries a message; it closes with the test.
                let _ = ended.recv();
            }
            for end in [client, server] {
                // The connection may be closed already.
                let _ = end.shutdown(Shutdown::Both);
            }
        };
        thread::Builder::new().name("link".to_owned()).spawn(link).unwrap();
        Self { address, _ends: ends }
    }

    pub(crate) fn address(&self) -> SocketAddr {
        self.address
    }
}

fn pass(mut from: &TcpStream, mut to: &TcpStream, most: usize) {
    let mut left = most;
    let mut buffer = [0; 4096];
    while left > 0 {
        let want = left.min(buffer.len());
        let Ok(count @ 1..) = from.read(&mut buffer[..want]) else { return };
        if to.write_all(&buffer[..count]).is_err() {
            return;
        }
        left -= count;
    }
}
