//! What goes over a link, line by line, fit to be kept and shown: secrets are
//! left out before a line gets here.

use std::{collections::VecDeque, time::Duration};

use jiff::Timestamp;

/// How many lines wait to be taken; beyond it the oldest go.
const MOST_WAITING: usize = 4096;

/// One line of the conversation with a device.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WireLine {
    /// When it was sent or had come in whole, UTC.
    pub at: Timestamp,
    /// Which way it went.
    pub direction: Direction,
    /// As it went, with its end, but without secrets; at most a kilobyte.
    /// Empty when nothing went: see [`Finding::NoReply`].
    pub bytes: Box<[u8]>,
    /// How many bytes it had on the wire.
    pub length: usize,
    /// Something was left out of `bytes`.
    pub is_shortened: bool,
    /// What was found in it.
    pub finding: Finding,
    /// For a reply: how long after its request.
    pub reply_after: Option<Duration>,
    /// It belongs to a question that is asked again and again by itself.
    pub is_poll: bool,
}

/// Which way a line went.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// To the device.
    Sent,
    /// From the device.
    Received,
}

/// What was found in a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Finding {
    /// A frame whose checksum is right.
    Good,
    /// A good frame of a protocol without checksums, and what it says.
    Known(&'static str),
    /// A frame with another checksum than that of its payload.
    BadChecksum {
        /// As in the line.
        received: u8,
        /// Of the payload.
        computed: u8,
    },
    /// A frame without a checksum.
    NoChecksum,
    /// Nothing that begins like a frame.
    NoHeader,
    /// Too long to be a frame.
    TooLong,
    /// The checksum is right, but there are bytes that are no text.
    NotText,
    /// The link ended before the line did.
    Unfinished,
    /// No line: a reply did not come in time.
    NoReply {
        /// How long it was waited for.
        waited: Duration,
        /// The question is sent a second time.
        is_repeated: bool,
    },
}

impl Finding {
    /// Nothing is wrong with the line.
    pub fn is_good(self) -> bool {
        matches!(self, Self::Good | Self::Known(_))
    }
}

/// Lines that wait for the session to take them.
#[derive(Debug, Default)]
pub(crate) struct WireQueue(VecDeque<WireLine>);

impl WireQueue {
    /// Adds the newest.
    pub(crate) fn push(&mut self, line: WireLine) {
        if self.0.len() == MOST_WAITING {
            self.0.pop_front();
        }
        self.0.push_back(line);
    }

    /// Takes the oldest.
    pub(crate) fn pop(&mut self) -> Option<WireLine> {
        self.0.pop_front()
    }
}
