//! Frames: header, address, command code, data, ETX, checksum (appendix D).

mod decoder;

pub(super) use decoder::is_device_type;
pub use decoder::{Decoder, FrameError};

use super::Address;

pub(super) const STX: u8 = 0x02;
pub(super) const ETX: u8 = 0x03;
pub(super) const ACK: u8 = 0x06;
pub(super) const NAK: u8 = 0x15;
/// Length of the longest frame, a status, bytes.
pub const MAX_FRAME_BYTES: usize = 38;
/// Length of the longest command, an auto move, bytes.
pub const MAX_COMMAND_BYTES: usize = 16;
/// Length of a frame around its data, bytes: header, address, code, ETX, checksum.
pub(super) const ENVELOPE_BYTES: usize = 5;
/// Data of a reply from a unit whose remote mode is disabled.
pub(super) const OFFLINE: &[u8] = b"F";

/// First byte of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Header {
    /// STX: a command, or its echo on the console's side.
    Command,
    /// ACK: a command that the unit understood, or an offline unit.
    Ack,
    /// NAK: a command that the unit refused.
    Nak,
}

impl Header {
    const fn from_byte(byte: u8) -> Option<Self> {
        match byte {
            STX => Some(Self::Command),
            ACK => Some(Self::Ack),
            NAK => Some(Self::Nak),
            _ => None,
        }
    }

    const fn byte(self) -> u8 {
        match self {
            Self::Command => STX,
            Self::Ack => ACK,
            Self::Nak => NAK,
        }
    }
}

/// The commands of appendix E.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Command {
    /// Question for the type of the unit.
    DeviceType = 0x30,
    /// Question for the status.
    Status = 0x31,
    /// Move to a satellite or a position.
    AutoMove = 0x32,
    /// Jog of azimuth or elevation, or a stop.
    Jog = 0x33,
    /// Turn of the polarization.
    Polarization = 0x34,
    /// Question for the name of a stored satellite.
    SatelliteName = 0x35,
    /// Commands for alarms, automatic polarization and the track mode.
    Miscellaneous = 0x36,
}

impl Command {
    /// All commands, in the order of their codes.
    pub const ALL: [Self; 7] = [
        Self::DeviceType,
        Self::Status,
        Self::AutoMove,
        Self::Jog,
        Self::Polarization,
        Self::SatelliteName,
        Self::Miscellaneous,
    ];

    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|command| command.code() == code)
    }

    pub const fn code(self) -> u8 {
        self as u8
    }

    /// Returns the total length of a good reply, bytes.
    pub const fn reply_bytes(self) -> usize {
        // A frame carries no length: only these numbers show the end of a reply (appendix E).
        match self {
            Self::DeviceType => 11,
            Self::SatelliteName => 19,
            // The unit answers every command that acts with the whole status, under the command's
            // code.
            Self::Status
            | Self::AutoMove
            | Self::Jog
            | Self::Polarization
            | Self::Miscellaneous => MAX_FRAME_BYTES,
        }
    }
}

/// A frame with correct form and checksum.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Frame {
    header: Header,
    address: Address,
    code: u8,
    data: Vec<u8>,
}

impl Frame {
    /// Returns a frame around `data`, which must be printable characters.
    pub(super) fn new(header: Header, address: Address, code: u8, data: Vec<u8>) -> Self {
        Self { header, address, code, data }
    }

    pub const fn header(&self) -> Header {
        self.header
    }

    /// Returns the address of the unit that receives or sends the frame.
    pub const fn address(&self) -> Address {
        self.address
    }

    /// Returns the command code, which a reply repeats. Not every code is a [`Command`].
    pub const fn code(&self) -> u8 {
        self.code
    }

    /// Returns the characters between code and ETX, 20h to 7Fh.
    pub fn data(&self) -> &[u8] {
        &self.data
    }

    /// Returns the bytes on the line, each below 80h.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = vec![self.header.byte(), self.address.number(), self.code];
        bytes.extend_from_slice(&self.data);
        bytes.push(ETX);
        bytes.push(checksum(&bytes));
        bytes
    }
}

/// Returns the checksum: XOR of every byte from the header to ETX (appendix E). It may equal any
/// control byte.
pub fn checksum(bytes: &[u8]) -> u8 {
    bytes.iter().fold(0, |sum, byte| sum ^ byte)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_may_look_like_any_control_byte() {
        let last = |address, code| {
            let address = Address::new(address).unwrap();
            *Frame::new(Header::Command, address, code, Vec::new()).to_bytes().last().unwrap()
        };
        assert_eq!([last(0x32, 0x30), last(0x33, 0x30), last(0x37, 0x30)], [ETX, STX, ACK]);
        assert_eq!([last(0x32, 0x31), last(0x33, 0x31), last(0x36, 0x31)], [STX, ETX, ACK]);
        assert_eq!(last(0x49, 0x31), 0x79);
    }

    #[test]
    fn every_command_is_found_by_its_code() {
        for command in Command::ALL {
            assert_eq!(Command::from_code(command.code()), Some(command));
        }
        assert_eq!(Command::from_code(0x37), None);
    }
}
