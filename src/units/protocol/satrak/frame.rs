//! Frames: `$` payload `*` checksum CR LF (document chapter "Message structure").

mod decoder;
mod shown;

use std::borrow::Cow;
use std::fmt;

pub use decoder::{Decoder, FrameError, MAX_LINE_BYTES, ReceivedLine};
pub use shown::{HIDDEN, Shown};

use super::{Verb, Word};

/// A harmless deviation of a frame from the document.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Oddity {
    /// A checksum with lower-case digits.
    LowerCaseChecksum,
    /// A checksum of one digit instead of two.
    OneDigitChecksum,
    /// A line that ends with LF alone.
    LineFeedOnly,
    /// Other bytes before the `$`.
    NoiseBeforeHeader,
    /// Blanks between the word and its sign.
    BlankBeforeSign,
}

/// Payload of a frame with a correct checksum, split into its parts.
#[derive(Clone, PartialEq, Eq)]
pub struct Frame {
    word: String,
    fields: Vec<String>,
    line: String,
    /// Start of the values in `line`, after the sign and one comma.
    values_at: Option<usize>,
    oddities: Vec<Oddity>,
}

impl Frame {
    /// Splits a payload (without `$`, checksum and line end) into its parts.
    pub fn from_payload(payload: &str) -> Self {
        let line = payload.to_owned();
        let (name, sign, rest_at) = if let Some(index) = line.find(['?', '=']) {
            let tail = line.get(index..).unwrap_or_default();
            // Only the document's sample frame has both signs. It must not match a known query.
            let sign = if tail.starts_with("?=") { "?=" } else { tail.get(..1).unwrap_or("") };
            (line.get(..index).unwrap_or_default(), sign, index + sign.len())
        } else {
            let position = line.find(',').unwrap_or(line.len());
            (line.get(..position).unwrap_or_default(), "", position)
        };
        // The examples of section 19 have a blank before `=`, and its request has none.
        let trimmed = name.trim_end_matches(' ');
        let oddities =
            if trimmed.len() < name.len() { vec![Oddity::BlankBeforeSign] } else { Vec::new() };
        let word = format!("{trimmed}{sign}");
        let rest = line.get(rest_at..).unwrap_or_default();
        // The document writes both `STATUS?0,..` and `STATUS?,0,..`.
        let values_at = match rest.strip_prefix(',') {
            Some(_) => Some(rest_at + 1),
            None if rest.is_empty() => None,
            None => Some(rest_at),
        };
        let mut frame = Self { word, fields: Vec::new(), line, values_at, oddities };
        // The examples of sections 26 and 28 have a blank after the comma.
        frame.fields = frame.raw_fields().map(|field| field.trim().to_owned()).collect();
        frame
    }

    /// Returns the word with its sign, such as `STATUS?` or `MOVE=`, without leading blanks.
    pub fn word(&self) -> &str {
        &self.word
    }

    /// Returns the word and verb, if the document has the word.
    pub fn command(&self) -> Option<(Word, Verb)> {
        let (name, verb) = match self.word.strip_suffix('?') {
            Some(name) => (name, Verb::Query),
            None => (self.word.strip_suffix('=')?, Verb::Set),
        };
        Some((Word::from_name(name)?, verb))
    }

    /// Returns the values without surrounding blanks.
    pub fn fields(&self) -> &[String] {
        &self.fields
    }

    /// Returns the payload as received. It may contain the FTP password: log [`Self::redacted`].
    pub fn line(&self) -> &str {
        &self.line
    }

    /// Returns the payload for logs and screens, without secrets.
    pub fn redacted(&self) -> Cow<'_, str> {
        redact(&self.line)
    }

    /// Returns the deviations from the document.
    pub fn oddities(&self) -> &[Oddity] {
        &self.oddities
    }

    /// Returns one value that may contain commas: the text between the first `before` and the last
    /// `after` fields, with its commas and inner blanks.
    pub(super) fn joined(&self, before: usize, after: usize) -> Option<String> {
        let raw: Vec<&str> = self.raw_fields().collect();
        let middle = raw.get(before..raw.len().checked_sub(after)?)?;
        (!middle.is_empty()).then(|| middle.join(",").trim().to_owned())
    }

    fn raw_fields(&self) -> impl Iterator<Item = &str> {
        let values = self.values_at.and_then(|index| self.line.get(index..));
        values.into_iter().flat_map(|values| values.split(','))
    }

    fn note(&mut self, oddity: Oddity) {
        self.oddities.push(oddity);
    }
}

// A derived implementation would print the FTP password.
impl fmt::Debug for Frame {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Frame")
            .field("line", &self.redacted())
            .field("oddities", &self.oddities)
            .finish_non_exhaustive()
    }
}

/// Returns `payload` for logs, without the values of `SATELLITE_FTP`, which contain a password in
/// clear.
pub fn redact(payload: &str) -> Cow<'_, str> {
    let name = Word::SatelliteFtp.name();
    // The search covers the whole payload: noise or a cut frame may precede the word.
    match payload.find(name) {
        Some(index) => {
            let shown = payload.get(..index + name.len()).unwrap_or(name);
            Cow::Owned(format!("{shown} (values hidden)"))
        }
        None => Cow::Borrowed(payload),
    }
}

/// Returns the checksum: XOR of every payload byte (document chapter "Message structure").
pub fn checksum(payload: &[u8]) -> u8 {
    payload.iter().fold(0, |sum, byte| sum ^ byte)
}

/// Returns the frame around `payload`, ready to send.
pub fn encode(payload: &str) -> Vec<u8> {
    // The digits are upper case, as in the document's sample.
    format!("${payload}*{:02X}\r\n", checksum(payload.as_bytes())).into_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_documents_own_frame_has_its_checksum() {
        let sent = encode("DATETIMEG?=,2016,12,22,15,55,40,10");
        assert_eq!(sent, b"$DATETIMEG?=,2016,12,22,15,55,40,10*6F\r\n");
    }

    #[test]
    fn a_payload_is_cut_at_its_first_sign() {
        let frame = Frame::from_payload("TRACK_AUTO_ENABLE =, 1 ,a=b?");
        assert_eq!(frame.word(), "TRACK_AUTO_ENABLE=");
        assert_eq!(frame.fields(), ["1", "a=b?"]);
        assert_eq!(frame.oddities(), [Oddity::BlankBeforeSign]);
        assert_eq!(frame.command(), Some((Word::TrackAutoEnable, Verb::Set)));
        assert!(Frame::from_payload("STATUS?").fields().is_empty());
        assert_eq!(Frame::from_payload("LOAD_IMAGE?,").fields(), [""]);
        assert_eq!(Frame::from_payload("HELLO,1").word(), "HELLO");
        assert_eq!(Frame::from_payload("DATETIMEG?=,1").command(), None);
    }

    #[test]
    fn middle_fields_are_joined_with_their_blanks() {
        let frame = Frame::from_payload("SATELLITE?,f, A, B ,1");
        assert_eq!(frame.joined(1, 1).as_deref(), Some("A, B"));
        assert_eq!(frame.joined(4, 0), None);
        assert_eq!(frame.joined(1, 9), None);
    }

    #[test]
    fn the_ftp_password_is_in_no_log_text() {
        let frame = Frame::from_payload("SATELLITE_FTP?,10.0.1.2,user,hunter2,22,f,s,1,1");
        assert!(!format!("{frame:?}").contains("hunter2"));
        assert!(!frame.redacted().contains("hunter2"));
        assert_eq!(redact("STATUS?"), "STATUS?");
    }
}
