//! Result of reading a text: elements, refusals and notes.

use serde::{Deserialize, Serialize};

use super::clean;
use crate::{
    Elements,
    elements::ElementsError,
    name::{self, Name},
};

/// Max number of listed refusals, and of listed notes. A text that is wrong throughout repeats the
/// same refusal, and must not fill the memory with it.
const MAX_LISTED: usize = 100_000;
/// Max length of the name of a refused object, characters.
const MAX_OBJECT_CHARS: usize = 60;

#[derive(Debug, Clone, Default, PartialEq)]
pub struct ReadReport {
    /// Objects that were read, in the order of the text.
    pub elements: Vec<Elements>,
    /// Refused objects in the order of the text, the first 100,000.
    pub refused: Vec<Refusal>,
    /// Number of refused objects beyond those listed.
    pub refused_unlisted: usize,
    /// Oddities of accepted objects, the first 100,000.
    pub notes: Vec<Note>,
    /// Reason why there are neither elements nor refusals, if so.
    pub nothing: Option<Nothing>,
}

/// A refused object.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Refusal {
    /// Line of the text on which the object starts, from 1.
    pub line: usize,
    /// Name or catalog number of the object, as far as readable.
    pub object: Option<String>,
    pub reason: RefusalReason,
}

/// An oddity of an accepted object.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Note {
    /// Line of the text on which the object starts, from 1.
    pub line: usize,
    /// Name or catalog number of the object.
    pub object: Option<String>,
    pub kind: NoteKind,
}

/// Oddities of objects that are still accepted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error, Serialize, Deserialize)]
pub enum NoteKind {
    /// The text before a TLE is a heading or a remark, so the set has no name.
    #[error("the text before it is not taken for its name")]
    TextBefore,
    /// A TLE line has no checksum, so nothing protects it against wrong characters.
    #[error("line {line} has no checksum")]
    BlankChecksum {
        /// Line of the set, 1 or 2.
        line: u8,
    },
}

#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize, Deserialize)]
pub enum RefusalReason {
    /// A TLE line 1 without its line 2, or line 2 without line 1.
    #[error("line {missing} of the element set is missing")]
    MissingLine {
        /// Missing line, 1 or 2.
        missing: u8,
    },
    /// A TLE line ends before its checksum.
    #[error("line {line} has {columns} of 69 columns")]
    TooShort {
        /// Line of the set, 1 or 2.
        line: u8,
        columns: usize,
    },
    /// A TLE line holds characters that no TLE has.
    #[error("line {line} holds characters outside ASCII")]
    NotAscii {
        /// Line of the set, 1 or 2.
        line: u8,
    },
    /// Column 69 of a TLE line is neither a digit nor blank.
    #[error("the checksum of line {line} is not a digit")]
    ChecksumNotDigit {
        /// Line of the set, 1 or 2.
        line: u8,
    },
    /// Column 69 of a TLE line does not match the line.
    #[error("the checksum of line {line} is {found}, the line gives {expected}")]
    Checksum {
        /// Line of the set, 1 or 2.
        line: u8,
        /// Digit in column 69.
        found: u8,
        /// Checksum of the columns before column 69.
        expected: u8,
    },
    /// A column between two fields of a TLE line is not blank, because characters before it are
    /// missing or superfluous.
    #[error("column {column} of line {line} is not blank")]
    Shifted {
        /// Line of the set, 1 or 2.
        line: u8,
        /// Column, counted from 1.
        column: usize,
    },
    /// The two lines of a TLE carry different catalog numbers.
    #[error("the two lines are of different objects")]
    TwoObjects,
    /// The stated catalog number differs from the number in the lines of the TLE.
    #[error("it is listed as {stated}, but its lines are of {lines}")]
    OtherNumber { stated: u64, lines: u32 },
    /// A field is missing; the text is its name in an OMM.
    #[error("{0} is missing")]
    MissingField(#[serde(deserialize_with = "name::one")] Name),
    /// A field has an unreadable value; the text is its name in an OMM.
    #[error("{0} cannot be read")]
    Field(#[serde(deserialize_with = "name::one")] Name),
    /// The date of the epoch begins with day or month. Spreadsheets write dates in this way when
    /// they save a file. The order depends on the country, and seconds are often lost.
    #[error(
        "EPOCH does not tell day and month apart; export the file again and do not save it from a \
         spreadsheet, or write the epoch as 2026-11-27T06:00:00"
    )]
    DateOrder,
    /// The text between the braces is not JSON.
    #[error("no JSON")]
    Json,
    /// An entry of a JSON list is not an object.
    #[error("not an object")]
    NotAnObject,
    /// A message is not XML.
    #[error("no XML")]
    Xml,
    /// A row of a CSV does not have as many fields as its header.
    #[error("the row has {found} of {expected} fields")]
    FieldCount { found: usize, expected: usize },
    /// The numbers do not make an orbit.
    #[error(transparent)]
    Orbit(#[from] ElementsError),
    /// A JSON list has no closing bracket, so the rest is missing.
    #[error("the list breaks off here")]
    BreaksOff,
}

/// Reason why a text contains neither readable nor refused objects.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Nothing {
    #[error("it is empty")]
    Empty,
    /// A server's error page, or the web page around a list.
    #[error("it is a web page")]
    WebPage,
    /// The answer of `CelesTrak` to a query that matches no object.
    #[error("it says \"No GP data found\"")]
    NoGpData,
    /// A zip, bzip2, xz or zstd file.
    #[error("it is packed in a way that is not read here; unpack it first")]
    Packed,
    #[error("it is compressed, and cannot be unpacked")]
    Unpackable,
    /// Line ends of Macs before 2001.
    #[error("its lines end with CR alone; save it with LF or CR LF")]
    CarriageReturns,
    #[error("it is UTF-16 without a byte order mark; save it as UTF-8")]
    Utf16,
    #[error("it is neither TLE nor OMM")]
    Unknown,
}

impl ReadReport {
    pub(super) fn refuse(&mut self, line: usize, object: Option<&str>, reason: RefusalReason) {
        if self.refused.len() < MAX_LISTED {
            self.refused.push(Refusal { line, object: object.map(shortened), reason });
        } else {
            self.refused_unlisted += 1;
        }
    }

    pub(super) fn note(&mut self, line: usize, object: Option<&str>, kind: NoteKind) {
        if self.notes.len() < MAX_LISTED {
            self.notes.push(Note { line, object: object.map(shortened), kind });
        }
    }
}

fn shortened(object: &str) -> String {
    clean(object).chars().take(MAX_OBJECT_CHARS).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refusals_without_end_are_counted_but_not_kept() {
        let mut report = ReadReport::default();
        for line in 1..=MAX_LISTED + 5 {
            report.refuse(line, None, RefusalReason::Json);
        }
        assert_eq!((report.refused.len(), report.refused_unlisted), (MAX_LISTED, 5));
    }

    #[test]
    fn a_name_without_end_is_cut() {
        let mut report = ReadReport::default();
        report.refuse(1, Some(&"x".repeat(1_000_000)), RefusalReason::Json);
        assert_eq!(report.refused[0].object.as_ref().unwrap().len(), MAX_OBJECT_CHARS);
    }
}
