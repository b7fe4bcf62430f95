//! What goes over a link, line by line, fit to be kept and shown: secrets are
//! left out before a line gets here.

use std::{borrow::Cow, collections::VecDeque, time::Duration};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::panel::Tone;
use crate::clock::Moment;

/// How many lines wait to be taken; beyond it the oldest go.
const MAX_WAITING: usize = 4096;

/// One line of the conversation with a device.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
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
    /// What it says; `None` where it is damaged, or the make has no words for it.
    pub meaning: Option<Meaning>,
    /// For a reply: how long after its request.
    pub reply_after: Option<Duration>,
    /// It belongs to a question that is asked again and again by itself.
    pub is_poll: bool,
}

impl WireLine {
    /// A whole line of which nothing more is known.
    pub(crate) fn new(direction: Direction, bytes: &[u8], finding: Finding, at: Timestamp) -> Self {
        Self {
            at,
            direction,
            bytes: bytes.into(),
            length: bytes.len(),
            is_shortened: false,
            finding,
            meaning: None,
            reply_after: None,
            is_poll: false,
        }
    }
}

/// What a line says, in a sentence.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Meaning {
    /// How it is to be taken.
    pub tone: Tone,
    /// The sentence, without a full stop.
    pub text: Cow<'static, str>,
}

impl Meaning {
    /// Something is asked or told.
    pub const fn plain(text: &'static str) -> Self {
        Self { tone: Tone::Plain, text: Cow::Borrowed(text) }
    }
}

/// A line taken apart.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Explained {
    /// What the document calls such a line; `None` where it is not in there.
    pub name: Option<&'static str>,
    /// In the order of the line.
    pub values: Vec<ExplainedValue>,
}

/// One value of a line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExplainedValue {
    /// Its place among the values of the line, counted from 1.
    pub number: usize,
    /// What it is.
    pub name: &'static str,
    /// As it stands in the line, blanks around it removed.
    pub raw: String,
    /// Unit of a number; empty for other values.
    pub unit: &'static str,
    /// What a code stands for; empty for a number or a text.
    pub stands_for: &'static str,
}

/// Which way a line went.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Direction {
    /// To the device.
    Sent,
    /// From the device.
    Received,
}

/// What was found in a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Finding {
    /// A frame whose checksum is right.
    Good,
    /// A good frame of a protocol without checksums.
    Unchecked,
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
        matches!(self, Self::Good | Self::Unchecked)
    }
}

/// Lines that wait for the session to take them.
#[derive(Debug, Default)]
pub(crate) struct WireQueue(VecDeque<WireLine>);

impl WireQueue {
    /// Adds the newest.
    pub(crate) fn push(&mut self, line: WireLine) {
        if self.0.len() == MAX_WAITING {
            self.0.pop_front();
        }
        self.0.push_back(line);
    }

    /// A reply is missing, and the question goes out again or is given up.
    pub(crate) fn no_reply(&mut self, waited: Duration, is_repeated: bool, now: Moment) {
        let finding = Finding::NoReply { waited, is_repeated };
        self.push(WireLine::new(Direction::Received, &[], finding, now.utc));
    }

    /// Takes the oldest.
    pub(crate) fn pop(&mut self) -> Option<WireLine> {
        self.0.pop_front()
    }
}
