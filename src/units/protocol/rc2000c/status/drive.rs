//! State of the drives.

use super::BASE;

/// Sense of a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sense {
    /// Azimuth counter-clockwise, elevation down: the counts fall.
    Negative,
    /// Azimuth clockwise, elevation up: the counts grow.
    Positive,
}

/// State of an axis drive. If several states apply, the unit shows the last of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AxisDrive {
    /// A drive without power.
    Still,
    /// A drive that is about to turn.
    Pending(Sense),
    Moving(Sense),
    AutoMove,
    /// Alarm: motion without a command.
    Runaway,
    /// Alarm: a command without motion at the sensor.
    Jammed,
    /// Alarm: a limit; documented for elevation only.
    Limit,
    /// Alarm: too much current.
    Overcurrent,
    Unknown(u8),
}

impl AxisDrive {
    // Appendix E leaves 1, 6, 11 and 13 to 15 undefined.
    const CODES: [(Self, u8); 10] = [
        (Self::Still, 0),
        (Self::Pending(Sense::Negative), 2),
        (Self::Pending(Sense::Positive), 3),
        (Self::Moving(Sense::Negative), 4),
        (Self::Moving(Sense::Positive), 5),
        (Self::AutoMove, 7),
        (Self::Runaway, 8),
        (Self::Jammed, 9),
        (Self::Limit, 10),
        (Self::Overcurrent, 12),
    ];

    pub(super) fn from_byte(byte: u8) -> Self {
        // A byte with other upper bits is no known state, even if its lower bits are those of one.
        let entry = Self::CODES.into_iter().find(|(_, code)| BASE + code == byte);
        entry.map_or(Self::Unknown(byte), |(drive, _)| drive)
    }

    pub(super) fn byte(self) -> u8 {
        if let Self::Unknown(byte) = self {
            return byte;
        }
        let entry = Self::CODES.into_iter().find(|(drive, _)| *drive == self);
        entry.map_or(BASE, |(_, code)| BASE + code)
    }

    /// Returns `true` if the axis turns or is about to turn. An unknown state counts as moving.
    pub const fn is_moving(self) -> bool {
        matches!(
            self,
            // A runaway is motion without a command, so an axis with that alarm counts as moving.
            Self::Pending(_) | Self::Moving(_) | Self::AutoMove | Self::Runaway | Self::Unknown(_)
        )
    }

    pub const fn is_alarm(self) -> bool {
        matches!(self, Self::Runaway | Self::Jammed | Self::Limit | Self::Overcurrent)
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PolarizationMotion {
    Still,
    JogClockwise,
    JogCounterClockwise,
    /// A turn to a stored polarization.
    ToStored,
    Unknown(u8),
}

impl PolarizationMotion {
    pub(super) const fn from_byte(byte: u8) -> Self {
        match byte {
            0x20 => Self::Still,
            0x21 => Self::JogClockwise,
            0x22 => Self::JogCounterClockwise,
            0x23 => Self::ToStored,
            other => Self::Unknown(other),
        }
    }

    pub(super) const fn byte(self) -> u8 {
        match self {
            Self::Still => 0x20,
            Self::JogClockwise => 0x21,
            Self::JogCounterClockwise => 0x22,
            Self::ToStored => 0x23,
            Self::Unknown(other) => other,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_character_is_kept() {
        for byte in 0..=u8::MAX {
            assert_eq!(AxisDrive::from_byte(byte).byte(), byte);
            assert_eq!(PolarizationMotion::from_byte(byte).byte(), byte);
        }
        let undefined = [0x21, 0x26, 0x2b, 0x2d, 0x2e, 0x2f, 0x30];
        assert!(undefined.map(AxisDrive::from_byte).iter().all(|drive| drive.is_moving()));
    }

    #[test]
    fn standing_still_is_known_and_free_of_motion() {
        for (drive, code) in AxisDrive::CODES {
            assert_eq!(drive.is_moving(), matches!(code, 2..=5 | 7 | 8), "{drive:?}");
            assert_eq!(drive.is_alarm(), code >= 8, "{drive:?}");
        }
    }
}
