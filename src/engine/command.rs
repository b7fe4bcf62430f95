//! What a client of a station asks for.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::{
    closing::CloseHow,
    passes::{ListChoice, PassKey, Scope},
    source_tests::TestAsk,
    uploads, written,
};
use crate::{
    driver,
    orbit::Source,
    station::{AntennaId, Station},
};

/// What a client of a station asks for. A STOP is none of these: it goes past them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Command {
    /// Something for an antenna.
    Antenna(AntennaId, driver::Command),
    /// Track a pass.
    Track {
        /// With which antenna.
        antenna: AntennaId,
        /// Which pass.
        pass: PassKey,
        /// The operator knows that the unit would miss.
        is_agreed: bool,
    },
    /// Follow a pass from here, position by position, also where the unit could track it
    /// by itself.
    ProgramTrackPass {
        /// With which antenna.
        antenna: AntennaId,
        /// Which pass.
        pass: PassKey,
    },
    /// List passes from this maximum elevation on, degrees.
    SetElevationFloor(f64),
    /// End the search for the passes of this list; what is listed stays.
    CancelSearch(Scope),
    /// Begin the cancelled search again.
    ResumeSearch(Scope),
    /// Mark this satellite as a favourite, or no longer.
    SetFavourite {
        /// Catalog number.
        number: u32,
        /// Whether it is to be one.
        is_favourite: bool,
    },
    /// Take up this source of elements.
    AddSource(Source),
    /// Give up the source of elements with this name.
    RemoveSource(String),
    /// Read all sources anew, and ask the servers of some.
    RefreshSources {
        /// The names of those whose servers are asked, where they may be.
        names: Vec<String>,
        /// The operator wants it although they were asked lately.
        forced: bool,
    },
    /// The alarm list is open.
    OpenedAlarms,
    /// This alarm was seen.
    AcknowledgeAlarm(u64),
    /// Save what is known of the settings of this antenna.
    SaveSettings(AntennaId),
    /// Compare the settings of this antenna with a file.
    CompareSettings(AntennaId),
    /// Read this copy of settings for the comparison.
    ReadCopy {
        /// Of which antenna.
        antenna: AntennaId,
        /// Where it is.
        path: PathBuf,
    },
    /// End the comparison.
    CloseCopy,
    /// Save these settings and use them.
    SaveStation(#[serde(with = "written::station")] Box<Station>),
    /// About a file of elements for a unit.
    Upload(uploads::Ask),
    /// About a test of a source that a unit is told to use.
    TestSource(TestAsk),
    /// End once this is done with the antennas that move.
    CloseAfter(CloseHow),
    /// Do not end after all.
    StayOpen,
    /// What the client looks at.
    Look(Attention),
}

/// What a client looks at, and what is therefore worked out.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Attention {
    /// Which passes it lists.
    pub list: ListChoice,
    /// The pass that is selected.
    pub selected: Option<PassKey>,
}

impl Command {
    /// The antenna that it would move, if it is about one.
    pub fn antenna(&self) -> Option<AntennaId> {
        match self {
            Self::Antenna(antenna, _)
            | Self::Track { antenna, .. }
            | Self::ProgramTrackPass { antenna, .. } => Some(*antenna),
            _ => None,
        }
    }

    /// Whether it may move an antenna. A stop at the same time voids it.
    pub fn may_move(&self) -> bool {
        match self {
            Self::Antenna(_, command) => {
                !matches!(command, driver::Command::ReadGroup(_) | driver::Command::LockOut(_))
            }
            Self::Track { .. }
            | Self::ProgramTrackPass { .. }
            | Self::CloseAfter(CloseHow::Park)
            | Self::Upload(uploads::Ask::AgreeToTracking) => true,
            _ => false,
        }
    }
}
