//! Auto moves, which continue until the unit arrives.

use super::{Polarity, PolarizationUnits, ValueError};
use crate::protocol::rc2000c::SatelliteName;

/// Target of an auto move (appendix E, command 32h).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AutoMove(Target);

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Target {
    Satellite(SatelliteName, Option<Polarity>),
    Position { az_counts: u16, el_counts: u16 },
    Polarization(PolarizationUnits),
}

impl AutoMove {
    /// Returns a move to a stored satellite and, if given, to one of its polarizations. The name
    /// must come from the unit's list.
    pub fn satellite(name: SatelliteName, polarity: Option<Polarity>) -> Result<Self, ValueError> {
        if name.is_all_digits() {
            Err(ValueError::NameIsPosition)
        } else if name.is_blank() {
            Err(ValueError::NoName)
        } else {
            Ok(Self(Target::Satellite(name, polarity)))
        }
    }

    /// Returns a move to a position of both axes in counts of their sensors; never angles.
    pub const fn position(az_counts: u16, el_counts: u16) -> Self {
        Self(Target::Position { az_counts, el_counts })
    }

    /// Returns a move to a position of the polarization alone.
    pub const fn polarization(position: PolarizationUnits) -> Self {
        Self(Target::Polarization(position))
    }

    /// Returns the satellite and its polarization, if the target is a satellite.
    pub const fn to_satellite(&self) -> Option<(SatelliteName, Option<Polarity>)> {
        if let Target::Satellite(name, polarity) = self.0 { Some((name, polarity)) } else { None }
    }

    /// Returns azimuth and elevation in counts, if the target is a position.
    pub const fn to_position(&self) -> Option<(u16, u16)> {
        if let Target::Position { az_counts, el_counts } = self.0 {
            Some((az_counts, el_counts))
        } else {
            None
        }
    }

    /// Returns the position of the polarization, if only the polarization turns.
    pub const fn to_polarization(&self) -> Option<PolarizationUnits> {
        if let Target::Polarization(position) = self.0 { Some(position) } else { None }
    }

    pub(super) fn data(self) -> Vec<u8> {
        let letter = |polarity| match polarity {
            Some(Polarity::Horizontal) => b'H',
            Some(Polarity::Vertical) => b'V',
            None => b' ',
        };
        match self.0 {
            Target::Satellite(name, polarity) => {
                let mut data = vec![letter(polarity)];
                data.extend_from_slice(name.field());
                data
            }
            Target::Position { az_counts, el_counts } => {
                // Zeros fill both numbers, because ten digits distinguish a position from a name.
                format!(" {az_counts:05}{el_counts:05}").into_bytes()
            }
            // The five zeros only keep the length: all forms of this command have 16 bytes.
            Target::Polarization(position) => format!("P{:05}00000", position.units()).into_bytes(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_that_means_a_position_is_refused() {
        let satellite = |name| AutoMove::satellite(SatelliteName::new(name).unwrap(), None);
        assert_eq!(satellite("0152500750"), Err(ValueError::NameIsPosition));
        assert!(satellite("015250075").is_ok());
        assert_eq!(AutoMove::satellite(SatelliteName::BLANK, None), Err(ValueError::NoName));
    }
}
