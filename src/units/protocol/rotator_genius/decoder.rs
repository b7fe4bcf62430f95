//! Decoder from a byte stream to replies.

use std::collections::VecDeque;

use super::layout::LayoutShape;
use super::reply::{ReplyStart, acknowledgement};
use super::{Layout, Reply, Status};

/// Max length of noise that the decoder reports in one piece, bytes.
pub const MAX_NOISE_BYTES: usize = 256;
/// Max number of bytes that wait between two calls, as many as 56 status replies; the decoder loses
/// more.
const MAX_PENDING_BYTES: usize = 4096;

/// Items found in a stream.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Received {
    Reply(Reply),
    /// Bytes of no reply, 1 to [`MAX_NOISE_BYTES`]. The decoder has found its place again after
    /// them.
    Noise(Vec<u8>),
    /// A status in another form than the previous status. The decoder returns it as noise; it
    /// accepts the next status in this form.
    LayoutChanged(Layout),
    /// A stream that begins with `V` and a digit, as on the maker's other products, which then
    /// require a code.
    OtherProtocol,
}

/// Decoder of a byte stream into replies.
///
/// Push the bytes that were read, then take items until `None`. The stream may be cut and merged
/// anywhere. Call [`Self::idle`] after a silence. The decoder buffers at most 4 KiB.
#[derive(Debug, Default)]
pub struct Decoder {
    pending: VecDeque<u8>,
    /// `true` if bytes were lost after the end of `pending`.
    has_overflowed: bool,
    /// Bytes before `pending` that belong to no reply.
    noise: Vec<u8>,
    /// `true` once the decoder has read the first bytes of the stream.
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
    /// Undecided: more bytes have to come.
    Unfinished {
        /// Number of missing bytes, for a status that lacks only the end of its last name.
        missing_of_name: Option<usize>,
    },
}

impl Decoder {
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes received bytes. Loses bytes that do not fit while the caller takes no replies,
    /// together with their reply.
    pub fn push(&mut self, bytes: &[u8]) {
        // After a gap, the decoder would join these bytes to the half reply before the gap.
        if self.has_overflowed {
            return;
        }
        let room = MAX_PENDING_BYTES.saturating_sub(self.pending.len());
        self.has_overflowed = bytes.len() > room;
        self.pending.extend(bytes.iter().take(room));
    }

    /// Returns the number of bytes that wait for the rest of their reply.
    pub fn unfinished_bytes(&self) -> usize {
        self.pending.len()
    }

    /// Returns `true` if bytes that begin no reply wait for the caller.
    pub fn has_noise(&self) -> bool {
        !self.noise.is_empty()
    }

    /// Ends unfinished replies after a silence (250 ms suffice), and returns the remaining items.
    ///
    /// The decoder completes with blanks a status that lacks only the end of the last name. All
    /// other bytes become noise, so no reply consists of two halves.
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
            // Later in the stream, the same letters can only be noise.
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
        // Blanks may replace a part of the name. A status cut off earlier would get invented
        // numbers.
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
            // The decoder returns noise first, which keeps the items in the order of the stream.
            if !self.noise.is_empty() && !matches!(front, Front::Noise | Front::Unfinished { .. }) {
                return Some(self.take_noise());
            }
            match front {
                Front::Reply(reply, length) => {
                    self.has_begun = true;
                    self.pending.drain(..length);
                    // The decoder remembers the form, because a status of another form may be a
                    // shifted status.
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
                    // The decoder skips the header, because it would now accept this status as a
                    // first one.
                    self.give_up_one();
                    return Some(Received::LayoutChanged(layout));
                }
                Front::Noise => self.give_up_one(),
                // The rest of this reply was lost. Waiting would join this part to the next reply.
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
