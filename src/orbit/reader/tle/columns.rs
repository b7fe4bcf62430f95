//! The columns of one TLE.
//!
//! Source: `CelesTrak`, "NORAD Two-Line Element Set Format". Columns count from 1.

use std::{borrow::Cow, ops::RangeInclusive};

use jiff::{SignedDuration, Timestamp, civil, tz::Offset};
use smol_str::{SmolStr, format_smolstr};

use super::super::{RefusalReason, clean, numbers};
use crate::{
    Elements,
    elements::{Classification, catalog_number},
};

/// Number of columns of a line; any text after them is not part of the set.
const COLUMNS: usize = 69;
/// Columns of lines 1 and 2 that are always blank.
const BLANK: [&[usize]; 2] = [&[2, 9, 18, 33, 44, 53, 62, 64], &[2, 8, 17, 26, 34, 43, 52]];
/// Number of digits in the fraction of a day in the epoch.
const EPOCH_DIGITS: usize = 8;
/// Last digit of the epoch, 1e-8 days, in microseconds.
const EPOCH_STEP_US: i64 = 864;

/// One line of a set, checked to be ASCII and to match its checksum.
pub(super) struct Columns<'a> {
    /// Text with 68 or 69 columns.
    text: Cow<'a, str>,
    /// Column 69 holds a digit.
    pub(super) has_checksum: bool,
}

impl<'a> Columns<'a> {
    /// Checks line `line` (1 or 2) of a set.
    pub(super) fn new(line: u8, source: &'a str) -> Result<Self, RefusalReason> {
        if source.len() < COLUMNS - 1 {
            return Err(RefusalReason::TooShort { line, columns: source.len() });
        }
        // A boundary inside a character means that the text is not ASCII.
        let Some(text) = source.get(..COLUMNS.min(source.len())).filter(|text| text.is_ascii())
        else {
            return Err(RefusalReason::NotAscii { line });
        };
        // A tab counts as one blank; if the tab replaced several blanks, the columns after it are
        // wrong.
        let text = if text.contains('\t') { text.replace('\t', " ").into() } else { text.into() };
        let columns = Self { text, has_checksum: false };
        let (content, check) = columns.text.as_bytes().split_at(COLUMNS - 1);
        let has_checksum = match check {
            [] | [b' '] => false,
            [check @ b'0'..=b'9'] => {
                let (found, expected) = (check - b'0', checksum(content));
                if found != expected {
                    return Err(RefusalReason::Checksum { line, found, expected });
                }
                true
            }
            _ => return Err(RefusalReason::ChecksumNotDigit { line }),
        };
        let [first, second] = BLANK;
        for &column in if line == 1 { first } else { second } {
            if content.get(column - 1) != Some(&b' ') {
                return Err(RefusalReason::Shifted { line, column });
            }
        }
        Ok(Self { has_checksum, ..columns })
    }

    fn raw(&self, columns: RangeInclusive<usize>) -> &str {
        self.text.get(columns.start() - 1..*columns.end()).unwrap_or_default()
    }

    /// Returns the text in `columns`, trimmed.
    fn text(&self, columns: RangeInclusive<usize>) -> &str {
        self.raw(columns).trim_ascii()
    }

    /// Returns text that ends in the last of its columns. A whole number with a blank in place of
    /// its last digit would be read as a tenth of its value.
    fn right_aligned(&self, columns: RangeInclusive<usize>) -> &str {
        self.raw(columns).trim_ascii_start()
    }

    /// Returns a number with a decimal point; `None` if the columns are blank.
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

    /// Returns a whole number, 0 if the columns are blank.
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

    /// Returns the digits of a fraction without its point: 1771 for `0001771`, which means
    /// 0.0001771. Old sets leave leading zeros blank.
    fn fraction(
        &self,
        columns: RangeInclusive<usize>,
        field: &'static str,
    ) -> Result<u64, RefusalReason> {
        numbers::digits(self.right_aligned(columns)).ok_or(RefusalReason::Field(field))
    }

    /// Returns a number of the form `-12345-6`, which means -0.12345e-6. Blank columns mean 0.
    fn assumed_point(&self, start: usize, field: &'static str) -> Result<f64, RefusalReason> {
        if self.text(start..=start + 7).is_empty() {
            return Ok(0.0);
        }
        let sign = match self.text(start..=start) {
            "" | "+" => 1.0,
            "-" => -1.0,
            _ => return Err(RefusalReason::Field(field)),
        };
        let fraction = self.fraction(start + 1..=start + 5, field)?;
        let exponent = self.right_aligned(start + 6..=start + 7).parse::<i8>();
        let exponent = exponent.map_err(|_| RefusalReason::Field(field))?;
        Ok(sign * decimal(fraction, exponent - 5))
    }

    fn catalog_number(&self) -> Result<u64, RefusalReason> {
        let text = self.right_aligned(3..=7);
        numbers::alpha_5(text).ok_or(RefusalReason::Field("NORAD_CAT_ID"))
    }

    /// Returns the international designator, such as `1998-067A` for `98067A`.
    fn international_designator(&self) -> SmolStr {
        match full_year(self.right_aligned(10..=11)) {
            Some(launch_year) => clean(&format_smolstr!("{launch_year}-{}", self.text(12..=17))),
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
        let fraction = fraction.get(..EPOCH_DIGITS).unwrap_or(fraction);
        let digits =
            if fraction.is_empty() { 0 } else { i64::try_from(numbers::digits(fraction)?).ok()? };
        let steps = digits * 10_i64.pow((EPOCH_DIGITS - fraction.len()) as u32);
        let since_new_year = SignedDuration::from_hours(24 * (day - 1))
            + SignedDuration::from_micros(steps * EPOCH_STEP_US);
        let start = Offset::UTC.to_timestamp(new_year.into()).ok()?;
        start.checked_add(since_new_year).ok()
    }
}

/// Returns `digits` times a power of ten, from 1e-14 to 1e94. The result is the nearest number, as
/// for the whole number in an OMM.
fn decimal(digits: u64, exponent: i8) -> f64 {
    let size = 10_f64.powi(i32::from(exponent).abs());
    match exponent {
        // Both operands are exact, so the division rounds only once.
        -22..=0 => digits as f64 / size,
        _ => format!("{digits}e{exponent}").parse().unwrap_or(f64::NAN),
    }
}

/// Returns the checksum of the columns: the sum of all digits modulo 10, in which a minus counts as
/// one.
pub(crate) fn checksum(content: &[u8]) -> u8 {
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

/// Returns the year for two digits: 57 is the year of the first satellite.
fn full_year(two_digits: &str) -> Option<i16> {
    let year = i16::try_from(numbers::digits(two_digits)?).ok()?;
    Some(year + if year < 57 { 2000 } else { 1900 })
}

pub(super) fn elements(
    name: &str,
    [first, second]: &[Columns<'_>; 2],
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
        eccentricity: decimal(eccentricity, -7),
        perigee_deg: second.needed(35..=42, "ARG_OF_PERICENTER")?,
        mean_anomaly_deg: second.needed(44..=51, "MEAN_ANOMALY")?,
        set_number: first.count(65..=68, "ELEMENT_SET_NO")?,
        revolution_number: second.count(64..=68, "REV_AT_EPOCH")?,
        ephemeris_type: first.count(63..=63, "EPHEMERIS_TYPE")?,
        classification,
    };
    Ok(elements.checked()?)
}
