//! Reads elements from text: TLE or OMM in JSON, whatever the text holds.
//!
//! Every object is read by itself. One that cannot be read is listed with its
//! place and the reason, and costs no other object.

mod omm;
mod tle;

use super::{Elements, elements::ElementsError};

/// What a text held.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ReadReport {
    /// The objects that were read, in the order of the text.
    pub elements: Vec<Elements>,
    /// The objects that were not, in the order of the text.
    pub refused: Vec<Refusal>,
}

/// One object that was not read.
#[derive(Debug, Clone, PartialEq)]
pub struct Refusal {
    /// The line of the text where the object starts, from 1.
    pub line: usize,
    /// Its name or catalogue number, as far as they could be read.
    pub object: Option<String>,
    /// Why it was refused.
    pub reason: RefusalReason,
}

/// Why an object was refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RefusalReason {
    /// A TLE line 1 without its line 2, or the other way about.
    #[error("line {missing} of the element set is missing")]
    MissingLine {
        /// The line that is missing, 1 or 2.
        missing: u8,
    },
    /// A TLE line is shorter than its 69 columns.
    #[error("line {line} has {columns} of 69 columns")]
    TooShort {
        /// The line of the set, 1 or 2.
        line: u8,
        /// How many columns it has.
        columns: usize,
    },
    /// A TLE line holds letters no TLE has.
    #[error("line {line} holds characters outside ASCII")]
    NotAscii {
        /// The line of the set, 1 or 2.
        line: u8,
    },
    /// Column 69 of a TLE line is no digit.
    #[error("the checksum of line {line} is no digit")]
    ChecksumNotDigit {
        /// The line of the set, 1 or 2.
        line: u8,
    },
    /// Column 69 of a TLE line does not agree with the line.
    #[error("the checksum of line {line} is {found}, the line gives {expected}")]
    Checksum {
        /// The line of the set, 1 or 2.
        line: u8,
        /// What column 69 says.
        found: u8,
        /// What the columns before it add up to.
        expected: u8,
    },
    /// A column of a TLE does not hold what belongs there.
    #[error("{0}")]
    Columns(sgp4::TleError),
    /// An OMM lacks a field.
    #[error("{0} is missing")]
    MissingField(&'static str),
    /// A field of an OMM does not hold what belongs there.
    #[error("{0} cannot be read")]
    Field(&'static str),
    /// What stands between the braces is no JSON.
    #[error("no JSON")]
    Json,
    /// An entry of a JSON list is no object.
    #[error("not an object")]
    NotAnObject,
    /// The numbers are no orbit.
    #[error(transparent)]
    Orbit(#[from] ElementsError),
}

/// Reads all elements of `text`: TLE with two or three lines a set (Alpha-5
/// numbers too), or OMM in JSON, one object or a list, as `CelesTrak` and
/// Space-Track write them. Never fails as a whole and never panics.
pub fn read_elements(text: &str) -> ReadReport {
    let text = text.trim_start_matches('\u{feff}');
    if text.trim_start().starts_with(['{', '[']) { omm::read(text) } else { tle::read(text) }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn any_text_is_harmless(text in any::<String>()) {
            read_elements(&text);
        }

        #[test]
        fn any_ascii_in_the_columns_is_harmless(
            first in "1 [ -~]{60,70}",
            second in "2 [ -~]{60,70}",
        ) {
            let report = read_elements(&format!("{first}\n{second}\n"));
            prop_assert!(report.elements.len() + report.refused.len() >= 1);
        }

        #[test]
        fn any_json_is_harmless(
            key in "EPOCH|NORAD_CAT_ID|MEAN_MOTION|OBJECT_NAME",
            value in any::<String>(),
            number in any::<f64>(),
        ) {
            let text = serde_json::json!([{ key.clone(): value }, { key: number }]).to_string();
            prop_assert_eq!(read_elements(&text).refused.len(), 2);
        }
    }

    #[test]
    fn an_empty_text_holds_nothing() {
        assert_eq!(read_elements(""), ReadReport::default());
        assert_eq!(read_elements("\u{feff}\r\n\r\n"), ReadReport::default());
    }
}
