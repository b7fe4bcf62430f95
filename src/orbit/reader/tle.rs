//! TLE: two lines of 69 columns, optionally preceded by a line with the name.

mod columns;

use rayon::prelude::*;

pub(crate) use self::columns::checksum;
use self::columns::{Columns, elements};
use super::{ReadReport, RefusalReason, report::NoteKind};
use crate::Elements;

/// A line with its number in the text, from 1.
#[derive(Clone, Copy)]
struct TleLine<'a> {
    place: usize,
    text: &'a str,
}

impl TleLine<'_> {
    /// Returns `true` if the line looks like line `number` of a set.
    fn is_numbered(self, number: char) -> bool {
        // A name may also start with a digit, but it has at most 24 columns.
        let mut letters = self.text.chars();
        letters.next() == Some(number)
            && matches!(letters.next(), Some(' ' | '\t'))
            && self.text.len() > 24
    }
}

pub(super) fn read(text: &str) -> ReadReport {
    let sets: Vec<TleSet<'_>> = sets(text).collect();
    let mut read: Vec<Result<Read, RefusalReason>> = Vec::new();
    sets.par_iter().with_min_len(LEAST_FOR_A_THREAD).map(TleSet::read).collect_into_vec(&mut read);
    let mut report = ReadReport::default();
    report.elements.reserve_exact(read.len());
    for (set, read) in sets.iter().zip(read) {
        match read {
            Ok(read) => read.finish(set.place, set.object(), &mut report),
            Err(reason) => report.refuse(set.place, set.object(), reason),
        }
    }
    report
}

/// Number of sets below which another thread is not worth its start.
const LEAST_FOR_A_THREAD: usize = 64;

/// The lines of a set, at least one of the two.
struct TleSet<'a> {
    name: &'a str,
    /// The number of its first line in the text, from 1.
    place: usize,
    first: Option<&'a str>,
    second: Option<&'a str>,
}

/// What a set holds, and those of its lines that have no checksum.
pub(super) struct Read {
    pub(super) elements: Elements,
    unprotected: [Option<u8>; 2],
}

impl Read {
    /// Adds the elements to `report`, with a note for each line without a checksum.
    pub(super) fn finish(self, place: usize, object: Option<&str>, report: &mut ReadReport) {
        for line in self.unprotected.into_iter().flatten() {
            report.note(place, object, NoteKind::BlankChecksum { line });
        }
        report.elements.push(self.elements);
    }
}

/// The name in a line 0. Space-Track starts it with the number of the line.
pub(super) fn name_in(line: &str) -> &str {
    let line = line.trim();
    line.strip_prefix("0 ").unwrap_or(line).trim()
}

/// Reads one set whose lines come apart from each other, as in JSON.
pub(super) fn read_lines(
    name: &str,
    first: Option<&str>,
    second: Option<&str>,
) -> Result<Read, RefusalReason> {
    TleSet { name, place: 1, first, second }.read()
}

/// All sets of a text, in its order.
fn sets(text: &str) -> impl Iterator<Item = TleSet<'_>> {
    let mut lines = text
        .lines()
        .zip(1..)
        .map(|(text, place)| TleLine { place, text: text.trim() })
        .filter(|line| !line.text.is_empty() && !line.text.starts_with('#'))
        .peekable();
    // Only the last line before a set can be its name; all other lines are remarks.
    let mut name = "";
    std::iter::from_fn(move || {
        loop {
            let TleLine { place, text } = lines.next()?;
            let line = TleLine { place, text };
            let (first, second) = if line.is_numbered('1') {
                let second = lines.next_if(|next| next.is_numbered('2'));
                (Some(text), second.map(|line| line.text))
            } else if line.is_numbered('2') {
                (None, Some(text))
            } else {
                name = name_in(text);
                continue;
            };
            return Some(TleSet { name: std::mem::take(&mut name), place, first, second });
        }
    })
}

impl<'a> TleSet<'a> {
    /// The name by which a refusal calls a set: its name, or else its number as written.
    fn object(&self) -> Option<&'a str> {
        let line = self.first.or(self.second);
        let number = || line?.get(2..7).map(str::trim);
        Some(self.name).filter(|name| !name.is_empty()).or_else(number).filter(|it| !it.is_empty())
    }

    fn read(&self) -> Result<Read, RefusalReason> {
        let missing = |missing| RefusalReason::MissingLine { missing };
        let (first, second) = (self.first.ok_or(missing(1))?, self.second.ok_or(missing(2))?);
        let lines = [Columns::new(1, first)?, Columns::new(2, second)?];
        let [first, second] = &lines;
        let unprotected = [(1, first), (2, second)]
            .map(|(line, columns)| (!columns.has_checksum).then_some(line));
        Ok(Read { elements: elements(self.name, &lines)?, unprotected })
    }
}

#[cfg(test)]
mod tests {
    use std::ops::RangeInclusive;

    use super::*;
    use crate::{ElementsError, reader::Refusal};

    const LINE_1: &str = "1 25544U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2927";
    const LINE_2: &str = "2 25544  51.6416 247.4627 0006703 130.5360 325.0288 15.72125391563537";

    /// `line` with `text` written from `column` (from 1) on and the checksum corrected.
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

    /// The reason why the only set of `text` is refused.
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
    fn blank_checksums_are_read_and_noted() {
        let (first, second) = (&LINE_1[..68], &LINE_2[..68]);
        let text = format!("{first}\r\n{second}\r\n{first} \t remark\n{LINE_2}\n");
        let report = read(&text);
        assert_eq!((report.elements.len(), report.refused.len()), (2, 0));
        assert_eq!(report.elements[0], read(&format!("{LINE_1}\n{LINE_2}")).elements[0]);
        let noted: Vec<_> = report.notes.iter().map(|note| (note.line, note.kind)).collect();
        let blank = |line| NoteKind::BlankChecksum { line };
        assert_eq!(noted, [(1, blank(1)), (1, blank(2)), (3, blank(1))]);
        assert_eq!(report.notes[0].object.as_deref(), Some("25544"));
    }

    #[test]
    fn tabs_and_blanks_around_the_lines_do_no_harm() {
        let text = format!("  ISS\n\t{LINE_1}\t\n {}  \n", LINE_2.replacen(' ', "\t", 1));
        let report = read(&text);
        assert_eq!((report.refused.as_slice(), report.notes.as_slice()), (&[][..], &[][..]));
        assert_eq!(report.elements[0].name(), "ISS");
    }

    #[test]
    fn the_epoch_is_exact_and_its_day_exists() {
        let epoch = |text: &str| {
            let first = with(LINE_1, 19, text);
            read(&format!("{first}\n{LINE_2}")).elements.first().map(Elements::epoch)
        };
        assert_eq!(epoch("26  1.00000001"), Some("2026-01-01T00:00:00.000864Z".parse().unwrap()));
        assert_eq!(epoch("24366.99999999"), Some("2024-12-31T23:59:59.999136Z".parse().unwrap()));
        assert_eq!(epoch("57001.5       "), Some("1957-01-01T12:00:00Z".parse().unwrap()));
        for wrong in ["26366.00000000", "26000.50000000", "26 -1.50000000", "26001.0e000000"] {
            assert_eq!(epoch(wrong), None, "{wrong}");
        }
    }

    /// Columns of lines 1 and 2 that hold numbers.
    const NUMBERS: [&[RangeInclusive<usize>]; 2] = [
        &[3..=7, 19..=32, 34..=43, 45..=52, 54..=61, 63..=63, 65..=68],
        &[3..=7, 9..=16, 18..=25, 27..=33, 35..=42, 44..=51, 53..=63, 64..=68],
    ];

    /// The sets that follow from `first` and `second` with `text` in each column of a number in
    /// turn, with what the columns held before.
    fn each_with(first: &str, second: &str, text: &str) -> Vec<(String, String)> {
        let lines = [first, second];
        let mut sets = Vec::new();
        for (index, columns) in NUMBERS.iter().enumerate() {
            for column in columns.iter().cloned().flatten() {
                let mut lines = lines.map(str::to_owned);
                let held = lines[index][column - 1..column].to_owned();
                lines[index] = with(&lines[index], column, text);
                if column <= 7 {
                    lines[1 - index] = with(&lines[1 - index], column, text);
                }
                sets.push((held, lines.join("\n")));
            }
        }
        sets
    }

    #[test]
    fn a_blank_in_place_of_a_digit_is_read_as_0_or_refused() {
        // Every field ends in 0, and B* and the second derivative are there.
        let first = with(LINE_1, 45, " 12340-5 -11600-4 0  290");
        let first = with(&with(&first, 3, "25540"), 43, "0");
        let second = with(LINE_2, 3, "25540  51.6410 247.4620 0006700 130.5360 325.0280");
        let second = with(&second, 53, "15.7212539056350");
        assert_eq!(read(&format!("{first}\n{second}")).refused, []);
        let zeros = each_with(&first, &second, "0");
        let mut refused = 0;
        for ((held, blank), (_, zero)) in each_with(&first, &second, " ").iter().zip(&zeros) {
            let (read_blank, read_zero) = (read(blank), read(zero));
            let is_number = held.bytes().all(|byte| byte.is_ascii_digit());
            let same = read_blank.elements == read_zero.elements;
            assert!(!read_blank.refused.is_empty() || (same || !is_number), "{blank}");
            refused += read_blank.refused.len();
        }
        assert!(refused > 20, "{refused}");
        // The last digit of an eccentricity and of B*.
        for (place, text) in [("ECCENTRICITY", 33), ("BSTAR", 59)] {
            let lines = match place {
                "BSTAR" => [with(&first, text, " "), second.clone()],
                _ => [first.clone(), with(&second, text, " ")],
            };
            assert_eq!(refusal(&lines.join("\n")), RefusalReason::Field(place));
        }
    }

    #[test]
    fn no_letter_is_part_of_a_number() {
        for letter in ["e", "E"] {
            for (_, set) in each_with(LINE_1, LINE_2, letter) {
                // In column 3, it is the first letter of an Alpha-5 number.
                if !set.contains("1 E") {
                    assert_eq!(read(&set).elements, [], "{set}");
                }
            }
        }
        let first = with(LINE_2, 9, " 51.6e25");
        assert_eq!(refusal(&format!("{LINE_1}\n{first}")), RefusalReason::Field("INCLINATION"));
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
        let short = &LINE_1[..67];
        assert_eq!(refusal(&format!("{short}\n{LINE_2}")), Why::TooShort { line: 1, columns: 67 });
        let check = Why::ChecksumNotDigit { line: 1 };
        assert_eq!(refusal(&format!("{short}2-\n{LINE_2}")), check);
        let wide = LINE_1.replace(" 08", "\u{b0}08");
        assert_eq!(refusal(&format!("{wide}\n{LINE_2}")), Why::NotAscii { line: 1 });
        let other = with(LINE_2, 3, "25545");
        assert_eq!(refusal(&format!("{LINE_1}\n{other}")), Why::TwoObjects);
        let shifted = with(LINE_2, 17, "2");
        let column = Why::Shifted { line: 2, column: 17 };
        assert_eq!(refusal(&format!("{LINE_1}\n{shifted}")), column);
        let xp = with(LINE_1, 63, "4");
        let orbit = Why::Orbit(ElementsError::EphemerisType(4));
        assert_eq!(refusal(&format!("{xp}\n{LINE_2}")), orbit);
        let still = with(LINE_2, 53, " 0.00000000");
        let orbit = Why::Orbit(ElementsError::MeanMotion(0.0));
        assert_eq!(refusal(&format!("{LINE_1}\n{still}")), orbit);
    }
}
