//! Wire of a Satrak: frames in, replies out, and their failures.

use std::collections::BTreeSet;

use super::{Control, Fault, Quirk, folder, unit::Satrak};
use crate::{
    protocol::satrak::{Decoder, Frame, encode, redact},
    sim::harness::{self, Replies, Wire},
};

/// Frame of another product, from the document's own example.
const UNSOLICITED: &str = "DATETIMEG?=,2016,12,22,15,55,40,10";
const NOISE: &[u8] = b"\x00\xff~garbage\r\n$ST";

type Switches = harness::Switches<Quirk, Fault>;

impl Wire<Satrak> for Decoder {
    /// Payload of a reply.
    type Reply = String;

    fn take(
        &mut self,
        bytes: &mut [u8],
        control: &Control,
        switches: &Switches,
        replies: &mut Replies<String>,
    ) {
        self.push(bytes);
        for read in self {
            match read {
                Ok(frame) => {
                    tracing::info!(target: "azel::sim", payload = %frame.redacted(), "in");
                    let payload = answer(&frame, control, switches);
                    replies.push(payload, control.reply_delay());
                }
                // A real unit also ignores a broken frame.
                Err(error) => tracing::info!(target: "azel::sim", %error, "refused"),
            }
        }
    }

    fn put(&mut self, payload: String, number: u64, switches: &Switches) -> Option<Vec<u8>> {
        if switches.has_fault(Fault::HangUp) && answers_a_command(&payload) {
            return None;
        }
        Some(reply_bytes(&payload, number, switches))
    }
}

fn answer(frame: &Frame, control: &Control, switches: &Switches) -> String {
    control.carry_out(frame.redacted().into_owned(), |unit| {
        if folder::is_about_a_file(frame)
            && let Some(folder) = &unit.element_folder
        {
            unit.take_files(folder::read(folder));
        }
        unit.answer(frame).payload(&switches.quirks)
    })
}

/// Returns `true` if the payload answers a command. An answer to a query has a question mark after
/// the word.
fn answers_a_command(payload: &str) -> bool {
    payload.trim_start_matches(|sign| !matches!(sign, '?' | '=')).starts_with('=')
}

/// Returns the bytes of reply `number`, counted from 1.
fn reply_bytes(payload: &str, number: u64, switches: &Switches) -> Vec<u8> {
    let has = |fault| switches.has_fault(fault);
    let is_third = number.is_multiple_of(3);
    if has(Fault::Silence) || has(Fault::DropReply) && is_third {
        return Vec::new();
    }
    tracing::info!(target: "azel::sim", payload = %redact(payload), "out");
    let mut bytes = if has(Fault::Garbage) { NOISE.to_vec() } else { Vec::new() };
    let frame = frame_bytes(payload, &switches.quirks);
    if has(Fault::BadChecksum) && is_third {
        // Change the digit before the line end, in either case.
        let from_end = if switches.has_quirk(Quirk::LfOnly) { 2 } else { 3 };
        let index = frame.len().saturating_sub(from_end);
        let digit = frame.iter().enumerate();
        bytes.extend(digit.map(|(here, byte)| if here == index { byte ^ 1 } else { *byte }));
    } else {
        bytes.extend(frame);
    }
    if has(Fault::Unsolicited) {
        bytes.extend(frame_bytes(UNSOLICITED, &switches.quirks));
    }
    bytes
}

fn frame_bytes(payload: &str, quirks: &BTreeSet<Quirk>) -> Vec<u8> {
    let mut frame = encode(payload);
    if quirks.contains(&Quirk::LowerHex) {
        // Start at the two digits before the line end.
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
