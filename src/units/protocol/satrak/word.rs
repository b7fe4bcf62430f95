//! Words of the protocol.

use std::fmt;

/// One of the 22 command names of the document.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Word {
    Version,
    Move,
    Step,
    Goto,
    Stop,
    Status,
    ErrStatus,
    Time,
    StartStopTime,
    Settings,
    AngleSettings,
    GpsData,
    Tpos,
    Track,
    TrackAutoEnable,
    RtcReupdate,
    GpsSettings,
    Satellite,
    SatelliteHttp,
    SatelliteFtp,
    LoadImage,
    Reduction,
}

impl Word {
    pub const ALL: [Self; 22] = [
        Self::Version,
        Self::Move,
        Self::Step,
        Self::Goto,
        Self::Stop,
        Self::Status,
        Self::ErrStatus,
        Self::Time,
        Self::StartStopTime,
        Self::Settings,
        Self::AngleSettings,
        Self::GpsData,
        Self::Tpos,
        Self::Track,
        Self::TrackAutoEnable,
        Self::RtcReupdate,
        Self::GpsSettings,
        Self::Satellite,
        Self::SatelliteHttp,
        Self::SatelliteFtp,
        Self::LoadImage,
        Self::Reduction,
    ];

    /// Returns the word on the wire, without `?` or `=`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Version => "VERSION",
            Self::Move => "MOVE",
            Self::Step => "STEP",
            Self::Goto => "GOTO",
            Self::Stop => "STOP",
            Self::Status => "STATUS",
            Self::ErrStatus => "ERRSTATUS",
            Self::Time => "TIME",
            Self::StartStopTime => "START_STOP_TIME",
            Self::Settings => "SETTINGS",
            Self::AngleSettings => "ANGLE_SETTINGS",
            Self::GpsData => "GPS_DATA",
            Self::Tpos => "TPOS",
            Self::Track => "TRACK",
            Self::TrackAutoEnable => "TRACK_AUTO_ENABLE",
            Self::RtcReupdate => "RTC_REUPDATE",
            Self::GpsSettings => "GPS_SETTINGS",
            Self::Satellite => "SATELLITE",
            Self::SatelliteHttp => "SATELLITE_HTTP",
            Self::SatelliteFtp => "SATELLITE_FTP",
            Self::LoadImage => "LOAD_IMAGE",
            Self::Reduction => "REDUCTION",
        }
    }

    /// Returns the word with this exact name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|word| word.name() == name)
    }
}

impl fmt::Display for Word {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Verb of a word: the sign that ends it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Verb {
    /// `?`: a question for values.
    Query,
    /// `=`: a setting or an action.
    Set,
}

impl Verb {
    /// Returns the sign on the wire.
    pub const fn sign(self) -> char {
        match self {
            Self::Query => '?',
            Self::Set => '=',
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_found_again() {
        for word in Word::ALL {
            assert_eq!(Word::from_name(word.name()), Some(word));
        }
        assert_eq!(Word::from_name("DATETIMEG"), None);
        assert_eq!(Word::from_name("stop"), None);
    }
}
