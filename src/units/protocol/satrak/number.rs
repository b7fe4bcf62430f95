//! Numbers in the format of the protocol: decimal point, no exponent.

use super::text::TextProblem;

/// Reason why a value cannot be sent.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ValueError {
    /// A number outside the range, or not finite.
    #[error("{name} {value} is not between {min} and {max}")]
    Range {
        /// Meaning of the number, with its unit.
        name: &'static str,
        value: f64,
        min: f64,
        max: f64,
    },
    /// A number without a meaning in the document.
    #[error("{name} has no choice {code}")]
    Choice {
        /// Subject of the choice.
        name: &'static str,
        code: i64,
    },
    /// A request without motion. Only the stop command ends a motion.
    #[error("no axis would move")]
    NoMotion,
    /// A change without a new value.
    #[error("no setting would change")]
    NoChange,
    /// A stop time that is not later than the start time.
    #[error("the stop time is not after the start time")]
    StopBeforeStart,
    /// A text that the protocol cannot carry.
    #[error("{name} {problem}")]
    Text {
        /// Meaning of the text.
        name: &'static str,
        /// Problem with the text; never contains the text itself.
        problem: TextProblem,
    },
}

/// Rounds `value` to a thousandth if it is between `min` and `max`.
pub(super) fn checked(
    name: &'static str,
    value: f64,
    min: f64,
    max: f64,
) -> Result<f64, ValueError> {
    // Rounding comes before the test, because the unit gets the rounded value.
    let rounded = (value * 1000.0).round() / 1000.0;
    // This form also refuses NaN. Adding zero removes a minus zero.
    if (min..=max).contains(&rounded) {
        Ok(rounded + 0.0)
    } else {
        Err(ValueError::Range { name, value, min, max })
    }
}

/// Returns a number with up to three decimals, and none for a whole number: `-3.5`, `0`, `125.1`.
pub(super) fn plain(value: f64) -> String {
    let text = format!("{value:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Returns a number like [`plain`], but always with a decimal: `5.0`.
pub(super) fn pointed(value: f64) -> String {
    let text = plain(value);
    // The examples of sections 13 and 15 have a decimal in each angle: `1.0`, `160.0`.
    if text.contains('.') { text } else { text + ".0" }
}

/// Reads a finite number with a decimal point.
pub(super) fn parse_decimal(text: &str) -> Option<f64> {
    // Rust also reads `inf`, `nan` and exponents, which the protocol does not have.
    let is_number_byte = |byte: u8| byte.is_ascii_digit() || b"+-.".contains(&byte);
    let number: Option<f64> = text.bytes().all(is_number_byte).then(|| text.parse().ok()).flatten();
    // Too many digits overflow to infinity.
    number.filter(|number| number.is_finite())
}

/// Reads a whole number; accepts a fraction of zeros.
pub(super) fn parse_integer(text: &str) -> Option<i64> {
    let (whole, fraction) = text.split_once('.').unwrap_or((text, ""));
    // The document does not say how a unit prints a whole number.
    fraction.bytes().all(|byte| byte == b'0').then(|| whole.parse().ok()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_look_like_the_documents_examples() {
        for (value, short, long) in [
            (-3.5, "-3.5", "-3.5"),
            (0.0, "0", "0.0"),
            (-0.0001, "0", "0.0"),
            (125.1, "125.1", "125.1"),
            (5.0, "5", "5.0"),
            (100.0, "100", "100.0"),
        ] {
            assert_eq!(plain(value), short);
            assert_eq!(pointed(value), long);
        }
    }

    #[test]
    fn only_plain_numbers_are_read() {
        assert_eq!(parse_decimal("+2"), Some(2.0));
        assert_eq!(parse_decimal("-.5"), Some(-0.5));
        let endless = "9".repeat(330);
        for bad in ["", "nan", "inf", "1e3", "1,5", "-", "2 3", "NONE", &endless] {
            assert_eq!(parse_decimal(bad), None, "{bad}");
        }
        assert_eq!(parse_integer("7.00"), Some(7));
        assert_eq!(parse_integer("7.5"), None);
        assert_eq!(parse_integer("99999999999999999999"), None);
    }

    #[test]
    fn what_is_not_finite_is_out_of_range() {
        assert_eq!(checked("x", 0.0006, 0.0, 1.0), Ok(0.001));
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1.001] {
            assert!(checked("x", bad, 0.0, 1.0).is_err());
        }
    }
}
