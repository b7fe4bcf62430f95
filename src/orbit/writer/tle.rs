//! TLE, within the limits of its columns.
//!
//! Source: `CelesTrak`, "NORAD Two-Line Element Set Format"; Space-Track, "Alpha-5".

use std::io::{self, Write};

use jiff::{Timestamp, civil, tz::TimeZone};

use crate::{
    Elements,
    reader::{ALPHA_5, checksum, is_remark},
};

/// Number of columns of a name line.
const NAME_COLUMNS: usize = 24;
/// Last digit of the epoch, 1e-8 days, in microseconds.
const EPOCH_STEP_US: i64 = 864;
const STEPS_A_DAY: i64 = 100_000_000;
/// Years that two digits can express.
const YEARS: std::ops::RangeInclusive<i16> = 1957..=2056;

/// One object that no TLE can carry.
#[derive(Debug, Clone, PartialEq)]
pub struct TleRefusal {
    pub catalog_number: u32,
    pub reason: TleRefusalReason,
}

/// Reason why a TLE cannot carry an object.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum TleRefusalReason {
    /// The catalog number is above 339999, the end of Alpha-5.
    #[error("a TLE carries catalogue numbers up to 339999")]
    CatalogNumber,
    /// The epoch is outside the years from 1957 to 2056, which two digits can express.
    #[error("a TLE carries epochs from 1957 to 2056")]
    Epoch,
    /// A number, given by its name in an OMM, is too large or too small for its columns.
    #[error("{0} does not fit into the columns of a TLE")]
    Columns(&'static str),
}

/// Writes all `elements` that a TLE can carry, and returns the others. A name comes before the two
/// lines of its set. The function fails only if `out` fails.
///
/// A name is cut after 24 columns, and `?` replaces characters outside ASCII. A designator in
/// another form is left blank. The element set and revolution numbers keep their last four and five
/// digits. None of these losses affects the position of the object.
pub fn write_tle<'a>(
    elements: impl IntoIterator<Item = &'a Elements>,
    mut out: impl Write,
) -> io::Result<Vec<TleRefusal>> {
    let mut refused = Vec::new();
    for elements in elements {
        match tle_lines(elements) {
            Ok([first, second]) => {
                if !elements.name.is_empty() {
                    writeln!(out, "{}", name_line(&elements.name))?;
                }
                writeln!(out, "{first}\n{second}")?;
            }
            Err(reason) => {
                refused.push(TleRefusal { catalog_number: elements.catalog_number, reason });
            }
        }
    }
    Ok(refused)
}

fn name_line(name: &str) -> String {
    let letters = name.chars().map(|letter| if letter.is_ascii() { letter } else { '?' });
    let name: String = letters.take(NAME_COLUMNS).collect();
    let name = name.trim_end();
    // A reader would take such names for a remark or another form, or would lose their start.
    let is_odd = !name.starts_with(|letter: char| letter.is_ascii_alphanumeric())
        || name.contains('=')
        || name.starts_with("0 ")
        || is_remark(name);
    if is_odd { format!("0 {name}") } else { name.into() }
}

/// Returns the two lines of a set, 69 columns each.
pub fn tle_lines(elements: &Elements) -> Result<[String; 2], TleRefusalReason> {
    let number = number(elements.catalog_number)?;
    let first = format!(
        "1 {number}{} {:8} {} {} {} {} {} {:>4}",
        elements.classification.letter(),
        designator(&elements.international_designator).unwrap_or_default(),
        epoch(elements.epoch)?,
        fraction(elements.mean_motion_dot).ok_or(TleRefusalReason::Columns("MEAN_MOTION_DOT"))?,
        assumed_point(elements.mean_motion_ddot)
            .ok_or(TleRefusalReason::Columns("MEAN_MOTION_DDOT"))?,
        assumed_point(elements.bstar).ok_or(TleRefusalReason::Columns("BSTAR"))?,
        elements.ephemeris_type,
        elements.set_number % 10_000,
    );
    let second = format!(
        "2 {number} {} {} {} {} {} {}{:>5}",
        degrees(elements.inclination_deg).ok_or(TleRefusalReason::Columns("INCLINATION"))?,
        turned(elements.node_deg).ok_or(TleRefusalReason::Columns("RA_OF_ASC_NODE"))?,
        eccentricity(elements.eccentricity).ok_or(TleRefusalReason::Columns("ECCENTRICITY"))?,
        turned(elements.perigee_deg).ok_or(TleRefusalReason::Columns("ARG_OF_PERICENTER"))?,
        turned(elements.mean_anomaly_deg).ok_or(TleRefusalReason::Columns("MEAN_ANOMALY"))?,
        mean_motion(elements.mean_motion_rev_day)
            .ok_or(TleRefusalReason::Columns("MEAN_MOTION"))?,
        elements.revolution_number % 100_000,
    );
    Ok([first, second].map(|line| format!("{line}{}", checksum(line.as_bytes()))))
}

/// Returns the number in five columns: digits, or a letter for the first two of six digits.
fn number(number: u32) -> Result<String, TleRefusalReason> {
    let (leading, rest) = (number / 10_000, number % 10_000);
    if leading < 10 {
        return Ok(format!("{number:05}"));
    }
    let letter = ALPHA_5.chars().nth(leading as usize - 10);
    Ok(format!("{}{rest:04}", letter.ok_or(TleRefusalReason::CatalogNumber)?))
}

/// Returns `98067A` for `1998-067A`; `None` for any other form.
fn designator(text: &str) -> Option<String> {
    let (year, piece) = text.split_once('-')?;
    let fits = piece.len() <= 6 && piece.bytes().all(|byte| byte.is_ascii_graphic());
    let year: i16 = year.parse().ok().filter(|year| YEARS.contains(year) && fits)?;
    Some(format!("{:02}{piece}", year % 100))
}

/// Returns the epoch in 14 columns: two digits of the year, then the day of the year from 1 on.
fn epoch(epoch: Timestamp) -> Result<String, TleRefusalReason> {
    // Every day begins on a whole step, so rounding comes first and determines the year.
    let steps = (epoch.as_microsecond() + EPOCH_STEP_US / 2).div_euclid(EPOCH_STEP_US);
    let of_day = steps.rem_euclid(STEPS_A_DAY);
    let date = Timestamp::from_microsecond(steps * EPOCH_STEP_US)
        .map(|rounded| rounded.to_zoned(TimeZone::UTC).date())
        .ok()
        .filter(|date: &civil::Date| YEARS.contains(&date.year()))
        .ok_or(TleRefusalReason::Epoch)?;
    Ok(format!("{:02}{:03}.{of_day:08}", date.year() % 100, date.day_of_year()))
}

/// Returns the number in ten columns: sign, point, eight digits.
fn fraction(number: f64) -> Option<String> {
    let text = format!("{:.8}", number.abs());
    let digits = text.strip_prefix('0')?;
    Some(format!("{}{digits}", sign(number)))
}

/// Returns the number in eight columns: `-12345-6` for -0.12345e-6.
fn assumed_point(number: f64) -> Option<String> {
    let scientific = format!("{:.4e}", number.abs());
    let (digits, exponent) = scientific.split_once('e')?;
    let exponent = exponent.parse::<i32>().ok()? + 1;
    let (digits, exponent) = match exponent {
        _ if number == 0.0 => ("00000".to_owned(), 0),
        -9..=9 => (digits.replace('.', ""), exponent),
        // The number is too small for five digits, so fewer digits remain.
        ..-9 => (format!("{:05.0}", number.abs() * 1e14), -9),
        _ => return None,
    };
    Some(format!("{}{digits}{exponent:+}", sign(number)))
}

fn sign(number: f64) -> char {
    if number.is_sign_negative() { '-' } else { ' ' }
}

/// Returns the angle in eight columns.
fn degrees(angle_deg: f64) -> Option<String> {
    Some(format!("{angle_deg:8.4}")).filter(|text| text.len() == 8)
}

/// Returns an angle in eight columns, wrapped to one turn if necessary.
fn turned(angle_deg: f64) -> Option<String> {
    let is_plain = (0.0..=360.0).contains(&angle_deg);
    degrees(if is_plain { angle_deg } else { angle_deg.rem_euclid(360.0) })
}

/// Returns the seven digits after an implied point.
fn eccentricity(eccentricity: f64) -> Option<String> {
    format!("{eccentricity:.7}").strip_prefix("0.").map(str::to_owned)
}

/// Returns the mean motion in eleven columns.
fn mean_motion(rev_day: f64) -> Option<String> {
    let text = format!("{rev_day:11.8}");
    Some(text)
        .filter(|text| text.len() == 11 && text.bytes().any(|byte| matches!(byte, b'1'..=b'9')))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_go_up_to_the_last_letter() {
        for (input, expected) in [
            (5, Ok("00005")),
            (99_999, Ok("99999")),
            (100_000, Ok("A0000")),
            (180_000, Ok("J0000")),
            (339_999, Ok("Z9999")),
            (340_000, Err(TleRefusalReason::CatalogNumber)),
            (999_999_999, Err(TleRefusalReason::CatalogNumber)),
        ] {
            assert_eq!(number(input), expected.map(str::to_owned), "{input}");
        }
    }

    #[test]
    fn drag_terms_take_their_columns() {
        for (input, expected) in [
            (0.000_353_83, Some(" 35383-3")),
            (-0.000_011_606, Some("-11606-4")),
            (0.5, Some(" 50000+0")),
            (0.999_999, Some(" 10000+1")),
            (0.0, Some(" 00000+0")),
            (-1.234_5e8, Some("-12345+9")),
            (1.0e9, None),
            (1.23e-11, Some(" 01230-9")),
            (1.0e-20, Some(" 00000-9")),
            (f64::MAX, None),
        ] {
            assert_eq!(assumed_point(input).as_deref(), expected, "{input}");
        }
        assert_eq!(fraction(-0.000_021_82).as_deref(), Some("-.00002182"));
        assert_eq!(fraction(0.999_999_999), None);
    }

    #[test]
    fn other_numbers_take_their_columns_or_none() {
        assert_eq!(turned(-10.0).as_deref(), Some("350.0000"));
        assert_eq!(turned(359.999_96).as_deref(), Some("360.0000"));
        assert_eq!(degrees(1234.5), None);
        assert_eq!(eccentricity(0.000_177_1).as_deref(), Some("0001771"));
        assert_eq!(eccentricity(0.999_999_96), None);
        assert_eq!(mean_motion(1.002_7).as_deref(), Some(" 1.00270000"));
        assert_eq!((mean_motion(100.0), mean_motion(1e-9)), (None, None));
        assert_eq!(designator("1998-067A").as_deref(), Some("98067A"));
        for none in ["", "UNKNOWN", "1998-067ABCD", "2198-001A", "1998-0 7A"] {
            assert_eq!(designator(none), None, "{none}");
        }
    }

    #[test]
    fn an_epoch_at_the_end_of_a_year_may_round_into_the_next() {
        let text = |iso: &str| epoch(iso.parse().unwrap());
        assert_eq!(text("2025-12-31T23:59:59.9999Z"), Ok("26001.00000000".to_owned()));
        assert_eq!(text("2024-12-31T12:00:00Z"), Ok("24366.50000000".to_owned()));
        assert_eq!(text("1957-10-04T00:00:00.000864Z"), Ok("57277.00000001".to_owned()));
        assert_eq!(text("2057-01-01T00:00:00Z"), Err(TleRefusalReason::Epoch));
    }

    #[test]
    fn names_keep_to_ascii_and_24_columns() {
        assert_eq!(name_line("ŞİLE 1"), "0 ??LE 1");
        assert_eq!(name_line(&"x".repeat(30)).len(), 24);
        assert_eq!((name_line("#1"), name_line("0 G")), ("0 #1".into(), "0 0 G".into()));
        assert_eq!(name_line("EPOCH = 3"), "0 EPOCH = 3");
        assert_eq!(name_line("A <B>"), "0 A <B>");
    }
}
