//! Status of both rotators (section 1.0).

use super::degrees::{signed_number, without_blanks};
use super::layout::LayoutShape;
use super::{Layout, RotatorNumber, WholeDegrees, name};

/// Status reply of the unit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Status {
    /// Form of the reply.
    pub layout: Layout,
    /// Obsolete byte, according to the document. Units send `2`.
    pub active: u8,
    /// Zero without a problem; the document defines no other codes. `None` if the byte was lost on
    /// the way.
    pub panic: Option<u8>,
    pub rotators: [Rotator; 2],
}

/// State of one rotator.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Rotator {
    /// Measured angle. The unit has already added its offset.
    pub position: Result<WholeDegrees, NoPosition>,
    /// Clockwise end of the travel. The document's example contradicts the natural meaning, so no
    /// arc can be computed from both limits.
    pub limit_cw: Option<WholeDegrees>,
    /// Counter-clockwise end of the travel.
    pub limit_ccw: Option<WholeDegrees>,
    pub kind: RotatorKind,
    /// Direction in which the unit drives the rotator, if it does.
    pub moving: Moving,
    /// Offset such as the magnetic declination, degrees, as received; `None` if blank or
    /// unreadable. It is not the stop offset of a configuration.
    pub offset_deg: Option<i16>,
    /// Target angle; `None` without one.
    pub target: Option<WholeDegrees>,
    /// Angle at which the rotator started towards the target.
    pub start: Option<WholeDegrees>,
    /// `true` if the rotator is outside its limits; `None` if the byte is unknown.
    pub is_outside_limits: Option<bool>,
    pub name: String,
}

/// Reason why the status has no position.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, thiserror::Error)]
pub enum NoPosition {
    /// 999 in the field: no sensor.
    #[error("the sensor is not connected")]
    NoSensor,
    /// A field of blanks.
    #[error("no position is given")]
    Blank,
    /// A number over 360 other than 999.
    #[error("the position is over 360 degrees")]
    OutOfRange,
    /// A field that is not a number.
    #[error("the position is not a number")]
    NotANumber,
}

/// Angle that a rotator turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum RotatorKind {
    /// `A` in the field.
    Azimuth,
    /// `E` in the field.
    Elevation,
}

impl RotatorKind {
    pub const fn from_letter(letter: u8) -> Option<Self> {
        match letter {
            b'A' => Some(Self::Azimuth),
            b'E' => Some(Self::Elevation),
            _ => None,
        }
    }

    pub const fn letter(self) -> u8 {
        match self {
            Self::Azimuth => b'A',
            Self::Elevation => b'E',
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Moving {
    /// `0` in the field. The rotator may still coast.
    Stopped,
    /// `1` in the field.
    Clockwise,
    /// `2` in the field.
    CounterClockwise,
}

impl Status {
    pub fn rotator(&self, number: RotatorNumber) -> &Rotator {
        number.select(&self.rotators)
    }

    /// Reads a status of this shape; `None` unless `bytes` have its length.
    pub(super) fn read(shape: LayoutShape, bytes: &[u8]) -> Option<Self> {
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
            // Kind and motion frame the status. Another value shows that the bytes are shifted.
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
            // The document lists digits, but units send a zero byte.
            is_outside_limits: match field(1)? {
                [0] | b"0" | b" " => Some(false),
                [1] | b"1" => Some(true),
                // An unknown byte does not count as inside: outside its limits, a rotator turns
                // until `|S` (section 1.3).
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
        // Over 360, only 999 has a meaning, so no other number may count as a missing sensor.
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
