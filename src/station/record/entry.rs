//! Entries that the station writes to its record.

use serde::Serialize;
use serde_json::Value;

use crate::{clock::Moment, station::AntennaId};

/// Entry of the record, other than measured positions and lines on a link.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    pub moment: Moment,
    /// Antenna of the entry; `None` for the whole station.
    pub antenna: Option<AntennaId>,
    pub kind: Kind,
    pub data: Value,
}

impl Entry {
    /// Creates an entry with `data` as JSON. A secret serialises to `null`, so none gets into the
    /// record.
    pub fn new(
        moment: Moment,
        antenna: Option<AntennaId>,
        kind: Kind,
        data: &impl Serialize,
    ) -> Self {
        let data = serde_json::to_value(data).unwrap_or_else(|error| {
            tracing::error!(%error, ?kind, "an entry of the record without its content");
            Value::Null
        });
        Self { moment, antenna, kind, data }
    }
}

/// Subject of an entry.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// Start or end of the program.
    Run,
    /// Change of the station file.
    Station,
    /// Step or other synchronisation of this computer's clock.
    Clock,
    /// Command to the station or an antenna, with its origin.
    Command,
    /// STOP, with its origin.
    Stop,
    /// Request that the gate or the unit refused, or that the unit did not answer.
    Refusal,
    /// Start or loss of an antenna's link.
    Link,
    /// Change of an antenna's intent, track, checks or automatic operation.
    State,
    /// Change of a unit's settings, with its outcome.
    Setting,
    /// Other event of an antenna.
    Event,
    /// Start, acknowledgement or end of an alarm.
    Alarm,
    /// Change of the schedule.
    Schedule,
    /// Outcome of a scheduled pass, or event of automatic operation.
    Day,
    /// Peak of the noise of the Sun or the Moon that the operator entered or removed.
    Peak,
    /// Call of a hook, with its result.
    Hook,
    /// Gap in which something could not be recorded.
    Gap,
}

impl Kind {
    pub const ALL: [Self; 16] = [
        Self::Run,
        Self::Station,
        Self::Clock,
        Self::Command,
        Self::Stop,
        Self::Refusal,
        Self::Link,
        Self::State,
        Self::Setting,
        Self::Event,
        Self::Alarm,
        Self::Schedule,
        Self::Day,
        Self::Peak,
        Self::Hook,
        Self::Gap,
    ];

    /// Returns the name of the kind in the record.
    pub fn word(self) -> &'static str {
        match self {
            Self::Run => "run",
            Self::Station => "station",
            Self::Clock => "clock",
            Self::Command => "command",
            Self::Stop => "stop",
            Self::Refusal => "refusal",
            Self::Link => "link",
            Self::State => "state",
            Self::Setting => "setting",
            Self::Event => "event",
            Self::Alarm => "alarm",
            Self::Schedule => "schedule",
            Self::Day => "day",
            Self::Peak => "peak",
            Self::Hook => "hook",
            Self::Gap => "gap",
        }
    }
}
