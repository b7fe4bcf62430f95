//! Alarm on the unit's display.

use super::BASE;

/// The most urgent alarm (appendix E, characters 30 and 31). The numbers are for the RC2000C;
/// related models use other numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Alarm {
    None,
    /// Low battery of the memory.
    LowBattery,
    Azimuth,
    Elevation,
    /// Wrong azimuth count.
    AzimuthCount,
    /// Wrong elevation count.
    ElevationCount,
    /// Corrupt azimuth limits.
    AzimuthLimits,
    /// Corrupt elevation limits.
    ElevationLimits,
    /// Corrupt data for automatic polarization.
    AutoPolarizationData,
    /// Corrupt setting for both axes at once.
    SimultaneousAxes,
    /// Corrupt slow speed of the azimuth.
    AzimuthSlowSpeed,
    /// Corrupt slow speed of the elevation.
    ElevationSlowSpeed,
    /// Corrupt settings of the serial port.
    SerialPortData,
    /// Corrupt geographic and elevation data.
    GeoElevationPosition,
    /// Corrupt settings of the track mode.
    TrackConfiguration,
    /// Corrupt antenna and receiver data.
    AntennaReceiver,
    /// Wrong time or date.
    TimeOrDate,
    /// Corrupt settings of the angle display.
    AngleDisplay,
    /// Corrupt settings of the polarization.
    PolarizationOptions,
    Polarization,
    /// Corrupt settings of azimuth and elevation.
    AxisOptions,
    /// Two unknown characters, the lower nibble first.
    Unknown([u8; 2]),
}

impl Alarm {
    /// All alarms in the order of their numbers, from 0: no alarm first, then the most urgent.
    pub const ALL: [Self; 21] = [
        Self::None,
        Self::LowBattery,
        Self::Azimuth,
        Self::Elevation,
        Self::AzimuthCount,
        Self::ElevationCount,
        Self::AzimuthLimits,
        Self::ElevationLimits,
        Self::AutoPolarizationData,
        Self::SimultaneousAxes,
        Self::AzimuthSlowSpeed,
        Self::ElevationSlowSpeed,
        Self::SerialPortData,
        Self::GeoElevationPosition,
        Self::TrackConfiguration,
        Self::AntennaReceiver,
        Self::TimeOrDate,
        Self::AngleDisplay,
        Self::PolarizationOptions,
        Self::Polarization,
        Self::AxisOptions,
    ];

    pub(super) fn from_bytes(low: u8, high: u8) -> Self {
        Self::ALL
            .into_iter()
            .find(|alarm| alarm.bytes() == [low, high])
            .unwrap_or(Self::Unknown([low, high]))
    }

    pub(super) fn bytes(self) -> [u8; 2] {
        if let Self::Unknown(bytes) = self {
            return bytes;
        }
        let number = Self::ALL.into_iter().zip(0_u8..).find(|(alarm, _)| *alarm == self);
        let number = number.map_or(0, |(_, number)| number);
        // The number has five bits. Split in two, it gives two printable characters.
        [BASE | number & 0x0f, BASE | number >> 4]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn alarms_are_numbered_as_documented() {
        assert_eq!(Alarm::from_bytes(0x20, 0x20), Alarm::None);
        assert_eq!(Alarm::from_bytes(0x22, 0x20), Alarm::Azimuth);
        assert_eq!(Alarm::from_bytes(0x20, 0x21), Alarm::TimeOrDate);
        assert_eq!(Alarm::from_bytes(0x24, 0x21), Alarm::AxisOptions);
        for odd in [[0x25, 0x21], [0x20, 0x40], [0x32, 0x20]] {
            assert_eq!(Alarm::from_bytes(odd[0], odd[1]), Alarm::Unknown(odd));
            assert_eq!(Alarm::Unknown(odd).bytes(), odd);
        }
    }
}
