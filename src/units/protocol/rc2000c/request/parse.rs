//! Decoding of requests from frames, as a unit does.

use std::time::Duration;

use super::{
    AutoMove, Band, Direction, DriveReset, Jog, MIN_JOG, Motion, NameIndex, Polarity,
    PolarizationMove, PolarizationUnits, Query, Request, STOP, Setting, Speed,
};
use crate::protocol::rc2000c::{Command, Frame, Header, SatelliteName};

/// Reason why a frame is not a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum RequestError {
    /// A frame that is a reply.
    #[error("no command")]
    NotACommand,
    /// A code that no command has.
    #[error("unknown command {0:02X}")]
    UnknownCode(u8),
    /// A wrong length for this command.
    #[error("{data_bytes} bytes of data")]
    Length {
        /// Number of characters between code and ETX.
        data_bytes: usize,
    },
    /// A value that the command does not have.
    #[error("value without meaning")]
    Value,
}

impl Request {
    /// Reads a command. A jog shorter than 150 ms counts as 150 ms.
    pub fn parse(frame: &Frame) -> Result<Self, RequestError> {
        if frame.header() != Header::Command {
            return Err(RequestError::NotACommand);
        }
        let command =
            Command::from_code(frame.code()).ok_or(RequestError::UnknownCode(frame.code()))?;
        let data = frame.data();
        let data_bytes = match command {
            Command::DeviceType | Command::Status => 0,
            Command::AutoMove => 11,
            Command::Jog => 6,
            Command::Polarization => 1,
            Command::SatelliteName | Command::Miscellaneous => 2,
        };
        // The code fixes the length, and a unit answers any other length with NAK (appendix E).
        if data.len() != data_bytes {
            return Err(RequestError::Length { data_bytes: data.len() });
        }
        match command {
            Command::DeviceType => Some(Self::Query(Query::DeviceType)),
            Command::Status => Some(Self::Query(Query::Status)),
            Command::AutoMove => auto_move(data).map(Motion::AutoMove).map(Self::Motion),
            Command::Jog => jog(data),
            Command::Polarization => polarization(data).map(Self::Motion),
            Command::SatelliteName => number(data)
                .and_then(|index| NameIndex::new(u8::try_from(index).ok()?).ok())
                .map(|index| Self::Query(Query::SatelliteName(index))),
            Command::Miscellaneous => miscellaneous(data),
        }
        .ok_or(RequestError::Value)
    }
}

fn auto_move(data: &[u8]) -> Option<AutoMove> {
    let (letter, target) = data.split_first()?;
    let (first, second) = target.split_at_checked(5)?;
    let polarity = match letter {
        b'H' => Some(Polarity::Horizontal),
        b'V' => Some(Polarity::Vertical),
        // A unit reads ten digits as a position, even if a satellite has such a name.
        b' ' if target.iter().all(u8::is_ascii_digit) => {
            let counts = |digits| u16::try_from(number(digits)?).ok();
            return Some(AutoMove::position(counts(first)?, counts(second)?));
        }
        b' ' => None,
        b'P' if second == b"00000" => {
            let units = u16::try_from(number(first)?).ok()?;
            return PolarizationUnits::new(units).ok().map(AutoMove::polarization);
        }
        _ => return None,
    };
    AutoMove::satellite(SatelliteName::from_field(target)?, polarity).ok()
}

fn jog(data: &[u8]) -> Option<Request> {
    let [letter, speed, duration @ ..] = data else { return None };
    let speed = match speed {
        b'F' => Speed::Fast,
        b'S' => Speed::Slow,
        _ => return None,
    };
    let duration = Duration::from_millis(number(duration)?.into());
    // The test for X comes last, because appendix E requires a valid speed and duration for a stop.
    if STOP.first() == Some(letter) {
        return Some(Request::Stop);
    }
    let (direction, _) = Direction::ALL.into_iter().find(|(_, code)| code == letter)?;
    // The timer of a unit runs in steps of about 150 ms (appendix E).
    let jog = Jog::new(direction, speed, duration.max(MIN_JOG)).ok()?;
    Some(Request::Motion(Motion::Jog(jog)))
}

fn polarization(data: &[u8]) -> Option<Motion> {
    let [letter] = data else { return None };
    let (step, _) = PolarizationMove::ALL.into_iter().find(|(_, code)| code == letter)?;
    Some(Motion::Polarization(step))
}

fn miscellaneous(data: &[u8]) -> Option<Request> {
    Some(match data {
        b"RA" => Request::Motion(Motion::ResetDrive(DriveReset::Azimuth)),
        b"RE" => Request::Motion(Motion::ResetDrive(DriveReset::Elevation)),
        b"RP" => Request::Motion(Motion::ResetDrive(DriveReset::Polarization)),
        b"TR" => Request::Motion(Motion::RestartTracking),
        b"PN" => Request::Setting(Setting::AutoPolarization(true)),
        b"PF" => Request::Setting(Setting::AutoPolarization(false)),
        b"TC" => Request::Setting(Setting::Band(Band::C)),
        b"TK" => Request::Setting(Setting::Band(Band::K)),
        _ => return None,
    })
}

/// Reads digits without a sign.
fn number(digits: &[u8]) -> Option<u32> {
    let text = std::str::from_utf8(digits).ok()?;
    text.bytes().all(|byte| byte.is_ascii_digit()).then(|| text.parse().ok()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::rc2000c::Address;

    fn parse(code: u8, data: &[u8]) -> Result<Request, RequestError> {
        let frame = Frame::new(Header::Command, Address::FACTORY, code, data.to_vec());
        Request::parse(&frame)
    }

    #[test]
    fn what_a_controller_refuses_is_refused() {
        assert_eq!(parse(0x3f, b""), Err(RequestError::UnknownCode(0x3f)));
        assert_eq!(parse(0x31, b"1"), Err(RequestError::Length { data_bytes: 1 }));
        for (code, data) in [
            (0x32, &b" 9999900750"[..]),
            (0x32, b"H0152500750"),
            (0x32, b"P0050000001"),
            (0x32, b"P0200000000"),
            (0x32, b"DSBS 6     "),
            (0x32, b"           "),
            (0x33, b"ZS0300"),
            (0x33, b"EM0300"),
            (0x33, b"ES 300"),
            (0x33, b"XS+000"),
            (0x34, b"N"),
            (0x35, b"00"),
            (0x35, b"51"),
            (0x35, b" 1"),
            (0x36, b"QQ"),
        ] {
            assert_eq!(parse(code, data), Err(RequestError::Value), "{data:?}");
        }
    }

    #[test]
    fn a_stop_needs_valid_digits_and_a_short_jog_lasts_one_step() {
        assert_eq!(parse(0x33, b"XF9999"), Ok(Request::Stop));
        let jog = Jog::new(Direction::Clockwise, Speed::Fast, MIN_JOG).unwrap();
        assert_eq!(parse(0x33, b"WF0000"), Ok(Request::Motion(Motion::Jog(jog))));
    }
}
