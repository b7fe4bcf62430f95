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
    /// A reply.
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
mod tests {
    use super::super::Acknowledgement;
    use super::*;

    /// Recorded at a station: the second rotator points to 43 degrees.
    const WIDE: &[u8] =
        b"|h2\x00999359  0A0   0999999\x00Tower        43359  0A0   0999999\x00Rotator 2   ";
    /// The document's example with its last name, which is blank.
    const NARROW: &[u8] = b"|h0\x00100005350A1009999990TOW1      999010060E0019999990          ";

    fn take(decoder: &mut Decoder, bytes: &[u8]) -> Vec<Received> {
        decoder.push(bytes);
        decoder.collect()
    }

    fn stop() -> Received {
        Received::Reply(Reply::Acknowledgement { to: Acknowledgement::Stop, is_accepted: true })
    }

    fn status(received: &Received) -> &Status {
        match received {
            Received::Reply(Reply::Status(status)) => status,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn names_may_hold_anything() {
        let mut bytes = WIDE.to_vec();
        bytes[26..38].copy_from_slice(b"|h2\0|SKA0|A1");
        bytes[60..72].copy_from_slice(b"|h|SK|cF\0E0V");
        let seen = take(&mut Decoder::new(), &bytes);
        assert_eq!(seen.len(), 1);
        assert_eq!(status(&seen[0]).rotators[0].name, "|h2\0|SKA0|A1");
        assert_eq!(status(&seen[0]).rotators[1].name, "|h|SK|cF\0E0V");
    }

    #[test]
    fn a_swallowed_panic_byte_moves_everything_by_one() {
        for (layout, whole) in [(Layout::Wide, WIDE), (Layout::Narrow, NARROW)] {
            let bytes: Vec<u8> = [&whole[..3], &whole[4..]].concat();
            let seen = take(&mut Decoder::new(), &bytes);
            assert_eq!(seen.len(), 1);
            assert_eq!((status(&seen[0]).layout, status(&seen[0]).panic), (layout, None));
            let with_it = take(&mut Decoder::new(), whole);
            assert_eq!(status(&seen[0]).rotators, status(&with_it[0]).rotators);
        }
    }

    #[test]
    fn another_form_is_announced_and_taken_from_the_second_on() {
        let mut decoder = Decoder::new();
        assert_eq!(status(&take(&mut decoder, WIDE)[0]).layout, Layout::Wide);
        let seen = take(&mut decoder, &NARROW.repeat(2));
        assert_eq!(
            seen[..2],
            [Received::LayoutChanged(Layout::Narrow), Received::Noise(NARROW.to_vec())]
        );
        assert_eq!(status(&seen[2]).layout, Layout::Narrow);
        assert_eq!(seen.len(), 3);
    }

    #[test]
    fn silence_ends_what_is_unfinished() {
        let mut decoder = Decoder::new();
        // Not the name alone is missing: no reply, and none with the next status.
        decoder.push(&WIDE[..59]);
        assert_eq!(decoder.unfinished_bytes(), 59);
        assert_eq!(decoder.idle(), [Received::Noise(WIDE[..59].to_vec())]);
        assert_eq!(decoder.idle(), []);
        let seen = take(&mut decoder, &WIDE[..61]);
        assert_eq!(seen, []);
        assert_eq!(status(&decoder.idle()[0]).rotators[1].name, "R");
        assert_eq!(decoder.unfinished_bytes(), 0);
        // What was hidden behind a piece of a status is found.
        decoder.push(b"|h2|SK");
        assert_eq!(decoder.idle(), [Received::Noise(b"|h2".to_vec()), stop()]);
    }

    #[test]
    fn a_piece_of_a_status_does_not_spoil_the_next_one() {
        let seen = take(&mut Decoder::new(), &[&WIDE[..9], WIDE].concat());
        assert_eq!(seen[0], Received::Noise(WIDE[..9].to_vec()));
        assert_eq!(status(&seen[1]).rotators[1].name, "Rotator 2");
    }

    #[test]
    fn the_greeting_of_another_product_is_recognised_at_the_start_only() {
        let mut decoder = Decoder::new();
        assert_eq!(take(&mut decoder, b"V"), []);
        assert_eq!(take(&mut decoder, b"1.2 AUTH\n"), [Received::OtherProtocol]);
        assert_eq!(decoder.idle(), [Received::Noise(b"V1.2 AUTH\n".to_vec())]);
        for other in [&b"|SKV1"[..], b"\nV1", b"VK"] {
            let seen = take(&mut Decoder::new(), other);
            assert!(!seen.contains(&Received::OtherProtocol), "{other:?}");
        }
    }

    #[test]
    fn a_stream_that_nobody_reads_fills_no_memory() {
        let mut decoder = Decoder::new();
        for _ in 0..100 {
            decoder.push(&WIDE.repeat(10));
        }
        assert_eq!(decoder.unfinished_bytes(), MAX_PENDING_BYTES);
        let seen: Vec<_> = decoder.by_ref().collect();
        assert_eq!(seen.len(), MAX_PENDING_BYTES / WIDE.len());
        // The status that was cut is no half of the next one.
        let seen = take(&mut decoder, WIDE);
        assert!(matches!(seen[0], Received::Noise(_)));
        assert_eq!(status(&seen[1]).rotators[1].name, "Rotator 2");
        let noise = take(&mut Decoder::new(), &[b'|'; 2 * MAX_NOISE_BYTES + 2]);
        assert_eq!(noise, vec![Received::Noise(vec![b'|'; MAX_NOISE_BYTES]); 2]);
    }
}
