//! Lines on a link, safe to store and show: secrets are removed before a line is recorded.

use std::{borrow::Cow, collections::VecDeque, time::Duration};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::panel::Tone;
use crate::clock::Moment;

/// Max number of pending lines; the queue drops older lines.
const MAX_WAITING: usize = 4096;

/// One line of the traffic with a unit.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct WireLine {
    /// UTC time at which the line was sent, or completely received.
    #[serde(rename = "at")]
    pub time: Timestamp,
    pub direction: Direction,
    /// Bytes of the line with its end, without secrets; at most a kilobyte. Empty for a missing
    /// reply: see [`Finding::NoReply`].
    pub bytes: Box<[u8]>,
    /// Length on the wire, bytes.
    pub length: usize,
    /// `true` if `bytes` is only a part of the line.
    pub is_shortened: bool,
    pub finding: Finding,
    /// Meaning; `None` for a damaged line, or if the make has no words for the line.
    pub meaning: Option<Meaning>,
    /// Time of a reply since its request.
    pub reply_after: Option<Duration>,
    /// `true` if the line belongs to a question that Azel repeats automatically.
    pub is_poll: bool,
}

impl WireLine {
    /// Returns a whole line without further details.
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
    /// Returns the meaning of a plain question or report.
    pub const fn plain(text: &'static str) -> Self {
        Self { tone: Tone::Plain, text: Cow::Borrowed(text) }
    }
}

/// A line split into its values.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Explained {
    /// Name of such a line in the document; `None` if the document has no such line.
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
    /// Line to the unit.
    Sent,
    /// Line from the unit.
    Received,
}

/// Result of checking a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Finding {
    /// A frame with the right checksum.
    Good,
    /// A good frame of a protocol without checksums.
    Unchecked,
    /// A frame whose checksum does not match its payload.
    BadChecksum {
        /// Checksum in the line.
        received: u8,
        /// Checksum of the payload.
        computed: u8,
    },
    /// A frame without a checksum.
    NoChecksum,
    /// A line without even the beginning of a frame.
    NoHeader,
    /// A line that is too long for a frame.
    TooLong,
    /// A line with the right checksum in which some bytes are not text.
    NotText,
    /// A line that the end of the link has cut off.
    Unfinished,
    /// No line: a reply that did not come in time.
    NoReply {
        /// Waiting time for the reply.
        waited: Duration,
        /// `true` if Azel sends the question again.
        is_repeated: bool,
    },
}

impl Finding {
    /// Returns `true` if nothing is wrong with the line.
    pub fn is_good(self) -> bool {
        matches!(self, Self::Good | Self::Unchecked)
    }
}

/// Lines that wait for the session to take them.
#[derive(Debug, Default)]
pub(crate) struct WireQueue(VecDeque<WireLine>);

impl WireQueue {
    pub(crate) fn push(&mut self, line: WireLine) {
        if self.0.len() == MAX_WAITING {
            self.0.pop_front();
        }
        self.0.push_back(line);
    }

    /// Adds a line for a missing reply. `is_repeated` is `true` if Azel sends the question again.
    pub(crate) fn no_reply(&mut self, waited: Duration, is_repeated: bool, now: Moment) {
        let finding = Finding::NoReply { waited, is_repeated };
        self.push(WireLine::new(Direction::Received, &[], finding, now.utc));
    }

    pub(crate) fn pop(&mut self) -> Option<WireLine> {
        self.0.pop_front()
    }
}
