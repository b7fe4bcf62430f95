//! Commands for the polarization.

use super::value::{ValueError, checked};

/// The most that a position can be: a rotating feed's.
const MAX_POLARIZATION: u16 = 1023;

/// One of the two stored polarizations of a satellite.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Polarity {
    /// H.
    Horizontal,
    /// V.
    Vertical,
}

/// Position of the polarization as the controller counts it: 0 to 661 with a
/// polarotor, 0 to 1023 with a rotating feed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct PolarizationUnits(u16);

impl PolarizationUnits {
    /// A position from 0 to 1023.
    pub fn new(units: u16) -> Result<Self, ValueError> {
        checked("polarization", units.into(), 0, MAX_POLARIZATION.into())?;
        Ok(Self(units))
    }

    /// The number on the line.
    pub const fn units(self) -> u16 {
        self.0
    }
}

/// Turns the polarization (appendix E, command 34h). How long a jog lasts is
/// set in the controller.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PolarizationMove {
    /// Clockwise for a moment.
    JogClockwise,
    /// Counter-clockwise for a moment.
    JogCounterClockwise,
    /// To the stored polarization of the satellite nearest in azimuth.
    ToStored(Polarity),
}

impl PolarizationMove {
    /// All moves with their letters.
    pub(super) const ALL: [(Self, u8); 4] = [
        (Self::JogClockwise, b'C'),
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
