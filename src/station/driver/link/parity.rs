//! Link whose far end is a serial line of seven bits and even parity.

use std::{
    io,
    pin::Pin,
    sync::{
        Arc,
        atomic::{AtomicU8, Ordering},
    },
    task::{Context, Poll, ready},
};

use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};

use super::{Duplicate, Stream};
use crate::protocol::Parity;

/// Max size of a single write, bytes; longer writes are split.
const PIECE: usize = 64;
/// Findings in ascending order; 0 means no finding.
const SILENT: u8 = 1;
const FITS: u8 = 2;
const IS_WRONG: u8 = 3;

/// Finding about the link: do the received bytes fit the assumed parity mode?
#[derive(Debug, Default)]
pub(super) struct Heard(AtomicU8);

impl Heard {
    /// Records that the link is open: from now on, silence is a finding, too.
    pub(super) fn note_open(&self) {
        self.learn(SILENT);
    }

    /// Returns `true` unless a finding contradicts the current parity mode for the next link.
    pub(super) fn fits(&self) -> bool {
        !matches!(self.0.load(Ordering::Relaxed), SILENT | IS_WRONG)
    }

    fn listen(&self, bytes: &[u8]) {
        if !bytes.is_empty() {
            self.learn(if bytes.is_ascii() { FITS } else { IS_WRONG });
        }
    }

    /// Records a finding; keeps the more severe of both.
    fn learn(&self, finding: u8) {
        self.0.fetch_max(finding, Ordering::Relaxed);
    }
}

/// Stream that adds the parity to outgoing bytes and removes it from incoming bytes.
#[derive(Debug)]
pub(super) struct WithParity<S> {
    stream: S,
    parity: Parity,
    heard: Arc<Heard>,
}

impl<S> WithParity<S> {
    pub(super) fn new(stream: S, parity: Parity, heard: Arc<Heard>) -> Self {
        Self { stream, parity, heard }
    }
}

impl<S: Stream> Stream for WithParity<S> {
    fn duplicate(&self) -> io::Result<Option<Duplicate>> {
        self.stream.duplicate()
    }

    fn encode(&self, bytes: &[u8]) -> Vec<u8> {
        let mut prepared = bytes.to_vec();
        self.parity.prepare(&mut prepared);
        self.stream.encode(&prepared)
    }
}

impl<S: AsyncRead + Unpin> AsyncRead for WithParity<S> {
    fn poll_read(
        self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        let port = self.get_mut();
        let before = buffer.filled().len();
        ready!(Pin::new(&mut port.stream).poll_read(context, buffer))?;
        let read = buffer.filled_mut().get_mut(before..).unwrap_or_default();
        port.parity.check(read);
        port.heard.listen(read);
        Poll::Ready(Ok(()))
    }
}

impl<S: AsyncWrite + Unpin> AsyncWrite for WithParity<S> {
    fn poll_write(
        self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        let port = self.get_mut();
        let mut prepared = [0; PIECE];
        let length = bytes.len().min(PIECE);
        for (target, source) in prepared.iter_mut().zip(bytes) {
            *target = *source;
        }
        let piece = prepared.get_mut(..length).unwrap_or_default();
        port.parity.prepare(piece);
        Pin::new(&mut port.stream).poll_write(context, piece)
    }

    fn poll_flush(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.get_mut().stream).poll_flush(context)
    }

    fn poll_shutdown(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.get_mut().stream).poll_shutdown(context)
    }
}

#[cfg(test)]
mod tests {
    use tokio::io::{AsyncReadExt, AsyncWriteExt, duplex};

    use super::*;

    #[tokio::test]
    async fn parity_goes_on_and_comes_off_in_writes_of_any_length() {
        let (near, mut far) = duplex(1024);
        let heard = Arc::new(Heard::default());
        let mut line = WithParity::new(near, Parity::Software, Arc::clone(&heard));
        assert!(heard.fits(), "a link that was never open says nothing");
        heard.note_open();
        assert!(!heard.fits(), "nothing came yet");
        let text: Vec<u8> = (0..0x80).collect();
        line.write_all(&text).await.unwrap();
        let mut wire = vec![0; text.len()];
        far.read_exact(&mut wire).await.unwrap();
        assert!(wire.iter().all(|byte| byte.count_ones().is_multiple_of(2)));
        far.write_all(&wire).await.unwrap();
        let mut back = vec![0; text.len()];
        line.read_exact(&mut back).await.unwrap();
        assert_eq!(back, text);
        assert!(heard.fits());
        far.write_all(b"\x02").await.unwrap();
        assert_eq!(line.read_u8().await.unwrap(), 0xff, "odd parity is no character");
        assert!(!heard.fits());
    }

    #[tokio::test]
    async fn without_parity_of_its_own_bytes_pass_and_an_eighth_bit_is_noticed() {
        let (near, mut far) = duplex(64);
        let heard = Arc::new(Heard::default());
        let mut line = WithParity::new(near, Parity::Port, Arc::clone(&heard));
        line.write_all(b"\x02\x31").await.unwrap();
        let mut wire = [0; 2];
        far.read_exact(&mut wire).await.unwrap();
        assert_eq!(&wire, b"\x02\x31");
        far.write_all(b"\x06\x82\x06").await.unwrap();
        line.read_exact(&mut [0; 3]).await.unwrap();
        assert!(!heard.fits());
        far.write_all(b"\x06").await.unwrap();
        line.read_u8().await.unwrap();
        assert!(!heard.fits(), "what was wrong once stays so");
    }
}
