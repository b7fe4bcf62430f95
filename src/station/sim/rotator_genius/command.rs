//! Splitting of a byte stream into commands, which have no terminator.

use std::collections::BTreeSet;

use super::Quirk;
use crate::protocol::rotator_genius::Request;

/// Length of a configuration without its name, as in the document's example.
pub(super) const SHORT_CONFIGURATION_BYTES: usize = 12;
/// Index of the angle in a go-to, and length of the command, bytes.
const GO_TO_ANGLE_AT: usize = 3;
const GO_TO_BYTES: usize = 6;

/// Reader that splits a stream by the length of each command's letter.
///
/// It skips bytes that form no command up to the next bar. Nobody knows if a real unit reads a
/// stream or segments.
#[derive(Debug, Default)]
pub struct CommandReader {
    pending: Vec<u8>,
}

impl CommandReader {
    /// Returns the commands that `segment` completes.
    pub(super) fn read(&mut self, segment: &[u8], quirks: &BTreeSet<Quirk>) -> Vec<Vec<u8>> {
        if quirks.contains(&Quirk::Segment) {
            return alone(segment);
        }
        self.pending.extend(segment);
        let mut commands = Vec::new();
        while let Some(command) = self.next(quirks) {
            commands.push(command);
        }
        commands
    }

    fn next(&mut self, quirks: &BTreeSet<Quirk>) -> Option<Vec<u8>> {
        loop {
            let bar = self.pending.iter().position(|byte| *byte == b'|');
            self.pending.drain(..bar.unwrap_or(self.pending.len()));
            let letter = *self.pending.get(1)?;
            let length = match Request::length(letter) {
                Some(length) => length,
                None if letter == b'|' => {
                    self.pending.remove(0);
                    continue;
                }
                None => 2,
            };
            let is_short = letter == b'c'
                && quirks.contains(&Quirk::Config12)
                && self.pending.len() == SHORT_CONFIGURATION_BYTES;
            let length = if is_short { SHORT_CONFIGURATION_BYTES } else { length };
            return (self.pending.len() >= length).then(|| self.pending.drain(..length).collect());
        }
    }
}

/// Returns the commands of a single segment, each up to the next bar. The number of a go-to may be
/// short; bytes after a command are ignored.
fn alone(segment: &[u8]) -> Vec<Vec<u8>> {
    let mut pieces = segment.split(|byte| *byte == b'|');
    // The bytes before the first bar form no command.
    pieces.next();
    pieces.filter(|piece| !piece.is_empty()).map(command).collect()
}

/// Returns a command from the bytes after its bar.
fn command(piece: &[u8]) -> Vec<u8> {
    let mut command = [b"|", piece].concat();
    let letter = piece.first().copied().unwrap_or_default();
    command.truncate(Request::length(letter).unwrap_or(2));
    if letter == b'A' {
        let missing = GO_TO_BYTES - command.len();
        let angle_at = GO_TO_ANGLE_AT.min(command.len());
        command.splice(angle_at..angle_at, std::iter::repeat_n(b' ', missing));
    }
    command
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn read(segments: &[&str], quirks: &[Quirk]) -> Vec<String> {
        let quirks = quirks.iter().copied().collect();
        let mut reader = CommandReader::default();
        let commands = segments.iter().flat_map(|segment| reader.read(segment.as_bytes(), &quirks));
        commands.map(|command| String::from_utf8(command).unwrap()).collect()
    }

    #[test]
    fn a_stream_is_cut_by_length_wherever_its_segments_end() {
        let sent = "|h\r\n|A1042||P1|X|S";
        let expected = ["|h", "|A1042", "|P1", "|X", "|S"];
        assert_eq!(read(&[sent], &[]), expected);
        let bytes: Vec<String> = sent.chars().map(String::from).collect();
        let bytes: Vec<&str> = bytes.iter().map(String::as_str).collect();
        assert_eq!(read(&bytes, &[]), expected);
        // A short number swallows the next command.
        assert_eq!(read(&["|A15", "|h"], &[]), ["|A15|h"]);
    }

    #[test]
    fn segments_stand_for_themselves() {
        let segment = [Quirk::Segment];
        assert_eq!(read(&["|A15", "|h\r\n", "|S|h"], &segment), ["|A1  5", "|h", "|S", "|h"]);
        assert_eq!(read(&["|A1", "042", "|", "h"], &segment), ["|A1   "]);
    }

    #[test]
    fn a_configuration_may_come_without_its_name() {
        let short = ["|c1030300A00", "|S"];
        assert_eq!(read(&short, &[Quirk::Config12]), short);
        assert_eq!(read(&short, &[Quirk::Config12, Quirk::Segment]), short);
        assert_eq!(read(&short, &[]), [""; 0]);
    }

    proptest! {
        #[test]
        fn any_bytes_are_harmless(
            segments in prop::collection::vec("[|hAPMSc0-9 \\x00\u{ff}]{0,30}", 0..8),
            quirks in prop::collection::btree_set(
                prop::sample::select(vec![Quirk::Segment, Quirk::Config12]),
                0..3,
            ),
        ) {
            let mut reader = CommandReader::default();
            for segment in &segments {
                for command in reader.read(segment.as_bytes(), &quirks) {
                    prop_assert!(command.len() >= 2 && command[0] == b'|', "{:?}", command);
                    let _ = Request::parse(&command);
                }
                // The rest is shorter than the longest command.
                prop_assert!(reader.pending.len() < 22);
            }
        }
    }
}
