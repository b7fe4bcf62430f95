//! TLE: two lines of 69 columns, optionally preceded by a line with the name.

mod columns;

use std::borrow::Cow;

use rayon::prelude::*;

pub(crate) use self::columns::checksum;
use self::columns::{Columns, elements};
use super::{ReadReport, RefusalReason, report::NoteKind};
use crate::Elements;

/// Max length of a name without a line number before it, characters.
const MAX_NAME_CHARS: usize = 24;

/// Length of a line without its checksum, characters.
const MIN_LINE_CHARS: usize = 68;

/// A line that is not empty.
struct TleLine<'a> {
    /// Line number in the text, from 1.
    place: usize,
    text: Cow<'a, str>,
    /// The previous line is empty.
    follows_gap: bool,
}

impl<'a> TleLine<'a> {
    /// Creates a line; `None` for an empty line and for a remark.
    fn new(text: &'a str, place: usize, follows_gap: bool) -> Option<Self> {
        let is_around = |letter: char| letter.is_whitespace() || is_invisible(letter);
        // Mail programs quote with `>`.
        let text = text.trim_start_matches(|letter| is_around(letter) || letter == '>');
        let text = text.trim_end_matches(is_around);
        if text.is_empty() || text.starts_with('#') {
            return None;
        }
        let text = if text.is_ascii() || !text.starts_with(['1', '2']) {
            Cow::Borrowed(text)
        } else {
            Cow::Owned(text.chars().filter_map(plain).collect())
        };
        Some(Self { place, text, follows_gap })
    }

    /// Returns `true` if the line looks like line `number` of a set.
    fn is_numbered(&self, number: char) -> bool {
        // A name may also start with a digit, but it has at most 24 columns.
        let mut letters = self.text.chars();
        letters.next() == Some(number)
            && matches!(letters.next(), Some(' ' | '\t'))
            && self.text.len() > MAX_NAME_CHARS
    }
}

fn is_invisible(letter: char) -> bool {
    matches!(letter, '\u{ad}' | '\u{200b}'..='\u{200f}' | '\u{2060}' | '\u{feff}')
}

/// Returns the ASCII character that web pages and word processors replace by `letter`; `None` for a
/// letter that takes no column.
fn plain(letter: char) -> Option<char> {
    match letter {
        '\t' => Some('\t'),
        // The non-breaking space of Latin-1 is invalid UTF-8.
        '\u{fffd}' => Some(' '),
        '\u{2010}'..='\u{2015}' | '\u{2212}' | '\u{fe63}' | '\u{ff0d}' => Some('-'),
        _ if letter.is_whitespace() => Some(' '),
        _ => Some(letter).filter(|letter| !is_invisible(*letter)),
    }
}

/// Returns `true` if `line` looks like a line of a set.
pub(super) fn is_numbered(line: &str) -> bool {
    TleLine::new(line, 1, false).is_some_and(|line| line.is_numbered('1') || line.is_numbered('2'))
}

pub(super) fn read(text: &str) -> ReadReport {
    let sets = sets(text);
    let mut read: Vec<Result<Read, RefusalReason>> = Vec::new();
    sets.par_iter().with_min_len(MIN_PER_THREAD).map(TleSet::read).collect_into_vec(&mut read);
    let mut report = ReadReport::default();
    report.elements.reserve_exact(read.len());
    for (set, read) in sets.iter().zip(read) {
        match read {
            Ok(read) => {
                if !set.text.is_empty() && set.name().is_empty() {
                    report.note(set.place, set.number(), NoteKind::TextBefore);
                }
                let object = Some(set.name()).filter(|name| !name.is_empty());
                read.finish(set.place, object.or_else(|| set.number()), &mut report);
            }
            Err(reason) => report.refuse(set.place, set.object(), reason),
        }
    }
    report
}

/// Min number of sets for which another thread is worth its start.
const MIN_PER_THREAD: usize = 64;

/// Lines of a set, with at least one of the two.
struct TleSet<'a> {
    /// Text before the set; empty without text.
    text: Cow<'a, str>,
    heading: Heading,
    /// Number of the set's first line in the text, from 1.
    place: usize,
    first: Option<Cow<'a, str>>,
    second: Option<Cow<'a, str>>,
}

/// Role of the text before a set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Heading {
    /// A line with the number 0.
    Numbered,
    /// Text that may be a name.
    Likely,
    Remark,
}

/// Elements of a set, and the numbers of its lines without a checksum.
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

/// Returns the name in a line 0. Space-Track starts this line with its number.
pub(super) fn name_in(line: &str) -> &str {
    let line = line.trim();
    line.strip_prefix("0 ").unwrap_or(line).trim()
}

/// Reads one set whose lines are given separately, as in JSON.
pub(super) fn read_lines(
    name: &str,
    first: Option<&str>,
    second: Option<&str>,
) -> Result<Read, RefusalReason> {
    let [first, second] = [first, second].map(|line| line.map(Cow::Borrowed));
    TleSet { text: name.into(), heading: Heading::Numbered, place: 1, first, second }.read()
}

/// Returns all sets of a text, in its order.
fn sets(text: &str) -> Vec<TleSet<'_>> {
    let mut is_gap = false;
    let lines = text.lines().zip(1..).filter_map(|(text, place)| {
        let follows_gap = std::mem::replace(&mut is_gap, text.trim().is_empty());
        TleLine::new(text, place, follows_gap)
    });
    let mut lines = lines.peekable();
    // Only the last line before a set can be its name; all other lines are remarks.
    let mut before: Option<Cow<'_, str>> = None;
    let mut sets: Vec<TleSet<'_>> = Vec::new();
    while let Some(line) = lines.next() {
        let (place, is_apart) = (line.place, line.follows_gap);
        let mut is_spaced = false;
        let (first, second) = if line.is_numbered('1') {
            let second = lines.next_if(|next| next.is_numbered('2'));
            is_spaced = second.as_ref().is_some_and(|second| second.follows_gap);
            (Some(line.text), second.map(|second| second.text))
        } else if line.is_numbered('2') {
            (None, Some(line.text))
        } else {
            before = Some(line.text);
            continue;
        };
        let text = before.take().unwrap_or_default();
        // An empty line separates a set from the text before it, unless there is an empty line
        // between all lines.
        let heading = if text.starts_with("0 ") {
            Heading::Numbered
        } else if is_remark(&text) || (is_apart && !is_spaced) {
            Heading::Remark
        } else {
            Heading::Likely
        };
        sets.push(TleSet { text, heading, place, first, second });
    }
    // If at most half of the sets have a name, the list has no names, and text before a set is a
    // heading. Sets with a torn line do not count.
    let whole = sets.iter().filter(|set| set.is_whole());
    let named = whole.clone().filter(|set| set.heading != Heading::Remark && !set.text.is_empty());
    if named.count() * 2 <= whole.count() {
        for set in sets.iter_mut().filter(|set| set.heading == Heading::Likely) {
            set.heading = Heading::Remark;
        }
    }
    sets
}

/// Returns `true` if `text` is not the name of a satellite, such as a heading with a date, an
/// address or a tag of a web page.
pub(crate) fn is_remark(text: &str) -> bool {
    let is_digit = |byte: Option<&u8>| byte.is_some_and(u8::is_ascii_digit);
    let bytes = text.as_bytes();
    let between_digits = |index: usize| {
        index > 0 && is_digit(bytes.get(index - 1)) && is_digit(bytes.get(index + 1))
    };
    let has_time = text.match_indices(':').any(|(position, _)| between_digits(position));
    text.chars().count() > MAX_NAME_CHARS
        || !text.contains(char::is_alphanumeric)
        || text.ends_with(':')
        || text.contains("://")
        || (text.contains('<') && text.contains('>'))
        || has_time
        || text.split(|letter: char| letter.is_whitespace() || "(),;".contains(letter)).any(is_date)
}

/// Returns `true` for three numbers of a date, such as 2026-11-27 or 27.11.26. Names such as
/// CX-1-02 have shorter numbers.
fn is_date(word: &str) -> bool {
    ['-', '.', '/'].into_iter().any(|sign| {
        let parts: Vec<&str> = word.split(sign).collect();
        let are_digits = parts.iter().all(|part| part.bytes().all(|byte| byte.is_ascii_digit()));
        let has_length = |length| move |part: &&str| part.len() == length;
        are_digits
            && parts.len() == 3
            && (parts.iter().any(has_length(4)) || parts.iter().all(has_length(2)))
    })
}

impl TleSet<'_> {
    /// Returns the name; empty if the text before the set is not its name.
    fn name(&self) -> &str {
        match self.heading {
            Heading::Numbered | Heading::Likely => name_in(&self.text),
            Heading::Remark => "",
        }
    }

    fn is_whole(&self) -> bool {
        let is_long = |line: &Option<Cow<'_, str>>| {
            line.as_ref().is_some_and(|line| line.len() >= MIN_LINE_CHARS)
        };
        is_long(&self.first) && is_long(&self.second)
    }

    /// Returns the catalog number as written.
    fn number(&self) -> Option<&str> {
        let line = self.first.as_ref().or(self.second.as_ref())?;
        line.get(2..7).map(str::trim).filter(|number| !number.is_empty())
    }

    /// Returns the text by which a refusal names the set: the text before the set, or else its
    /// number.
    fn object(&self) -> Option<&str> {
        Some(name_in(&self.text)).filter(|name| !name.is_empty()).or_else(|| self.number())
    }

    fn read(&self) -> Result<Read, RefusalReason> {
        let missing = |missing| RefusalReason::MissingLine { missing };
        let first = self.first.as_deref().ok_or(missing(1))?;
        let second = self.second.as_deref().ok_or(missing(2))?;
        let lines = [Columns::new(1, first)?, Columns::new(2, second)?];
        let [first, second] = &lines;
        let unprotected = [(1, first), (2, second)]
            .map(|(line, columns)| (!columns.has_checksum).then_some(line));
        Ok(Read { elements: elements(self.name(), &lines)?, unprotected })
    }
}

#[cfg(test)]
mod tests {
    use std::ops::RangeInclusive;

    use super::*;
    use crate::{ElementsError, reader::Refusal};

    const LINE_1: &str = "1 25544U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2927";
    const LINE_2: &str = "2 25544  51.6416 247.4627 0006703 130.5360 325.0288 15.72125391563537";

    /// Returns `line` with `text` written from `column` (from 1) on and the checksum corrected.
    fn replaced(line: &str, column: usize, text: &str) -> String {
        let mut line = line.to_owned();
        line.replace_range(column - 1..column - 1 + text.len(), text);
        let sum: u32 = line[..68]
            .chars()
            .map(|letter| if letter == '-' { 1 } else { letter.to_digit(10).unwrap_or(0) })
            .sum();
        line.replace_range(68..69, &(sum % 10).to_string());
        line
    }

    /// Returns the reason why the only set of `text` is refused.
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

    /// Reads `sets` sets without names, preceded by `text`, and returns the names that result.
    fn names(text: &str, sets: usize) -> Vec<String> {
        let set = format!("{LINE_1}\n{LINE_2}\n");
        let report = read(&format!("{text}\n{}", set.repeat(sets)));
        assert_eq!((report.elements.len(), &report.refused), (sets, &vec![]), "{text}");
        report.elements.iter().map(|elements| elements.name().to_owned()).collect()
    }

    #[test]
    fn text_around_sets_is_no_name() {
        for text in [
            "Last fetched 2026-11-27 06:00 UTC",
            "Updated 2026-11-27",
            "27.11.2026",
            "11/27/26 list",
            "Fetched 06:00 UTC",
            "https://example.org/a",
            "<pre>",
            "-----",
            "Weather satellites:",
            "Elements of the satellites that we use",
            "Weather\n",
            "Weather\n\n",
        ] {
            assert_eq!(names(text, 1), [""], "{text}");
            assert_eq!(names(text, 2), ["", ""], "{text}");
        }
        assert_eq!(names("Weather", 2), ["", ""]);
        assert_eq!(names("Weather", 1), ["Weather"]);
        for name in
            ["0 ISS", "ISS", "COSMOS 2251 DEB", "AO-07", "1KUNS-PF", "CX 1-02 (CX-1-02)", "A-1.5-2"]
        {
            assert_eq!(names(name, 1), [name.trim_start_matches("0 ")], "{name}");
        }
        let long = "0 A NAME OF MORE THAN TWENTY-FOUR LETTERS";
        assert_eq!(names(long, 3), [&long[2..], "", ""]);
        let report = read(&format!("Weather\n{LINE_1}\n{LINE_2}\n{LINE_1}\n{LINE_2}\n"));
        let noted: Vec<_> = report.notes.iter().map(|note| (note.line, note.kind)).collect();
        assert_eq!(noted, [(2, NoteKind::TextBefore)]);
    }

    #[test]
    fn names_in_a_text_with_empty_lines_everywhere_are_read() {
        let text = format!("ISS\n\n{LINE_1}\n\n{LINE_2}\n\nISS B\n\n{LINE_1}\n\n{LINE_2}\n");
        let names: Vec<_> =
            read(&text).elements.iter().map(|elements| elements.name().to_owned()).collect();
        assert_eq!(names, ["ISS", "ISS B"]);
    }

    #[test]
    fn signs_of_web_pages_and_mails_in_the_lines_are_read() {
        let plain = format!("ISS\n{LINE_1}\n{LINE_2}\n");
        for text in [
            plain.replace(' ', "\u{a0}"),
            plain.replace("1 ", "1\u{2007}"),
            plain.replace('-', "\u{2212}"),
            plain.replace('\n', "\u{200b}\n").replace("1 2", "1\u{200b} 2"),
            plain.replace("ISS", "\u{feff}ISS").replace("\n1", "\n\u{feff}1"),
            plain.lines().flat_map(|line| ["> > ", line, "\n"]).collect(),
        ] {
            let report = read(&text);
            assert_eq!(report.refused, [], "{text:?}");
            assert_eq!(report.elements, read(&plain).elements, "{text:?}");
        }
    }

    #[test]
    fn alpha_5_numbers_are_read() {
        let text = format!("{}\n{}\n", replaced(LINE_1, 3, "T0001"), replaced(LINE_2, 3, "T0001"));
        let report = read(&text);
        assert_eq!(report.refused, []);
        assert_eq!(report.elements[0].catalog_number(), 270_001);
    }

    #[test]
    fn blank_old_fields_are_read() {
        let first = replaced(LINE_1, 63, " ");
        let report = read(&format!("{}\n{LINE_2}\n", replaced(&first, 8, " ")));
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
            let first = replaced(LINE_1, 19, text);
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

    /// Returns the sets that result from `first` and `second` with `text` in each column of a
    /// number in turn, each with the previous content of the column.
    fn each_with(first: &str, second: &str, text: &str) -> Vec<(String, String)> {
        let lines = [first, second];
        let mut sets = Vec::new();
        for (index, columns) in NUMBERS.iter().enumerate() {
            for column in columns.iter().cloned().flatten() {
                let mut lines = lines.map(str::to_owned);
                let original = lines[index][column - 1..column].to_owned();
                lines[index] = replaced(&lines[index], column, text);
                if column <= 7 {
                    lines[1 - index] = replaced(&lines[1 - index], column, text);
                }
                sets.push((original, lines.join("\n")));
            }
        }
        sets
    }

    #[test]
    fn a_blank_in_place_of_a_digit_is_read_as_0_or_refused() {
        // Every field ends in 0, and B* and the second derivative are present.
        let first = replaced(LINE_1, 45, " 12340-5 -11600-4 0  290");
        let first = replaced(&replaced(&first, 3, "25540"), 43, "0");
        let second = replaced(LINE_2, 3, "25540  51.6410 247.4620 0006700 130.5360 325.0280");
        let second = replaced(&second, 53, "15.7212539056350");
        assert_eq!(read(&format!("{first}\n{second}")).refused, []);
        let zeros = each_with(&first, &second, "0");
        let mut refused = 0;
        for ((original, blank), (_, zero)) in each_with(&first, &second, " ").iter().zip(&zeros) {
            let (read_blank, read_zero) = (read(blank), read(zero));
            let is_number = original.bytes().all(|byte| byte.is_ascii_digit());
            let same = read_blank.elements == read_zero.elements;
            assert!(!read_blank.refused.is_empty() || (same || !is_number), "{blank}");
            refused += read_blank.refused.len();
        }
        assert!(refused > 20, "{refused}");
        // The blank replaces the last digit of an eccentricity and of B*.
        for (place, text) in [("ECCENTRICITY", 33), ("BSTAR", 59)] {
            let lines = match place {
                "BSTAR" => [replaced(&first, text, " "), second.clone()],
                _ => [first.clone(), replaced(&second, text, " ")],
            };
            assert_eq!(refusal(&lines.join("\n")), RefusalReason::Field(place));
        }
    }

    #[test]
    fn no_letter_is_part_of_a_number() {
        for letter in ["e", "E"] {
            for (_, set) in each_with(LINE_1, LINE_2, letter) {
                // In column 3, the letter is the first letter of an Alpha-5 number.
                if !set.contains("1 E") {
                    assert_eq!(read(&set).elements, [], "{set}");
                }
            }
        }
        let first = replaced(LINE_2, 9, " 51.6e25");
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
        let other = replaced(LINE_2, 3, "25545");
        assert_eq!(refusal(&format!("{LINE_1}\n{other}")), Why::TwoObjects);
        let shifted = replaced(LINE_2, 17, "2");
        let column = Why::Shifted { line: 2, column: 17 };
        assert_eq!(refusal(&format!("{LINE_1}\n{shifted}")), column);
        let xp = replaced(LINE_1, 63, "4");
        let orbit = Why::Orbit(ElementsError::EphemerisType(4));
        assert_eq!(refusal(&format!("{xp}\n{LINE_2}")), orbit);
        let still = replaced(LINE_2, 53, " 0.00000000");
        let orbit = Why::Orbit(ElementsError::MeanMotion(0.0));
        assert_eq!(refusal(&format!("{LINE_1}\n{still}")), orbit);
    }
}
