//! Reader of elements from text, which may be TLE, or OMM in JSON, XML, KVN or CSV.
//!
//! Each object is read separately. An unreadable object is listed with its place and the reason,
//! and does not affect the others. Time and memory grow no faster than the length of the text.

mod numbers;
mod omm;
mod report;
mod tle;

use std::{borrow::Cow, io::Read as _};

use smol_str::SmolStr;

use self::omm::{csv, json, kvn, xml};
pub use self::report::{Note, NoteKind, Nothing, ReadReport, Refusal, RefusalReason};
pub(super) use self::{
    numbers::ALPHA_5,
    tle::{checksum, is_remark},
};

/// Max size of an unpacked text of elements, bytes; the whole catalog as XML has 30 MB.
pub const MAX_ELEMENT_BYTES: u64 = 1 << 28;

/// Reads all elements of `text`: TLE with two or three lines per set (including Alpha-5 numbers),
/// or OMM in JSON, XML, KVN or CSV. `CelesTrak` and Space-Track write these forms. The function
/// never fails as a whole and never panics.
pub fn read_elements(text: &str) -> ReadReport {
    // Programs that join files leave the byte order mark of each file.
    let joined;
    let mut text = text.trim_start_matches('\u{feff}');
    if text.contains('\u{feff}') {
        joined = text.replace('\u{feff}', " ");
        text = &joined;
    }
    let form = form(text);
    if form.is_of_lines() && !text.contains('\n') && text.trim().contains('\r') {
        return of_nothing(Nothing::CarriageReturns);
    }
    let mut report = match form {
        Form::Json => json::read(text),
        Form::Xml => xml::read(text),
        Form::Kvn => kvn::read(text),
        Form::Csv => csv::read(text),
        Form::Tle => tle::read(text),
    };
    if report.elements.is_empty() && report.refused.is_empty() {
        report.nothing = Some(nothing_in(text));
    }
    report
}

/// Returns the reason why `text` holds no elements.
fn nothing_in(text: &str) -> Nothing {
    let text = text.trim();
    let start: String = text.chars().take(15).collect::<String>().to_ascii_lowercase();
    if text.is_empty() {
        Nothing::Empty
    } else if start.starts_with("no gp data") {
        Nothing::NoGpData
    } else if start.starts_with("<!doctype html") || start.starts_with("<html") {
        Nothing::WebPage
    } else {
        Nothing::Unknown
    }
}

/// Reads all elements of a file as stored on disk or received. The function replaces bytes that are
/// not UTF-8, and unpacks gzip. It reads UTF-16, which some shells write, if there is a byte order
/// mark.
pub fn read_element_bytes(bytes: &[u8]) -> ReadReport {
    let unpacked;
    let bytes = if bytes.starts_with(GZIP) {
        let Some(read) = unpack(bytes) else { return of_nothing(Nothing::Unpackable) };
        unpacked = read;
        &unpacked
    } else {
        bytes
    };
    if PACKED.iter().any(|mark| bytes.starts_with(mark)) {
        return of_nothing(Nothing::Packed);
    }
    if is_unmarked_utf_16(bytes) {
        return of_nothing(Nothing::Utf16);
    }
    read_elements(&decoded(bytes))
}

fn of_nothing(nothing: Nothing) -> ReadReport {
    ReadReport { nothing: Some(nothing), ..ReadReport::default() }
}

/// Returns all files of a gzip; `None` if the gzip is damaged or too large unpacked.
fn unpack(bytes: &[u8]) -> Option<Vec<u8>> {
    let mut unpacked = Vec::new();
    let mut packed = flate2::read::MultiGzDecoder::new(bytes).take(MAX_ELEMENT_BYTES + 1);
    packed.read_to_end(&mut unpacked).ok()?;
    (unpacked.len() as u64 <= MAX_ELEMENT_BYTES).then_some(unpacked)
}

/// Returns the text of a file: UTF-8, or UTF-16 with a byte order mark. Bytes of other encodings
/// become U+FFFD.
pub fn decoded(bytes: &[u8]) -> Cow<'_, str> {
    let (code, is_big) = match bytes {
        [0xff, 0xfe, code @ ..] => (code, false),
        [0xfe, 0xff, code @ ..] => (code, true),
        // This test is several times faster than replacing bytes, which are hardly ever invalid.
        _ => match str::from_utf8(bytes) {
            Ok(text) => return text.into(),
            Err(_) => return String::from_utf8_lossy(bytes),
        },
    };
    let (pairs, _) = code.as_chunks();
    let unit = if is_big { u16::from_be_bytes } else { u16::from_le_bytes };
    let units = pairs.iter().map(|pair| unit(*pair));
    let letters = char::decode_utf16(units).map(|letter| letter.unwrap_or('\u{fffd}'));
    Cow::Owned(letters.collect())
}

/// Returns `true` if every other byte of the start is 0 without a byte order mark, as in UTF-16 of
/// ASCII.
fn is_unmarked_utf_16(bytes: &[u8]) -> bool {
    // All forms start with ASCII.
    matches!(bytes, [1..=127, 0, 1..=127, 0, ..] | [0, 1..=127, 0, 1..=127, ..])
}

/// First bytes of a gzip.
const GZIP: &[u8] = &[0x1f, 0x8b];
/// First bytes of zip, bzip2, xz and zstd.
const PACKED: [&[u8]; 4] = [b"PK\x03\x04", b"BZh", b"\xfd7zXZ", &[0x28, 0xb5, 0x2f, 0xfd]];

enum Form {
    Json,
    Xml,
    Kvn,
    Csv,
    Tle,
}

impl Form {
    fn is_of_lines(&self) -> bool {
        matches!(self, Self::Kvn | Self::Csv | Self::Tle)
    }
}

/// Max number of lines that are examined to find the form; a list may have a heading.
const MAX_HEAD_LINES: usize = 20;

/// Returns the form of `text`, from the first line that shows it.
fn form(text: &str) -> Form {
    // The test needs two characters, because a name may start with any one of them.
    let mut signs = text.chars().filter(|sign| !sign.is_whitespace());
    if matches!(
        (signs.next(), signs.next()),
        (Some('['), Some('{' | ']')) | (Some('{'), Some('"' | '}'))
    ) {
        return Form::Json;
    }
    let head = text
        .lines()
        .map(str::trim)
        .filter(|line| !line.is_empty() && !line.starts_with('#') && !kvn::is_comment(line))
        .take(MAX_HEAD_LINES);
    for line in head {
        // A web page around a list of TLE also starts with a tag, but with a different one.
        if line.starts_with("<?xml") || xml::is_first(line) {
            return Form::Xml;
        }
        if kvn::is_first(line) {
            return Form::Kvn;
        }
        if csv::is_header(line) {
            return Form::Csv;
        }
        if tle::is_numbered(line) {
            return Form::Tle;
        }
    }
    Form::Tle
}

/// Returns a text of a source on one line, trimmed, with blanks in place of the characters that no
/// screen and no form can show.
fn clean(text: &str) -> SmolStr {
    // A form may lose the byte order mark. Neither this mark nor the characters that reverse the
    // order of text are control characters.
    let is_unseen = |letter: char| {
        let turns = matches!(letter, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
        letter.is_control() || letter == '\u{feff}' || turns
    };
    if text.bytes().all(|byte| matches!(byte, b' '..=b'~')) {
        return text.trim_ascii().into();
    }
    let text = text.trim_matches(|letter: char| letter.is_whitespace() || is_unseen(letter));
    if text.contains(is_unseen) { text.replace(is_unseen, " ").into() } else { text.into() }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use std::io::Write as _;

    use super::*;
    use crate::Elements;

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

    /// One object in every form.
    const FORMS: [&str; 5] = [
        "0 A\r\n1 25544U 98067A   26223.50000000  .00000000  00000-0  10000-3 0  9994\r\n\
         2 25544  51.6000 225.4000 0001771  44.9000   5.1000 15.50000000    18\r\n",
        r#" [{"OBJECT_NAME":"A","OBJECT_ID":"1998-067A","NORAD_CAT_ID":"25544",
         "EPOCH":"2026-08-11T12:00:00","MEAN_MOTION":15.5,"ECCENTRICITY":0.0001771,
         "INCLINATION":51.6,"RA_OF_ASC_NODE":225.4,"ARG_OF_PERICENTER":44.9,"MEAN_ANOMALY":5.1,
         "BSTAR":1e-4,"ELEMENT_SET_NO":999,"REV_AT_EPOCH":1}]"#,
        "# remark\n<ndm><omm><OBJECT_NAME>A</OBJECT_NAME><OBJECT_ID>1998-067A</OBJECT_ID>\
         <NORAD_CAT_ID>25544</NORAD_CAT_ID><EPOCH>2026-08-11T12:00:00</EPOCH>\
         <MEAN_MOTION>15.5</MEAN_MOTION><ECCENTRICITY>.0001771</ECCENTRICITY>\
         <INCLINATION>51.6</INCLINATION><RA_OF_ASC_NODE>225.4</RA_OF_ASC_NODE>\
         <ARG_OF_PERICENTER>44.9</ARG_OF_PERICENTER><MEAN_ANOMALY>5.1</MEAN_ANOMALY>\
         <BSTAR>.1E-3</BSTAR><ELEMENT_SET_NO>999</ELEMENT_SET_NO>\
         <REV_AT_EPOCH>1</REV_AT_EPOCH></omm></ndm>",
        "COMMENT A\nOBJECT_NAME=A\nOBJECT_ID=1998-067A\nNORAD_CAT_ID=25544\n\
         EPOCH=2026-223T12:00:00Z\nMEAN_MOTION=15.5\nECCENTRICITY=.0001771\nINCLINATION=51.6\n\
         RA_OF_ASC_NODE=225.4\nARG_OF_PERICENTER=44.9\nMEAN_ANOMALY=5.1\nBSTAR=0.0001\n\
         ELEMENT_SET_NO=999\nREV_AT_EPOCH=1\n",
        "OBJECT_NAME,OBJECT_ID,NORAD_CAT_ID,EPOCH,MEAN_MOTION,ECCENTRICITY,INCLINATION,\
         RA_OF_ASC_NODE,ARG_OF_PERICENTER,MEAN_ANOMALY,BSTAR,ELEMENT_SET_NO,REV_AT_EPOCH\n\
         A,1998-067A,25544,2026-08-11 12:00:00,15.5,1.771e-4,51.6,225.4,44.9,5.1,1e-4,999,1\n",
    ];

    #[test]
    fn every_form_is_known_by_its_content_and_says_the_same() {
        let first = read_elements(FORMS[0]);
        assert_eq!((first.elements.len(), first.refused.len()), (1, 0), "{:?}", first.refused);
        for text in FORMS {
            for text in [text.to_owned(), format!("\u{feff}{text}")] {
                let report = read_elements(&text);
                assert_eq!(
                    (&report.elements, &report.refused),
                    (&first.elements, &vec![]),
                    "{text}"
                );
            }
        }
    }

    #[test]
    fn files_that_were_joined_with_their_marks_are_read() {
        for form in FORMS {
            let alone = read_elements(form);
            let joined = read_elements(&format!("\u{feff}{form}\n\u{feff}{form}"));
            let expected = [&alone.elements[0], &alone.elements[0]];
            assert_eq!(joined.elements.iter().collect::<Vec<_>>(), expected, "{form}");
            assert_eq!((joined.refused, joined.notes), (vec![], vec![]), "{form}");
        }
    }

    #[test]
    fn text_before_the_records_does_no_harm() {
        for form in [FORMS[0], FORMS[2], FORMS[3], FORMS[4]] {
            let text = format!("Elements of the week\nfetched at noon, by us\n\n{form}");
            let report = read_elements(&text);
            assert_eq!(report.elements, read_elements(form).elements, "{text}");
            assert_eq!(report.refused, [], "{text}");
        }
    }

    #[test]
    fn bytes_of_other_encodings_are_read() {
        let latin = FORMS[0].replace("0 A", "0 Caf\u{e9}");
        let bytes: Vec<u8> = latin.chars().map(|letter| letter as u8).collect();
        assert_eq!(read_element_bytes(&bytes).elements[0].name(), "Caf\u{fffd}");
        let units: Vec<u16> = format!("\u{feff}{}", FORMS[1]).encode_utf16().collect();
        let little: Vec<u8> = units.iter().flat_map(|unit| unit.to_le_bytes()).collect();
        let big: Vec<u8> = units.iter().flat_map(|unit| unit.to_be_bytes()).collect();
        for bytes in [little, big] {
            assert_eq!(read_element_bytes(&bytes).elements, read_elements(FORMS[1]).elements);
        }
    }

    #[test]
    fn names_lose_what_no_screen_can_show() {
        let text = FORMS[1].replace("\"A\"", "\" A\\u0007\\nB \"");
        assert_eq!(read_elements(&text).elements[0].name(), "A  B");
        let text = FORMS[1].replace("\"A\"", "\"\\u0000 \u{feff}A\u{feff}B \\u0000\"");
        assert_eq!(read_elements(&text).elements[0].name(), "A B");
        let text = FORMS[1].replace("1998-067A", "\\u0000");
        assert_eq!(read_elements(&text).elements[0].international_designator(), None);
    }

    #[test]
    fn an_empty_text_holds_nothing() {
        for text in ["", "\u{feff}\r\n\r\n"] {
            assert_eq!(read_elements(text), of_nothing(Nothing::Empty));
        }
    }

    #[test]
    fn what_holds_nothing_says_what_it_is() {
        for (bytes, nothing) in [
            (&b"No GP data found\n"[..], Nothing::NoGpData),
            (b"<!DOCTYPE html>\n<html><body>503</body></html>", Nothing::WebPage),
            (b" <html>\n<head><title>403 Forbidden</title></head>", Nothing::WebPage),
            (b"PK\x03\x04....", Nothing::Packed),
            (b"\x1f\x8b\x08 no gzip", Nothing::Unpackable),
            (b"hello\nworld\n", Nothing::Unknown),
            (b"hello\rworld\r\n", Nothing::Unknown),
            (b"[]", Nothing::Unknown),
        ] {
            assert_eq!(read_element_bytes(bytes), of_nothing(nothing), "{nothing}");
        }
    }

    #[test]
    fn lines_that_end_with_cr_alone_are_told() {
        let cr = |text: &str| text.replace("\r\n", "\n").replace('\n', "\r");
        for text in [FORMS[0], &FORMS[0][5..], FORMS[3], FORMS[4]] {
            assert_eq!(read_elements(&cr(text)), of_nothing(Nothing::CarriageReturns), "{text}");
        }
        // These two forms need no lines.
        for text in [FORMS[1], FORMS[2].trim_start_matches("# remark\n")] {
            assert_eq!(read_elements(&cr(text)), read_elements(text), "{text}");
        }
    }

    #[test]
    fn utf_16_without_a_mark_is_told() {
        for text in FORMS {
            let units: Vec<u16> = text.replace("0 A", "0 \u{15f}").encode_utf16().collect();
            let little = units.iter().flat_map(|unit| unit.to_le_bytes());
            let big = units.iter().flat_map(|unit| unit.to_be_bytes());
            for bytes in [little.collect::<Vec<u8>>(), big.collect()] {
                assert_eq!(read_element_bytes(&bytes), of_nothing(Nothing::Utf16), "{text}");
            }
        }
    }

    #[test]
    fn the_catalog_number_of_an_omm_is_digits_with_a_plus_at_most() {
        let refused = RefusalReason::Field("NORAD_CAT_ID");
        for form in &FORMS[1..] {
            for text in ["+25544", "025544"] {
                let report = read_elements(&form.replace("25544", text));
                assert_eq!(report, read_elements(form), "{text}");
            }
            // Alpha-5 belongs to the five columns of a TLE.
            for text in ["A0000", "+A0000", "++25544", "-25544", "25544.0"] {
                let report = read_elements(&form.replace("25544", text));
                assert_eq!(report.elements, [], "{text}");
                assert_eq!(report.refused[0].reason, refused, "{text}");
            }
        }
        let signed = FORMS[3].replace("REV_AT_EPOCH=1", "REV_AT_EPOCH=+1").replace("=999", "=+999");
        assert_eq!(read_elements(&signed), read_elements(FORMS[3]));
        let zero = FORMS[3].replace("=999", "=0");
        assert_eq!(read_elements(&zero.replace("_NO=0", "_NO=+0")), read_elements(&zero));
    }

    #[test]
    fn an_omm_without_a_catalog_number_is_refused_by_its_name() {
        let report = read_elements(&FORMS[3].replace("NORAD_CAT_ID=25544\n", ""));
        assert_eq!(report.elements, []);
        let reason = RefusalReason::MissingField("NORAD_CAT_ID");
        assert_eq!(report.refused, [Refusal { line: 2, object: Some("A".to_owned()), reason }]);
    }

    #[test]
    fn what_is_compressed_is_read() {
        let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        packed.write_all(FORMS[0].as_bytes()).unwrap();
        let packed = packed.finish().unwrap();
        assert_eq!(read_element_bytes(&packed), read_elements(FORMS[0]));
        let cut = &packed[..packed.len() - 12];
        assert_eq!(read_element_bytes(cut), of_nothing(Nothing::Unpackable));
    }

    #[test]
    fn an_epoch_with_an_offset_is_that_time() {
        for (epoch, utc) in [
            ("2026-08-11T15:00:00+03:00", Some("2026-08-11T12:00:00Z")),
            ("2026-08-11T00:30:00-11:30", Some("2026-08-11T12:00:00Z")),
            ("2026-08-11T12:00:00+00:00", Some("2026-08-11T12:00:00Z")),
            ("2026-08-11T12:00:00Z", Some("2026-08-11T12:00:00Z")),
            ("2026-08-11T12:00:00", Some("2026-08-11T12:00:00Z")),
            ("2026-223T12:00:00", Some("2026-08-11T12:00:00Z")),
            ("2026-223T12:00:00+03:00", None),
            ("2026-08-11T12:00:00[Europe/Istanbul]", None),
            ("2026-08-11T15:00:00+03:00[Europe/Istanbul]", None),
        ] {
            let report = read_elements(&FORMS[1].replace("2026-08-11T12:00:00", epoch));
            let read = report.elements.first().map(Elements::epoch);
            assert_eq!(read, utc.map(|utc| utc.parse().unwrap()), "{epoch}");
            assert_eq!(report.refused.len(), usize::from(utc.is_none()), "{epoch}");
        }
    }

    #[test]
    fn names_of_refused_objects_are_harmless_too() {
        let text =
            FORMS[1].replace("\"A\"", "\"A\\u001b]0;x\\u0007 \\u202eB\"").replace("15.5", "-1");
        let refused = &read_elements(&text).refused[0];
        assert_eq!(refused.object.as_deref(), Some("A ]0;x   B"));
    }
}
