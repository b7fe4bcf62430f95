//! Replies of appendix E.

use std::fmt;

use super::frame::{OFFLINE, is_device_type};
use super::satellite_name::NAME_BYTES;
use super::{Address, Command, Frame, Header, SatelliteName, Status};

/// A reply of a unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reply {
    DeviceType(DeviceType),
    /// Status in reply to `command`. For a motion, it says that the unit understood the command,
    /// not that the unit carried it out.
    Status {
        command: Command,
        status: Status,
    },
    /// One entry of the list of satellites.
    SatelliteName(NameEntry),
    /// Reply of a unit that is configured to take no commands. Its frame begins with ACK
    /// nevertheless.
    Offline {
        /// Code of the command.
        code: u8,
    },
    /// Refusal of a command that is unknown, has a wrong length or cannot be carried out. The unit
    /// does not report which.
    Refused {
        /// Code of the command.
        code: u8,
    },
}

/// Reason why a frame is not a reply.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum ReplyError {
    /// A command: the line echoes what Azel sends.
    #[error("echo of command {code:02X}")]
    Echo {
        /// Code of the echoed command.
        code: u8,
    },
    /// A list entry without numbers.
    #[error("list entry without numbers")]
    Entry,
    /// A frame whose code and form match no reply.
    #[error("reply to {code:02X} without meaning")]
    Form {
        /// Code of the reply.
        code: u8,
    },
}

/// Kind of mount and firmware version.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DeviceType {
    /// Mount for which the firmware is made.
    pub mount: MountKind,
    /// First two digits of the version, as characters.
    pub version: [u8; 2],
}

/// Kind of mount for which the firmware is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MountKind {
    /// RC2000C, elevation over azimuth.
    ElevationOverAzimuth,
    /// RC2000C, polar with declination.
    Polar,
    /// RC2000C, azimuth over elevation.
    AzimuthOverElevation,
    /// Another device, with its name on the line.
    Other([u8; 4]),
}

impl MountKind {
    const NAMES: [(Self, [u8; 4]); 3] = [
        (Self::ElevationOverAzimuth, *b"2KCA"),
        (Self::Polar, *b"2KCP"),
        (Self::AzimuthOverElevation, *b"2KCE"),
    ];

    fn from_name(name: [u8; 4]) -> Self {
        let entry = Self::NAMES.into_iter().find(|(_, bytes)| *bytes == name);
        // Related models such as the RC2000A (`RC2K`) also answer, but use some other codes.
        entry.map_or(Self::Other(name), |(mount, _)| mount)
    }

    fn name(self) -> [u8; 4] {
        if let Self::Other(name) = self {
            return name;
        }
        let entry = Self::NAMES.into_iter().find(|(mount, _)| *mount == self);
        entry.map_or(*b"    ", |(_, name)| name)
    }
}

impl fmt::Display for DeviceType {
    /// Formats the type, for example as `2KCA 1.4`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // The reply leaves out the point: 4.31 comes as `43` (appendix E).
        let [whole, tenth] = self.version.map(char::from);
        let name = self.mount.name();
        write!(f, "{} {whole}.{tenth}", String::from_utf8_lossy(&name))
    }
}

/// One entry of the list of satellites.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NameEntry {
    /// Index, counted from 1.
    pub index: u8,
    /// Number of entries in the list.
    pub count: u8,
    /// Name as received, which a command must repeat unchanged.
    pub name: SatelliteName,
}

impl Reply {
    pub fn parse(frame: &Frame) -> Result<Self, ReplyError> {
        let (code, data) = (frame.code(), frame.data());
        match frame.header() {
            // An RS-422 adapter may return the bytes that it sends.
            Header::Command => return Err(ReplyError::Echo { code }),
            Header::Nak => return Ok(Self::Refused { code }),
            // This test precedes the code, because any command may get this reply.
            Header::Ack if data == OFFLINE => return Ok(Self::Offline { code }),
            Header::Ack => {}
        }
        let unknown = ReplyError::Form { code };
        // Some firmware repeats a wrong code in this reply.
        if is_device_type(data) || code == Command::DeviceType.code() {
            return device_type(data).map(Self::DeviceType).ok_or(unknown);
        }
        match Command::from_code(code).ok_or(unknown)? {
            Command::SatelliteName => entry(data).map(Self::SatelliteName).ok_or(ReplyError::Entry),
            command => {
                let status = Status::parse(data).ok_or(unknown)?;
                Ok(Self::Status { command, status })
            }
        }
    }

    /// Returns the frame from the unit at `address`.
    pub fn to_frame(&self, address: Address) -> Frame {
        let (header, code, data) = match self {
            Self::DeviceType(device) => {
                let data = [&device.mount.name()[..], &device.version].concat();
                (Header::Ack, Command::DeviceType.code(), data)
            }
            Self::Status { command, status } => (Header::Ack, command.code(), status.data()),
            Self::SatelliteName(entry) => {
                // Both numbers have two digits on the line (appendix E).
                let numbers = format!("{:02}{:02}", entry.index.min(99), entry.count.min(99));
                let data = [numbers.as_bytes(), entry.name.field()].concat();
                (Header::Ack, Command::SatelliteName.code(), data)
            }
            Self::Offline { code } => (Header::Ack, *code, OFFLINE.to_vec()),
            Self::Refused { code } => (Header::Nak, *code, Vec::new()),
        };
        Frame::new(header, address, code, data)
    }
}

fn device_type(data: &[u8]) -> Option<DeviceType> {
    let (name, version) = data.split_first_chunk::<4>()?;
    Some(DeviceType { mount: MountKind::from_name(*name), version: version.try_into().ok()? })
}

fn entry(data: &[u8]) -> Option<NameEntry> {
    let (numbers, name) = data.split_at_checked(data.len().checked_sub(NAME_BYTES)?)?;
    let [index, count] = [numbers.get(..2)?, numbers.get(2..)?].map(|digits| {
        let text = std::str::from_utf8(digits).ok()?;
        // `parse` alone would accept a plus sign.
        text.bytes().all(|byte| byte.is_ascii_digit()).then(|| text.parse().ok()).flatten()
    });
    Some(NameEntry { index: index?, count: count?, name: SatelliteName::from_field(name)? })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(header: Header, code: u8, data: &[u8]) -> Frame {
        Frame::new(header, Address::FACTORY, code, data.to_vec())
    }

    #[test]
    fn an_ack_is_not_success() {
        let offline = frame(Header::Ack, 0x32, b"F");
        assert_eq!(Reply::parse(&offline), Ok(Reply::Offline { code: 0x32 }));
        let refused = frame(Header::Nak, 0x3f, b"");
        assert_eq!(Reply::parse(&refused), Ok(Reply::Refused { code: 0x3f }));
    }

    #[test]
    fn our_own_command_is_an_echo() {
        let echo = frame(Header::Command, 0x31, b"");
        assert_eq!(Reply::parse(&echo), Err(ReplyError::Echo { code: 0x31 }));
    }

    #[test]
    fn other_devices_keep_their_name() {
        let reply = Reply::parse(&frame(Header::Ack, 0x30, b"250025")).unwrap();
        let Reply::DeviceType(device) = reply else { panic!("{reply:?}") };
        assert_eq!(device.mount, MountKind::Other(*b"2500"));
        assert_eq!(device.to_string(), "2500 2.5");
    }

    #[test]
    fn forms_without_meaning_are_refused() {
        for (code, data, error) in [
            (0x35, &b"0112"[..], ReplyError::Entry),
            (0x35, b"A112SBS 6     ", ReplyError::Entry),
            (0x31, b"", ReplyError::Form { code: 0x31 }),
            (0x37, b"", ReplyError::Form { code: 0x37 }),
            (0x30, b"", ReplyError::Form { code: 0x30 }),
        ] {
            assert_eq!(Reply::parse(&frame(Header::Ack, code, data)), Err(error));
        }
    }
}
