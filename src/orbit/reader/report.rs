//! The result of reading a text: elements, refusals, notes.

use serde::{Deserialize, Serialize};

use super::clean;
use crate::{
    Elements,
    elements::ElementsError,
    name::{self, Name},
};

/// Maximum number of refusals and of notes that are listed one by one. A text that is wrong
/// throughout repeats the same thing, and must not fill the memory with it.
const MAX_LISTED: usize = 100_000;
/// Maximum length of the name of a refused object, in characters.
const MAX_OBJECT_CHARS: usize = 60;

#[derive(Debug, Clone, Default, PartialEq)]
pub struct ReadReport {
    /// The objects that were read, in the order of the text.
    pub elements: Vec<Elements>,
    /// Refused objects in the order of the text, the first 100,000.
    pub refused: Vec<Refusal>,
    /// Number of refused objects beyond those listed.
    pub refused_unlisted: usize,
    /// Oddities of accepted objects, the first 100,000.
    pub notes: Vec<Note>,
    /// Why there are neither elements nor refusals, if there are none.
    pub nothing: Option<Nothing>,
}

/// A refused object.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Refusal {
    /// The line of the text on which the object starts, from 1.
    pub line: usize,
    /// Its name or catalog number, as far as they could be read.
    pub object: Option<String>,
    pub reason: RefusalReason,
}

/// An oddity of an accepted object.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Note {
    /// The line of the text on which the object starts, from 1.
    pub line: usize,
    /// Its name or catalog number.
    pub object: Option<String>,
    pub kind: NoteKind,
}

/// Oddities of objects that are still accepted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error, Serialize, Deserialize)]
pub enum NoteKind {
    /// The text before a TLE is a heading or a remark, so that the set has no name.
    #[error("the text before it is not taken for its name")]
    TextBefore,
    /// Nothing protects the line of a TLE against wrong characters.
    #[error("line {line} has no checksum")]
    BlankChecksum {
        /// The line of the set, 1 or 2.
        line: u8,
    },
}

#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize, Deserialize)]
pub enum RefusalReason {
    /// A TLE line 1 without its line 2, or line 2 without line 1.
    #[error("line {missing} of the element set is missing")]
    MissingLine {
        /// 1 or 2.
        missing: u8,
    },
    /// A TLE line ends before its checksum.
    #[error("line {line} has {columns} of 69 columns")]
    TooShort {
        /// The line of the set, 1 or 2.
        line: u8,
        columns: usize,
    },
    /// A TLE line holds characters that no TLE has.
    #[error("line {line} holds characters outside ASCII")]
    NotAscii {
        /// The line of the set, 1 or 2.
        line: u8,
    },
    /// Column 69 of a TLE line is neither a digit nor blank.
    #[error("the checksum of line {line} is not a digit")]
    ChecksumNotDigit {
        /// The line of the set, 1 or 2.
        line: u8,
    },
    /// Column 69 of a TLE line does not match the line.
    #[error("the checksum of line {line} is {found}, the line gives {expected}")]
    Checksum {
        /// The line of the set, 1 or 2.
        line: u8,
        /// The digit in column 69.
        found: u8,
        /// The checksum of the columns before it.
        expected: u8,
    },
    /// A column between two fields of a TLE line is not blank: before it, something is missing
    /// or superfluous.
    #[error("column {column} of line {line} is not blank")]
    Shifted {
        /// The line of the set, 1 or 2.
        line: u8,
        /// Counted from 1.
        column: usize,
    },
    /// The two lines of a TLE carry different catalog numbers.
    #[error("the two lines are of different objects")]
    TwoObjects,
    /// The catalog number beside the lines of a TLE is not theirs.
    #[error("it is listed as {stated}, but its lines are of {lines}")]
    OtherNumber { stated: u64, lines: u32 },
    /// A field is missing, given by its name in an OMM.
    #[error("{0} is missing")]
    MissingField(#[serde(deserialize_with = "name::one")] Name),
    /// A field does not hold what belongs there; the name is that in an OMM.
    #[error("{0} cannot be read")]
    Field(#[serde(deserialize_with = "name::one")] Name),
    /// The date of the epoch begins with day or month, as spreadsheets write dates of a file that is
    /// opened and saved in them. Its order depends on the country, and seconds are often gone.
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
    /// A list of JSON ends without its bracket, so the rest is missing.
    #[error("the list breaks off here")]
    BreaksOff,
}

/// The reason why a text holds nothing: no object that could be read, and none that was refused.
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
    /// Zip, bzip2, xz, zstd.
    #[error("it is packed in a way that is not read here; unpack it first")]
    Packed,
    #[error("it is compressed, and cannot be unpacked")]
    Unpackable,
    /// Lines as Macs wrote them before 2001.
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
