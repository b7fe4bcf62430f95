//! One client: frames in, replies out, and what can go wrong on the way.

use std::collections::VecDeque;
use std::io;
use std::time::Duration;

use tokio::io::{AsyncRead, AsyncReadExt, AsyncWrite, AsyncWriteExt};
use tokio::time::{Instant, sleep, sleep_until, timeout};

use super::control::{Mood, Reply};
use super::{Control, Fault, Quirk};
use crate::protocol::satrak::{Decoder, encode, redact};

/// A client that takes nothing for this long is given up.
const WRITE_TIMEOUT: Duration = Duration::from_secs(5);
/// With [`Fault::Merge`], replies are gathered for this long.
const MERGE_TIME: Duration = Duration::from_millis(100);
/// With [`Fault::Split`], the pause between two pieces.
const SPLIT_PAUSE: Duration = Duration::from_millis(5);
/// Replies that may wait; with more, nothing is read.
const MOST_WAITING: usize = 64;
/// A frame of another product, as in the document's own example.
const UNSOLICITED: &str = "DATETIMEG?=,2016,12,22,15,55,40,10";
const NOISE: &[u8] = b"\x00\xff~garbage\r\n$ST";

impl Control {
    /// Serves one client until it leaves, is dropped or stops reading.
    pub async fn serve<S>(&self, stream: S) -> io::Result<()>
    where
        S: AsyncRead + AsyncWrite + Unpin,
    {
        let connection = Connection {
            control: self.clone(),
            stream,
            decoder: Decoder::new(),
            waiting: VecDeque::new(),
            replies: 0,
        };
        connection.run().await
    }
}

struct Connection<S> {
    control: Control,
    stream: S,
    decoder: Decoder,
    /// Payloads and when they go out.
    waiting: VecDeque<(Instant, String)>,
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
                    timeout(WRITE_TIMEOUT, self.send_due()).await??;
                }
                _ = drops.changed() => return Ok(()),
            }
        }
    }

    /// Carries out what came in. The requests act at once, the replies wait.
    fn take(&mut self, bytes: &[u8]) {
        self.decoder.push(bytes);
        for read in self.decoder.by_ref() {
            match read {
                Ok(frame) => {
                    tracing::info!(target: "azel::sim", payload = %frame.redacted(), "in");
                    let Reply { payload, delay } = self.control.answer(&frame);
                    let last_due = self.waiting.back().map(|(due, _)| *due);
                    let due = if self.control.mood().faults.contains(&Fault::Merge) {
                        last_due.unwrap_or_else(|| Instant::now() + MERGE_TIME)
                    } else {
                        last_due.unwrap_or_else(Instant::now).max(Instant::now()) + delay
                    };
                    self.waiting.push_back((due, payload));
                }
                // As a real unit: what is broken is not answered.
                Err(error) => tracing::info!(target: "azel::sim", %error, "refused"),
            }
        }
    }

    async fn send_due(&mut self) -> io::Result<()> {
        let mood = self.control.mood();
        let mut bytes = Vec::new();
        while let Some((_, payload)) = self.waiting.pop_front_if(|(due, _)| *due <= Instant::now())
        {
            self.replies += 1;
            if mood.faults.contains(&Fault::HangUp) && answers_a_command(&payload) {
                return Err(io::ErrorKind::ConnectionAborted.into());
            }
            bytes.extend(reply_bytes(&payload, self.replies, &mood));
            if !mood.faults.contains(&Fault::Merge) {
                break;
            }
        }
        self.write(&bytes, mood.faults.contains(&Fault::Split)).await
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

/// A query is answered with a question mark behind its word.
fn answers_a_command(payload: &str) -> bool {
    payload.trim_start_matches(|sign| !matches!(sign, '?' | '=')).starts_with('=')
}

/// What goes out for the reply with this number, counted from 1.
fn reply_bytes(payload: &str, number: u64, mood: &Mood) -> Vec<u8> {
    let has = |fault| mood.faults.contains(&fault);
    let is_third = number.is_multiple_of(3);
    if has(Fault::Silence) || has(Fault::DropReply) && is_third {
        return Vec::new();
    }
    tracing::info!(target: "azel::sim", payload = %redact(payload), "out");
    let mut bytes = if has(Fault::Garbage) { NOISE.to_vec() } else { Vec::new() };
    let frame = frame_bytes(payload, &mood.quirks);
    if has(Fault::BadChecksum) && is_third {
        // The digit before the line end, in either case, to another one.
        let from_end = if mood.quirks.contains(&Quirk::LfOnly) { 2 } else { 3 };
        let at = frame.len().saturating_sub(from_end);
        let digit = frame.iter().enumerate();
        bytes.extend(digit.map(|(here, byte)| if here == at { byte ^ 1 } else { *byte }));
    } else {
        bytes.extend(frame);
    }
    if has(Fault::Unsolicited) {
        bytes.extend(frame_bytes(UNSOLICITED, &mood.quirks));
    }
    bytes
}

fn frame_bytes(payload: &str, quirks: &std::collections::BTreeSet<Quirk>) -> Vec<u8> {
    let mut frame = encode(payload);
    if quirks.contains(&Quirk::LowerHex) {
        // Two digits and the line end.
        let digits_at = frame.len().saturating_sub(4);
        frame.iter_mut().skip(digits_at).for_each(u8::make_ascii_lowercase);
    }
    if quirks.contains(&Quirk::LfOnly) {
        frame.retain(|byte| *byte != b'\r');
    }
    frame
}

#[cfg(test)]
mod tests;
