//! Entries that the station hands to its record.

use serde::Serialize;
use serde_json::Value;

use crate::{clock::Moment, station::AntennaId};

/// An entry of the record, other than measured positions and lines on a link.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    pub moment: Moment,
    /// `None` where it concerns the whole station.
    pub antenna: Option<AntennaId>,
    pub kind: Kind,
    pub data: Value,
}

impl Entry {
    /// An entry with `data` as JSON. Secrets have no JSON of their own, so none gets in.
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
    /// The program has started or ended.
    Run,
    /// The station file, or a part of it, has changed.
    Station,
    /// The clock of this computer was set, or is kept by another service, or by none.
    Clock,
    /// A command to the station or an antenna, and who gave it.
    Command,
    /// STOP, and who gave it.
    Stop,
    /// A request that the gate or the unit has refused, or the unit has not answered.
    Refusal,
    /// The link of an antenna came or went.
    Link,
    /// The intent of an antenna, its track, its checks, its automatic operation.
    State,
    /// A change of the settings of a unit, and its outcome.
    Setting,
    /// Another event of an antenna.
    Event,
    /// An alarm has come, was seen, or is over.
    Alarm,
    /// The schedule has changed.
    Schedule,
    /// The outcome of a pass of the schedule, or an event of automatic operation.
    Day,
    /// The operator has entered a peak of the noise of the Sun or the Moon, or removed one.
    Peak,
    /// Something could not be recorded.
    Gap,
}

impl Kind {
    pub const ALL: [Self; 15] = [
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
        Self::Gap,
    ];

    /// Its word in the record.
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
            Self::Gap => "gap",
        }
    }
}
