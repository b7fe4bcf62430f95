//! TLE: two lines of 69 columns, perhaps a line with the name before them.
//!
//! Source: `CelesTrak`, "NORAD Two-Line Element Set Format".

use super::{ReadReport, Refusal, RefusalReason};
use crate::orbit::Elements;

/// Columns of a line; what follows them is not part of the set.
const COLUMNS: usize = 69;

/// A line with its place in the text, from 1.
#[derive(Clone, Copy)]
struct Line<'a> {
    place: usize,
    text: &'a str,
}

impl Line<'_> {
    /// Whether the line looks like line `number` of a set.
    fn is_numbered(self, number: char) -> bool {
        // A name may start with a digit too, but it has 24 columns at most.
        let mut letters = self.text.chars();
        letters.next() == Some(number) && letters.next() == Some(' ') && self.text.len() > 24
    }
}

/// Reads all sets of `text`.
pub(super) fn read(text: &str) -> ReadReport {
    let mut report = ReadReport::default();
    let mut lines = text
        .lines()
        .enumerate()
        .map(|(index, text)| Line { place: index + 1, text: text.trim_end() })
        .filter(|line| !line.text.is_empty())
        .peekable();
    let mut name: Option<Line<'_>> = None;
    while let Some(line) = lines.next() {
        let mut refuse = |place, object, reason| {
            report.refused.push(Refusal { line: place, object, reason });
        };
        if line.is_numbered('1') {
            let title = name.take().map(|name| title(name.text));
            let object = title.clone().or_else(|| number_text(line.text));
            let Some(second) = lines.next_if(|next| next.is_numbered('2')) else {
                refuse(line.place, object, RefusalReason::MissingLine { missing: 2 });
                continue;
            };
            match set(title, line.text, second.text) {
                Ok(elements) => report.elements.push(elements),
                Err(reason) => refuse(line.place, object, reason),
            }
        } else if line.is_numbered('2') {
            let object = name.take().map(|name| title(name.text));
            let object = object.or_else(|| number_text(line.text));
            refuse(line.place, object, RefusalReason::MissingLine { missing: 1 });
        } else {
            // Only the last line before a set can be its name; all else is remarks.
            name = Some(line).filter(|line| !line.text.starts_with('#'));
        }
    }
    report
}

/// The name on a name line, which Space-Track starts with `0 `.
fn title(text: &str) -> String {
    text.strip_prefix("0 ").unwrap_or(text).trim().to_owned()
}

/// The catalogue number of a set line as it is written, to name a refused set.
fn number_text(line: &str) -> Option<String> {
    let number = line.get(2..7)?.trim();
    (!number.is_empty()).then(|| number.to_owned())
}

/// Reads one set.
fn set(title: Option<String>, first: &str, second: &str) -> Result<Elements, RefusalReason> {
    let mut first = columns(1, first)?;
    let second = columns(2, second)?;
    // Old sets leave these blank. Blanks and zeros count the same in the checksum.
    if let Some(class @ b' ') = first.get_mut(7) {
        *class = b'U';
    }
    if let Some(kind @ b' ') = first.get_mut(62) {
        *kind = b'0';
    }
    let inner = sgp4::Elements::from_tle(title, &first, &second).map_err(RefusalReason::Columns)?;
    Ok(Elements::new(inner)?)
}

/// The 69 columns of a line, sure to be ASCII and to have the right checksum:
/// the library relies on both.
fn columns(line: u8, text: &str) -> Result<[u8; COLUMNS], RefusalReason> {
    let bytes = text.as_bytes();
    let Some(columns) = bytes.first_chunk::<COLUMNS>() else {
        return Err(RefusalReason::TooShort { line, columns: bytes.len() });
    };
    if !columns.is_ascii() {
        return Err(RefusalReason::NotAscii { line });
    }
    let [content @ .., check] = columns;
    if !check.is_ascii_digit() {
        return Err(RefusalReason::ChecksumNotDigit { line });
    }
    let sum: u32 = content
        .iter()
        .map(|byte| match byte {
            b'-' => 1,
            b'0'..=b'9' => u32::from(byte - b'0'),
            _ => 0,
        })
        .sum();
    let (found, expected) = (check - b'0', (sum % 10) as u8);
    if found != expected {
        return Err(RefusalReason::Checksum { line, found, expected });
    }
    Ok(*columns)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINE_1: &str = "1 25544U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2927";
    const LINE_2: &str = "2 25544  51.6416 247.4627 0006703 130.5360 325.0288 15.72125391563537";

    /// `line` with `text` from `column` (from 1) on and the checksum put right.
    fn with(line: &str, column: usize, text: &str) -> String {
        let mut line = line.to_owned();
        line.replace_range(column - 1..column - 1 + text.len(), text);
        let sum: u32 = line[..68]
            .chars()
            .map(|letter| if letter == '-' { 1 } else { letter.to_digit(10).unwrap_or(0) })
            .sum();
        line.replace_range(68..69, &(sum % 10).to_string());
        line
    }

    /// Why the only set of `text` is refused.
    fn refusal(text: &str) -> RefusalReason {
        let report = read(text);
        assert_eq!((report.elements.len(), report.refused.len()), (0, 1), "{report:?}");
        report.refused[0].reason.clone()
    }

    #[test]
    fn names_remarks_and_line_ends_of_every_kind_are_read() {
        let text = format!(
            "# remark\r\n0 ISS (ZARYA)\r\n{LINE_1}\r\n{LINE_2}\r\n\r\n<html>\nISS\n{LINE_1}\n\
             {LINE_2}   0.0 1440.0\n{LINE_1}\n{LINE_2}\n"
        );
        let report = read(&text);
        assert_eq!(report.refused, []);
        let names: Vec<_> = report.elements.iter().map(Elements::name).collect();
        assert_eq!(names, ["ISS (ZARYA)", "ISS", ""]);
        let iss = &report.elements[0];
        assert_eq!(iss.catalog_number(), 25_544);
        assert_eq!(iss.international_designator(), Some("1998-067A"));
        assert_eq!(iss.epoch(), "2008-09-20T12:25:40.104192Z".parse().unwrap());
        assert!((iss.inclination().degrees() - 51.6416).abs() < 1e-12);
    }

    #[test]
    fn alpha_5_numbers_are_read() {
        let text = format!("{}\n{}\n", with(LINE_1, 3, "T0001"), with(LINE_2, 3, "T0001"));
        let report = read(&text);
        assert_eq!(report.refused, []);
        assert_eq!(report.elements[0].catalog_number(), 270_001);
    }

    #[test]
    fn blank_old_fields_are_read() {
        let first = with(LINE_1, 63, " ");
        let report = read(&format!("{}\n{LINE_2}\n", with(&first, 8, " ")));
        assert_eq!(report.refused, []);
    }

    #[test]
    fn a_bad_set_is_named_and_costs_no_other() {
        let text = format!("BAD\n{LINE_1}\n{}8\n{LINE_1}\n{LINE_2}\n", &LINE_2[..68]);
        let report = read(&text);
        assert_eq!(report.elements.len(), 1);
        let reason = RefusalReason::Checksum { line: 2, found: 8, expected: 7 };
        let refused = Refusal { line: 2, object: Some("BAD".to_owned()), reason };
        assert_eq!(report.refused, [refused]);
    }

    #[test]
    fn every_reason_is_told_apart() {
        use RefusalReason as Why;
        assert_eq!(refusal(&format!("{LINE_1}\n")), Why::MissingLine { missing: 2 });
        assert_eq!(refusal(&format!("{LINE_2}\n")), Why::MissingLine { missing: 1 });
        let short = &LINE_1[..68];
        assert_eq!(refusal(&format!("{short}\n{LINE_2}")), Why::TooShort { line: 1, columns: 68 });
        // Below '0' the library would end the program in debug builds.
        let check = Why::ChecksumNotDigit { line: 1 };
        assert_eq!(refusal(&format!("{short}-\n{LINE_2}")), check);
        let wide = LINE_1.replace(" 08", "\u{b0}08");
        assert_eq!(refusal(&format!("{wide}\n{LINE_2}")), Why::NotAscii { line: 1 });
        let other = with(LINE_2, 3, "25545");
        assert!(matches!(refusal(&format!("{LINE_1}\n{other}")), Why::Columns(_)));
        let xp = with(LINE_1, 63, "4");
        let orbit = Why::Orbit(crate::orbit::ElementsError::EphemerisType(4));
        assert_eq!(refusal(&format!("{xp}\n{LINE_2}")), orbit);
        let still = with(LINE_2, 53, " 0.00000000");
        let orbit = Why::Orbit(crate::orbit::ElementsError::MeanMotion(0.0));
        assert_eq!(refusal(&format!("{LINE_1}\n{still}")), orbit);
    }
}
