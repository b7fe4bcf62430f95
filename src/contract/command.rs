//! Commands of clients to a station.

use std::{net::SocketAddr, path::PathBuf};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::written;
use crate::{
    alarms::ShelveTime,
    astro::{Term, TrackOffsets},
    closing::CloseHow,
    control::ClientCommand,
    driver::{self, Effect, Row, TakesControl},
    older_sets::SetChoice,
    orbit::{RefreshHours, Source},
    passes::{ListChoice, PassListKey, Scope},
    record::PeakChange,
    recorded::RecordLook,
    secret::Secret,
    source_tests::TestAsk,
    sources::Copied,
    station::{
        Antenna, AntennaId, Frequency, OffsetsSubject, PassLimits, Priority, Scheduling, Station,
        Take,
    },
    uploads,
};

/// A command of a client to a station. STOP is not one: it bypasses the queue of commands.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Command {
    /// A command for an antenna.
    Antenna(AntennaId, driver::Command),
    /// Track a pass: on board where the unit can, else by program track.
    Track {
        antenna: AntennaId,
        pass: PassListKey,
        /// The operator knows that the unit would miss the satellite.
        is_agreed: bool,
    },
    /// Track a pass by program track, even where the unit could track on board.
    ProgramTrackPass {
        antenna: AntennaId,
        pass: PassListKey,
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
    PriceSwap(PassListKey),
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
    /// Let a satellite prefer the elements of these sources, the first one first; none for the
    /// newest of all. With an order, the satellite becomes a favourite.
    SetSourceOrder {
        /// Catalog number.
        satellite: u32,
        /// Names of the sources.
        sources: Vec<String>,
    },
    /// Give a satellite these frequencies in place of its own.
    SetFrequencies {
        /// Catalog number.
        satellite: u32,
        frequencies: Vec<Frequency>,
    },
    /// Remember these offsets: tracks begin with them.
    KeepOffsets {
        #[serde(rename = "of")]
        subject: OffsetsSubject,
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
        #[serde(rename = "from")]
        origin: Copied,
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
    /// Log in at the server of this source with this password, and ask it.
    SetSourcePassword {
        /// Name of the source.
        name: String,
        secret: Secret,
        /// Keep it in the keyring of the operating system.
        keep: bool,
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
    /// From a program that is connected to the port of this antenna.
    Client(AntennaId, ClientCommand),
    /// Take control of this antenna from whoever has it. Its way to a fixed direction goes on.
    TakeControl(AntennaId),
    /// Leave the control of this antenna to whoever asks first.
    ReleaseControl(AntennaId),
    /// Let this program point the antenna, and hand control to it.
    HandOver {
        antenna: AntennaId,
        client: SocketAddr,
        /// Let all programs at its address point the antenna from now on.
        always: bool,
    },
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
    pub selected: Option<PassListKey>,
}

impl Command {
    /// The antenna of a command that goes to the session of one.
    pub fn antenna(&self) -> Option<AntennaId> {
        match self {
            Self::Antenna(antenna, _)
            | Self::Track { antenna, .. }
            | Self::ProgramTrackPass { antenna, .. }
            | Self::SetAutomatic { antenna, .. }
            | Self::GoOn(antenna)
            | Self::Client(antenna, _)
            | Self::TakeControl(antenna)
            | Self::ReleaseControl(antenna)
            | Self::HandOver { antenna, .. } => Some(*antenna),
            // Those of an antenna among these read, save and compare what is known here.
            Self::SaveSettings(_)
            | Self::CompareSettings(_)
            | Self::ReadCopy { .. }
            | Self::FitPointing(..)
            | Self::ChangePeaks(..)
            | Self::ChoosePass { .. }
            | Self::PriceSwap(_)
            | Self::SetPassLimits { .. }
            | Self::SetScheduling(_)
            | Self::SetElevationFloor(_)
            | Self::CancelSearch(_)
            | Self::ResumeSearch(_)
            | Self::SetFavourites { .. }
            | Self::SetPriority { .. }
            | Self::SetSourceOrder { .. }
            | Self::SetFrequencies { .. }
            | Self::KeepOffsets { .. }
            | Self::AddSource(_)
            | Self::RemoveSource(_)
            | Self::SetRefresh { .. }
            | Self::CopyElements { .. }
            | Self::ListOlderSets(_)
            | Self::LookAtRecord(_)
            | Self::UseSet(_)
            | Self::RefreshSources { .. }
            | Self::SetSourcePassword { .. }
            | Self::OpenedAlarms
            | Self::AcknowledgeAlarm(_)
            | Self::AcknowledgeAlarms { .. }
            | Self::ShelveAlarm { .. }
            | Self::UnshelveAlarm(_)
            | Self::CloseCopy
            | Self::SaveStation(_)
            | Self::Upload(_)
            | Self::TestSource(_)
            | Self::TestLink(_)
            | Self::CloseAfter(_)
            | Self::StayOpen
            | Self::Look(_) => None,
        }
    }

    /// The row of the command in the table of commands.
    pub fn row(&self) -> Row {
        match self {
            Self::Antenna(_, command) => command.row(),
            Self::Track { .. } | Self::ProgramTrackPass { .. } => Row::STATION_MOVES,
            // After an upload the unit tracks again, once the file is in place.
            Self::SetAutomatic { is_on: true, .. }
            | Self::GoOn(_)
            | Self::Upload(uploads::Ask::AgreeToTracking) => {
                Row { takes_control: TakesControl::FromClients, ..Row::STATION_MOVES }
            }
            Self::SetAutomatic { is_on: false, .. }
            | Self::Client(_, ClientCommand::Stop)
            | Self::CloseAfter(CloseHow::Hold | CloseHow::Leave) => {
                Row { effect: Effect::Stops, ..Row::OF_STATION }
            }
            // The operator may choose again while it closes.
            Self::CloseAfter(CloseHow::Park) => {
                let takes_control = TakesControl::FromClients;
                Row { takes_control, while_closing: true, ..Row::STATION_MOVES }
            }
            Self::SaveStation(_) | Self::ReleaseControl(_) => {
                Row { effect: Effect::ChangesSafety, ..Row::OF_STATION }
            }
            // The rules of control decide about these, not the table.
            Self::Client(
                _,
                ClientCommand::Point(_) | ClientCommand::Park | ClientCommand::Turn { .. },
            ) => Row { takes_control: TakesControl::Never, ..Row::STATION_MOVES },
            Self::TakeControl(_) => Row {
                effect: Effect::Stops,
                takes_control: TakesControl::FromAll,
                ..Row::OF_STATION
            },
            Self::HandOver { .. } => Row {
                effect: Effect::ChangesSafety,
                while_closing: false,
                void_after_stop: true,
                ..Row::OF_STATION
            },
            Self::Look(_)
            | Self::LookAtRecord(_)
            | Self::FitPointing(..)
            | Self::OpenedAlarms
            | Self::ListOlderSets(_)
            | Self::PriceSwap(_) => Row::STATION_LOOKS,
            Self::ChoosePass { .. }
            | Self::SetPassLimits { .. }
            | Self::SetScheduling(_)
            | Self::SetElevationFloor(_)
            | Self::CancelSearch(_)
            | Self::ResumeSearch(_)
            | Self::SetFavourites { .. }
            | Self::SetPriority { .. }
            | Self::SetSourceOrder { .. }
            | Self::SetFrequencies { .. }
            | Self::KeepOffsets { .. }
            | Self::AddSource(_)
            | Self::RemoveSource(_)
            | Self::SetRefresh { .. }
            | Self::CopyElements { .. }
            | Self::ChangePeaks(..)
            | Self::UseSet(_)
            | Self::RefreshSources { .. }
            | Self::SetSourcePassword { .. }
            | Self::AcknowledgeAlarm(_)
            | Self::AcknowledgeAlarms { .. }
            | Self::ShelveAlarm { .. }
            | Self::UnshelveAlarm(_)
            | Self::SaveSettings(_)
            | Self::CompareSettings(_)
            | Self::ReadCopy { .. }
            | Self::CloseCopy
            | Self::Upload(_)
            | Self::TestSource(_)
            | Self::TestLink(_)
            | Self::StayOpen => Row::OF_STATION,
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
                | Self::SetSourceOrder { .. }
                | Self::SetFrequencies { .. }
                | Self::KeepOffsets { .. }
        )
    }

    /// Returns `true` if the command asks to be shown something, and changes nothing.
    pub fn only_looks(&self) -> bool {
        let Row { effect, in_replay, .. } = self.row();
        effect == Effect::Looks && in_replay
    }
}
