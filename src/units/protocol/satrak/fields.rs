//! Values of a frame, read by their number in the document.

use jiff::civil::DateTime;
use jiff::tz::TimeZone;
use jiff::{SignedDuration, Timestamp};

use super::Frame;
use super::number::{parse_decimal, parse_integer};

/// Problem with a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum FieldProblem {
    #[error("is missing")]
    Missing,
    #[error("is not a number")]
    NotNumber,
    #[error("is not a whole number")]
    NotInteger,
    /// A number outside the range of its type.
    #[error("is out of range")]
    Range,
    /// A value that begins no valid date and time with the values after it.
    #[error("begins no possible date and time")]
    NotTime,
    /// A value that is not a latitude or longitude with a letter of direction.
    #[error("is no latitude or longitude")]
    NotPlace,
}

/// A value that could not be read. The error contains none of its text, which may be secret.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("value {field} {problem}")]
pub struct FieldError {
    /// Number of the value, counted from 1 as in the document.
    pub field: usize,
    pub problem: FieldProblem,
}

/// The values of a frame, numbered from 1 as in the document.
#[derive(Clone, Copy)]
pub(super) struct FrameFields<'a> {
    frame: &'a Frame,
}

impl<'a> FrameFields<'a> {
    pub(super) fn new(frame: &'a Frame) -> Self {
        Self { frame }
    }

    pub(super) fn count(self) -> usize {
        self.frame.fields().len()
    }

    pub(super) fn text(self, field: usize) -> Result<&'a str, FieldError> {
        field
            .checked_sub(1)
            .and_then(|index| self.frame.fields().get(index))
            .map(String::as_str)
            .ok_or(FieldError { field, problem: FieldProblem::Missing })
    }

    pub(super) fn decimal(self, field: usize) -> Result<f64, FieldError> {
        parse_decimal(self.text(field)?)
            .ok_or(FieldError { field, problem: FieldProblem::NotNumber })
    }

    pub(super) fn integer<T: TryFrom<i64>>(self, field: usize) -> Result<T, FieldError> {
        let value = parse_integer(self.text(field)?)
            .ok_or(FieldError { field, problem: FieldProblem::NotInteger })?;
        T::try_from(value).map_err(|_| FieldError { field, problem: FieldProblem::Range })
    }

    /// Reads a flag: any number except zero counts as set, also an unexplained number.
    pub(super) fn flag(self, field: usize) -> Result<bool, FieldError> {
        self.integer::<i64>(field).map(|value| value != 0)
    }

    /// Reads six values from `first` on: hour, minute, second, day, month, year. Adds
    /// `base_year` to the year.
    pub(super) fn time(self, first: usize, base_year: i16) -> Result<Timestamp, FieldError> {
        // The date as a whole is wrong, such as 30 February, so the error names its first value.
        let impossible = FieldError { field: first, problem: FieldProblem::NotTime };
        let part = |offset| self.integer::<i8>(first + offset);
        let year: i16 = self.integer(first + 5)?;
        let year = year.checked_add(base_year).ok_or(impossible)?;
        let (hour, minute, second) = (part(0)?, part(1)?, part(2)?);
        DateTime::new(year, part(4)?, part(3)?, hour, minute, second, 0)
            .ok()
            .and_then(|civil| TimeZone::UTC.to_timestamp(civil).ok())
            .ok_or(impossible)
    }

    /// Reads a time like [`Self::time`], with milliseconds in the value after the year.
    pub(super) fn time_with_ms(self, first: usize) -> Result<Timestamp, FieldError> {
        let field = first + 6;
        let milliseconds: u16 = self.integer(field)?;
        // A larger number would carry over into the second and give another time.
        if milliseconds > 999 {
            return Err(FieldError { field, problem: FieldProblem::Range });
        }
        self.time(first, 0)?
            .checked_add(SignedDuration::from_millis(i64::from(milliseconds)))
            .map_err(|_| FieldError { field: first, problem: FieldProblem::NotTime })
    }

    /// Reads one value that may contain commas, between `before` and `after` other values.
    pub(super) fn joined(self, before: usize, after: usize) -> Result<String, FieldError> {
        self.frame
            .joined(before, after)
            .ok_or(FieldError { field: before + 1, problem: FieldProblem::Missing })
    }
}

/// Returns the values of a time in the document's order: hour, minute, second, day, month, year.
pub(super) fn time_values(time: Timestamp) -> [String; 6] {
    // All times of the unit are UTC (notes in sections 8 to 11).
    let civil = TimeZone::UTC.to_datetime(time);
    [
        // The values have no leading zeros: section 9 writes `16,43,0,17,3,2017`.
        civil.hour().to_string(),
        civil.minute().to_string(),
        civil.second().to_string(),
        civil.day().to_string(),
        civil.month().to_string(),
        civil.year().to_string(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn time_of(payload: &str) -> Result<Timestamp, FieldError> {
        FrameFields::new(&Frame::from_payload(payload)).time(1, 0)
    }

    #[test]
    fn impossible_times_are_errors() {
        for payload in [
            "TIME?,24,0,0,1,1,2000",
            "TIME?,0,0,60,1,1,2000",
            "TIME?,0,0,0,30,2,2024",
            "TIME?,0,0,0,0,0,0",
            "TIME?,0,0,0,1,1,9999999",
            "TIME?,0,0,0,1,300,2000",
            "TIME?,0,0,0,1,1",
        ] {
            assert!(time_of(payload).is_err(), "{payload}");
        }
        assert!(
            FrameFields::new(&Frame::from_payload("T?,0,0,0,1,1,32767")).time(1, 2000).is_err()
        );
    }

    #[test]
    fn a_time_comes_back_in_the_order_of_the_document() {
        let time = time_of("TIME?,16,43,0,17,3,2017").unwrap();
        assert_eq!(time_values(time), ["16", "43", "0", "17", "3", "2017"]);
    }
}
