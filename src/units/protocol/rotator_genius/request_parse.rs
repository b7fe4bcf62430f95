//! Decoding of requests from bytes, as a unit or its simulator does.

use super::degrees::whole_number;
use super::{
    Configuration, Direction, Motion, Request, RotatorKind, RotatorName, RotatorNumber, ValueError,
    WholeDegrees, name,
};

/// Reason why bytes are not a request.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum RequestError {
    /// A command that the document does not have.
    #[error("unknown request")]
    Unknown,
    /// A wrong length for this command.
    #[error("{found} bytes instead of {expected}")]
    Length {
        /// Number of bytes received.
        found: usize,
        expected: usize,
    },
    /// An unreadable angle or number, or a kind other than `A` and `E`.
    #[error("unreadable field")]
    Field,
    /// A value that the protocol does not have.
    #[error(transparent)]
    Value(#[from] ValueError),
}

impl Request {
    /// Returns the length in bytes of the command with this letter, including the bar; `None` if
    /// the document has no such command.
    pub const fn length(letter: u8) -> Option<usize> {
        match letter {
            b'h' | b'S' => Some(2),
            b'P' | b'M' => Some(3),
            b'A' => Some(6),
            b'c' => Some(22),
            _ => None,
        }
    }

    /// Reads one whole request. Numbers may have blanks on either side, as the document allows.
    pub fn parse(bytes: &[u8]) -> Result<Self, RequestError> {
        let [b'|', letter, values @ ..] = bytes else { return Err(RequestError::Unknown) };
        let expected = Self::length(*letter).ok_or(RequestError::Unknown)?;
        // Even a terminator is one byte too many, because the document has none.
        if bytes.len() != expected {
            return Err(RequestError::Length { found: bytes.len(), expected });
        }
        let (rotator, values) = match values {
            [] => return Ok(if *letter == b'h' { Self::Read } else { Self::Stop }),
            [number, values @ ..] => (RotatorNumber::new(number.wrapping_sub(b'0'))?, values),
        };
        Ok(match letter {
            b'A' => Self::Motion(Motion::GoTo { rotator, target: angle(values)? }),
            b'c' => Self::Configure(configuration(rotator, values)?),
            b'P' => Self::Motion(Motion::Rotate { rotator, direction: Direction::Clockwise }),
            // Only `M` remains here, because `length` knows no further letter.
            _ => Self::Motion(Motion::Rotate { rotator, direction: Direction::CounterClockwise }),
        })
    }
}

fn angle(field: &[u8]) -> Result<WholeDegrees, RequestError> {
    WholeDegrees::parse(field).ok_or(RequestError::Field)
}

fn configuration(rotator: RotatorNumber, values: &[u8]) -> Result<Configuration, RequestError> {
    let (limits, rest) = values.split_at_checked(6).ok_or(RequestError::Field)?;
    let (cw, ccw) = limits.split_at_checked(3).ok_or(RequestError::Field)?;
    let [kind, tens, ones, text @ ..] = rest else { return Err(RequestError::Field) };
    let limits = [angle(cw)?, angle(ccw)?];
    let kind = RotatorKind::from_letter(*kind).ok_or(RequestError::Field)?;
    let stop_offset = whole_number(&[*tens, *ones]).and_then(|number| u8::try_from(number).ok());
    let name = RotatorName::new(&name::from_field(text)).map_err(ValueError::from)?;
    let stop_offset = stop_offset.ok_or(RequestError::Field)?;
    Ok(Configuration::new(rotator, limits, kind, stop_offset, name)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blanks_may_fill_numbers() {
        let target = WholeDegrees::new(5).unwrap();
        let rotator = RotatorNumber::Two;
        for sent in [&b"|A2005"[..], b"|A2  5", b"|A25  "] {
            let expected = Request::Motion(Motion::GoTo { rotator, target });
            assert_eq!(Request::parse(sent), Ok(expected));
        }
        assert!(Request::parse(b"|c1 30300A 0TOW1      ").is_ok());
    }

    #[test]
    fn what_the_document_does_not_know_is_refused() {
        use RequestError::{Field, Length, Unknown, Value};
        for (sent, error) in [
            (&b"|X"[..], Unknown),
            (b"", Unknown),
            (b"|", Unknown),
            (b"h", Unknown),
            (b"|h\n", Length { found: 3, expected: 2 }),
            (b"|A15", Length { found: 4, expected: 6 }),
            (b"|c1030300A00", Length { found: 12, expected: 22 }),
            (b"|P3", Value(ValueError::Rotator(3))),
            (b"|A0090", Value(ValueError::Rotator(0))),
            (b"|A1361", Field),
            (b"|A1   ", Field),
            (b"|A1-10", Field),
            (b"|c1030300B00TOW1      ", Field),
            (b"|c1030300A11TOW1      ", Value(ValueError::StopOffset(11))),
        ] {
            assert_eq!(Request::parse(sent), Err(error), "{sent:?}");
        }
    }
}
