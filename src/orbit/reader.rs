//! Reads elements from text: TLE, or OMM in JSON, XML, KVN or CSV, whatever the
//! text holds.
//!
//! Every object is read by itself. One that cannot be read is listed with its
//! place and the reason, and costs no other object. Time and memory grow with
//! the length of the text and no faster.

mod numbers;
mod omm;
mod report;
mod tle;

use smol_str::SmolStr;

use self::omm::json;
pub use self::report::{Note, NoteKind, ReadReport, Refusal, RefusalReason};

/// Reads all elements of `text`: TLE with two or three lines a set (Alpha-5
/// numbers too), or OMM in JSON, one object or a list, as `CelesTrak` and
/// Space-Track write them. Never fails as a whole and never panics.
pub fn read_elements(text: &str) -> ReadReport {
    let text = text.trim_start_matches('\u{feff}');
    if text.trim_start().starts_with(['{', '[']) { json::read(text) } else { tle::read(text) }
}

/// A text of a source on one line: without blanks around it, and with blanks
/// for the characters that no screen and no form can show.
fn clean(text: &str) -> SmolStr {
    let text = text.trim();
    if text.contains(char::is_control) {
        text.replace(char::is_control, " ").into()
    } else {
        text.into()
    }
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
