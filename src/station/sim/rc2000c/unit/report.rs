//! Status of the unit in its own reports.

use super::Rc2000c;
use crate::protocol::rc2000c::{
    Alarm, AxisDrive, Band, DeviceType, LimitEnd, MountKind, NameDisplay, PolarizationCode,
    PolarizationMode, Position, Receiver, ReceiverChannel, SatelliteName, Sense, Status, Submode,
    Track, TrackBand,
};
use crate::sim::rc2000c::axis::Axis;
use crate::sim::rc2000c::satellites::Closeness;
use crate::sim::rc2000c::tracking::Tracking;
use crate::sim::rc2000c::{Fault, Quirk};

/// Counts at 180 degrees of azimuth, and at 0 degrees of elevation.
const AZIMUTH_CENTRE: i32 = 1830;
const ELEVATION_ZERO: i32 = 30;
/// Gain that a user enters; it makes one count half a tenth of a degree.
const DISPLAY_GAIN: i32 = 200;

impl Rc2000c {
    pub(super) fn device_type(&self) -> DeviceType {
        if self.quirks.contains(&Quirk::Rc2000a) {
            DeviceType { mount: MountKind::Other(*b"RC2K"), version: *b"14" }
        } else {
            DeviceType { mount: MountKind::ElevationOverAzimuth, version: *b"14" }
        }
    }

    pub(super) fn status(&self) -> Status {
        let counts = self.frozen.unwrap_or_else(|| self.counts());
        let shown = self
            .satellites
            .iter()
            .find_map(|satellite| Some((satellite, satellite.closeness(counts)?)));
        let (satellite, name_display) = match shown {
            Some((satellite, Closeness::On)) => (satellite.name, NameDisplay::OnSatellite),
            Some((satellite, Closeness::Near)) => (satellite.name, NameDisplay::NearSatellite),
            None => (SatelliteName::BLANK, NameDisplay::Hidden),
        };
        let units = self.feed.units();
        let code = shown.map_or(PolarizationCode::None, |(shown, _)| shown.polarization(units));
        let is_older = self.quirks.contains(&Quirk::Rc2000a);
        let azimuth_ends = [LimitEnd::CounterClockwise, LimitEnd::Clockwise];
        let [az_tenths, el_tenths] = angles(counts);
        Status {
            satellite,
            name_display,
            azimuth: self.position(&self.azimuth, counts[0], az_tenths, azimuth_ends),
            elevation: self.position(
                &self.elevation,
                counts[1],
                el_tenths,
                [LimitEnd::Down, LimitEnd::Up],
            ),
            feed: self.feed.reading(),
            polarization_mode: Some(PolarizationMode {
                code,
                is_automatic: self.is_auto_polarization,
            }),
            azimuth_drive: self.reported(self.azimuth.drive()),
            elevation_drive: self.reported(self.elevation.drive()),
            polarization_motion: self.feed.motion(),
            alarm: self.alarm(),
            track: (!is_older).then(|| self.track_report()),
            receiver: (!is_older).then(|| self.receiver(code)),
        }
    }

    fn reported(&self, drive: AxisDrive) -> AxisDrive {
        if self.faults.contains(&Fault::FalseRest) { AxisDrive::Still } else { drive }
    }

    fn position(
        &self,
        axis: &Axis,
        counts: u16,
        tenths: i16,
        [min, max]: [LimitEnd; 2],
    ) -> Position {
        let end = match axis.limit() {
            Some(Sense::Negative) => min,
            Some(Sense::Positive) => max,
            None if self.quirks.contains(&Quirk::AngleDisplay) => {
                return Position::TenthsOfDegree(tenths);
            }
            None => return Position::Counts(counts),
        };
        match end {
            LimitEnd::CounterClockwise if self.has_left_words() => Position::Unknown(*b"CCW  "),
            LimitEnd::Clockwise if self.has_left_words() => Position::Unknown(*b"CW   "),
            LimitEnd::Down if self.has_left_words() => Position::Unknown(*b"DOWN "),
            LimitEnd::Up if self.has_left_words() => Position::Unknown(*b"UP   "),
            end => Position::Limit(end),
        }
    }

    fn has_left_words(&self) -> bool {
        self.quirks.contains(&Quirk::LeftWords)
    }

    /// Returns the most urgent alarm.
    fn alarm(&self) -> Alarm {
        let own = [(&self.azimuth, Alarm::Azimuth), (&self.elevation, Alarm::Elevation)];
        let own = own.into_iter().filter(|(axis, _)| AxisDrive::is_alarm(axis.drive()));
        let injected = self.faults.iter().filter_map(|fault| match fault {
            Fault::Alarm(alarm) => Some(*alarm),
            _ => None,
        });
        own.map(|(_, alarm)| alarm).chain(injected).min().unwrap_or(Alarm::None)
    }

    fn track_report(&self) -> Track {
        let submode = self.tracking.as_ref().map_or(Submode::Off, Tracking::submode);
        let band = match self.tracking.as_ref().map(|tracking| tracking.band) {
            Some(Band::K) => TrackBand::K,
            Some(Band::C) | None => TrackBand::C,
        };
        Track { band, submode }
    }

    fn receiver(&self, code: PolarizationCode) -> Receiver {
        let counts = self.counts();
        let agc = self.satellites.iter().map(|satellite| satellite.agc(counts)).max();
        let is_vertical =
            matches!(code, PolarizationCode::Vertical | PolarizationCode::NearVertical);
        Receiver {
            channel: if is_vertical { ReceiverChannel::Two } else { ReceiverChannel::One },
            agc: agc.unwrap_or(0),
            allows_polarization: self
                .tracking
                .as_ref()
                .is_some_and(|tracking| !tracking.is_peaking() && !self.is_auto_polarization),
        }
    }
}

/// Returns azimuth and elevation in tenths of a degree, as the display computes them.
fn angles([az_counts, el_counts]: [u16; 2]) -> [i16; 2] {
    let relative = |counts: u16, zero: i32| (i32::from(counts) - zero) * 100 / DISPLAY_GAIN;
    let azimuth = (1800 + relative(az_counts, AZIMUTH_CENTRE)).rem_euclid(3600);
    [azimuth, relative(el_counts, ELEVATION_ZERO)]
        .map(|tenths| i16::try_from(tenths).unwrap_or(i16::MAX))
}
