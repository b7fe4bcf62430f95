//! Status of a unit: 33 characters between code and ETX.

mod alarm;
mod drive;
mod feed;
mod position;
mod track;

pub use alarm::Alarm;
pub use drive::{AxisDrive, PolarizationMotion, Sense};
pub use feed::{FeedPosition, FeedReading, PolarizationCode, PolarizationDevice, PolarizationMode};
pub use position::{LimitEnd, Position};
pub use track::{Receiver, ReceiverChannel, Submode, Track, TrackBand};

use super::SatelliteName;
use position::PositionAxis;

/// Length of a status in its frame, characters.
pub(super) const STATUS_BYTES: usize = 33;
/// Fixed upper bits of most coded characters; a blank has no coded bits.
const BASE: u8 = 0x20;
/// Character for an unknown polarization mode, because a blank is a valid mode.
const NO_MODE: u8 = b'?';

/// Status of a unit. An undocumented field value becomes `Unknown` or `None`, and the other fields
/// stay valid; the frame keeps the characters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Status {
    /// Satellite on the display, blank for none.
    pub satellite: SatelliteName,
    pub name_display: NameDisplay,
    pub azimuth: Position,
    pub elevation: Position,
    pub feed: FeedReading,
    pub polarization_mode: Option<PolarizationMode>,
    /// Drive of the azimuth; positive is clockwise.
    pub azimuth_drive: AxisDrive,
    /// Drive of the elevation; positive is up.
    pub elevation_drive: AxisDrive,
    pub polarization_motion: PolarizationMotion,
    /// Most urgent alarm; the unit shows the next alarm once this one is cleared.
    pub alarm: Alarm,
    /// Track mode; `None` from an RC2000A, which has none.
    pub track: Option<Track>,
    /// Receiver; `None` from an RC2000A, which has none.
    pub receiver: Option<Receiver>,
}

/// Style in which the display shows the name of a satellite.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NameDisplay {
    /// Upper case: the antenna points at the satellite.
    OnSatellite,
    /// Lower case: the antenna points close to the satellite.
    NearSatellite,
    Hidden,
    Unknown(u8),
}

impl NameDisplay {
    const fn from_byte(byte: u8) -> Self {
        match byte {
            0x20 => Self::OnSatellite,
            0x21 => Self::NearSatellite,
            0x22 => Self::Hidden,
            other => Self::Unknown(other),
        }
    }

    const fn byte(self) -> u8 {
        match self {
            Self::OnSatellite => 0x20,
            Self::NearSatellite => 0x21,
            Self::Hidden => 0x22,
            Self::Unknown(other) => other,
        }
    }
}

impl Status {
    /// Returns `true` if an active track mode lets commands turn the polarization; `None` while it
    /// is off and the flag has no meaning.
    pub fn allows_polarization(&self) -> Option<bool> {
        self.track.filter(|track| track.submode.is_active())?;
        self.receiver.map(|receiver| receiver.allows_polarization)
    }

    /// Reads the characters between code and ETX; `None` unless there are 33.
    pub(super) fn parse(data: &[u8]) -> Option<Self> {
        let (name, rest) = data.split_at_checked(10)?;
        let (display, rest) = rest.split_first()?;
        let (azimuth, rest) = rest.split_first_chunk::<5>()?;
        let (elevation, rest) = rest.split_first_chunk::<5>()?;
        let (feed, rest) = rest.split_first_chunk::<2>()?;
        let &[
            mode,
            azimuth_drive,
            elevation_drive,
            feed_motion,
            alarm_low,
            alarm_high,
            device,
            track,
            agc_low,
            agc_high,
        ] = rest
        else {
            return None;
        };
        Some(Self {
            satellite: SatelliteName::from_field(name)?,
            name_display: NameDisplay::from_byte(*display),
            azimuth: Position::parse(PositionAxis::Azimuth, *azimuth),
            elevation: Position::parse(PositionAxis::Elevation, *elevation),
            feed: FeedReading::parse(*feed, device),
            polarization_mode: PolarizationMode::from_byte(mode),
            azimuth_drive: AxisDrive::from_byte(azimuth_drive),
            elevation_drive: AxisDrive::from_byte(elevation_drive),
            polarization_motion: PolarizationMotion::from_byte(feed_motion),
            alarm: Alarm::from_bytes(alarm_low, alarm_high),
            track: Track::from_byte(track),
            receiver: Receiver::from_bytes(agc_low, agc_high),
        })
    }

    /// Returns the characters between code and ETX. Blanks replace an absent track mode and
    /// receiver, as on an RC2000A.
    pub(super) fn data(&self) -> Vec<u8> {
        let mut data = Vec::with_capacity(STATUS_BYTES);
        data.extend_from_slice(self.satellite.field());
        data.push(self.name_display.byte());
        data.extend_from_slice(&self.azimuth.text());
        data.extend_from_slice(&self.elevation.text());
        let (feed, device) = self.feed.bytes();
        data.extend_from_slice(&feed);
        data.push(self.polarization_mode.map_or(NO_MODE, PolarizationMode::byte));
        data.extend([self.azimuth_drive.byte(), self.elevation_drive.byte()]);
        data.push(self.polarization_motion.byte());
        data.extend(self.alarm.bytes());
        data.push(device);
        data.push(self.track.map_or(BASE, Track::byte));
        data.extend(self.receiver.map_or([BASE; 2], Receiver::bytes));
        data
    }

    /// Returns `true` if the unit reports that an axis or the polarization turns or is about to
    /// turn. An axis with an idle drive may still coast: compare its positions.
    pub const fn is_moving(&self) -> bool {
        self.azimuth_drive.is_moving()
            || self.elevation_drive.is_moving()
            // An unknown code counts as motion, like an unknown code of an axis.
            || !matches!(self.polarization_motion, PolarizationMotion::Still)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_status_of_an_older_controller_has_no_track_mode_and_no_receiver() {
        let data = b"SBS 6       1525  75039       #   ";
        assert_eq!(data.len(), STATUS_BYTES + 1);
        assert_eq!(Status::parse(data), None);
        let status = Status::parse(b"SBS 6       1525  75039      #   ").unwrap();
        assert_eq!((status.track, status.receiver), (None, None));
        assert_eq!(status.data(), b"SBS 6       1525  75039      #   ");
        assert!(!status.is_moving());
    }

    #[test]
    fn every_field_takes_any_character() {
        for byte in 0..=u8::MAX {
            let status = Status::parse(&[byte; STATUS_BYTES]).unwrap();
            assert_eq!(Status::parse(&status.data()).unwrap(), status, "{byte:02x}");
        }
    }
}
