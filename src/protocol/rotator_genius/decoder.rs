//! From a byte stream to replies.

use std::collections::VecDeque;

use super::layout::Shape;
use super::reply::{Start, acknowledgement};
use super::{Layout, Reply, Status};

/// Longest run of unknown bytes that is reported in one piece.
pub const MAX_NOISE_BYTES: usize = 256;
/// What may wait between two calls; more is lost. 56 status replies.
const MAX_PENDING_BYTES: usize = 4096;

/// What was found in a stream.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Received {
    Reply(Reply),
    /// Bytes that are no reply, 1 to [`MAX_NOISE_BYTES`]. The reader has found
    /// its place again behind them.
    Noise(Vec<u8>),
    /// The status has another form than the ones before it. It is given up and
    /// comes as noise; the next one in this form is taken.
    LayoutChanged(Layout),
    /// The stream began with `V` and a digit, as that of other products of the
    /// maker, which then ask for a code.
    OtherProtocol,
}

/// Cuts a byte stream into replies.
///
/// Push what was read, then take until `None`. The stream may be cut and merged
/// anywhere. Say [`Self::idle`] when nothing came for a while. Holds at most 4 KiB.
#[derive(Debug, Default)]
pub struct Decoder {
    pending: VecDeque<u8>,
    /// Bytes were lost after the end of `pending`.
    has_overflowed: bool,
    /// Bytes in front of `pending` that are no reply.
    noise: Vec<u8>,
    /// The first bytes of the stream are behind us.
    has_begun: bool,
    /// The form of the last status.
    layout: Option<Layout>,
}

/// What stands at the beginning of the pending bytes.
enum Front {
    Reply(Reply, usize),
    OtherProtocol,
    LayoutChanged(Layout),
    Noise,
    /// More bytes are needed to tell.
    Unfinished {
        /// How many, when it is a status that lacks nothing but the end of its
        /// last name.
        missing_of_name: Option<usize>,
    },
}

impl Decoder {
    /// A decoder at the start of a stream.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes bytes of the stream. What does not fit while nobody takes replies
    /// is lost, and the reply that it cuts with it.
    pub fn push(&mut self, bytes: &[u8]) {
        if self.has_overflowed {
            return;
        }
        let room = MAX_PENDING_BYTES.saturating_sub(self.pending.len());
        self.has_overflowed = bytes.len() > room;
        self.pending.extend(bytes.iter().take(room));
    }

    /// How many bytes wait for the rest of their reply.
    pub fn unfinished_bytes(&self) -> usize {
        self.pending.len()
    }

    /// Ends what is unfinished, when nothing came for a while: 250 ms are plenty.
    /// Gives what is left.
    ///
    /// A status that lacks only the end of the last name is completed with blanks.
    /// Everything else is noise, so that no reply is made of two halves.
    pub fn idle(&mut self) -> Vec<Received> {
        let mut seen: Vec<_> = self.by_ref().collect();
        if let Front::Unfinished { missing_of_name: Some(missing) } = self.front() {
            self.pending.extend(std::iter::repeat_n(b' ', missing));
        }
        seen.extend(self.by_ref());
        while !self.pending.is_empty() {
            self.give_up_one();
            seen.extend(self.by_ref());
        }
        if !self.noise.is_empty() {
            seen.push(self.take_noise());
        }
        seen
    }

    fn front(&mut self) -> Front {
        const UNFINISHED: Front = Front::Unfinished { missing_of_name: None };
        let is_first = !self.has_begun;
        let bytes: &[u8] = self.pending.make_contiguous();
        match bytes {
            [b'V'] if is_first => UNFINISHED,
            [b'V', digit, ..] if is_first && digit.is_ascii_digit() => Front::OtherProtocol,
            [b'|', b'h', ..] => match Shape::decide(bytes) {
                Start::Unfinished => UNFINISHED,
                Start::Unknown => Front::Noise,
                Start::Whole(shape, length) => status(shape, bytes, length, self.layout),
            },
            _ => match acknowledgement(bytes) {
                Start::Unfinished => UNFINISHED,
                Start::Unknown => Front::Noise,
                Start::Whole(reply, length) => Front::Reply(reply, length),
            },
        }
    }

    fn give_up_one(&mut self) {
        self.has_begun = true;
        self.noise.extend(self.pending.pop_front());
    }

    fn take_noise(&mut self) -> Received {
        Received::Noise(std::mem::take(&mut self.noise))
    }
}

fn status(shape: Shape, bytes: &[u8], length: usize, before: Option<Layout>) -> Front {
    if before.is_some_and(|before| before != shape.layout) {
        return Front::LayoutChanged(shape.layout);
    }
    let Some(whole) = bytes.get(..length) else {
        let missing = length - bytes.len();
        let is_name = missing <= shape.layout.name_length();
        return Front::Unfinished { missing_of_name: is_name.then_some(missing) };
    };
    let read = Status::read(shape, whole);
    read.map_or(Front::Noise, |status| Front::Reply(Reply::Status(status), length))
}

impl Iterator for Decoder {
    type Item = Received;

    fn next(&mut self) -> Option<Received> {
        loop {
            if self.noise.len() >= MAX_NOISE_BYTES {
                return Some(self.take_noise());
            }
            let front = self.front();
            if !self.noise.is_empty() && !matches!(front, Front::Noise | Front::Unfinished { .. }) {
                return Some(self.take_noise());
            }
            match front {
                Front::Reply(reply, length) => {
                    self.has_begun = true;
                    self.pending.drain(..length);
                    if let Reply::Status(status) = &reply {
                        self.layout = Some(status.layout);
                    }
                    return Some(Received::Reply(reply));
                }
                Front::OtherProtocol => {
                    self.give_up_one();
                    return Some(Received::OtherProtocol);
                }
                Front::LayoutChanged(layout) => {
                    self.layout = None;
                    // Past its header, which would now be taken for a first status.
                    self.give_up_one();
                    return Some(Received::LayoutChanged(layout));
                }
                Front::Noise => self.give_up_one(),
                Front::Unfinished { .. } if self.has_overflowed && !self.pending.is_empty() => {
                    self.give_up_one();
                }
                Front::Unfinished { .. } => {
                    self.has_overflowed = false;
                    return None;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
