//! Commands of the views, carried out once a frame after everything is drawn.

use std::{path::PathBuf, sync::Arc};

use super::{Line, Model, ThemeName, View, effects};
use crate::{
    astro::HorizonMask,
    driver,
    engine::{
        self,
        closing::CloseHow,
        passes::{PassKey, PredictedPass, Scope},
        source_tests, uploads,
    },
    orbit::Source,
    station::Station,
};

/// A command of a view. Antennas are named by index: the antenna that was shown when the
/// command was queued.
#[derive(Debug, Clone, PartialEq)]
pub enum UiCommand {
    /// Stop every antenna that is connected or was moved from here.
    Stop,
    /// Stop the antenna with this index, also where that takes a connection.
    StopAntenna(usize),
    /// Close the window at once.
    Close,
    /// Close the window after this is done with the antennas that move.
    CloseAfter(CloseHow),
    /// Keep the window open after all.
    StayOpen,
    SelectPass(PassKey),
    /// Show the present or next pass of this satellite.
    SelectSatellite(u32),
    SelectAntenna(usize),
    /// A command for the session of the antenna.
    Antenna(usize, driver::Command),
    /// Track a pass, with the program of the unit where it has one.
    Track {
        antenna: usize,
        pass: PassKey,
    },
    /// Track a pass by positions from here.
    ProgramTrackPass {
        antenna: usize,
        pass: PassKey,
    },
    /// Let the unit track a pass although it would miss.
    TrackAnyway {
        antenna: usize,
        pass: PassKey,
    },
    /// List passes from this maximum elevation on, degrees.
    SetElevationFloor(f64),
    /// List the passes of these satellites.
    SetScope(Scope),
    /// List the passes of this many hours from now on.
    SetSpan(u32),
    /// End the search for the passes of the list; what is listed stays.
    CancelSearch,
    /// Begin the cancelled search again.
    ResumeSearch,
    /// Make this satellite a favourite, or no longer.
    SetFavourite {
        number: u32,
        is_favourite: bool,
    },
    /// Add this source of elements.
    AddSource(Source),
    /// Remove the source of elements with this name.
    RemoveSource(String),
    /// Read all sources anew, and ask the servers of some.
    RefreshSources {
        /// Names of the sources whose servers are asked, where they may be.
        names: Vec<String>,
        /// Ask although they were asked lately.
        forced: bool,
    },
    Show(View),
    SetTheme(ThemeName),
    /// Note that the alarm list was opened.
    OpenedAlarms,
    /// Acknowledge this alarm.
    AcknowledgeAlarm(u64),
    /// Save the known settings of the unit to a file.
    SaveSettings {
        antenna: usize,
    },
    /// Compare the settings of the unit with a file.
    CompareSettings {
        antenna: usize,
    },
    /// Read this copy of settings for the comparison.
    ReadCopy {
        antenna: usize,
        path: PathBuf,
    },
    CloseCopy,
    /// Write these lines of the console to a file.
    SaveLog(Vec<Arc<Line>>),
    /// Work out the effects of keep-outs on the passes to come.
    ShowEffects(Box<effects::Question>),
    /// Read a horizon mask from this file into the form.
    ImportMask(PathBuf),
    /// Write this horizon mask to a file.
    ExportMask(Box<HorizonMask>),
    /// A command that the station itself offered.
    Station(engine::Command),
    /// Save the station and use it.
    SaveStation(Box<Station>),
    /// A command for the upload of a file of elements.
    Upload(uploads::Ask),
    /// A command for the test of a source that a unit is configured for.
    TestSource(source_tests::TestAsk),
}

impl UiCommand {
    /// Tracks the selected pass with the selected antenna.
    pub fn track_selected(model: &Model) -> Option<Self> {
        let pass = model.selected_pass().map(PredictedPass::key)?;
        Some(Self::Track { antenna: model.selected_antenna, pass })
    }

    /// Whether the command may move an antenna. A stop in the same frame voids it.
    pub fn may_move(&self) -> bool {
        match self {
            Self::Antenna(_, command) => {
                !matches!(command, driver::Command::ReadGroup(_) | driver::Command::LockOut(_))
            }
            Self::Station(command) => command.may_move(),
            Self::Track { .. }
            | Self::ProgramTrackPass { .. }
            | Self::CloseAfter(CloseHow::Park)
            | Self::TrackAnyway { .. }
            | Self::Upload(uploads::Ask::AgreeToTracking) => true,
            _ => false,
        }
    }
}
