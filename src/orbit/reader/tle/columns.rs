//! The columns of one TLE.
//!
//! Source: `CelesTrak`, "NORAD Two-Line Element Set Format". Columns count from 1.

use std::{ops::RangeInclusive, str::FromStr};

use jiff::{SignedDuration, Timestamp, civil, tz::TimeZone};
use smol_str::SmolStr;

use super::super::{RefusalReason, clean, numbers};
use crate::orbit::{
    Elements,
    elements::{Classification, catalog_number},
};

/// Number of columns of a line; what follows them is not part of the set.
const COLUMNS: usize = 69;
/// Columns of lines 1 and 2 that are always blank.
const BLANK: [&[usize]; 2] = [&[2, 9, 18, 33, 44, 53, 62, 64], &[2, 8, 17, 26, 34, 43, 52]];
/// The last digit of the epoch of a TLE, 1e-8 days, in microseconds.
const EPOCH_STEP_US: i64 = 864;

/// One line of a set, known to be ASCII and to match its checksum.
pub(super) struct Columns {
    bytes: [u8; COLUMNS],
    /// Column 69 holds a digit.
    pub(super) has_checksum: bool,
}

impl Columns {
    /// Checks line `line` (1 or 2) of a set.
    pub(super) fn new(line: u8, text: &str) -> Result<Self, RefusalReason> {
        let mut bytes = [b' '; COLUMNS];
        let given = text.as_bytes();
        if given.len() < COLUMNS - 1 {
            return Err(RefusalReason::TooShort { line, columns: given.len() });
        }
        for (column, byte) in bytes.iter_mut().zip(given) {
            // A tab is read as one blank; if it replaced more than one, the columns
            // after it are wrong.
            *column = if *byte == b'\t' { b' ' } else { *byte };
        }
        if !bytes.is_ascii() {
            return Err(RefusalReason::NotAscii { line });
        }
        let [content @ .., check] = &bytes;
        let has_checksum = *check != b' ';
        if has_checksum {
            if !check.is_ascii_digit() {
                return Err(RefusalReason::ChecksumNotDigit { line });
            }
            let (found, expected) = (check - b'0', checksum(content));
            if found != expected {
                return Err(RefusalReason::Checksum { line, found, expected });
            }
        }
        let [first, second] = BLANK;
        for &column in if line == 1 { first } else { second } {
            if bytes.get(column - 1) != Some(&b' ') {
                return Err(RefusalReason::Shifted { line, column });
            }
        }
        Ok(Self { bytes, has_checksum })
    }

    /// The text in `columns`, trimmed.
    fn text(&self, columns: RangeInclusive<usize>) -> &str {
        self.bytes
            .get(columns.start() - 1..*columns.end())
            .and_then(|bytes| str::from_utf8(bytes).ok())
            .unwrap_or_default()
            .trim()
    }

    /// A number; `None` if the columns are blank.
    fn number<T: FromStr>(
        &self,
        columns: RangeInclusive<usize>,
        field: &'static str,
    ) -> Result<Option<T>, RefusalReason> {
        let text = self.text(columns);
        if text.is_empty() {
            return Ok(None);
        }
        text.parse().map(Some).map_err(|_| RefusalReason::Field(field))
    }

    fn needed<T: FromStr>(
        &self,
        columns: RangeInclusive<usize>,
        field: &'static str,
    ) -> Result<T, RefusalReason> {
        self.number(columns, field)?.ok_or(RefusalReason::MissingField(field))
    }

    /// A number of the form `-12345-6`, which means -0.12345e-6. All blank is 0.
    fn assumed_point(&self, start: usize, field: &'static str) -> Result<f64, RefusalReason> {
        if self.text(start..=start + 7).is_empty() {
            return Ok(0.0);
        }
        let sign = self.text(start..=start);
        let digits = self.zero_filled(start + 1..=start + 5);
        let exponent: i8 = self.needed(start + 6..=start + 7, field)?;
        // Parsed as one decimal number, so that it equals that of an OMM.
        format!("{sign}0.{digits}e{exponent}").parse().map_err(|_| RefusalReason::Field(field))
    }

    /// The digits in `columns`; old sets leave leading zeros blank.
    fn zero_filled(&self, columns: RangeInclusive<usize>) -> String {
        let width = columns.end() - columns.start() + 1;
        format!("{:0>width$}", self.text(columns))
    }

    fn catalog_number(&self) -> Result<u64, RefusalReason> {
        numbers::catalog_number(self.text(3..=7)).ok_or(RefusalReason::Field("NORAD_CAT_ID"))
    }

    /// Such as `1998-067A` for `98067A`.
    fn international_designator(&self) -> SmolStr {
        let text = self.text(10..=17);
        let Some((launch_year, rest)) = text.split_at_checked(2) else { return SmolStr::default() };
        match launch_year.parse().ok() {
            Some(launch_year) => clean(&format!("{}-{rest}", full_year(launch_year))),
            None => SmolStr::default(),
        }
    }

    fn epoch(&self) -> Option<Timestamp> {
        let year = full_year(self.text(19..=20).parse().ok()?);
        let new_year = civil::Date::new(year, 1, 1).ok()?;
        let (day, fraction) = self.text(21..=32).split_once('.')?;
        let day: i64 = day.trim().parse().ok()?;
        if !(1..=i64::from(new_year.days_in_year())).contains(&day) {
            return None;
        }
        let fraction = fraction.get(..8).unwrap_or(fraction);
        let steps = i64::try_from(numbers::digits(&format!("{fraction:0<8}"))?).ok()?;
        let since_new_year = SignedDuration::from_hours(24 * (day - 1))
            + SignedDuration::from_micros(steps * EPOCH_STEP_US);
        let start = new_year.to_zoned(TimeZone::UTC).ok()?.timestamp();
        start.checked_add(since_new_year).ok()
    }
}

/// The checksum of the columns before it: the sum of all digits modulo 10, in which a minus
/// counts as one.
pub(in crate::orbit) fn checksum(content: &[u8]) -> u8 {
    let sum: u32 = content
        .iter()
        .map(|byte| match byte {
            b'-' => 1,
            b'0'..=b'9' => u32::from(byte - b'0'),
            _ => 0,
        })
        .sum();
    (sum % 10) as u8
}

/// The year that two digits mean: 57 is the year of the first satellite.
fn full_year(two_digits: u8) -> i16 {
    i16::from(two_digits) + if two_digits < 57 { 2000 } else { 1900 }
}

pub(super) fn elements(
    name: &str,
    [first, second]: &[Columns; 2],
) -> Result<Elements, RefusalReason> {
    let number = first.catalog_number()?;
    if number != second.catalog_number()? {
        return Err(RefusalReason::TwoObjects);
    }
    let classification = match first.text(8..=8) {
        "" => Classification::default(),
        letter @ ("U" | "C" | "S") => Classification::from_letter(letter),
        _ => return Err(RefusalReason::Field("CLASSIFICATION_TYPE")),
    };
    let eccentricity = format!("0.{}", second.zero_filled(27..=33));
    let elements = Elements {
        name: clean(name),
        international_designator: first.international_designator(),
        catalog_number: catalog_number(number)?,
        epoch: first.epoch().ok_or(RefusalReason::Field("EPOCH"))?,
        mean_motion_rev_day: second.needed(53..=63, "MEAN_MOTION")?,
        mean_motion_dot: first.number(34..=43, "MEAN_MOTION_DOT")?.unwrap_or(0.0),
        mean_motion_ddot: first.assumed_point(45, "MEAN_MOTION_DDOT")?,
        bstar: first.assumed_point(54, "BSTAR")?,
        inclination_deg: second.needed(9..=16, "INCLINATION")?,
        node_deg: second.needed(18..=25, "RA_OF_ASC_NODE")?,
        eccentricity: eccentricity.parse().map_err(|_| RefusalReason::Field("ECCENTRICITY"))?,
        perigee_deg: second.needed(35..=42, "ARG_OF_PERICENTER")?,
        mean_anomaly_deg: second.needed(44..=51, "MEAN_ANOMALY")?,
        set_number: first.number(65..=68, "ELEMENT_SET_NO")?.unwrap_or(0),
        revolution_number: second.number(64..=68, "REV_AT_EPOCH")?.unwrap_or(0),
        ephemeris_type: first.number(63..=63, "EPHEMERIS_TYPE")?.unwrap_or(0),
        classification,
    };
    Ok(elements.checked()?)
}
