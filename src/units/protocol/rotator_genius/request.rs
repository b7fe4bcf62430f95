//! Requests of a client (sections 1.0 to 1.5).

use super::{Configuration, NameProblem, WholeDegrees};

/// Any request of a client. Its values were checked at construction, so encoding cannot fail.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Request {
    /// `|h`: a read of everything, which changes nothing.
    Read,
    /// `|S`: a stop of both rotators. The protocol has no stop for only one of them.
    Stop,
    Motion(Motion),
    /// `|c`: a change of the configuration of one rotator in the unit.
    Configure(Configuration),
}

/// A request that can move a rotator. Only the driver's gate may encode it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motion {
    /// `|A`: a turn to an angle.
    GoTo {
        rotator: RotatorNumber,
        /// Target angle, azimuth or elevation.
        target: WholeDegrees,
    },
    /// `|P` or `|M`: a turn until stopped. A rotator inside its limits stops at the limit; outside
    /// them only `|S` ends the motion.
    Rotate { rotator: RotatorNumber, direction: Direction },
}

/// One of the two rotators of a unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum RotatorNumber {
    One,
    Two,
}

impl RotatorNumber {
    pub const ALL: [Self; 2] = [Self::One, Self::Two];

    /// Returns rotator 1 or 2, or an error for any other number.
    pub fn new(number: u8) -> Result<Self, ValueError> {
        let found = Self::ALL.into_iter().find(|rotator_number| rotator_number.number() == number);
        found.ok_or(ValueError::Rotator(number))
    }

    pub const fn number(self) -> u8 {
        match self {
            Self::One => 1,
            Self::Two => 2,
        }
    }

    /// Returns the item of `pair` that belongs to this rotator.
    pub fn select<T>(self, pair: &[T; 2]) -> &T {
        let [one, two] = pair;
        match self {
            Self::One => one,
            Self::Two => two,
        }
    }

    /// Returns the mutable item of `pair` that belongs to this rotator.
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
    /// Rotation to larger angles.
    Clockwise,
    /// Rotation to smaller angles.
    CounterClockwise,
}

/// Reason why a value cannot be sent.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ValueError {
    /// A number other than 1 or 2.
    #[error("rotator {0} is not 1 or 2")]
    Rotator(u8),
    /// An angle outside 0 to 360, or not a number.
    #[error("angle {0} is not between 0 and 360 degrees")]
    Degrees(f64),
    /// A stop offset over 10 degrees.
    #[error("stop offset {0} is not between 0 and 10 degrees")]
    StopOffset(u8),
    #[error("the name {0}")]
    Name(#[from] NameProblem),
}

impl Request {
    /// Returns the bytes to send in one piece. There is no terminator.
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
