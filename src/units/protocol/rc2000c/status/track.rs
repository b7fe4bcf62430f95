//! Track mode, and the receiver that it uses.

/// Band of the receiver in track mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TrackBand {
    C,
    K,
    L,
    Unknown,
}

/// Activity of the track mode. The numbers are for the RC2000C; related models use other numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Submode {
    Off,
    /// Setup: the unit asks for data.
    Setup,
    AutoEntry,
    /// Peaking of the signal step by step.
    Step,
    /// Search for the signal.
    Search,
    /// Program track along the learned path.
    Program,
    /// Error: a jammed axis.
    JammedError,
    /// Error: an axis at a limit.
    LimitError,
    /// Error of a drive.
    DriveError,
    /// Error: a peak at a limit.
    PeakLimitError,
    /// Error of the azimuth scale factor.
    AzimuthScaleError,
    /// Error of the geographic position.
    GeoPositionError,
    SystemError,
    /// Error of a memory checksum.
    ChecksumError,
    Unknown(u8),
}

impl Submode {
    // Appendix E leaves 6 and 7 undefined. The RC2500 numbers 12 to 14 differently.
    const CODES: [(Self, u8); 14] = [
        (Self::Off, 0),
        (Self::Setup, 1),
        (Self::AutoEntry, 2),
        (Self::Step, 3),
        (Self::Search, 4),
        (Self::Program, 5),
        (Self::JammedError, 8),
        (Self::LimitError, 9),
        (Self::DriveError, 10),
        (Self::PeakLimitError, 11),
        (Self::AzimuthScaleError, 12),
        (Self::GeoPositionError, 13),
        (Self::SystemError, 14),
        (Self::ChecksumError, 15),
    ];

    fn from_code(code: u8) -> Self {
        let entry = Self::CODES.into_iter().find(|(_, number)| *number == code);
        entry.map_or(Self::Unknown(code), |(submode, _)| submode)
    }

    fn code(self) -> u8 {
        if let Self::Unknown(code) = self {
            return code & 0x0f;
        }
        let entry = Self::CODES.into_iter().find(|(submode, _)| *submode == self);
        entry.map_or(0, |(_, code)| code)
    }

    /// Returns `true` if the track mode is on, with or without an error. An unknown submode counts
    /// as on.
    pub fn is_active(self) -> bool {
        self != Self::Off
    }

    /// Returns `true` if the track mode has stopped with an error.
    pub fn is_error(self) -> bool {
        self.code() >= 8
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Track {
    /// Band in use.
    pub band: TrackBand,
    pub submode: Submode,
}

impl Track {
    pub(super) fn from_byte(byte: u8) -> Option<Self> {
        // An RC2000A sends a blank here, and any track character has bit 6 set.
        if byte & 0xc0 != 0x40 {
            return None;
        }
        let band = match byte & 0x30 {
            0x00 => TrackBand::C,
            0x10 => TrackBand::K,
            0x30 => TrackBand::L,
            _ => TrackBand::Unknown,
        };
        Some(Self { band, submode: Submode::from_code(byte & 0x0f) })
    }

    pub(super) fn byte(self) -> u8 {
        let band = match self.band {
            TrackBand::C => 0x00,
            TrackBand::K => 0x10,
            TrackBand::Unknown => 0x20,
            TrackBand::L => 0x30,
        };
        0x40 | band | self.submode.code()
    }
}

/// The stronger of the two receivers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReceiverChannel {
    One,
    Two,
    Unknown,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Receiver {
    pub channel: ReceiverChannel,
    /// Signal level of the channel, 0 to 1023, without unit.
    pub agc: u16,
    /// `true` if the unit accepts commands for the polarization; valid only while the track mode is
    /// on. See [`Status::allows_polarization`](super::Status::allows_polarization).
    pub allows_polarization: bool,
}

impl Receiver {
    pub(super) fn from_bytes(low: u8, high: u8) -> Option<Self> {
        if low & 0x80 != 0 || high & 0xc0 != 0x40 {
            return None;
        }
        let channel = match low & 0x60 {
            0x20 => ReceiverChannel::One,
            0x40 => ReceiverChannel::Two,
            _ => ReceiverChannel::Unknown,
        };
        // Each character carries five of the ten bits, so both characters stay printable.
        let agc = u16::from(high & 0x1f) << 5 | u16::from(low & 0x1f);
        Some(Self { channel, agc, allows_polarization: high & 0x20 != 0 })
    }

    pub(super) fn bytes(self) -> [u8; 2] {
        let channel = match self.channel {
            ReceiverChannel::One => 0x20,
            ReceiverChannel::Two => 0x40,
            ReceiverChannel::Unknown => 0x60,
        };
        let agc = self.agc.min(1023);
        let flag = u8::from(self.allows_polarization) << 5;
        [channel | (agc & 0x1f) as u8, 0x40 | flag | (agc >> 5) as u8]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_track_character_is_kept_and_others_are_none() {
        for byte in 0..=u8::MAX {
            let track = Track::from_byte(byte);
            assert_eq!(track.is_some(), (0x40..0x80).contains(&byte));
            assert!(track.is_none_or(|track| track.byte() == byte));
        }
        assert!(Submode::Unknown(6).is_active() && !Submode::Unknown(7).is_error());
    }

    #[test]
    fn every_level_comes_back() {
        for agc in 0..1024 {
            for channel in [ReceiverChannel::One, ReceiverChannel::Two, ReceiverChannel::Unknown] {
                let receiver = Receiver { channel, agc, allows_polarization: agc % 2 == 0 };
                let [low, high] = receiver.bytes();
                assert!((0x20..0x80).contains(&low) && (0x40..0x80).contains(&high));
                assert_eq!(Receiver::from_bytes(low, high), Some(receiver));
            }
        }
        assert_eq!(Receiver::from_bytes(0x20, 0x20), None);
    }
}
