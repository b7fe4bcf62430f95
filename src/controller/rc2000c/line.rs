//! The times of the line. The vendor names none but the speed; these are on the
//! safe side.

use std::time::Duration;

use crate::{
    device::PROMPT,
    protocol::rc2000c::{Address, MAX_COMMAND_BYTES, MAX_FRAME_BYTES, Request},
};

/// Start, seven data bits, parity, stop.
const BITS_PER_CHARACTER: u32 = 10;
/// What the unit may take on top of the time that the characters need.
const LATENCY: Duration = Duration::from_secs(1);
/// Between a reply and the next command.
pub(super) const GAP: Duration = Duration::from_millis(50);
/// A frame whose next character does not come in this time, or in the time of
/// twenty characters, does not go on.
const SILENCE: Duration = Duration::from_millis(100);
const SILENT_CHARACTERS: u32 = 20;

/// A line at its speed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    character: Duration,
}

impl Line {
    /// A line of `baud` bits a second.
    pub(super) fn new(baud: u32) -> Self {
        Self { character: Duration::from_secs(BITS_PER_CHARACTER.into()) / baud.max(1) }
    }

    /// How long the reply to `request` may take.
    pub(super) fn reply_wait(self, request: &Request) -> Duration {
        LATENCY + self.exchange_of(request)
    }

    /// The same while metal moves.
    pub(super) fn prompt(self, request: &Request) -> Duration {
        PROMPT + self.exchange_of(request)
    }

    /// How long any reply takes at most while all is well.
    pub(super) fn longest_prompt(self) -> Duration {
        PROMPT + self.exchange()
    }

    /// How long any reply may take.
    pub(super) fn longest_wait(self) -> Duration {
        LATENCY + self.exchange()
    }

    /// How long a halt and the question after it take with their replies.
    pub(super) fn halt_wait(self) -> Duration {
        LATENCY.max((self.exchange() + GAP) * 2)
    }

    /// A command and its reply on the wire.
    fn exchange_of(self, request: &Request) -> Duration {
        self.time_of(request.to_bytes(Address::FACTORY).len() + request.command().reply_bytes())
    }

    /// The longest command and the longest reply on the wire.
    fn exchange(self) -> Duration {
        self.time_of(MAX_COMMAND_BYTES + MAX_FRAME_BYTES)
    }

    fn time_of(self, characters: usize) -> Duration {
        self.character * u32::try_from(characters).unwrap_or(u32::MAX)
    }

    /// After this long without a character nothing of a frame is to come.
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
        // 43 characters of ten bits, and a second.
        assert_eq!([wait(9600), wait(300)], [1044, 2433]);
        assert_eq!(Line::new(9600).halt_wait(), Duration::from_secs(1));
        assert_eq!(Line::new(300).halt_wait().as_millis(), 3699);
        assert_eq!(Line::new(9600).silence(), Duration::from_millis(100));
        assert_eq!(Line::new(300).silence().as_millis(), 666);
    }
}
