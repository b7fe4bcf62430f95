//! Lines on a link, fit to be stored and shown: secrets are removed before a line gets
//! here.

use std::{borrow::Cow, collections::VecDeque, time::Duration};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::panel::Tone;
use crate::clock::Moment;

/// Maximum number of lines that wait; beyond it the oldest are dropped.
const MAX_WAITING: usize = 4096;

/// One line of the traffic with a unit.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct WireLine {
    /// UTC when it was sent, or received in whole.
    #[serde(rename = "at")]
    pub time: Timestamp,
    pub direction: Direction,
    /// Bytes of the line with its end, without secrets; at most a kilobyte. Empty when no
    /// reply came: see [`Finding::NoReply`].
    pub bytes: Box<[u8]>,
    /// Length on the wire, bytes.
    pub length: usize,
    /// `bytes` is not the whole line.
    pub is_shortened: bool,
    pub finding: Finding,
    /// `None` where the line is damaged, or the make has no words for it.
    pub meaning: Option<Meaning>,
    /// For a reply: time since its request.
    pub reply_after: Option<Duration>,
    /// The line belongs to a question that is repeated automatically.
    pub is_poll: bool,
}

impl WireLine {
    /// A whole line without further details.
    pub fn new(direction: Direction, bytes: &[u8], finding: Finding, time: Timestamp) -> Self {
        Self {
            time,
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

    /// Returns `true` for a routine question or answer with nothing unusual in it.
    pub fn is_routine_poll(&self) -> bool {
        let is_calm = |meaning: &Meaning| matches!(meaning.tone, Tone::Plain | Tone::Good);
        self.is_poll && self.finding.is_good() && self.meaning.as_ref().is_none_or(is_calm)
    }
}

/// Meaning of a line, as a sentence.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Meaning {
    pub tone: Tone,
    /// A sentence without a full stop.
    pub text: Cow<'static, str>,
}

impl Meaning {
    /// A plain question or report.
    pub const fn plain(text: &'static str) -> Self {
        Self { tone: Tone::Plain, text: Cow::Borrowed(text) }
    }
}

/// A line split into its values.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Explained {
    /// Name of such a line in the document; `None` where it is not in there.
    pub name: Option<&'static str>,
    /// Values in the order of the line.
    pub values: Vec<ExplainedValue>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExplainedValue {
    /// Place among the values of the line, counted from 1.
    pub number: usize,
    pub name: &'static str,
    /// Text in the line, without blanks around it.
    pub raw: String,
    /// Unit of a number; empty for other values.
    pub unit: &'static str,
    /// Meaning of a code; empty for a number or a text.
    pub stands_for: &'static str,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Direction {
    /// To the unit.
    Sent,
    /// From the unit.
    Received,
}

/// Result of checking a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Finding {
    /// A frame with the right checksum.
    Good,
    /// A good frame of a protocol without checksums.
    Unchecked,
    /// A frame whose checksum is not that of its payload.
    BadChecksum {
        /// Checksum in the line.
        received: u8,
        /// Checksum of the payload.
        computed: u8,
    },
    /// A frame without a checksum.
    NoChecksum,
    /// Not even the beginning of a frame.
    NoHeader,
    /// Too long for a frame.
    TooLong,
    /// The checksum is right, but some bytes are not text.
    NotText,
    /// The link ended before the line did.
    Unfinished,
    /// No line: a reply did not come in time.
    NoReply {
        /// Waiting time for the reply.
        waited: Duration,
        /// The question is sent a second time.
        is_repeated: bool,
    },
}

impl Finding {
    /// Returns `true` if nothing is wrong with the line.
    pub fn is_good(self) -> bool {
        matches!(self, Self::Good | Self::Unchecked)
    }
}

/// Lines that wait for the session.
#[derive(Debug, Default)]
pub(crate) struct WireQueue(VecDeque<WireLine>);

impl WireQueue {
    pub(crate) fn push(&mut self, line: WireLine) {
        if self.0.len() == MAX_WAITING {
            self.0.pop_front();
        }
        self.0.push_back(line);
    }

    /// Adds a line for a missing reply. `is_repeated`: the question goes out again.
    pub(crate) fn no_reply(&mut self, waited: Duration, is_repeated: bool, now: Moment) {
        let finding = Finding::NoReply { waited, is_repeated };
        self.push(WireLine::new(Direction::Received, &[], finding, now.utc));
    }

    pub(crate) fn pop(&mut self) -> Option<WireLine> {
        self.0.pop_front()
    }
}
