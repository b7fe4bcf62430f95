//! Whole degrees, and numbers padded with blanks.

use std::fmt;

use super::ValueError;

/// An angle of the protocol: whole degrees, 0 to 360.
///
/// 360 stays distinct from 0: on a mount with its stop in the north, they can be opposite ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct WholeDegrees(u16);

impl WholeDegrees {
    pub const MAX: Self = Self(360);

    /// Returns the angle of `degrees`, or an error outside 0 to 360.
    pub fn new(degrees: u16) -> Result<Self, ValueError> {
        Self::nearest(f64::from(degrees))
    }

    /// Clamps `degrees` to 360.
    pub const fn saturating(degrees: u16) -> Self {
        if degrees > Self::MAX.0 { Self::MAX } else { Self(degrees) }
    }

    /// Rounds `degrees`, which must be between 0 and 360.
    pub fn nearest(degrees: f64) -> Result<Self, ValueError> {
        // This form also refuses NaN.
        if (0.0..=f64::from(Self::MAX.0)).contains(&degrees) {
            Ok(Self(degrees.round() as u16))
        } else {
            Err(ValueError::Degrees(degrees))
        }
    }

    pub const fn degrees(self) -> u16 {
        self.0
    }

    /// Returns three digits with leading zeros, as in the document's examples of commands.
    pub(super) fn digits(self) -> String {
        // A unit may count bytes: after fewer digits, it would take bytes of the next request.
        format!("{:03}", self.0)
    }

    /// Reads a field of a message.
    pub(super) fn parse(field: &[u8]) -> Option<Self> {
        let degrees = whole_number(field).and_then(|number| u16::try_from(number).ok())?;
        // Section 1.0 writes 999 for a missing sensor or target, so 999 is no angle.
        Self::new(degrees).ok()
    }
}

impl fmt::Display for WholeDegrees {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// Strips the blanks on either side of `field`.
pub(super) fn without_blanks(field: &[u8]) -> &[u8] {
    let is_blank = |byte: &u8| *byte == b' ';
    let start = field.iter().position(|byte| !is_blank(byte)).unwrap_or(field.len());
    let end = field.iter().rposition(|byte| !is_blank(byte)).map_or(start, |last| last + 1);
    field.get(start..end).unwrap_or_default()
}

/// Reads at most four digits with blanks on either side.
pub(super) fn whole_number(field: &[u8]) -> Option<i16> {
    let digits = without_blanks(field);
    // The widest number has four characters (section 1.0), and four digits fit in an `i16`.
    if !(1..=4).contains(&digits.len()) || !digits.iter().all(u8::is_ascii_digit) {
        return None;
    }
    Some(digits.iter().fold(0, |number, digit| number * 10 + i16::from(digit - b'0')))
}

/// Reads a number like [`whole_number`], with an optional sign in front and blanks on either side.
pub(super) fn signed_number(field: &[u8]) -> Option<i16> {
    match without_blanks(field) {
        [b'-', digits @ ..] => whole_number(digits).map(|number| -number),
        [b'+', digits @ ..] | digits => whole_number(digits),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_angles_of_the_protocol_are_built() {
        for (value, rounded) in [(0.0, 0), (-0.0, 0), (41.6, 42), (359.5, 360), (360.0, 360)] {
            assert_eq!(WholeDegrees::nearest(value).unwrap().degrees(), rounded, "{value}");
        }
        for bad in [-1.0, -0.1, 360.1, 361.0, 999.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(WholeDegrees::nearest(bad).is_err(), "{bad}");
        }
        assert!(WholeDegrees::new(361).is_err());
        assert_eq!(WholeDegrees::saturating(361), WholeDegrees::MAX);
        assert_eq!(WholeDegrees::new(5).unwrap().digits(), "005");
    }

    #[test]
    fn blanks_may_stand_on_either_side() {
        for (field, number) in [
            (&b"  5"[..], Some(5)),
            (b"5  ", Some(5)),
            (b"005", Some(5)),
            (b" 43 ", Some(43)),
            (b"   ", None),
            (b"", None),
            (b"4 3", None),
            (b"-10", None),
            (b"4x", None),
            (b"\x0012", None),
        ] {
            assert_eq!(whole_number(field), number, "{field:?}");
        }
        for (field, number) in [
            (&b" -10"[..], Some(-10)),
            (b"-  5", Some(-5)),
            (b"  +7", Some(7)),
            (b"-180", Some(-180)),
            (b"9999", Some(9999)),
            (b"   -", None),
            (b"--10", None),
        ] {
            assert_eq!(signed_number(field), number, "{field:?}");
        }
    }
}
