//! Requests of a client.

use super::frame::encode;
use super::{
    AngleChange, ClockTime, FtpTle, GpsSettingsChange, HttpTle, Motion, Reduction, SatelliteChoice,
    SettingsRequest, TextValue, TrackWindow, Verb, Word,
};

/// Any request of a client. Its values were checked at construction, so encoding cannot fail.
#[derive(Debug, Clone, PartialEq)]
pub enum Request {
    /// A read, which changes nothing.
    Query(Query),
    /// An end of motion; always allowed.
    Halt(Halt),
    /// A request that can move the antenna.
    Motion(Motion),
    /// A change of a value that the unit stores.
    Setting(Setting),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Query {
    Version,
    Status,
    Faults,
    Clock,
    StartStopTime,
    Settings,
    AngleSettings,
    GpsData,
    TimedPosition,
    GpsSettings,
    Satellite,
    SatelliteHttp,
    SatelliteFtp,
    ImageStatus,
    Reduction,
}

impl Query {
    /// All queries with their words, in the order of the document.
    pub const ALL: [(Self, Word); 15] = [
        (Self::Version, Word::Version),
        (Self::Status, Word::Status),
        (Self::Faults, Word::ErrStatus),
        (Self::Clock, Word::Time),
        (Self::StartStopTime, Word::StartStopTime),
        (Self::Settings, Word::Settings),
        (Self::AngleSettings, Word::AngleSettings),
        (Self::GpsData, Word::GpsData),
        (Self::TimedPosition, Word::Tpos),
        (Self::GpsSettings, Word::GpsSettings),
        (Self::Satellite, Word::Satellite),
        (Self::SatelliteHttp, Word::SatelliteHttp),
        (Self::SatelliteFtp, Word::SatelliteFtp),
        (Self::ImageStatus, Word::LoadImage),
        (Self::Reduction, Word::Reduction),
    ];

    pub fn word(self) -> Word {
        let entry = Self::ALL.into_iter().find(|(query, _)| *query == self);
        entry.map_or(Word::Version, |(_, word)| word)
    }
}

/// Requests that end motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Halt {
    /// Standstill. The document does not say whether tracking continues afterwards.
    Stop,
    /// Tracking off.
    TrackOff,
    /// Auto-track off: the unit does not start to track unattended.
    AutoTrackOff,
}

impl Halt {
    pub const fn word(self) -> Word {
        match self {
            Self::Stop => Word::Stop,
            Self::TrackOff => Word::Track,
            Self::AutoTrackOff => Word::TrackAutoEnable,
        }
    }
}

/// Changes of values that the unit stores.
#[derive(Debug, Clone, PartialEq)]
pub enum Setting {
    Time(ClockTime),
    StartStopTime(TrackWindow),
    Settings(SettingsRequest),
    AngleSettings(AngleChange),
    /// Update of the clock from GPS, now.
    RtcReupdate,
    /// Place of the unit.
    GpsSettings(GpsSettingsChange),
    /// Satellite from a file.
    Satellite(SatelliteChoice),
    /// Elements from the web.
    SatelliteHttp(HttpTle),
    /// Elements from an FTP server.
    SatelliteFtp(FtpTle),
    /// Load of an image file, presumably of the firmware.
    LoadImage(TextValue),
    /// Scales of the drives.
    Reduction(Reduction),
}

impl Setting {
    pub const fn word(&self) -> Word {
        match self {
            Self::Time(_) => Word::Time,
            Self::StartStopTime(_) => Word::StartStopTime,
            Self::Settings(_) => Word::Settings,
            Self::AngleSettings(_) => Word::AngleSettings,
            Self::RtcReupdate => Word::RtcReupdate,
            Self::GpsSettings(_) => Word::GpsSettings,
            Self::Satellite(_) => Word::Satellite,
            Self::SatelliteHttp(_) => Word::SatelliteHttp,
            Self::SatelliteFtp(_) => Word::SatelliteFtp,
            Self::LoadImage(_) => Word::LoadImage,
            Self::Reduction(_) => Word::Reduction,
        }
    }

    fn values(&self) -> Vec<String> {
        match self {
            Self::Time(time) => time.values(),
            Self::StartStopTime(window) => window.values(),
            Self::Settings(request) => request.values(),
            Self::AngleSettings(change) => change.values(),
            Self::RtcReupdate => Vec::new(),
            Self::GpsSettings(change) => change.values(),
            Self::Satellite(choice) => choice.values(),
            Self::SatelliteHttp(source) => source.values(),
            Self::SatelliteFtp(source) => source.values(),
            Self::LoadImage(file) => vec![file.as_str().to_owned()],
            Self::Reduction(reduction) => reduction.values(),
        }
    }
}

impl Request {
    /// Returns the word, which the reply repeats.
    pub fn word(&self) -> Word {
        match self {
            Self::Query(query) => query.word(),
            Self::Halt(halt) => halt.word(),
            Self::Motion(motion) => motion.word(),
            Self::Setting(setting) => setting.word(),
        }
    }

    /// Returns the verb, which the reply repeats.
    pub const fn verb(&self) -> Verb {
        match self {
            Self::Query(_) => Verb::Query,
            Self::Halt(_) | Self::Motion(_) | Self::Setting(_) => Verb::Set,
        }
    }

    /// Returns the frame to send.
    pub fn to_bytes(&self) -> Vec<u8> {
        encode(&self.payload())
    }

    /// Returns the payload. It may contain the FTP password: log it through [`super::redact`].
    pub fn payload(&self) -> String {
        let values = match self {
            // `STOP=` ends with its sign, without a comma (section 5).
            Self::Query(_) | Self::Halt(Halt::Stop) => Vec::new(),
            Self::Halt(Halt::TrackOff | Halt::AutoTrackOff) => vec!["0".to_owned()],
            Self::Motion(motion) => motion.values(),
            Self::Setting(setting) => setting.values(),
        };
        let mut payload = format!("{}{}", self.word(), self.verb().sign());
        for value in values {
            // The first value also has a comma before it: only the examples of section 15 omit that
            // comma.
            payload.push(',');
            payload.push_str(&value);
        }
        payload
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_query_has_its_own_word() {
        for (query, word) in Query::ALL {
            assert_eq!(query.word(), word);
            assert_eq!(Request::Query(query).payload(), format!("{word}?"));
        }
    }
}
