//! Requests of a client (sections 1.0 to 1.5).

use super::{Configuration, NameProblem, WholeDegrees};

/// Anything a client can ask. Every value was checked when it was built, so
/// each request has bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Request {
    /// `|h`: reads everything and changes nothing.
    Read,
    /// `|S`: stops both rotators; there is no stop for one.
    Stop,
    /// Can make metal move.
    Motion(Motion),
    /// `|c`: changes what the device remembers of one rotator.
    Configure(Configuration),
}

/// A request that can make metal move. Only the gate of the driver may turn one
/// into bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motion {
    /// `|A`: turn to an angle.
    GoTo {
        rotator: RotatorNumber,
        /// Azimuth or elevation.
        target: WholeDegrees,
    },
    /// `|P` or `|M`: turn until stopped. Inside its limits the device itself
    /// stops at the limit; outside nothing but `|S` ends it.
    Rotate { rotator: RotatorNumber, direction: Direction },
}

/// One of the two rotators of a device.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum RotatorNumber {
    One,
    Two,
}

impl RotatorNumber {
    /// Both.
    pub const ALL: [Self; 2] = [Self::One, Self::Two];

    /// Rotator 1 or 2.
    pub fn new(number: u8) -> Result<Self, ValueError> {
        let known = Self::ALL.into_iter().find(|known| known.number() == number);
        known.ok_or(ValueError::Rotator(number))
    }

    /// 1 or 2.
    pub const fn number(self) -> u8 {
        match self {
            Self::One => 1,
            Self::Two => 2,
        }
    }

    /// The one of `pair` that belongs to it.
    pub fn of<T>(self, pair: &[T; 2]) -> &T {
        let [one, two] = pair;
        match self {
            Self::One => one,
            Self::Two => two,
        }
    }

    /// The one of `pair` that belongs to it, to be changed.
    pub fn of_mut<T>(self, pair: &mut [T; 2]) -> &mut T {
        let [one, two] = pair;
        match self {
            Self::One => one,
            Self::Two => two,
        }
    }
}

/// A sense of rotation, seen from above.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Direction {
    /// To larger angles.
    Clockwise,
    /// To smaller angles.
    CounterClockwise,
}

/// Why a value cannot be sent.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ValueError {
    /// The device has rotators 1 and 2.
    #[error("rotator {0} is not 1 or 2")]
    Rotator(u8),
    /// Not between 0 and 360, or not a number.
    #[error("angle {0} is not between 0 and 360 degrees")]
    Degrees(f64),
    /// Not between 0 and 10.
    #[error("stop offset {0} is not between 0 and 10 degrees")]
    StopOffset(u8),
    /// A name that cannot be carried.
    #[error("the name {0}")]
    Name(#[from] NameProblem),
}

impl Request {
    /// What goes over the wire, to be sent in one piece. There is no terminator.
    pub fn to_bytes(&self) -> Vec<u8> {
        let text = match self {
            Self::Read => "|h".to_owned(),
            Self::Stop => "|S".to_owned(),
            Self::Motion(Motion::GoTo { rotator, target }) => {
                format!("|A{}{}", rotator.number(), target.digits())
            }
            Self::Motion(Motion::Rotate { rotator, direction }) => {
                let letter = match direction {
                    Direction::Clockwise => 'P',
                    Direction::CounterClockwise => 'M',
                };
                format!("|{letter}{}", rotator.number())
            }
            Self::Configure(configuration) => return configuration.to_bytes(),
        };
        text.into_bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_two_rotators() {
        assert_eq!(RotatorNumber::new(1), Ok(RotatorNumber::One));
        assert_eq!(RotatorNumber::new(2), Ok(RotatorNumber::Two));
        for bad in [0, 3, b'1'] {
            assert_eq!(RotatorNumber::new(bad), Err(ValueError::Rotator(bad)));
        }
    }
}
