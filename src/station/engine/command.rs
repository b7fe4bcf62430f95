//! Commands of clients to a station.

use std::path::PathBuf;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{
    alarms::ShelveTime,
    closing::CloseHow,
    older_sets::SetChoice,
    passes::{ListChoice, PassKey, Scope},
    recorded::RecordLook,
    source_tests::TestAsk,
    sources::Copied,
    uploads, written,
};
use crate::{
    astro::{Term, TrackOffsets},
    driver,
    orbit::{RefreshHours, Source},
    record::PeakChange,
    station::{
        Antenna, AntennaId, Frequency, OffsetsOf, PassLimits, Priority, Scheduling, Station, Take,
    },
};

/// A command of a client to a station. STOP is not one: it bypasses the queue of commands.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Command {
    /// A command for an antenna.
    Antenna(AntennaId, driver::Command),
    /// Track a pass: on board where the unit can, else by program track.
    Track {
        antenna: AntennaId,
        pass: PassKey,
        /// The operator knows that the unit would miss the satellite.
        is_agreed: bool,
    },
    /// Track a pass by program track, even where the unit could track on board.
    ProgramTrackPass {
        antenna: AntennaId,
        pass: PassKey,
    },
    /// Switch automatic operation of an antenna on or off.
    SetAutomatic {
        antenna: AntennaId,
        is_on: bool,
    },
    /// Let automatic operation of an antenna go on that was suspended.
    GoOn(AntennaId),
    /// Choose a pass for the schedule or against it; `None` leaves it to the schedule.
    ChoosePass {
        /// Catalog number.
        satellite: u32,
        tca: Timestamp,
        take: Option<Take>,
    },
    /// Work out what it costs to take a pass that the schedule leaves out.
    PriceSwap(PassKey),
    /// Give favourites these limits; other satellites become favourites.
    SetPassLimits {
        /// Catalog numbers.
        numbers: Vec<u32>,
        limits: PassLimits,
    },
    /// Plan passes like this.
    SetScheduling(Scheduling),
    /// List passes with at least this maximum elevation, degrees.
    SetElevationFloor(f64),
    /// End the search for the passes of this list; listed passes stay.
    CancelSearch(Scope),
    /// Restart the cancelled search.
    ResumeSearch(Scope),
    /// Mark or unmark satellites as favourites.
    SetFavourites {
        /// Catalog numbers.
        numbers: Vec<u32>,
        is_favourite: bool,
    },
    /// Give favourites this priority; other satellites become favourites.
    SetPriority {
        /// Catalog numbers.
        numbers: Vec<u32>,
        priority: Priority,
    },
    /// Give a satellite these frequencies in place of its own.
    SetFrequencies {
        /// Catalog number.
        satellite: u32,
        frequencies: Vec<Frequency>,
    },
    /// Remember these offsets: tracks begin with them.
    KeepOffsets {
        of: OffsetsOf,
        offsets: TrackOffsets,
    },
    /// Add a source of elements.
    AddSource(Source),
    /// Remove the source of elements with this name.
    RemoveSource(String),
    /// Ask the server of the source with this name so often without a client; `None` for never.
    SetRefresh {
        name: String,
        hours: Option<RefreshHours>,
    },
    /// Copy elements into the library, as a source with this name.
    CopyElements {
        name: String,
        from: Copied,
    },
    /// Publish the older sets of the object with this catalog number.
    ListOlderSets(u32),
    /// Publish what the record holds of this; `None` ends it.
    LookAtRecord(Option<RecordLook>),
    /// Publish the pointing model that fits the record of this antenna, without these terms.
    FitPointing(AntennaId, Vec<Term>),
    /// Enter a peak of the noise of the Sun or the Moon that an antenna was pointed to, or remove one.
    ChangePeaks(AntennaId, PeakChange),
    /// Use this set of elements of an object.
    UseSet(SetChoice),
    /// Read all sources anew, and ask the servers of some.
    RefreshSources {
        /// Names of the sources whose servers are asked, where they may be.
        names: Vec<String>,
        /// Ask even if they were asked lately.
        forced: bool,
    },
    /// The operator has opened the alarm list.
    OpenedAlarms,
    /// The operator has seen this alarm.
    AcknowledgeAlarm(u64),
    /// The operator has seen all alarms up to the one with this id.
    AcknowledgeAlarms {
        newest: u64,
    },
    /// Keep this alarm quiet for a time; refused for a top-priority alarm.
    ShelveAlarm {
        id: u64,
        time: ShelveTime,
    },
    /// Take this alarm back from the shelf.
    UnshelveAlarm(u64),
    /// Save the settings that were read from this antenna's unit.
    SaveSettings(AntennaId),
    /// Compare the settings of this antenna's unit with a file.
    CompareSettings(AntennaId),
    /// Read this copy of settings for the comparison.
    ReadCopy {
        antenna: AntennaId,
        path: PathBuf,
    },
    CloseCopy,
    /// Save this station and use it.
    SaveStation(#[serde(with = "written::station")] Box<Station>),
    /// About an upload of elements to a unit.
    Upload(uploads::Ask),
    /// About a test of an element source that a unit shall use.
    TestSource(TestAsk),
    /// Ask the unit of this antenna, which the station need not have, and hang up.
    TestLink(#[serde(with = "written::antenna")] Box<Antenna>),
    /// End once the moving antennas are treated like this.
    CloseAfter(CloseHow),
    /// Cancel the closing.
    StayOpen,
    /// The list and pass that the client shows.
    Look(Attention),
}

/// The list and pass that a client shows; they decide what is computed.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Attention {
    pub list: ListChoice,
    pub selected: Option<PassKey>,
}

impl Command {
    /// The antenna of the command, for commands to one antenna.
    pub fn antenna(&self) -> Option<AntennaId> {
        match self {
            Self::Antenna(antenna, _)
            | Self::Track { antenna, .. }
            | Self::ProgramTrackPass { antenna, .. }
            | Self::SetAutomatic { antenna, .. }
            | Self::GoOn(antenna) => Some(*antenna),
            _ => None,
        }
    }

    /// Returns `true` if the command changes the station file at once, beside its preferences.
    pub fn changes_station(&self) -> bool {
        matches!(
            self,
            Self::ChoosePass { .. }
                | Self::SetPassLimits { .. }
                | Self::SetScheduling(_)
                | Self::SetFavourites { .. }
                | Self::SetPriority { .. }
                | Self::SetFrequencies { .. }
                | Self::KeepOffsets { .. }
        )
    }

    /// Returns `true` if a view may give the command by itself, without a wish of the operator.
    pub fn is_unasked(&self) -> bool {
        use driver::Command::{EndJog, ReadGroup};
        let is_read = matches!(self, Self::ListOlderSets(_) | Self::PriceSwap(_));
        is_read || self.only_looks() || matches!(self, Self::Antenna(_, EndJog | ReadGroup(_)))
    }

    /// Returns `true` if the command asks to be shown something, and changes nothing.
    pub fn only_looks(&self) -> bool {
        use driver::Command::Preview;
        matches!(
            self,
            Self::Look(_)
                | Self::LookAtRecord(_)
                | Self::FitPointing(..)
                | Self::OpenedAlarms
                | Self::Antenna(_, Preview(_))
        )
    }

    /// Returns `true` if the command may move an antenna. A later STOP voids it.
    pub fn may_move(&self) -> bool {
        match self {
            Self::Antenna(_, command) => !matches!(
                command,
                driver::Command::ReadGroup(_)
                    | driver::Command::LockOut(_)
                    | driver::Command::Preview(_)
            ),
            Self::Track { .. }
            | Self::ProgramTrackPass { .. }
            | Self::SetAutomatic { is_on: true, .. }
            | Self::GoOn(_)
            | Self::CloseAfter(CloseHow::Park)
            | Self::Upload(uploads::Ask::AgreeToTracking) => true,
            _ => false,
        }
    }
}
