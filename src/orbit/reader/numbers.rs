//! Numbers that occur in more than one form.

/// Returns the catalog number in `text`: digits, or Alpha-5, in which a letter stands for the first
/// two of six digits. `A0001` is 100001, `Z9999` is 339999. Alpha-5 omits the letters I and O,
/// because they look like digits.
///
/// Source: Space-Track, "Alpha-5".
pub(super) fn alpha_5(text: &str) -> Option<u64> {
    let mut letters = text.chars();
    let Some(letter @ 'A'..='Z') = letters.next() else {
        return digits(text);
    };
    let leading = ALPHA_5.chars().position(|candidate| candidate == letter)? as u64 + 10;
    let rest = Some(letters.as_str()).filter(|rest| rest.len() == 4)?;
    Some(leading * 10_000 + digits(rest)?)
}

/// Letters of Alpha-5, which stand for the numbers from 10 on.
pub(crate) const ALPHA_5: &str = "ABCDEFGHJKLMNPQRSTUVWXYZ";

/// Returns a number with a point and without an exponent, such as `-.00002182`.
pub(super) fn with_point(text: &str) -> Option<f64> {
    let (whole, fraction) = text.strip_prefix(['+', '-']).unwrap_or(text).split_once('.')?;
    let mut digits = whole.bytes().chain(fraction.bytes());
    if digits.all(|byte| byte.is_ascii_digit()) { text.parse().ok() } else { None }
}

/// Returns a number written only with digits, without a sign.
pub(super) fn digits(text: &str) -> Option<u64> {
    Some(text).filter(|text| text.bytes().all(|byte| byte.is_ascii_digit()))?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_with_a_point_has_no_exponent() {
        for (text, number) in [
            ("51.6416", Some(51.6416)),
            ("-.5", Some(-0.5)),
            ("+1.", Some(1.0)),
            ("51.6e25", None),
            ("1.E5", None),
            ("1 .5", None),
            ("--.5", None),
            ("15", None),
            ("inf", None),
            (".", None),
            ("", None),
        ] {
            assert_eq!(with_point(text), number, "{text}");
        }
    }

    #[test]
    fn alpha_5_has_24_letters() {
        for (text, number) in [
            ("5", Some(5)),
            ("00900", Some(900)),
            ("999999999", Some(999_999_999)),
            ("A0000", Some(100_000)),
            ("H9999", Some(179_999)),
            ("J0000", Some(180_000)),
            ("N0000", Some(220_000)),
            ("P0000", Some(230_000)),
            ("T0001", Some(270_001)),
            ("Z9999", Some(339_999)),
            ("I0000", None),
            ("O0000", None),
            ("A000", None),
            ("A+000", None),
            ("a0000", None),
            ("+5", None),
            ("", None),
            ("5 5", None),
        ] {
            assert_eq!(alpha_5(text), number, "{text}");
        }
    }
}
