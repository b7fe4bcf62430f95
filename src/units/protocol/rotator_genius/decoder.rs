//! Decoder from a byte stream to replies.

use std::collections::VecDeque;

use super::layout::LayoutShape;
use super::reply::{ReplyStart, acknowledgement};
use super::{Layout, Reply, Status};

/// Maximum length of noise that is reported in one piece.
pub const MAX_NOISE_BYTES: usize = 256;
/// Maximum of bytes that wait between two calls, as many as 56 status replies; more are
/// lost.
const MAX_PENDING_BYTES: usize = 4096;

/// Items found in a stream.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Received {
    Reply(Reply),
    /// Bytes of no reply, 1 to [`MAX_NOISE_BYTES`]. Behind them the decoder is in step again.
    Noise(Vec<u8>),
    /// The status has another form than the ones before it. It is given up as noise; the next
    /// one in this form is accepted.
    LayoutChanged(Layout),
    /// The stream began with `V` and a digit, like that of the maker's other products, which
    /// then ask for a code.
    OtherProtocol,
}

/// Splits a byte stream into replies.
///
/// Push the bytes that were read, then take items until `None`. The stream may be cut and
/// merged anywhere. Call [`Self::idle`] when nothing has come for a while. Holds at most 4
/// KiB.
#[derive(Debug, Default)]
pub struct Decoder {
    pending: VecDeque<u8>,
    /// Bytes were lost after the end of `pending`.
    has_overflowed: bool,
    /// Bytes in front of `pending` that belong to no reply.
    noise: Vec<u8>,
    /// The first bytes of the stream have been read.
    has_begun: bool,
    /// Form of the last status.
    layout: Option<Layout>,
}

/// Item at the beginning of the pending bytes.
enum Front {
    Reply(Reply, usize),
    OtherProtocol,
    LayoutChanged(Layout),
    Noise,
    /// Undecided until more bytes come.
    Unfinished {
        /// Number of missing bytes, for a status that lacks only the end of its last name.
        missing_of_name: Option<usize>,
    },
}

impl Decoder {
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes bytes of the stream. Bytes that do not fit while nobody takes replies are lost,
    /// together with the reply that they belong to.
    pub fn push(&mut self, bytes: &[u8]) {
        // Behind a gap, these bytes would be joined to half a reply in front of it.
        if self.has_overflowed {
            return;
        }
        let room = MAX_PENDING_BYTES.saturating_sub(self.pending.len());
        self.has_overflowed = bytes.len() > room;
        self.pending.extend(bytes.iter().take(room));
    }

    /// Number of bytes that wait for the rest of their reply.
    pub fn unfinished_bytes(&self) -> usize {
        self.pending.len()
    }

    /// Returns `true` if bytes that begin no reply wait to be handed out.
    pub fn has_noise(&self) -> bool {
        !self.noise.is_empty()
    }

    /// Ends unfinished replies after nothing has come for a while (250 ms are plenty), and
    /// returns the items left.
    ///
    /// A status that lacks only the end of the last name is completed with blanks. Everything
    /// else is noise, so that no reply is made of two halves.
    pub fn idle(&mut self) -> Vec<Received> {
        let mut items: Vec<_> = self.by_ref().collect();
        // The document's example of a status lacks the blanks of its last, empty name.
        if let Front::Unfinished { missing_of_name: Some(missing) } = self.front() {
            self.pending.extend(std::iter::repeat_n(b' ', missing));
        }
        items.extend(self.by_ref());
        while !self.pending.is_empty() {
            self.give_up_one();
            items.extend(self.by_ref());
        }
        if !self.noise.is_empty() {
            items.push(self.take_noise());
        }
        items
    }

    fn front(&mut self) -> Front {
        const UNFINISHED: Front = Front::Unfinished { missing_of_name: None };
        let is_first = !self.has_begun;
        let bytes: &[u8] = self.pending.make_contiguous();
        match bytes {
            // Later on, the same letters can only be noise.
            [b'V'] if is_first => UNFINISHED,
            [b'V', digit, ..] if is_first && digit.is_ascii_digit() => Front::OtherProtocol,
            [b'|', b'h', ..] => match LayoutShape::decide(bytes) {
                ReplyStart::Unfinished => UNFINISHED,
                ReplyStart::Unknown => Front::Noise,
                ReplyStart::Whole(shape, length) => status(shape, bytes, length, self.layout),
            },
            _ => match acknowledgement(bytes) {
                ReplyStart::Unfinished => UNFINISHED,
                ReplyStart::Unknown => Front::Noise,
                ReplyStart::Whole(reply, length) => Front::Reply(reply, length),
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

fn status(shape: LayoutShape, bytes: &[u8], length: usize, before: Option<Layout>) -> Front {
    if before.is_some_and(|before| before != shape.layout) {
        return Front::LayoutChanged(shape.layout);
    }
    let Some(whole) = bytes.get(..length) else {
        let missing = length - bytes.len();
        // Blanks may stand for a name. Cut any earlier, a status would get invented numbers.
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
            // Noise goes out first, so that items keep the order of the stream.
            if !self.noise.is_empty() && !matches!(front, Front::Noise | Front::Unfinished { .. }) {
                return Some(self.take_noise());
            }
            match front {
                Front::Reply(reply, length) => {
                    self.has_begun = true;
                    self.pending.drain(..length);
                    // A status of another form may be a shifted one, so the form is remembered.
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
                    // Skips the header, which would now pass for a first status.
                    self.give_up_one();
                    return Some(Received::LayoutChanged(layout));
                }
                Front::Noise => self.give_up_one(),
                // The rest of this reply was lost. Waiting would join it to the next reply.
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
