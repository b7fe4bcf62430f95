//! Client at the other end of an in-memory stream, for the tests of the makes.

use std::time::Duration;

use tokio::{
    io::{AsyncReadExt, AsyncWriteExt, DuplexStream},
    time::timeout,
};

use super::{Control, Unit};

/// Timeout for a reply.
const PATIENCE: Duration = Duration::from_secs(2);

/// Client that reads with the decoder `D`.
pub(in crate::sim) struct Client<D> {
    pub(in crate::sim) stream: DuplexStream,
    pub(in crate::sim) decoder: D,
    push: fn(&mut D, &[u8]),
}

impl<D: Iterator> Client<D> {
    /// Connects a client to a unit; `push` passes received bytes to `decoder`.
    pub(in crate::sim) fn connect<U: Unit>(
        control: &Control<U>,
        decoder: D,
        push: fn(&mut D, &[u8]),
    ) -> Self {
        let (stream, other) = tokio::io::duplex(4096);
        let control = control.clone();
        tokio::spawn(async move { control.serve(other).await });
        Self { stream, decoder, push }
    }

    pub(in crate::sim) async fn write(&mut self, bytes: &[u8]) {
        self.stream.write_all(bytes).await.unwrap();
    }

    /// Returns the next item of the decoder; `None` after 2 s without an item or at the end of the
    /// connection.
    pub(in crate::sim) async fn receive(&mut self) -> Option<D::Item> {
        let mut buffer = [0; 512];
        loop {
            if let Some(found) = self.decoder.next() {
                return Some(found);
            }
            match timeout(PATIENCE, self.stream.read(&mut buffer)).await {
                Ok(Ok(count)) if count > 0 => (self.push)(&mut self.decoder, &buffer[..count]),
                _ => return None,
            }
        }
    }
}
