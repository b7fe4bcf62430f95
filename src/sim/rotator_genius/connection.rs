//! One client: commands in, replies out, and what can go wrong on the way.

use std::collections::{BTreeSet, VecDeque};
use std::io;
use std::ops::ControlFlow;
use std::time::Duration;

use tokio::io::{AsyncRead, AsyncReadExt, AsyncWrite, AsyncWriteExt};
use tokio::time::{Instant, sleep, sleep_until, timeout};

use super::command::CommandReader;
use super::control::{Reply, latin_1};
use super::{Control, Fault};

/// A client that takes nothing for this long is given up.
const WRITE_TIMEOUT: Duration = Duration::from_secs(5);
/// With [`Fault::Merge`], replies are gathered for this long.
const MERGE_TIME: Duration = Duration::from_millis(100);
/// With [`Fault::Split`], the pause between two pieces.
const SPLIT_PAUSE: Duration = Duration::from_millis(5);
/// Replies that may wait; with more, nothing is read.
const MOST_WAITING: usize = 64;
/// Holds pieces that look like replies.
const NOISE: &[u8] = b"\x00\xff~|A12\r\n|";

impl Control {
    /// Serves one client until it leaves, is dropped or stops reading.
    pub async fn serve<S>(&self, stream: S) -> io::Result<()>
    where
        S: AsyncRead + AsyncWrite + Unpin,
    {
        let connection = Connection {
            control: self.clone(),
            stream,
            reader: CommandReader::default(),
            waiting: VecDeque::new(),
            replies: 0,
        };
        connection.run().await
    }
}

struct Connection<S> {
    control: Control,
    stream: S,
    reader: CommandReader,
    /// Replies and when they go out.
    waiting: VecDeque<(Instant, Vec<u8>)>,
    /// How many replies went out or were lost.
    replies: u64,
}

impl<S: AsyncRead + AsyncWrite + Unpin> Connection<S> {
    async fn run(mut self) -> io::Result<()> {
        let mut drops = self.control.drops();
        let mut buffer = [0; 1024];
        loop {
            let due = self.waiting.front().map(|(due, _)| *due);
            tokio::select! {
                read = self.stream.read(&mut buffer), if self.waiting.len() < MOST_WAITING => {
                    let count = read?;
                    if count == 0 {
                        return Ok(());
                    }
                    self.take(buffer.get(..count).unwrap_or_default());
                }
                () = sleep_until(due.unwrap_or_else(Instant::now)), if due.is_some() => {
                    if timeout(WRITE_TIMEOUT, self.send_due()).await??.is_break() {
                        return Ok(());
                    }
                }
                _ = drops.changed() => return Ok(()),
            }
        }
    }

    /// Carries out what came in. The commands act at once, the replies wait.
    fn take(&mut self, segment: &[u8]) {
        for command in self.reader.read(segment, &self.control.quirks()) {
            tracing::info!(target: "azel::sim", command = latin_1(&command), "in");
            let Some(Reply { bytes, delay }) = self.control.answer(&command) else { continue };
            let last_due = self.waiting.back().map(|(due, _)| *due);
            let due = if self.control.faults().contains(&Fault::Merge) {
                last_due.unwrap_or_else(|| Instant::now() + MERGE_TIME)
            } else {
                last_due.unwrap_or_else(Instant::now).max(Instant::now()) + delay
            };
            self.waiting.push_back((due, bytes));
        }
    }

    async fn send_due(&mut self) -> io::Result<ControlFlow<()>> {
        let faults = self.control.faults();
        let mut bytes = Vec::new();
        while let Some((_, reply)) = self.waiting.pop_front_if(|(due, _)| *due <= Instant::now()) {
            self.replies += 1;
            if faults.contains(&Fault::HangUp) && self.replies.is_multiple_of(3) {
                return Ok(ControlFlow::Break(()));
            }
            bytes.extend(reply_bytes(&reply, self.replies, &faults));
            if !faults.contains(&Fault::Merge) {
                break;
            }
        }
        self.write(&bytes, faults.contains(&Fault::Split)).await?;
        Ok(ControlFlow::Continue(()))
    }

    async fn write(&mut self, mut bytes: &[u8], is_split: bool) -> io::Result<()> {
        while !bytes.is_empty() {
            let count = if is_split { self.control.random(1, 8) } else { u64::MAX };
            let count = usize::try_from(count).unwrap_or(usize::MAX).min(bytes.len());
            let (piece, rest) = bytes.split_at_checked(count).unwrap_or((bytes, &[]));
            self.stream.write_all(piece).await?;
            self.stream.flush().await?;
            bytes = rest;
            if !bytes.is_empty() {
                sleep(SPLIT_PAUSE).await;
            }
        }
        Ok(())
    }
}

/// What goes out for the reply with this number, counted from 1.
fn reply_bytes(reply: &[u8], number: u64, faults: &BTreeSet<Fault>) -> Vec<u8> {
    let is_lost = faults.contains(&Fault::DropReply) && number.is_multiple_of(3);
    if faults.contains(&Fault::Silence) || is_lost {
        return Vec::new();
    }
    tracing::info!(target: "azel::sim", reply = latin_1(reply), "out");
    let noise = if faults.contains(&Fault::Garbage) { NOISE } else { &[] };
    [noise, reply].concat()
}

#[cfg(test)]
mod tests;
