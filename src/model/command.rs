//! What a view asks for. Carried out once a frame, after everything is drawn.

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

/// What a view asks for.
#[derive(Debug, Clone, PartialEq)]
pub enum UiCommand {
    /// Stop every antenna that is connected or was moved from here.
    Stop,
    /// Stop the antenna with this index, also where that takes a connection.
    StopAntenna(usize),
    /// Close the window, whatever is lost with it.
    Close,
    /// Close the window once this is done with the antennas that move.
    CloseAfter(CloseHow),
    /// Do not close the window after all.
    StayOpen,
    /// Show this pass.
    SelectPass(PassKey),
    /// Show the present or next pass of this satellite.
    SelectSatellite(u32),
    /// Show this antenna.
    SelectAntenna(usize),
    /// Something for the antenna with this index, which was shown when it was
    /// asked for.
    Antenna(usize, driver::Command),
    /// Track a pass with the antenna of this index.
    Track {
        /// Which antenna was shown when it was asked for.
        antenna: usize,
        /// Which pass was shown when it was asked for.
        pass: PassKey,
    },
    /// Follow a pass from here, position by position, with the antenna of this index.
    FollowPass {
        /// Which antenna was shown when it was asked for.
        antenna: usize,
        /// Which pass was shown when it was asked for.
        pass: PassKey,
    },
    /// Let the unit of this antenna track a pass although it would miss.
    TrackAnyway {
        /// Which antenna was shown when it was asked for.
        antenna: usize,
        /// Which pass was shown when it was asked for.
        pass: PassKey,
    },
    /// List passes from this maximum elevation on, degrees.
    SetElevationFloor(f64),
    /// List the passes of these satellites.
    SetScope(Scope),
    /// List the passes of so many hours from now on.
    SetSpan(u32),
    /// End the search for the passes of the list; what is listed stays.
    CancelSearch,
    /// Begin the cancelled search again.
    ResumeSearch,
    /// Follow this satellite, or follow it no longer.
    Follow {
        /// Catalog number.
        number: u32,
        /// Whether it is to be followed.
        is_followed: bool,
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
    /// Fill the window with this view.
    Show(View),
    /// Change the colours.
    SetTheme(ThemeName),
    /// The alarm list is open.
    OpenedAlarms,
    /// This alarm was seen.
    AcknowledgeAlarm(u64),
    /// Save what is known of the settings of the antenna with this index.
    SaveSettings {
        /// Which antenna was shown when it was asked for.
        antenna: usize,
    },
    /// Compare the settings of the antenna with this index with a file.
    CompareSettings {
        /// Which antenna was shown when it was asked for.
        antenna: usize,
    },
    /// Read this copy of settings for the comparison.
    ReadCopy {
        /// Which antenna was shown when it was asked for.
        antenna: usize,
        /// Where it is.
        path: PathBuf,
    },
    /// End the comparison.
    CloseCopy,
    /// Write these lines of the console to a file.
    SaveLog(Vec<Arc<Line>>),
    /// Work out what keep-outs do to the passes to come.
    ShowEffects(Box<effects::Question>),
    /// Read a horizon mask from this file into the form.
    ImportMask(PathBuf),
    /// Write this horizon mask to a file.
    ExportMask(Box<HorizonMask>),
    /// Something for the station, as it offered it.
    Station(engine::Command),
    /// Save these settings and use them.
    SaveStation(Box<Station>),
    /// About a file of elements for a unit.
    Upload(uploads::Ask),
    /// About a test of a source that a unit is told to use.
    TestSource(source_tests::TestAsk),
}

impl UiCommand {
    /// Track what is selected now with the antenna that is selected now.
    pub fn track_selected(model: &Model) -> Option<Self> {
        let pass = model.selected_pass().map(PredictedPass::key)?;
        Some(Self::Track { antenna: model.selected_antenna, pass })
    }

    /// Whether it may move an antenna. A stop in the same frame voids it.
    pub fn may_move(&self) -> bool {
        match self {
            Self::Antenna(_, command) => {
                !matches!(command, driver::Command::ReadGroup(_) | driver::Command::LockOut(_))
            }
            Self::Station(command) => command.may_move(),
            Self::Track { .. }
            | Self::FollowPass { .. }
            | Self::CloseAfter(CloseHow::Park)
            | Self::TrackAnyway { .. }
            | Self::Upload(uploads::Ask::AgreeToTracking) => true,
            _ => false,
        }
    }
}
