//! The columns of one TLE.
//!
//! Source: `CelesTrak`, "NORAD Two-Line Element Set Format". Columns count from 1.

use std::ops::RangeInclusive;

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

    fn raw(&self, columns: RangeInclusive<usize>) -> &str {
        self.bytes
            .get(columns.start() - 1..*columns.end())
            .and_then(|bytes| str::from_utf8(bytes).ok())
            .unwrap_or_default()
    }

    /// The text in `columns`, trimmed.
    fn text(&self, columns: RangeInclusive<usize>) -> &str {
        self.raw(columns).trim()
    }

    /// Text that ends in the last of its columns. A whole number with a blank in place of its
    /// last digit would be read as a tenth of itself.
    fn right_aligned(&self, columns: RangeInclusive<usize>) -> &str {
        self.raw(columns).trim_start()
    }

    /// A number with a decimal point; `None` if the columns are blank.
    fn decimal(
        &self,
        columns: RangeInclusive<usize>,
        field: &'static str,
    ) -> Result<Option<f64>, RefusalReason> {
        match self.text(columns) {
            "" => Ok(None),
            text => numbers::with_point(text).map(Some).ok_or(RefusalReason::Field(field)),
        }
    }

    fn needed(
        &self,
        columns: RangeInclusive<usize>,
        field: &'static str,
    ) -> Result<f64, RefusalReason> {
        self.decimal(columns, field)?.ok_or(RefusalReason::MissingField(field))
    }

    /// A whole number, 0 if the columns are blank.
    fn count<T: TryFrom<u64> + Default>(
        &self,
        columns: RangeInclusive<usize>,
        field: &'static str,
    ) -> Result<T, RefusalReason> {
        match self.right_aligned(columns) {
            "" => Ok(T::default()),
            text => numbers::digits(text)
                .and_then(|number| T::try_from(number).ok())
                .ok_or(RefusalReason::Field(field)),
        }
    }

    /// A fraction without its point: `0.0001771` for `0001771`.
    fn fraction(
        &self,
        columns: RangeInclusive<usize>,
        field: &'static str,
    ) -> Result<String, RefusalReason> {
        let width = columns.end() - columns.start() + 1;
        let text = self.right_aligned(columns);
        numbers::digits(text).ok_or(RefusalReason::Field(field))?;
        // Old sets leave leading zeros blank.
        Ok(format!("0.{text:0>width$}"))
    }

    /// A number of the form `-12345-6`, which means -0.12345e-6. All blank is 0.
    fn assumed_point(&self, start: usize, field: &'static str) -> Result<f64, RefusalReason> {
        if self.text(start..=start + 7).is_empty() {
            return Ok(0.0);
        }
        let sign @ ("" | "+" | "-") = self.text(start..=start) else {
            return Err(RefusalReason::Field(field));
        };
        let fraction = self.fraction(start + 1..=start + 5, field)?;
        let exponent = self.right_aligned(start + 6..=start + 7).parse::<i8>();
        let exponent = exponent.map_err(|_| RefusalReason::Field(field))?;
        // Parsed as one decimal number, so that it equals that of an OMM.
        format!("{sign}{fraction}e{exponent}").parse().map_err(|_| RefusalReason::Field(field))
    }

    fn catalog_number(&self) -> Result<u64, RefusalReason> {
        let text = self.right_aligned(3..=7);
        numbers::alpha_5(text).ok_or(RefusalReason::Field("NORAD_CAT_ID"))
    }

    /// Such as `1998-067A` for `98067A`.
    fn international_designator(&self) -> SmolStr {
        match full_year(self.right_aligned(10..=11)) {
            Some(launch_year) => clean(&format!("{launch_year}-{}", self.text(12..=17))),
            None => SmolStr::default(),
        }
    }

    fn epoch(&self) -> Option<Timestamp> {
        let year = full_year(self.right_aligned(19..=20))?;
        let new_year = civil::Date::new(year, 1, 1).ok()?;
        let (day, fraction) = self.text(21..=32).split_once('.')?;
        let day = i64::try_from(numbers::digits(day)?).ok()?;
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
fn full_year(two_digits: &str) -> Option<i16> {
    let year = i16::try_from(numbers::digits(two_digits)?).ok()?;
    Some(year + if year < 57 { 2000 } else { 1900 })
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
    let eccentricity = second.fraction(27..=33, "ECCENTRICITY")?;
    let elements = Elements {
        name: clean(name),
        international_designator: first.international_designator(),
        catalog_number: catalog_number(number)?,
        epoch: first.epoch().ok_or(RefusalReason::Field("EPOCH"))?,
        mean_motion_rev_day: second.needed(53..=63, "MEAN_MOTION")?,
        mean_motion_dot: first.decimal(34..=43, "MEAN_MOTION_DOT")?.unwrap_or(0.0),
        mean_motion_ddot: first.assumed_point(45, "MEAN_MOTION_DDOT")?,
        bstar: first.assumed_point(54, "BSTAR")?,
        inclination_deg: second.needed(9..=16, "INCLINATION")?,
        node_deg: second.needed(18..=25, "RA_OF_ASC_NODE")?,
        eccentricity: eccentricity.parse().map_err(|_| RefusalReason::Field("ECCENTRICITY"))?,
        perigee_deg: second.needed(35..=42, "ARG_OF_PERICENTER")?,
        mean_anomaly_deg: second.needed(44..=51, "MEAN_ANOMALY")?,
        set_number: first.count(65..=68, "ELEMENT_SET_NO")?,
        revolution_number: second.count(64..=68, "REV_AT_EPOCH")?,
        ephemeris_type: first.count(63..=63, "EPHEMERIS_TYPE")?,
        classification,
    };
    Ok(elements.checked()?)
}
