//! The status of both rotators (section 1.0).

use super::degrees::{signed_number, without_blanks};
use super::layout::Shape;
use super::{Layout, RotatorNumber, WholeDegrees, name};

/// Everything the device tells about itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Status {
    /// The form that was received.
    pub layout: Layout,
    /// Not used any more, says the document. Devices send `2`.
    pub active: u8,
    /// Zero when everything is well; other codes are not defined. `None` when the
    /// byte was lost on the way.
    pub panic: Option<u8>,
    /// Both rotators.
    pub rotators: [Rotator; 2],
}

/// What the device tells about one rotator.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Rotator {
    /// Where it points. The device has added its offset already.
    pub position: Result<WholeDegrees, NoPosition>,
    /// The end of the travel clockwise. The document's own example contradicts
    /// the natural meaning, so no arc can be computed from both limits.
    pub limit_cw: Option<WholeDegrees>,
    /// The end of the travel counter-clockwise.
    pub limit_ccw: Option<WholeDegrees>,
    /// Azimuth or elevation.
    pub kind: RotatorKind,
    /// Whether it is driven, and which way.
    pub moving: Moving,
    /// Magnetic declination and the like, degrees, as received; `None` when blank
    /// or unreadable. Not the stop offset of a configuration.
    pub offset_deg: Option<i16>,
    /// Where it is going; `None` when nowhere.
    pub target: Option<WholeDegrees>,
    /// Where it was when it set out for the target.
    pub start: Option<WholeDegrees>,
    /// Whether it stands outside its limits; `None` when the byte is none of
    /// those that are known.
    pub is_outside_limits: Option<bool>,
    pub name: String,
}

/// Why there is no position.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, thiserror::Error)]
pub enum NoPosition {
    /// 999.
    #[error("the sensor is not connected")]
    NoSensor,
    /// Nothing but blanks.
    #[error("no position is given")]
    Blank,
    /// A number over 360 other than 999.
    #[error("the position is over 360 degrees")]
    OutOfRange,
    /// No number.
    #[error("the position is not a number")]
    NotANumber,
}

/// Which angle a rotator turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum RotatorKind {
    /// `A`.
    Azimuth,
    /// `E`.
    Elevation,
}

impl RotatorKind {
    /// The kind with this letter.
    pub const fn from_letter(letter: u8) -> Option<Self> {
        match letter {
            b'A' => Some(Self::Azimuth),
            b'E' => Some(Self::Elevation),
            _ => None,
        }
    }

    /// The letter on the wire.
    pub const fn letter(self) -> u8 {
        match self {
            Self::Azimuth => b'A',
            Self::Elevation => b'E',
        }
    }
}

/// Whether a rotator is driven.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Moving {
    /// `0`. It may still coast.
    Stopped,
    /// `1`.
    Clockwise,
    /// `2`.
    CounterClockwise,
}

impl Status {
    /// What is told about one rotator.
    pub fn rotator(&self, number: RotatorNumber) -> &Rotator {
        number.of(&self.rotators)
    }

    /// Reads a status of this shape; `None` when `bytes` are not as long as it.
    pub(super) fn read(shape: Shape, bytes: &[u8]) -> Option<Self> {
        let (header, rotators) = bytes.split_at_checked(shape.header_length())?;
        let (one, two) = rotators.split_at_checked(shape.layout.rotator_length())?;
        Some(Self {
            layout: shape.layout,
            active: *header.get(2)?,
            panic: header.get(3).copied(),
            rotators: [Rotator::read(shape.layout, one)?, Rotator::read(shape.layout, two)?],
        })
    }
}

impl Rotator {
    fn read(layout: Layout, bytes: &[u8]) -> Option<Self> {
        let mut rest = bytes;
        let mut field = |length| {
            let (field, after) = rest.split_at_checked(length)?;
            rest = after;
            Some(field)
        };
        Some(Self {
            position: position(field(3)?),
            limit_cw: WholeDegrees::parse(field(3)?),
            limit_ccw: WholeDegrees::parse(field(3)?),
            kind: RotatorKind::from_letter(*field(1)?.first()?)?,
            moving: match field(1)? {
                b"0" => Moving::Stopped,
                b"1" => Moving::Clockwise,
                b"2" => Moving::CounterClockwise,
                _ => return None,
            },
            offset_deg: signed_number(field(layout.offset_length())?),
            target: WholeDegrees::parse(field(3)?),
            start: WholeDegrees::parse(field(3)?),
            // The document has digits, devices send a zero byte.
            is_outside_limits: match field(1)? {
                [0] | b"0" | b" " => Some(false),
                [1] | b"1" => Some(true),
                _ => None,
            },
            name: name::from_field(field(layout.name_length())?),
        })
    }
}

fn position(field: &[u8]) -> Result<WholeDegrees, NoPosition> {
    WholeDegrees::parse(field).ok_or_else(|| match without_blanks(field) {
        b"999" => NoPosition::NoSensor,
        b"" => NoPosition::Blank,
        digits if digits.iter().all(u8::is_ascii_digit) => NoPosition::OutOfRange,
        _ => NoPosition::NotANumber,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_position_has_its_reason() {
        for (field, reason) in [
            (b"999", NoPosition::NoSensor),
            (b"   ", NoPosition::Blank),
            (b"361", NoPosition::OutOfRange),
            (b"998", NoPosition::OutOfRange),
            (b"1x0", NoPosition::NotANumber),
            (b"- 1", NoPosition::NotANumber),
        ] {
            assert_eq!(position(field), Err(reason), "{field:?}");
        }
        assert_eq!(position(b"360").map(WholeDegrees::degrees), Ok(360));
        assert_eq!(position(b" 43").map(WholeDegrees::degrees), Ok(43));
    }

    #[test]
    fn the_limit_byte_has_five_known_forms() {
        for (byte, outside) in [
            (0, Some(false)),
            (b'0', Some(false)),
            (b' ', Some(false)),
            (1, Some(true)),
            (b'1', Some(true)),
            (b'?', None),
            (2, None),
        ] {
            let mut bytes = b" 43359  0A0   0999999_Tower       ".to_vec();
            bytes[21] = byte;
            let rotator = Rotator::read(Layout::Wide, &bytes).unwrap();
            assert_eq!(rotator.is_outside_limits, outside, "{byte}");
        }
    }
}
