//! Wire of a Rotator Genius: commands in, replies out, and their failures.

use super::{Control, Fault, Quirk, command::CommandReader, unit::RotatorGenius};
use crate::sim::harness::{self, Replies, Wire};

/// Noise that contains pieces of replies.
const NOISE: &[u8] = b"\x00\xff~|A12\r\n|";

type Switches = harness::Switches<Quirk, Fault>;

impl Wire<RotatorGenius> for CommandReader {
    type Reply = Vec<u8>;

    fn take(
        &mut self,
        segment: &mut [u8],
        control: &Control,
        switches: &Switches,
        replies: &mut Replies<Vec<u8>>,
    ) {
        for command in self.read(segment, &switches.quirks) {
            let text = latin_1(&command);
            tracing::info!(target: "azel::sim", command = text, "in");
            let reply = control.carry_out(text, |unit| unit.answer(&command, &switches.quirks));
            if let Some(reply) = reply {
                replies.push(reply, control.reply_delay());
            }
        }
    }

    fn put(&mut self, reply: Vec<u8>, number: u64, switches: &Switches) -> Option<Vec<u8>> {
        let is_third = number.is_multiple_of(3);
        if switches.has_fault(Fault::HangUp) && is_third {
            return None;
        }
        let is_lost = switches.has_fault(Fault::DropReply) && is_third;
        if switches.has_fault(Fault::Silence) || is_lost {
            return Some(Vec::new());
        }
        tracing::info!(target: "azel::sim", reply = latin_1(&reply), "out");
        let noise = if switches.has_fault(Fault::Garbage) { NOISE } else { &[] };
        Some([noise, &reply].concat())
    }
}

/// Returns `bytes` as Latin-1 text, for logs and tests.
fn latin_1(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| char::from(*byte)).collect()
}

#[cfg(test)]
mod tests;
