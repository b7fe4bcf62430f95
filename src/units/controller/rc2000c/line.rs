//! Timing of the line. The vendor documents only the speed; the other values are conservative.

use std::time::Duration;

use crate::{
    device::PROMPT,
    protocol::rc2000c::{Address, MAX_COMMAND_BYTES, MAX_FRAME_BYTES, Request},
};

/// Bits of one character: start, seven data bits, parity, stop.
const BITS_PER_CHARACTER: u32 = 10;
/// Max time that the unit needs in addition to the transmission of the characters.
const LATENCY: Duration = Duration::from_secs(1);
/// Min gap between a reply and the next command.
pub(super) const GAP: Duration = Duration::from_millis(50);
/// Min silence after which Azel gives up an unfinished frame; [`SILENT_CHARACTERS`] applies if that
/// is longer.
const SILENCE: Duration = Duration::from_millis(100);
const SILENT_CHARACTERS: u32 = 20;

#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    character: Duration,
}

impl Line {
    /// Returns a line of `baud` bits a second.
    pub(super) fn new(baud: u32) -> Self {
        Self { character: Duration::from_secs(BITS_PER_CHARACTER.into()) / baud.max(1) }
    }

    /// Returns the max time for the reply to `request`.
    pub(super) fn reply_wait(self, request: &Request) -> Duration {
        LATENCY + self.exchange_of(request)
    }

    /// Returns the max time for the reply to `request` while the antenna moves.
    pub(super) fn prompt(self, request: &Request) -> Duration {
        PROMPT + self.exchange_of(request)
    }

    /// Returns the max time for any reply in normal operation.
    pub(super) fn longest_prompt(self) -> Duration {
        PROMPT + self.exchange()
    }

    /// Returns the max time for any reply.
    pub(super) fn longest_wait(self) -> Duration {
        LATENCY + self.exchange()
    }

    /// Returns the time for a halt, the question after it, and their replies.
    pub(super) fn halt_wait(self) -> Duration {
        LATENCY.max((self.exchange() + GAP) * 2)
    }

    /// Returns the time of a command and its reply on the wire.
    fn exchange_of(self, request: &Request) -> Duration {
        self.time_of(request.to_bytes(Address::FACTORY).len() + request.command().reply_bytes())
    }

    /// Returns the time of the longest command and the longest reply on the wire.
    fn exchange(self) -> Duration {
        self.time_of(MAX_COMMAND_BYTES + MAX_FRAME_BYTES)
    }

    fn time_of(self, characters: usize) -> Duration {
        self.character * u32::try_from(characters).unwrap_or(u32::MAX)
    }

    /// Returns the silence after which no more of a frame will come.
    pub(super) fn silence(self) -> Duration {
        SILENCE.max(self.character * SILENT_CHARACTERS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::rc2000c::Query;

    #[test]
    fn slow_lines_are_waited_for_longer() {
        let status = Request::Query(Query::Status);
        let wait = |baud| Line::new(baud).reply_wait(&status).as_millis();
        // The wait is 43 characters of ten bits, and a second.
        assert_eq!([wait(9600), wait(300)], [1044, 2433]);
        assert_eq!(Line::new(9600).halt_wait(), Duration::from_secs(1));
        assert_eq!(Line::new(300).halt_wait().as_millis(), 3699);
        assert_eq!(Line::new(9600).silence(), Duration::from_millis(100));
        assert_eq!(Line::new(300).silence().as_millis(), 666);
    }
}
