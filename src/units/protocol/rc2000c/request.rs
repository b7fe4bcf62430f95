//! Commands of appendix E.

mod auto_move;
mod motion;
mod parse;
mod polarization;
mod value;

pub use auto_move::AutoMove;
pub use motion::{Direction, DriveReset, Jog, MAX_JOG, MIN_JOG, Motion, Speed};
pub use parse::RequestError;
pub use polarization::{Polarity, PolarizationMove, PolarizationUnits};
pub use value::ValueError;

use super::{Address, Command, Frame, Header};

/// Data of STOP for azimuth and elevation. Speed and duration must be valid, but have no effect.
const STOP: &[u8] = b"XS0000";

/// Any request of a console. Its values were checked at construction, so encoding cannot fail.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Request {
    /// A read. Any command, even a read, may take the panel from a local operator.
    Query(Query),
    /// End of any motion of azimuth and elevation; always allowed. The document does not say
    /// whether it ends an auto move, polarization or tracking.
    Stop,
    /// A command that can move the antenna or the polarization.
    Motion(Motion),
    /// A change of the unit's later behaviour.
    Setting(Setting),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Query {
    /// Kind of mount and version of the firmware.
    DeviceType,
    /// Complete status.
    Status,
    /// One name in the list of satellites.
    SatelliteName(NameIndex),
}

/// Index in the list of satellites, 1 to 50. The list of an RC2000C has 35 entries, or 50 with a
/// polar mount.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct NameIndex(u8);

impl NameIndex {
    const MAX: u8 = 50;

    /// Returns the index, or an error outside 1 to 50.
    pub fn new(index: u8) -> Result<Self, ValueError> {
        value::checked("place in the list", index.into(), 1, Self::MAX.into())?;
        Ok(Self(index))
    }

    pub const fn number(self) -> u8 {
        self.0
    }
}

/// Settings, which only affect later moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Setting {
    /// Automatic polarization for each satellite. While it is on, the unit refuses commands for the
    /// polarization.
    AutoPolarization(bool),
    /// Band of a dual-band satellite; valid only while the unit tracks.
    Band(Band),
}

/// Band of the receiver.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Band {
    C,
    K,
}

impl Request {
    /// Returns the command, whose code the reply repeats.
    pub const fn command(&self) -> Command {
        match self {
            Self::Query(Query::DeviceType) => Command::DeviceType,
            Self::Query(Query::Status) => Command::Status,
            Self::Query(Query::SatelliteName(_)) => Command::SatelliteName,
            // The protocol has no command for STOP: it is a jog with the letter X (appendix E).
            Self::Stop => Command::Jog,
            Self::Motion(motion) => motion.command(),
            Self::Setting(_) => Command::Miscellaneous,
        }
    }

    /// Returns the frame for the unit at `address`.
    pub fn to_frame(&self, address: Address) -> Frame {
        let data = match self {
            Self::Query(Query::DeviceType | Query::Status) => Vec::new(),
            Self::Query(Query::SatelliteName(index)) => {
                format!("{:02}", index.number()).into_bytes()
            }
            Self::Stop => STOP.to_vec(),
            Self::Motion(motion) => motion.data(),
            // Only a part of the page of appendix E with these letters was legible. The second
            // letters come from the RC1500 and the RC4000, whose protocols derive from this
            // protocol.
            Self::Setting(Setting::AutoPolarization(true)) => b"PN".to_vec(),
            Self::Setting(Setting::AutoPolarization(false)) => b"PF".to_vec(),
            Self::Setting(Setting::Band(Band::C)) => b"TC".to_vec(),
            Self::Setting(Setting::Band(Band::K)) => b"TK".to_vec(),
        };
        Frame::new(Header::Command, address, self.command().code(), data)
    }

    /// Returns the bytes for the unit at `address`.
    pub fn to_bytes(&self, address: Address) -> Vec<u8> {
        self.to_frame(address).to_bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_in_the_list_are_1_to_50() {
        assert!(NameIndex::new(0).is_err() && NameIndex::new(51).is_err());
        assert_eq!(NameIndex::new(35).map(NameIndex::number), Ok(35));
    }
}
