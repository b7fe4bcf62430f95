//! Positions on the front panel, in five characters.

/// Length of the field on the line, bytes.
const POSITION_BYTES: usize = 5;

/// Axis of a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PositionAxis {
    Azimuth,
    Elevation,
}

/// Position of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Position {
    /// Counts of the sensor, 0 to 65535.
    Counts(u16),
    /// Tenths of a degree, if the unit is configured to show angles.
    TenthsOfDegree(i16),
    /// Limit at which the axis stands; the unit then shows no number.
    Limit(LimitEnd),
    /// Unknown text, as received.
    Unknown([u8; POSITION_BYTES]),
}

/// A limit of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LimitEnd {
    /// Azimuth, counter-clockwise.
    CounterClockwise,
    /// Azimuth, clockwise.
    Clockwise,
    /// Elevation, lowest.
    Down,
    /// Elevation, highest.
    Up,
}

impl LimitEnd {
    const fn word(self) -> &'static str {
        match self {
            Self::CounterClockwise => "CCW",
            Self::Clockwise => "CW",
            Self::Down => "DOWN",
            Self::Up => "UP",
        }
    }
}

impl Position {
    /// Reads a field. The manuals pad the words for limits on either side.
    pub(super) fn parse(axis: PositionAxis, field: [u8; POSITION_BYTES]) -> Self {
        let text = std::str::from_utf8(&field).unwrap_or_default().trim_matches(' ');
        let ends = match axis {
            PositionAxis::Azimuth => [LimitEnd::CounterClockwise, LimitEnd::Clockwise],
            PositionAxis::Elevation => [LimitEnd::Down, LimitEnd::Up],
        };
        if let Some(end) = ends.into_iter().find(|end| end.word() == text) {
            return Self::Limit(end);
        }
        // Only the point distinguishes degrees from counts: no other field shows which of them the
        // unit displays.
        let number = match text.split_once('.') {
            Some((whole, tenth)) => tenths(whole, tenth).map(Self::TenthsOfDegree),
            None if is_digits(text) => text.parse().ok().map(Self::Counts),
            None => None,
        };
        number.unwrap_or(Self::Unknown(field))
    }

    /// Returns the text of the field. Angles outside -99.9 to 999.9 degrees do not fit and show as
    /// asterisks.
    pub(super) fn text(self) -> [u8; POSITION_BYTES] {
        let text = match self {
            Self::Counts(counts) => counts.to_string(),
            Self::TenthsOfDegree(tenths) => {
                let sign = if tenths < 0 { "-" } else { "" };
                let size = tenths.unsigned_abs();
                format!("{sign}{}.{}", size / 10, size % 10)
            }
            Self::Limit(end) => end.word().to_owned(),
            Self::Unknown(field) => return field,
        };
        let padded = format!("{text:>POSITION_BYTES$}");
        padded.as_bytes().try_into().unwrap_or([b'*'; POSITION_BYTES])
    }
}

fn is_digits(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit())
}

/// Returns tenths of a degree from the texts before and after the point.
fn tenths(whole: &str, tenth: &str) -> Option<i16> {
    // The manual shows no angle below zero, so Azel accepts both `-0.5` and `-.5`.
    let digits = whole.strip_prefix('-').unwrap_or(whole);
    if tenth.len() != 1 || !is_digits(tenth) || !(digits.is_empty() || is_digits(digits)) {
        return None;
    }
    format!("{whole}{tenth}").parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_words_are_read_as_the_panel_shows_them() {
        let azimuth = |text: &[u8; 5]| Position::parse(PositionAxis::Azimuth, *text);
        let elevation = |text: &[u8; 5]| Position::parse(PositionAxis::Elevation, *text);
        assert_eq!(azimuth(b" 1525"), Position::Counts(1525));
        assert_eq!(azimuth(b"65535"), Position::Counts(65535));
        assert_eq!(azimuth(b"178.4"), Position::TenthsOfDegree(1784));
        assert_eq!(elevation(b" -0.5"), Position::TenthsOfDegree(-5));
        assert_eq!(elevation(b"  -.5"), Position::TenthsOfDegree(-5));
        for text in [b"  CCW", b" CCW ", b"CCW  "] {
            assert_eq!(azimuth(text), Position::Limit(LimitEnd::CounterClockwise));
        }
        assert_eq!(azimuth(b"   CW"), Position::Limit(LimitEnd::Clockwise));
        assert_eq!(elevation(b" DOWN"), Position::Limit(LimitEnd::Down));
        assert_eq!(elevation(b"  UP "), Position::Limit(LimitEnd::Up));
    }

    #[test]
    fn anything_else_is_kept_as_it_came() {
        for text in [
            b"     ", b"*****", b"65536", b"1 525", b" 1.25", b"1..25", b"   UP", b"  +15",
            b"  .  ",
        ] {
            assert_eq!(Position::parse(PositionAxis::Azimuth, *text), Position::Unknown(*text));
        }
        assert_eq!(
            Position::parse(PositionAxis::Elevation, *b"  CCW"),
            Position::Unknown(*b"  CCW")
        );
    }

    #[test]
    fn a_position_is_written_to_the_right() {
        for (position, text) in [
            (Position::Counts(0), b"    0"),
            (Position::TenthsOfDegree(442), b" 44.2"),
            (Position::TenthsOfDegree(-5), b" -0.5"),
            (Position::TenthsOfDegree(i16::MIN), b"*****"),
            (Position::Limit(LimitEnd::Down), b" DOWN"),
        ] {
            assert_eq!(position.text(), *text);
        }
    }
}
