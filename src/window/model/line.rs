//! One line of the log: bytes of a link and their meaning.

use std::{fmt::Write as _, sync::Arc};

use jiff::tz::TimeZone;

use crate::{
    contract::driver::Recorded,
    device::{Direction, Finding, Meaning, WireLine, panel::Tone},
};

/// One line of the log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ConsoleLine {
    /// Position among the lines of all antennas.
    pub position: u64,
    pub antenna: Arc<str>,
    pub recorded: Arc<Recorded>,
    pub raw: String,
    pub meaning: Meaning,
}

impl ConsoleLine {
    /// Creates the line at `position` among the lines of all antennas.
    pub fn new(position: u64, antenna: Arc<str>, recorded: Arc<Recorded>) -> Self {
        let raw = pieces(&recorded.line.bytes).into_iter().fold(String::new(), |raw, piece| {
            raw + &match piece {
                Piece::Text(text) => text,
                Piece::Code(code) => format!("<{code}>"),
            }
        });
        let meaning = meaning(&recorded.line);
        Self { position, antenna, recorded, raw, meaning }
    }

    pub fn wire(&self) -> &WireLine {
        &self.recorded.line
    }

    /// Returns `true` if the bytes, the meaning or the name of the antenna contains `needle`, which
    /// is in lower case.
    pub fn has(&self, needle: &str) -> bool {
        let texts = [self.raw.as_str(), &self.meaning.text, &self.antenna];
        texts.into_iter().any(|text| text.to_lowercase().contains(needle))
    }

    /// Returns the round trip, such as "34 ms".
    pub fn round_trip(&self) -> Option<String> {
        let after = self.wire().reply_after?;
        Some(format!("{:.0} ms", after.as_secs_f64() * 1000.0))
    }

    /// Returns the line for the clipboard and for a file: UTC, antenna, direction, frame, round
    /// trip and meaning, separated by tabs.
    pub fn report(&self) -> String {
        let time_text = self.wire().time.to_zoned(TimeZone::UTC).strftime("%FT%T.%3fZ").to_string();
        let mut text =
            format!("{time_text}\t{}\t{}\t{}\t", self.antenna, self.direction(), self.raw);
        text.push_str(&self.round_trip().unwrap_or_default());
        // Writing to a string cannot fail.
        let _ = write!(text, "\t{}", self.meaning.text);
        text
    }

    /// Returns "sent" or "received"; empty for a missing reply.
    pub fn direction(&self) -> &'static str {
        match (self.wire().direction, self.wire().finding) {
            (_, Finding::NoReply { .. }) => "",
            (Direction::Sent, _) => "sent",
            (Direction::Received, _) => "received",
        }
    }
}

/// A part of a line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Piece {
    /// Printable ASCII characters.
    Text(String),
    /// Name of an unprintable byte.
    Code(String),
}

/// Splits the bytes into printable text and names of unprintable bytes.
pub fn pieces(bytes: &[u8]) -> Vec<Piece> {
    let mut pieces = Vec::new();
    for byte in bytes {
        match (byte, pieces.last_mut()) {
            (0x20..0x7f, Some(Piece::Text(text))) => text.push(char::from(*byte)),
            (0x20..0x7f, _) => pieces.push(Piece::Text(char::from(*byte).to_string())),
            (b'\r', _) => pieces.push(Piece::Code("CR".to_owned())),
            (b'\n', _) => pieces.push(Piece::Code("LF".to_owned())),
            (0, _) => pieces.push(Piece::Code("NUL".to_owned())),
            (other, _) => pieces.push(Piece::Code(format!("{other:02X}"))),
        }
    }
    pieces
}

/// Returns a generic meaning for a line that the make does not explain.
fn unnamed(direction: Direction, length: usize) -> Meaning {
    let kind = if direction == Direction::Sent { "Request" } else { "Reply" };
    let plural = if length == 1 { "" } else { "s" };
    Meaning { tone: Tone::Plain, text: format!("{kind}, {length} byte{plural}").into() }
}

fn meaning(line: &WireLine) -> Meaning {
    let (tone, text) = match line.finding {
        Finding::Good | Finding::Unchecked => {
            let parsed = line.meaning.clone();
            return parsed.unwrap_or_else(|| unnamed(line.direction, line.length));
        }
        Finding::BadChecksum { received, computed } => {
            (Tone::Bad, format!("Checksum {received:02X}, should be {computed:02X}. Dropped"))
        }
        Finding::NoChecksum => (Tone::Bad, "No checksum. Dropped".to_owned()),
        Finding::NoHeader => (Tone::Caution, "No frame".to_owned()),
        Finding::TooLong => (Tone::Bad, "Too long for a frame. Dropped".to_owned()),
        Finding::NotText => (Tone::Bad, "Not text. Dropped".to_owned()),
        Finding::Unfinished => (Tone::Bad, "The link ended within this line".to_owned()),
        Finding::NoReply { waited, is_repeated } => {
            let next = if is_repeated { "asked again" } else { "given up" };
            let waited_ms = waited.as_secs_f64() * 1000.0;
            (Tone::Caution, format!("No reply in {waited_ms:.0} ms, {next}"))
        }
    };
    Meaning { tone, text: text.into() }
}

#[cfg(test)]
pub(crate) mod testing {
    use super::*;
    use crate::controller::satrak;

    /// Returns a valid line at a second of the epoch.
    pub(crate) fn wire(second: i64, direction: Direction, text: &str) -> WireLine {
        let bytes = format!("{text}\r\n").into_bytes();
        WireLine {
            time: jiff::Timestamp::from_second(second).unwrap(),
            direction,
            length: bytes.len(),
            meaning: Some(satrak::meaning(direction, &bytes)),
            bytes: bytes.into(),
            is_shortened: false,
            finding: Finding::Good,
            reply_after: None,
            is_poll: false,
        }
    }

    pub(crate) fn line(position: u64, wire: WireLine) -> ConsoleLine {
        ConsoleLine::new(
            position,
            "Satrak".into(),
            Arc::new(Recorded { number: position, line: wire }),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::{testing::*, *};
    use std::time::Duration;

    #[test]
    fn a_line_is_reported_with_time_direction_frame_and_meaning() {
        let mut wire = wire(1, Direction::Received, "$MOVE=,ERR,7*5E");
        wire.reply_after = Some(Duration::from_millis(34));
        let line = line(0, wire);
        let words = "1970-01-01T00:00:01.000Z\tSatrak\treceived\t$MOVE=,ERR,7*5E<CR><LF>\t34 ms\t\
                     Refused: ERR,7";
        assert_eq!(line.report(), words);
        assert!(line.has("move=") && line.has("refused") && line.has("satrak"));
        assert!(!line.has("status"));
    }

    #[test]
    fn what_is_damaged_says_how() {
        let mut wire = wire(1, Direction::Received, "$STOP=,OK*00");
        wire.finding = Finding::BadChecksum { received: 0, computed: 0x0d };
        let line = line(0, wire.clone());
        assert_eq!(line.meaning.text, "Checksum 00, should be 0D. Dropped");
        let waited = Duration::from_secs(2);
        wire.finding = Finding::NoReply { waited, is_repeated: true };
        let line = testing::line(0, wire);
        assert_eq!(line.meaning.text, "No reply in 2000 ms, asked again");
        assert_eq!(line.direction(), "");
    }

    #[test]
    fn what_its_make_has_no_words_for_is_told_by_its_bytes() {
        let wire = WireLine { meaning: None, ..wire(1, Direction::Received, "|h00OK") };
        let line = line(0, wire);
        assert_eq!((line.meaning.tone, &*line.meaning.text), (Tone::Plain, "Reply, 8 bytes"));
    }

    #[test]
    fn only_usual_polls_are_polls() {
        let mut wire = wire(1, Direction::Received, "$TIME?,ERR,7*4D");
        assert!(!wire.is_routine_poll());
        wire.is_poll = true;
        assert!(!wire.is_routine_poll(), "a refusal is worth a look");
        let question = testing::wire(1, Direction::Sent, "$STATUS?*2B");
        assert!(WireLine { is_poll: true, ..question }.is_routine_poll());
    }

    #[test]
    fn bytes_that_cannot_be_printed_are_named() {
        let text = |text: &str| Piece::Text(text.to_owned());
        let code = |code: &str| Piece::Code(code.to_owned());
        let found = pieces(b"ab\0\xffc\r\n");
        assert_eq!(found, [text("ab"), code("NUL"), code("FF"), text("c"), code("CR"), code("LF")]);
    }
}
