//! Everything that can make metal move.

use std::time::Duration;

use crate::protocol::rc2000c::{Command, SatelliteName};

/// The shortest jog; the controller's timer runs in steps of about this.
pub const MIN_JOG: Duration = Duration::from_millis(150);
/// The longest jog that the field holds.
pub const MAX_JOG: Duration = Duration::from_millis(9999);
/// The most that a position of the polarization can be: a rotating feed's.
const MAX_POLARIZATION: u16 = 1023;

/// Why a value cannot be sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum ValueError {
    /// Outside the range.
    #[error("{what} {value} is not between {least} and {most}")]
    Range {
        /// What the number means, with its unit.
        what: &'static str,
        /// As given.
        value: u64,
        /// Smallest accepted.
        least: u64,
        /// Largest accepted.
        most: u64,
    },
    /// A controller would read the ten digits of the name as a position.
    #[error("a name of ten digits means a position")]
    NameIsPosition,
    /// No satellite has a name of blanks.
    #[error("the name is empty")]
    NoName,
}

/// `value`, when it lies between `least` and `most`.
pub(super) fn checked(
    what: &'static str,
    value: u64,
    least: u64,
    most: u64,
) -> Result<u64, ValueError> {
    if (least..=most).contains(&value) {
        Ok(value)
    } else {
        Err(ValueError::Range { what, value, least, most })
    }
}

/// A request that can make metal move. Only the gate of the driver may turn one
/// into bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motion {
    /// Go to a target. It runs until it is there.
    AutoMove(AutoMove),
    /// Turn one axis for a time. It ends by itself.
    Jog(Jog),
    /// Turn the polarization.
    Polarization(PolarizationMove),
    /// Clear the alarm of a drive. It takes power again, and what was pending
    /// may go on.
    ResetDrive(DriveReset),
    /// Clear the error of the track mode, which starts again.
    RestartTracking,
}

/// Where an auto move goes (appendix E, command 32h).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AutoMove(Target);

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Target {
    Satellite(SatelliteName, Option<Polarity>),
    Position { az_counts: u16, el_counts: u16 },
    Polarization(PolarizationUnits),
}

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

impl AutoMove {
    /// To a stored satellite and, if given, one of its polarizations. The name
    /// must be one that the controller listed.
    pub fn satellite(name: SatelliteName, polarity: Option<Polarity>) -> Result<Self, ValueError> {
        if name.is_all_digits() {
            Err(ValueError::NameIsPosition)
        } else if name.is_blank() {
            Err(ValueError::NoName)
        } else {
            Ok(Self(Target::Satellite(name, polarity)))
        }
    }

    /// To a position of both axes, in counts of their sensors; never angles.
    pub const fn position(az_counts: u16, el_counts: u16) -> Self {
        Self(Target::Position { az_counts, el_counts })
    }

    /// To a position of the polarization alone.
    pub const fn polarization(position: PolarizationUnits) -> Self {
        Self(Target::Polarization(position))
    }

    /// The satellite and its polarization, if it goes to one.
    pub const fn to_satellite(&self) -> Option<(SatelliteName, Option<Polarity>)> {
        if let Target::Satellite(name, polarity) = self.0 { Some((name, polarity)) } else { None }
    }

    /// Azimuth and elevation in counts, if it goes to a position.
    pub const fn to_position(&self) -> Option<(u16, u16)> {
        if let Target::Position { az_counts, el_counts } = self.0 {
            Some((az_counts, el_counts))
        } else {
            None
        }
    }

    /// The position of the polarization, if it turns nothing else.
    pub const fn to_polarization(&self) -> Option<PolarizationUnits> {
        if let Target::Polarization(position) = self.0 { Some(position) } else { None }
    }

    fn data(self) -> Vec<u8> {
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
                format!(" {az_counts:05}{el_counts:05}").into_bytes()
            }
            Target::Polarization(position) => format!("P{:05}00000", position.0).into_bytes(),
        }
    }
}

/// Which way a jog turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// Azimuth counter-clockwise.
    CounterClockwise,
    /// Azimuth clockwise.
    Clockwise,
    /// Elevation down.
    Down,
    /// Elevation up.
    Up,
}

impl Direction {
    /// All directions with their letters. E means counter-clockwise here,
    /// while W means so in commands for the polarization.
    pub(super) const ALL: [(Self, u8); 4] = [
        (Self::CounterClockwise, b'E'),
        (Self::Clockwise, b'W'),
        (Self::Down, b'D'),
        (Self::Up, b'U'),
    ];
}

/// Speed of a jog.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs, reason = "the controller has these two, and no numbers for them")]
pub enum Speed {
    Slow,
    Fast,
}

/// One axis turns for a time (appendix E, command 33h).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Jog {
    direction: Direction,
    speed: Speed,
    duration_ms: u16,
}

impl Jog {
    /// A jog of 150 to 9999 ms, cut to whole milliseconds. The controller
    /// rounds to its own steps of about 150 ms.
    pub fn new(direction: Direction, speed: Speed, duration: Duration) -> Result<Self, ValueError> {
        let given_ms = u64::try_from(duration.as_millis()).unwrap_or(u64::MAX);
        let [least_ms, most_ms] = [MIN_JOG, MAX_JOG].map(|bound| bound.as_millis() as u64);
        let duration_ms = checked("jog in ms", given_ms, least_ms, most_ms)? as u16;
        Ok(Self { direction, speed, duration_ms })
    }

    /// Which way.
    pub const fn direction(self) -> Direction {
        self.direction
    }

    /// How fast.
    pub const fn speed(self) -> Speed {
        self.speed
    }

    /// How long.
    pub const fn duration(self) -> Duration {
        Duration::from_millis(self.duration_ms as u64)
    }

    fn data(self) -> Vec<u8> {
        let found = Direction::ALL.into_iter().find(|(known, _)| *known == self.direction);
        let letter = char::from(found.map_or(b'X', |(_, letter)| letter));
        let speed = match self.speed {
            Speed::Slow => 'S',
            Speed::Fast => 'F',
        };
        format!("{letter}{speed}{:04}", self.duration_ms).into_bytes()
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

/// The drive whose alarm is cleared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DriveReset {
    /// Azimuth.
    Azimuth,
    /// Elevation.
    Elevation,
    /// Polarization; refused without a rotating feed.
    Polarization,
}

impl Motion {
    /// The command on the line.
    pub const fn command(&self) -> Command {
        match self {
            Self::AutoMove(_) => Command::AutoMove,
            Self::Jog(_) => Command::Jog,
            Self::Polarization(_) => Command::Polarization,
            Self::ResetDrive(_) | Self::RestartTracking => Command::Miscellaneous,
        }
    }

    pub(super) fn data(self) -> Vec<u8> {
        match self {
            Self::AutoMove(auto_move) => auto_move.data(),
            Self::Jog(jog) => jog.data(),
            Self::Polarization(wanted) => PolarizationMove::ALL
                .into_iter()
                .filter(|(known, _)| *known == wanted)
                .map(|(_, letter)| letter)
                .collect(),
            Self::ResetDrive(DriveReset::Azimuth) => b"RA".to_vec(),
            Self::ResetDrive(DriveReset::Elevation) => b"RE".to_vec(),
            Self::ResetDrive(DriveReset::Polarization) => b"RP".to_vec(),
            Self::RestartTracking => b"TR".to_vec(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_jog_too_short_or_too_long_is_refused() {
        let jog = |duration| Jog::new(Direction::Up, Speed::Slow, duration);
        assert!(jog(Duration::from_micros(149_999)).is_err());
        assert!(jog(Duration::from_secs(10)).is_err() && jog(Duration::MAX).is_err());
        assert_eq!(jog(MIN_JOG).map(Jog::duration), Ok(MIN_JOG));
        assert_eq!(jog(MAX_JOG).map(Jog::duration), Ok(MAX_JOG));
    }

    #[test]
    fn a_name_that_means_a_position_is_refused() {
        let to = |name| AutoMove::satellite(SatelliteName::new(name).unwrap(), None);
        assert_eq!(to("0152500750"), Err(ValueError::NameIsPosition));
        assert!(to("015250075").is_ok());
        assert_eq!(AutoMove::satellite(SatelliteName::BLANK, None), Err(ValueError::NoName));
        assert!(PolarizationUnits::new(1024).is_err());
    }
}
