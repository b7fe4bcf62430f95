//! Requests that can move the antenna or the polarization.

use std::time::Duration;

use super::auto_move::AutoMove;
use super::polarization::PolarizationMove;
use super::value::{ValueError, checked};
use crate::protocol::rc2000c::Command;

/// Min duration of a jog; the unit's timer has steps of about this duration.
pub const MIN_JOG: Duration = Duration::from_millis(150);
/// Max duration of a jog, which fills the field.
pub const MAX_JOG: Duration = Duration::from_millis(9999);

/// A request that can move the antenna or the polarization. Only the driver's gate may encode it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motion {
    /// Move to a target, which continues until the unit arrives.
    AutoMove(AutoMove),
    /// Turn of one axis for a fixed time.
    Jog(Jog),
    /// Turn of the polarization.
    Polarization(PolarizationMove),
    /// Reset of a drive alarm. The drive takes power again, and a pending motion may continue.
    ResetDrive(DriveReset),
    /// Reset of an error of the track mode, which then starts again.
    RestartTracking,
}

/// Direction of a jog.
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
    /// All directions with their letters. W means clockwise here, but counter-clockwise in commands
    /// for the polarization.
    pub(super) const ALL: [(Self, u8); 4] = [
        (Self::CounterClockwise, b'E'),
        (Self::Clockwise, b'W'),
        (Self::Down, b'D'),
        (Self::Up, b'U'),
    ];
}

/// Speed of a jog.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Speed {
    Slow,
    Fast,
}

/// Turn of one axis for a time (appendix E, command 33h).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Jog {
    direction: Direction,
    speed: Speed,
    duration_ms: u16,
}

impl Jog {
    /// Returns a jog of 150 to 9999 ms, rounded down to whole milliseconds. The unit rounds it to
    /// its own steps of about 150 ms.
    pub fn new(direction: Direction, speed: Speed, duration: Duration) -> Result<Self, ValueError> {
        let given_ms = u64::try_from(duration.as_millis()).unwrap_or(u64::MAX);
        let [min_ms, max_ms] = [MIN_JOG, MAX_JOG].map(|bound| bound.as_millis() as u64);
        let duration_ms = checked("jog in ms", given_ms, min_ms, max_ms)? as u16;
        Ok(Self { direction, speed, duration_ms })
    }

    pub const fn direction(self) -> Direction {
        self.direction
    }

    pub const fn speed(self) -> Speed {
        self.speed
    }

    pub const fn duration(self) -> Duration {
        Duration::from_millis(self.duration_ms as u64)
    }

    fn data(self) -> Vec<u8> {
        let found = Direction::ALL.into_iter().find(|(direction, _)| *direction == self.direction);
        // The letter X stops the antenna, in case a direction is missing in the list.
        let letter = char::from(found.map_or(b'X', |(_, letter)| letter));
        let speed = match self.speed {
            Speed::Slow => 'S',
            Speed::Fast => 'F',
        };
        format!("{letter}{speed}{:04}", self.duration_ms).into_bytes()
    }
}

/// Drive whose alarm the request clears.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DriveReset {
    Azimuth,
    Elevation,
    /// Drive of the polarization. A unit without a rotating feed refuses this reset.
    Polarization,
}

impl Motion {
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
            Self::Polarization(step) => PolarizationMove::ALL
                .into_iter()
                .filter(|(polarization_move, _)| *polarization_move == step)
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
}
