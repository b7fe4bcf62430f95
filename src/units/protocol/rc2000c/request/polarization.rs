//! Commands for the polarization.

use super::value::{ValueError, checked};

/// Max position, which only a rotating feed reaches.
const MAX_POLARIZATION: u16 = 1023;

/// One of the two stored polarizations of a satellite.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Polarity {
    Horizontal,
    Vertical,
}

/// Position of the polarization in the unit's count: 0 to 661 with a polarotor, 0 to 1023
/// with a rotating feed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct PolarizationUnits(u16);

impl PolarizationUnits {
    /// Returns a position, or an error outside 0 to 1023.
    pub fn new(units: u16) -> Result<Self, ValueError> {
        // The command does not name the device, so the wider range of the rotating feed applies.
        checked("polarization", units.into(), 0, MAX_POLARIZATION.into())?;
        Ok(Self(units))
    }

    /// Returns the number on the line.
    pub const fn units(self) -> u16 {
        self.0
    }
}

/// Move of the polarization (appendix E, command 34h). The unit's settings determine the duration
/// of a jog.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PolarizationMove {
    /// Short turn clockwise.
    JogClockwise,
    /// Short turn counter-clockwise.
    JogCounterClockwise,
    /// Turn to the stored polarization of the satellite nearest in azimuth.
    ToStored(Polarity),
}

impl PolarizationMove {
    pub(super) const ALL: [(Self, u8); 4] = [
        (Self::JogClockwise, b'C'),
        // W means clockwise in a jog of the azimuth, but counter-clockwise here.
        (Self::JogCounterClockwise, b'W'),
        (Self::ToStored(Polarity::Horizontal), b'H'),
        (Self::ToStored(Polarity::Vertical), b'V'),
    ];
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_are_0_to_1023() {
        assert_eq!(PolarizationUnits::new(1023).map(PolarizationUnits::units), Ok(1023));
        assert!(PolarizationUnits::new(1024).is_err());
    }
}
