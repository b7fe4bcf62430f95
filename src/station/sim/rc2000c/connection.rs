//! Wire of an RC2000C: commands in, replies out, and their failures.

use std::{ops::RangeInclusive, time::Duration};

use super::{Control, Fault, Quirk, unit::Rc2000c};
use crate::{
    clock::Instant,
    protocol::{
        Parity,
        rc2000c::{Address, Decoder, Frame, Header, Reply, checksum},
    },
    sim::harness::{self, Replies, Wire},
};

/// Max time between characters of one command, unless 20 characters take longer.
const LONGEST_GAP: Duration = Duration::from_millis(100);
const LONGEST_GAP_CHARACTERS: u32 = 20;
const STX: u8 = 0x02;
const STX_WITH_PARITY: u8 = 0x82;
/// Noise: a header, a character of another unit, and the start of a reply.
const NOISE: &[u8] = b"\x06\x7f\x15\x62\x06";

type Switches = harness::Switches<Quirk, Fault>;

/// Serial line of one client.
#[derive(Debug)]
pub struct Line {
    address: Address,
    /// Transmission time of a character of ten bits.
    character_time: Duration,
    /// `true` if answers take the parity of the last command.
    is_as_spoken: bool,
    heard: Parity,
    decoder: Decoder,
    last_read: Option<Instant>,
    /// Number of replies, including lost ones.
    replies: usize,
}

impl Line {
    pub(super) fn new(address: Address, baud: u32) -> Self {
        Self {
            address,
            character_time: Duration::from_secs(10) / baud,
            is_as_spoken: false,
            heard: Parity::Port,
            decoder: Decoder::new(address),
            last_read: None,
            replies: 0,
        }
    }

    /// Returns a line of eight bits without its own parity. It answers with parity in the eighth
    /// bit if the client uses such parity.
    #[cfg(unix)]
    pub(super) fn answering_as_spoken(self) -> Self {
        Self { is_as_spoken: true, ..self }
    }

    fn carry_out(
        &mut self,
        frame: &Frame,
        control: &Control,
        switches: &Switches,
        replies: &mut Replies<Vec<u8>>,
    ) {
        let command = frame.to_bytes();
        tracing::info!(target: "azel::sim", frame = %hex(&command), "in");
        let reply = control.carry_out(frame.clone(), |unit| unit.answer(frame));
        let Some(reply) = reply else { return };
        self.replies += 1;
        let bytes = reply_bytes(&reply, self.address, self.replies, switches);
        let characters = u32::try_from(command.len() + bytes.len()).unwrap_or(u32::MAX);
        replies.push(bytes, control.reply_delay() + self.character_time * characters);
    }

    fn parity(&self, switches: &Switches) -> Parity {
        if switches.has_quirk(Quirk::ParityBit) {
            Parity::Software
        } else if self.is_as_spoken {
            self.heard
        } else {
            Parity::Port
        }
    }
}

impl Wire<Rc2000c> for Line {
    /// Characters of a reply, without parity.
    type Reply = Vec<u8>;

    const MERGE_TIME: Duration = Duration::from_millis(200);
    const PIECE_BYTES: RangeInclusive<u64> = 7..=7;

    fn take(
        &mut self,
        bytes: &mut [u8],
        control: &Control,
        switches: &Switches,
        replies: &mut Replies<Vec<u8>>,
    ) {
        // The first byte of a command differs with and without parity.
        if bytes.contains(&STX_WITH_PARITY) {
            self.heard = Parity::Software;
        } else if bytes.contains(&STX) {
            self.heard = Parity::Port;
        }
        self.parity(switches).check(bytes);
        if switches.has_quirk(Quirk::Echo) {
            replies.push_now(bytes.to_vec());
        }
        let longest_gap = LONGEST_GAP.max(self.character_time * LONGEST_GAP_CHARACTERS);
        let now = control.clock().now().steady;
        let is_quiet = self.last_read.is_some_and(|last| now - last > longest_gap);
        let mut frames = if is_quiet { self.decoder.line_is_quiet() } else { Vec::new() };
        self.last_read = Some(now);
        self.decoder.push(bytes);
        frames.extend(self.decoder.by_ref());
        for frame in frames {
            match frame {
                Ok(frame) if frame.header() == Header::Command => {
                    self.carry_out(&frame, control, switches, replies);
                }
                // The frame is for another unit on the bus.
                Ok(_) => {}
                // A real unit also ignores a broken command.
                Err(error) => tracing::info!(target: "azel::sim", %error, "refused"),
            }
        }
    }

    fn put(&mut self, mut reply: Vec<u8>, _number: u64, switches: &Switches) -> Option<Vec<u8>> {
        tracing::info!(target: "azel::sim", frame = %hex(&reply), "out");
        self.parity(switches).prepare(&mut reply);
        Some(reply)
    }
}

/// Returns the bytes of reply `number`, counted from 1.
fn reply_bytes(reply: &Reply, address: Address, number: usize, switches: &Switches) -> Vec<u8> {
    let has = |fault| switches.has_fault(fault);
    let is_third = number.is_multiple_of(3);
    if has(Fault::Silence) || has(Fault::DropReply) && is_third {
        return Vec::new();
    }
    let mut frame = reply.to_frame(address).to_bytes();
    if matches!(reply, Reply::DeviceType(_)) && switches.has_quirk(Quirk::TypeCode) {
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

/// Returns the frame with a status's command code and a matching checksum.
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
