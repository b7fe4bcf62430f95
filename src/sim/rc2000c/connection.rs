//! One client: commands in, replies out, and what can go wrong on the way.

use std::collections::VecDeque;
use std::io;
use std::time::Duration;

use tokio::io::{AsyncRead, AsyncReadExt, AsyncWrite, AsyncWriteExt};
use tokio::time::{Instant, sleep, sleep_until, timeout};

use super::control::Mood;
use super::{Control, Fault, Quirk};
use crate::protocol::{
    Parity,
    rc2000c::{Address, Decoder, Frame, Header, Reply, checksum},
};

/// A client that takes nothing for this long is given up.
const WRITE_TIMEOUT: Duration = Duration::from_secs(5);
/// With [`Fault::Merge`], replies are gathered for this long.
const MERGE_TIME: Duration = Duration::from_millis(200);
/// With [`Fault::Split`], the pause between two pieces.
const SPLIT_PAUSE: Duration = Duration::from_millis(5);
/// Characters of one command are no farther apart than this, or 20 characters.
const LONGEST_GAP: Duration = Duration::from_millis(100);
const LONGEST_GAP_CHARACTERS: u32 = 20;
/// Replies that may wait; with more, nothing is read.
const MOST_WAITING: usize = 64;
const STX: u8 = 0x02;
const STX_WITH_PARITY: u8 = 0x82;
/// A header, a character of another controller, the beginning of a reply.
const NOISE: &[u8] = b"\x06\x7f\x15\x62\x06";

impl Control {
    /// Serves one client until it leaves, is dropped or stops reading.
    pub async fn serve<S>(&self, stream: S) -> io::Result<()>
    where
        S: AsyncRead + AsyncWrite + Unpin,
    {
        self.connect(stream, false).await
    }

    /// As [`Self::serve`], on a line that has no parity of its own and carries
    /// eight bits: it answers with parity in the eighth when spoken to so.
    #[cfg(unix)]
    pub(super) async fn serve_as_spoken<S>(&self, stream: S) -> io::Result<()>
    where
        S: AsyncRead + AsyncWrite + Unpin,
    {
        self.connect(stream, true).await
    }

    async fn connect<S>(&self, stream: S, is_as_spoken: bool) -> io::Result<()>
    where
        S: AsyncRead + AsyncWrite + Unpin,
    {
        let connection = Connection {
            control: self.clone(),
            stream,
            is_as_spoken,
            heard: Parity::Port,
            decoder: Decoder::new(self.address()),
            last_read: Instant::now(),
            waiting: VecDeque::new(),
            replies: 0,
        };
        connection.run().await
    }
}

struct Connection<S> {
    control: Control,
    stream: S,
    /// Answers with the parity of the last command.
    is_as_spoken: bool,
    heard: Parity,
    decoder: Decoder,
    last_read: Instant,
    /// Characters without parity and when they go out.
    waiting: VecDeque<(Instant, Vec<u8>)>,
    /// How many replies went out or were lost.
    replies: usize,
}

impl<S: AsyncRead + AsyncWrite + Unpin> Connection<S> {
    async fn run(mut self) -> io::Result<()> {
        let mut drops = self.control.drops();
        let mut buffer = [0; 256];
        loop {
            let due = self.waiting.front().map(|(due, _)| *due);
            tokio::select! {
                read = self.stream.read(&mut buffer), if self.waiting.len() < MOST_WAITING => {
                    let count = read?;
                    if count == 0 {
                        return Ok(());
                    }
                    self.take(buffer.get_mut(..count).unwrap_or_default());
                }
                () = sleep_until(due.unwrap_or_else(Instant::now)), if due.is_some() => {
                    timeout(WRITE_TIMEOUT, self.send_due()).await??;
                }
                _ = drops.changed() => return Ok(()),
            }
        }
    }

    /// Carries out what came in. The commands act at once, the replies wait.
    fn take(&mut self, bytes: &mut [u8]) {
        let mood = self.control.mood();
        // The first byte of a command looks different with and without parity.
        if bytes.contains(&STX_WITH_PARITY) {
            self.heard = Parity::Software;
        } else if bytes.contains(&STX) {
            self.heard = Parity::Port;
        }
        self.parity(&mood).check(bytes);
        if mood.quirks.contains(&Quirk::Echo) {
            self.waiting.push_back((Instant::now(), bytes.to_vec()));
        }
        let longest_gap = LONGEST_GAP.max(self.control.character_time() * LONGEST_GAP_CHARACTERS);
        let mut seen = if self.last_read.elapsed() > longest_gap {
            self.decoder.line_is_quiet()
        } else {
            Vec::new()
        };
        self.last_read = Instant::now();
        self.decoder.push(bytes);
        seen.extend(self.decoder.by_ref());
        for frame in seen {
            match frame {
                Ok(frame) if frame.header() == Header::Command => self.carry_out(&frame, &mood),
                // Other controllers on the bus.
                Ok(_) => {}
                // As a real controller: what is broken is not answered.
                Err(error) => tracing::info!(target: "azel::sim", %error, "refused"),
            }
        }
    }

    fn carry_out(&mut self, frame: &Frame, mood: &Mood) {
        let command = frame.to_bytes();
        tracing::info!(target: "azel::sim", frame = %hex(&command), "in");
        let Some(reply) = self.control.answer(frame) else { return };
        self.replies += 1;
        let bytes = reply_bytes(&reply, self.control.address(), self.replies, mood);
        let delay = self.control.reply_delay(command.len() + bytes.len());
        let last_due = self.waiting.back().map(|(due, _)| *due);
        let due = if mood.faults.contains(&Fault::Merge) {
            last_due.unwrap_or_else(|| Instant::now() + MERGE_TIME)
        } else {
            last_due.unwrap_or_else(Instant::now).max(Instant::now()) + delay
        };
        self.waiting.push_back((due, bytes));
    }

    async fn send_due(&mut self) -> io::Result<()> {
        let mood = self.control.mood();
        let mut bytes = Vec::new();
        while let Some((_, reply)) = self.waiting.pop_front_if(|(due, _)| *due <= Instant::now()) {
            tracing::info!(target: "azel::sim", frame = %hex(&reply), "out");
            bytes.extend(reply);
            if !mood.faults.contains(&Fault::Merge) {
                break;
            }
        }
        self.parity(&mood).prepare(&mut bytes);
        let piece = if mood.faults.contains(&Fault::Split) { 7 } else { usize::MAX };
        let mut pieces = bytes.chunks(piece).peekable();
        while let Some(piece) = pieces.next() {
            self.stream.write_all(piece).await?;
            self.stream.flush().await?;
            if pieces.peek().is_some() {
                sleep(SPLIT_PAUSE).await;
            }
        }
        Ok(())
    }

    fn parity(&self, mood: &Mood) -> Parity {
        if mood.quirks.contains(&Quirk::ParityBit) {
            Parity::Software
        } else if self.is_as_spoken {
            self.heard
        } else {
            Parity::Port
        }
    }
}

/// What goes out for the reply with this number, counted from 1.
fn reply_bytes(reply: &Reply, address: Address, number: usize, mood: &Mood) -> Vec<u8> {
    let has = |fault| mood.faults.contains(&fault);
    let is_third = number.is_multiple_of(3);
    if has(Fault::Silence) || has(Fault::DropReply) && is_third {
        return Vec::new();
    }
    let mut frame = reply.to_frame(address).to_bytes();
    if matches!(reply, Reply::DeviceType(_)) && mood.quirks.contains(&Quirk::TypeCode) {
        frame = with_wrong_code(frame);
    }
    if has(Fault::BitError) && is_third {
        let bit = number % (frame.len() * 7);
        if let Some(byte) = frame.get_mut(bit / 7) {
            *byte ^= 1 << (bit % 7);
        }
    }
    if has(Fault::Truncate) && is_third {
        frame.truncate(frame.len() / 2);
    }
    if has(Fault::Garbage) {
        frame.splice(..0, NOISE.iter().copied());
    }
    frame
}

/// The frame with the code of a status, and the checksum for that.
fn with_wrong_code(mut frame: Vec<u8>) -> Vec<u8> {
    frame.pop();
    if let Some(code) = frame.get_mut(2) {
        *code = b'1';
    }
    frame.push(checksum(&frame));
    frame
}

fn hex(bytes: &[u8]) -> String {
    let digits: Vec<String> = bytes.iter().map(|byte| format!("{byte:02X}")).collect();
    digits.join(" ")
}

#[cfg(test)]
mod tests;
