//! Parsing of an angle that the operator has entered.

/// A field of the go-to form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Field {
    Azimuth,
    Elevation,
}

impl Field {
    pub fn name(self) -> &'static str {
        match self {
            Self::Azimuth => "Azimuth",
            Self::Elevation => "Elevation",
        }
    }
}

/// Parses the angle called `name`, in degrees within `range_deg`, both ends included. Accepts
/// a decimal point or comma, either kind of minus sign and a degree sign.
///
/// # Errors
/// The sentence to show under the field.
pub fn angle(text: &str, name: &str, range_deg: (f64, f64)) -> Result<f64, String> {
    let typed = text.trim();
    if typed.is_empty() {
        return Err(format!("{name} is empty. Write an angle, such as 85.5."));
    }
    let plain = typed.trim_end_matches('°').trim_end().replace('−', "-").replace(',', ".");
    // `inf`, `nan` and exponents would parse, but here they are typing errors.
    let only_digits = plain.chars().all(|c| c.is_ascii_digit() || matches!(c, '.' | '-' | '+'));
    let value = if only_digits { plain.parse::<f64>().ok() } else { None };
    let Some(value) = value else {
        return Err(format!("{name} “{typed}” is not a number. Write 85.5 or 85,5."));
    };
    let (low, high) = range_deg;
    if !(low..=high).contains(&value) {
        let [low, high] = [low, high].map(|end| end.to_string().replace('-', "−"));
        return Err(format!("{name} {typed} is outside {low}° to {high}°."));
    }
    Ok(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const RANGE: (f64, f64) = (-10.0, 360.0);

    fn read(text: &str) -> Result<f64, String> {
        angle(text, "Azimuth", RANGE)
    }

    #[test]
    fn point_comma_and_both_minus_signs_are_read() {
        for (text, requested) in [
            ("185.5", 185.5),
            (" 185,50° ", 185.5),
            ("-3", -3.0),
            ("−3,25", -3.25),
            ("360.0", 360.0),
        ] {
            assert!((read(text).expect(text) - requested).abs() < 1e-9, "{text}");
        }
    }

    #[test]
    fn a_refusal_says_what_was_typed_and_what_would_do() {
        assert_eq!(
            read("12..5"),
            Err("Azimuth “12..5” is not a number. Write 85.5 or 85,5.".into())
        );
        assert_eq!(read("400"), Err("Azimuth 400 is outside −10° to 360°.".into()));
        assert_eq!(read("  "), Err("Azimuth is empty. Write an angle, such as 85.5.".into()));
    }

    #[test]
    fn nothing_but_plain_numbers_is_read() {
        for text in ["nan", "inf", "1e2", "1,234.5", "0x10", "--3", "-", "."] {
            assert!(read(text).is_err(), "{text}");
        }
    }

    proptest! {
        #[test]
        fn whatever_is_typed_gives_an_angle_in_range_or_a_sentence(text in "\\PC{0,12}") {
            match read(&text) {
                Ok(value) => prop_assert!((RANGE.0..=RANGE.1).contains(&value)),
                Err(sentence) => prop_assert!(sentence.ends_with('.')),
            }
        }
    }
}
