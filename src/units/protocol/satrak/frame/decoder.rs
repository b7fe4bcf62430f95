//! Decoder from a byte stream to frames.

use std::collections::VecDeque;

use super::{Frame, Oddity, checksum};

/// Max length of a line without its LF, bytes. The longest frame of the document has 82 bytes; a
/// long URL takes more.
pub const MAX_LINE_BYTES: usize = 1024;
/// Max number of bytes that wait between two calls; the decoder drops more as an over-long line.
const MAX_PENDING_BYTES: usize = 16 * 1024;
/// Max length of the excerpt of a refused line, characters.
const EXCERPT_CHARS: usize = 24;

/// Reason why a line is not a frame. The excerpts contain at most 24 characters and no values,
/// because a broken line may contain a piece of a password.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FrameError {
    #[error("line of {length} bytes without header: {excerpt}")]
    NoHeader {
        /// Length of the line, bytes.
        length: usize,
        /// Beginning of the line; empty if it looks like the tail of a frame.
        excerpt: String,
    },
    /// A checksum that does not match the payload.
    #[error("checksum {received:02X} instead of {computed:02X}: {excerpt}")]
    BadChecksum {
        /// Checksum in the line.
        received: u8,
        /// Checksum of the payload after the first `$`.
        computed: u8,
        /// Word of the line.
        excerpt: String,
    },
    /// A line without a star before its last two characters.
    #[error("no checksum: {excerpt}")]
    NoChecksum {
        /// Word of the line.
        excerpt: String,
    },
    /// More than [`MAX_LINE_BYTES`] bytes without LF.
    #[error("line longer than {MAX_LINE_BYTES} bytes: {excerpt}")]
    TooLong {
        /// Word of the line.
        excerpt: String,
    },
    /// A right checksum, but a payload that is not printable ASCII.
    #[error("not text: {excerpt}")]
    NotText {
        /// Word of the line.
        excerpt: String,
    },
    /// A line that the end of the link has cut off.
    #[error("unfinished line: {excerpt}")]
    Unfinished {
        /// Word of the line.
        excerpt: String,
    },
}

/// One line of the stream.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReceivedLine {
    /// Bytes as received, with the line end. An over-long line has the bytes until the decoder gave
    /// it up. They may contain the FTP password: show [`Self::without_secrets`].
    pub(super) bytes: Vec<u8>,
    pub frame: Result<Frame, FrameError>,
}

impl ReceivedLine {
    pub fn length(&self) -> usize {
        self.bytes.len()
    }
}

/// Decoder of a byte stream into frames.
///
/// Push the bytes that were read, then take frames until `None`. The stream may be cut and merged
/// anywhere. The decoder buffers at most 16 KiB.
#[derive(Debug, Default)]
pub struct Decoder {
    pending: VecDeque<u8>,
    /// `true` while the decoder drops all bytes up to the next LF.
    skipping: bool,
    /// `true` if bytes were lost after the end of `pending`.
    overflowed: bool,
}

impl Decoder {
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes received bytes. Drops bytes that do not fit while the caller takes no frames, and
    /// reports them as one over-long line.
    pub fn push(&mut self, bytes: &[u8]) {
        // After a gap, the rest of the line is useless too.
        if self.overflowed {
            return;
        }
        let room = MAX_PENDING_BYTES - self.pending.len().min(MAX_PENDING_BYTES);
        self.overflowed = bytes.len() > room;
        self.pending.extend(bytes.iter().take(room));
    }

    /// Returns the next line, good or not; skips empty lines.
    pub fn next_line(&mut self) -> Option<ReceivedLine> {
        loop {
            let Some(end) = self.pending.iter().position(|byte| *byte == b'\n') else {
                return self.give_up_unfinished();
            };
            let bytes: Vec<u8> = self.pending.drain(..=end).collect();
            // These bytes are the tail of a line that was reported as too long.
            if std::mem::take(&mut self.skipping) {
                continue;
            }
            let line = bytes.strip_suffix(b"\n").unwrap_or(&bytes);
            // A line that arrives together with its LF was not given up before.
            if line.len() > MAX_LINE_BYTES {
                let error = FrameError::TooLong { excerpt: excerpt(line) };
                return Some(ReceivedLine { bytes, frame: Err(error) });
            }
            let ended_with_cr = line.last() == Some(&b'\r');
            let content = without_cr(line);
            if !content.is_empty() {
                let frame = read_line(content, ended_with_cr);
                return Some(ReceivedLine { bytes, frame });
            }
        }
    }

    /// Returns `true` if the pending bytes form no whole line yet.
    pub fn is_within_line(&self) -> bool {
        self.skipping || !self.pending.is_empty()
    }

    /// Returns the beginning of a line whose end will not come.
    pub fn take_unfinished(&mut self) -> Option<ReceivedLine> {
        let bytes: Vec<u8> = self.pending.drain(..).collect();
        // The decoder reported a skipped line when it gave the line up.
        let is_skipped = std::mem::take(&mut self.skipping);
        let excerpt = excerpt(&bytes);
        (!bytes.is_empty() && !is_skipped)
            .then_some(ReceivedLine { bytes, frame: Err(FrameError::Unfinished { excerpt }) })
    }

    /// Ends an unfinished line that can no longer become a frame.
    fn give_up_unfinished(&mut self) -> Option<ReceivedLine> {
        // Without an LF, all of these bytes belong to the line that was given up.
        if self.skipping {
            self.pending.clear();
            self.overflowed = false;
            return None;
        }
        // After an overflow the LF may be among the lost bytes, so the wait for it might never end.
        if self.pending.len() <= MAX_LINE_BYTES && !self.overflowed {
            return None;
        }
        let bytes: Vec<u8> = self.pending.drain(..).collect();
        self.skipping = true;
        self.overflowed = false;
        let error = FrameError::TooLong { excerpt: excerpt(&bytes) };
        Some(ReceivedLine { bytes, frame: Err(error) })
    }
}

impl Iterator for Decoder {
    type Item = Result<Frame, FrameError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.next_line().map(|line| line.frame)
    }
}

/// Returns the line without the carriage returns at its end.
fn without_cr(mut line: &[u8]) -> &[u8] {
    while let Some(shorter) = line.strip_suffix(b"\r") {
        line = shorter;
    }
    line
}

/// Reads one line, which comes without its end.
fn read_line(line: &[u8], ended_with_cr: bool) -> Result<Frame, FrameError> {
    let mut headers =
        line.iter().enumerate().filter(|(_, byte)| **byte == b'$').map(|(index, _)| index);
    let Some(first) = headers.next() else {
        return Err(FrameError::NoHeader { length: line.len(), excerpt: headless_excerpt(line) });
    };
    let Some((body, digits)) = split_checksum(line) else {
        return Err(FrameError::NoChecksum { excerpt: excerpt(line) });
    };
    let received = digits.iter().fold(0, |sum, digit| sum << 4 | hex_value(*digit).unwrap_or(0));
    // A piece of a cut frame may precede a whole frame: the decoder tries each header.
    let payload = std::iter::once(first)
        .chain(headers)
        .filter_map(|position| Some((position, body.get(position + 1..)?)))
        .find(|(_, payload)| checksum(payload) == received);
    let Some((offset, payload)) = payload else {
        let computed = checksum(body.get(first + 1..).unwrap_or_default());
        return Err(FrameError::BadChecksum { received, computed, excerpt: excerpt(line) });
    };
    let text = std::str::from_utf8(payload)
        .ok()
        // The document uses only ASCII, so other bytes show damage that the checksum missed.
        .filter(|text| text.bytes().all(|byte| (0x20..0x7f).contains(&byte)))
        .ok_or_else(|| FrameError::NotText { excerpt: excerpt(line) })?;
    let mut frame = Frame::from_payload(text);
    for (is_present, oddity) in [
        (digits.iter().any(u8::is_ascii_lowercase), Oddity::LowerCaseChecksum),
        (digits.len() == 1, Oddity::OneDigitChecksum),
        (!ended_with_cr, Oddity::LineFeedOnly),
        (offset > 0, Oddity::NoiseBeforeHeader),
    ] {
        if is_present {
            frame.note(oddity);
        }
    }
    Ok(frame)
}

/// Splits a line at the checksum's star into payload and digits. Only the fixed place of the star
/// counts, because values may contain stars too.
fn split_checksum(line: &[u8]) -> Option<(&[u8], &[u8])> {
    // The decoder also accepts one digit, with a note, if the leading zero is missing.
    [2, 1].into_iter().find_map(|count| {
        let (front, digits) = line.split_at_checked(line.len().checked_sub(count)?)?;
        let front = front.strip_suffix(b"*")?;
        digits.iter().all(|digit| hex_value(*digit).is_some()).then_some((front, digits))
    })
}

fn hex_value(digit: u8) -> Option<u8> {
    char::from(digit).to_digit(16).and_then(|value| u8::try_from(value).ok())
}

/// Returns the first header and the word after it.
fn excerpt(line: &[u8]) -> String {
    let start = line.iter().position(|byte| *byte == b'$').unwrap_or(line.len());
    let word = line.get(start..).unwrap_or_default();
    // Values begin after these signs, and a value may be a password.
    let end = word.iter().position(|byte| b",?=".contains(byte)).unwrap_or(word.len());
    printable(word.get(..end).unwrap_or_default())
}

fn headless_excerpt(line: &[u8]) -> String {
    // The tail of a frame may contain a value, and the value may be a password.
    let is_tail_of_frame = line.iter().any(|byte| b",*".contains(byte));
    if is_tail_of_frame { String::new() } else { printable(line) }
}

fn printable(bytes: &[u8]) -> String {
    let shown = |byte: &u8| if (0x20..0x7f).contains(byte) { char::from(*byte) } else { '.' };
    bytes.iter().take(EXCERPT_CHARS).map(shown).collect()
}

#[cfg(test)]
mod tests {
    use super::super::encode;
    use super::*;

    fn read(bytes: &[u8]) -> Vec<Result<Frame, FrameError>> {
        let mut decoder = Decoder::new();
        decoder.push(bytes);
        decoder.collect()
    }

    fn only(bytes: &[u8]) -> Result<Frame, FrameError> {
        let mut all = read(bytes);
        assert_eq!(all.len(), 1, "{all:?}");
        all.remove(0)
    }

    #[test]
    fn a_cut_frame_in_front_of_a_good_one_is_skipped() {
        let frame = only(b"$STATUS?,0,2$STOP=,OK*0D\r\n").unwrap();
        assert_eq!(frame.line(), "STOP=,OK");
        assert_eq!(frame.oddities(), [Oddity::NoiseBeforeHeader]);
    }

    #[test]
    fn a_star_in_a_value_is_no_checksum() {
        let frame = only(&encode("LOAD_IMAGE?,a*4F")).unwrap();
        assert_eq!(frame.fields(), ["a*4F"]);
    }

    #[test]
    fn one_digit_is_enough_but_noted() {
        let frame = only(b"$STOP=,OK*D\r\n").unwrap();
        assert_eq!(frame.oddities(), [Oddity::OneDigitChecksum]);
        assert!(matches!(only(b"$STOP=,OK*+D\r\n"), Err(FrameError::NoChecksum { .. })));
    }

    #[test]
    fn each_broken_line_says_why() {
        let computed = 0x0d;
        assert_eq!(
            only(b"$STOP=,OK*00\r\n"),
            Err(FrameError::BadChecksum { received: 0, computed, excerpt: "$STOP".into() })
        );
        assert_eq!(
            only(b"login:\r\n"),
            Err(FrameError::NoHeader { length: 6, excerpt: "login:".into() })
        );
        assert_eq!(
            only(b"secret,22,1,1*00\n"),
            Err(FrameError::NoHeader { length: 16, excerpt: String::new() })
        );
        assert!(matches!(only(&encode("A\u{7f}?")), Err(FrameError::NotText { .. })));
        assert!(read(b"\r\n\n\r\r\n").is_empty());
    }

    #[test]
    fn an_over_long_line_is_reported_once_and_the_next_is_read() {
        let mut decoder = Decoder::new();
        let mut frames = Vec::new();
        for _ in 0..100 {
            decoder.push(&[b'x'; 100]);
            frames.extend(decoder.by_ref());
        }
        decoder.push(b"\n$STOP=*25\r\n");
        frames.extend(decoder.by_ref());
        assert_eq!(frames.len(), 2, "{frames:?}");
        assert!(matches!(frames[0], Err(FrameError::TooLong { .. })));
        assert_eq!(frames[1].as_ref().unwrap().word(), "STOP=");
    }

    #[test]
    fn nobody_reading_costs_no_memory() {
        let mut decoder = Decoder::new();
        for _ in 0..10_000 {
            decoder.push(&encode("STOP="));
        }
        assert!(decoder.pending.len() <= MAX_PENDING_BYTES);
        let drained: Vec<_> = decoder.by_ref().collect();
        assert!(matches!(drained.last(), Some(Err(FrameError::TooLong { .. }))));
        decoder.push(b"\r\n$STATUS?*2B\r\n");
        assert_eq!(decoder.next().unwrap().unwrap().word(), "STATUS?");
    }
    #[test]
    fn a_loss_is_reported_even_when_more_comes_before_it_is_reached() {
        let mut decoder = Decoder::new();
        decoder.push(&encode("STOP=").repeat(2000));
        assert!(decoder.next().unwrap().is_ok());
        decoder.push(b"\r\n$STATUS?*2B\r\n");
        let last = decoder.by_ref().last();
        assert!(matches!(last, Some(Err(FrameError::TooLong { .. }))), "{last:?}");
    }
}
