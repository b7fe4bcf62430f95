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
        Antenna, AntennaId, Frequency, Hook, OffsetsSubject, PassLimits, Priority, Scheduling,
        Station, Take,
    },
    uploads,
};

/// Command of a client to a station. STOP is no such command, because it bypasses the queue of
/// commands.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Command {
    Antenna(AntennaId, driver::Command),
    /// Track of a pass: on board if the unit can, otherwise program track.
    Track {
        antenna: AntennaId,
        pass: PassListKey,
        /// The operator accepts that the unit would miss the satellite.
        is_agreed: bool,
    },
    /// Program track of a pass, even if the unit could track on board.
    ProgramTrackPass {
        antenna: AntennaId,
        pass: PassListKey,
    },
    /// Switch of an antenna's automatic operation.
    SetAutomatic {
        antenna: AntennaId,
        is_on: bool,
    },
    /// Resumption of an antenna's suspended automatic operation.
    GoOn(AntennaId),
    /// Choice for or against a pass; `None` leaves the choice to the schedule.
    ChoosePass {
        /// Catalog number.
        satellite: u32,
        tca: Timestamp,
        take: Option<Take>,
    },
    /// Computation of the cost of taking a pass that the schedule leaves out.
    PriceSwap(PassListKey),
    /// New limits for favourites; other satellites in the list become favourites.
    SetPassLimits {
        /// Catalog numbers.
        numbers: Vec<u32>,
        limits: PassLimits,
    },
    /// New scheduling preferences.
    SetScheduling(Scheduling),
    /// New min of the maximum elevation of listed passes, degrees.
    SetElevationFloor(f64),
    /// Cancellation of the search for this list; listed passes stay.
    CancelSearch(Scope),
    /// Restart of the cancelled search.
    ResumeSearch(Scope),
    /// Addition of satellites to the favourites, or their removal.
    SetFavourites {
        /// Catalog numbers.
        numbers: Vec<u32>,
        is_favourite: bool,
    },
    /// New priority for favourites; other satellites in the list become favourites.
    SetPriority {
        /// Catalog numbers.
        numbers: Vec<u32>,
        priority: Priority,
    },
    /// Preferred sources of a satellite's elements, best first; an empty list selects the newest
    /// elements. With an order, the satellite becomes a favourite.
    SetSourceOrder {
        /// Catalog number.
        satellite: u32,
        /// Names of the sources.
        sources: Vec<String>,
    },
    /// Frequencies of a satellite that replace its own.
    SetFrequencies {
        /// Catalog number.
        satellite: u32,
        frequencies: Vec<Frequency>,
    },
    /// Offsets to keep: later tracks begin with them.
    KeepOffsets {
        #[serde(rename = "of")]
        subject: OffsetsSubject,
        offsets: TrackOffsets,
    },
    /// Addition of a source of elements.
    AddSource(Source),
    /// Removal of the source of elements with this name.
    RemoveSource(String),
    /// Interval between automatic requests to the server of the source with this name; `None` for
    /// no automatic requests.
    SetRefresh {
        name: String,
        hours: Option<RefreshHours>,
    },
    /// Copy of elements into the library, as a source with this name.
    CopyElements {
        name: String,
        #[serde(rename = "from")]
        origin: Copied,
    },
    /// Request to publish the older sets of the object with this catalog number.
    ListOlderSets(u32),
    /// Request to publish this part of the record; `None` ends the publication.
    LookAtRecord(Option<RecordLook>),
    /// Request to publish the pointing model that fits the record of this antenna, without these
    /// terms.
    FitPointing(AntennaId, Vec<Term>),
    /// Addition or removal of a peak of the noise of the Sun or the Moon, measured with this
    /// antenna.
    ChangePeaks(AntennaId, PeakChange),
    /// Choice of the set of elements of an object.
    UseSet(SetChoice),
    /// Request to reread all sources, and to ask the servers of some sources.
    RefreshSources {
        /// Names of the sources whose servers Azel asks, if their limits allow it.
        names: Vec<String>,
        /// Azel asks even if the last request was recent.
        forced: bool,
    },
    /// Log-in at the server of this source with this password, followed by a request.
    SetSourcePassword {
        /// Name of the source.
        name: String,
        secret: Secret,
        /// Azel stores the password in the keyring of the operating system.
        keep: bool,
    },
    /// Notice that the operator has opened the alarm list.
    OpenedAlarms,
    /// Acknowledgement of this alarm.
    AcknowledgeAlarm(u64),
    /// Acknowledgement of all alarms up to the alarm with this id.
    AcknowledgeAlarms {
        newest: u64,
    },
    /// Shelving of this alarm for a time; refused for a top-priority alarm.
    ShelveAlarm {
        id: u64,
        time: ShelveTime,
    },
    /// End of the shelving of this alarm.
    UnshelveAlarm(u64),
    /// Request to save the settings that Azel read from this antenna's unit.
    SaveSettings(AntennaId),
    /// Comparison of the settings of this antenna's unit with a file.
    CompareSettings(AntennaId),
    /// Request to read this copy of settings for the comparison.
    ReadCopy {
        antenna: AntennaId,
        path: PathBuf,
    },
    CloseCopy,
    /// Request to save this station and use it.
    SaveStation(#[serde(with = "written::station")] Box<Station>),
    /// Request about an upload of elements to a unit.
    Upload(uploads::Ask),
    /// Command of a program that is connected to the port of this antenna.
    Client(AntennaId, ClientCommand),
    /// Request of the operator to take control of this antenna from any other party. A motion to a
    /// fixed direction goes on.
    TakeControl(AntennaId),
    /// Release of the control of this antenna to the next party that asks.
    ReleaseControl(AntennaId),
    /// Permission for this program to point the antenna, and transfer of control to it.
    HandOver {
        antenna: AntennaId,
        client: SocketAddr,
        /// The permission includes all later programs from the same IP address.
        always: bool,
    },
    /// Request about a test of an element source that a unit is to use.
    TestSource(TestAsk),
    /// Test of the link to the unit of this antenna, which may be outside the station. Azel hangs
    /// up afterwards.
    TestLink(#[serde(with = "written::antenna")] Box<Antenna>),
    /// Trial call of a hook that may not be saved yet, with values of a sample pass.
    TryHook(Box<Hook>),
    /// Request to close the station after this treatment of moving antennas.
    CloseAfter(CloseHow),
    /// Cancellation of the closing.
    StayOpen,
    /// List and pass that the client shows.
    Look(Attention),
}

/// List and pass that a client shows. The station computes only the data for them.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Attention {
    pub list: ListChoice,
    pub selected: Option<PassListKey>,
}

impl Command {
    /// Returns the antenna to whose session the command goes; `None` for other commands.
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
            // Settings, fits and peaks of an antenna concern data of the station, not the session.
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
            | Self::TryHook(_)
            | Self::CloseAfter(_)
            | Self::StayOpen
            | Self::Look(_) => None,
        }
    }

    /// Returns the row of the command in the table of commands.
    pub fn row(&self) -> Row {
        match self {
            Self::Antenna(_, command) => command.row(),
            Self::Track { .. } | Self::ProgramTrackPass { .. } => Row::STATION_MOVES,
            // After an upload, the unit tracks again once the file is in place.
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
            // The operator may choose again while the station closes.
            Self::CloseAfter(CloseHow::Park) => {
                let takes_control = TakesControl::FromClients;
                Row { takes_control, while_closing: true, ..Row::STATION_MOVES }
            }
            Self::SaveStation(_) | Self::ReleaseControl(_) => {
                Row { effect: Effect::ChangesSafety, ..Row::OF_STATION }
            }
            // The rules of control decide about these commands, not the table.
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
            // The call runs a program of this machine.
            Self::TryHook(_) => Row { only_here: true, ..Row::OF_STATION },
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

    /// Returns `true` if the command changes the station file immediately, outside Preferences.
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

    /// Returns `true` if the command only requests information and changes nothing.
    pub fn only_looks(&self) -> bool {
        let Row { effect, in_replay, .. } = self.row();
        effect == Effect::Looks && in_replay
    }
}
