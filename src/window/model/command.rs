//! Commands of the views. The window carries them out once a frame, after it has drawn all views.

use std::{path::PathBuf, sync::Arc};

use jiff::Timestamp;

use super::{
    Appearance, ConsoleLine, Model, NextStation, ThemeName, View, catalog_table,
    effects::{mounts, obstacles, sites},
    export::Export,
    intake::Offer,
    replay::{ReplayCommand, Stretch},
    typed_path::{OpenedFile, TypedPath},
};
use crate::{
    astro::HorizonMask,
    contract::{
        self, driver,
        passes::{PassListKey, PredictedPass, Scope},
    },
    desktop::Sound,
    station::AntennaId,
};

/// A command of a view to the station, to the drivers directly, or to the window.
#[derive(Debug, Clone, PartialEq)]
pub enum UiCommand {
    /// STOP for every antenna that is connected or that this window has moved.
    Stop,
    /// STOP for this antenna, even if Azel has to connect first.
    StopAntenna(AntennaId),
    Station(contract::Command),
    /// Immediate closing of the window.
    Close,
    /// Change to another station.
    ChooseStation(NextStation),
    /// Choice of a file in the desktop dialog. Azel changes to its station or offers its elements.
    ChooseFile(OpenedFile),
    /// File to open, whose path the operator has entered.
    OpenFile(OpenedFile, PathBuf),
    /// Change to the station that the operator has confirmed.
    ChangeNow,
    /// Decision to keep the current station in the window.
    KeepStation,
    SelectPass(PassListKey),
    /// Question whether the selected antenna should track this pass. The second step of the views
    /// asks it.
    AskToTrack(PassListKey),
    /// Selection of the current or next pass of this satellite.
    SelectSatellite(u32),
    /// Selection of the antenna at this index.
    SelectAntenna(usize),
    /// Satellites whose passes the list shows.
    SetScope(Scope),
    /// Time span of the list of passes from now on, hours.
    SetSpan(u32),
    Show(View),
    /// Theme to use regardless of the Sun.
    SetTheme(ThemeName),
    SetAppearance(Appearance),
    /// Example of an alarm or a reminder to show and play.
    TryNotice(Sound),
    /// Lines of the console to write to a file.
    SaveLog(Vec<Arc<ConsoleLine>>),
    /// Objects to show in the table of the catalog.
    ShowCatalog(catalog_table::Question),
    /// Files and texts to read, which the operator drags over the window or has dropped.
    OfferElements {
        offers: Vec<Offer>,
        is_dropped: bool,
    },
    /// Rejection of the offered elements.
    LeaveElements,
    /// Object to show in detail in the Elements view.
    InspectObject(u32),
    /// Export to a file that the operator names in the desktop dialog.
    Save(Export),
    /// Export to a file whose path the operator has entered.
    SaveAs(Export, TypedPath),
    /// Question about the effects of keep-outs on the predicted passes.
    ShowEffects(Box<obstacles::Question>),
    /// Question about the share of the predicted passes that an antenna tracks.
    ShowTracked(Box<mounts::Question>),
    /// Question about the predicted passes over an edited site.
    ShowMoved(Box<sites::Question>),
    /// Rehearsal of the whole plan or of this pass, against simulated units.
    Rehearse(Option<PassListKey>),
    /// End of the current rehearsal, or removal of the last result.
    EndRehearsal,
    /// Replay of this stretch of the record from this time on.
    BeginReplay(Stretch, Timestamp),
    /// Change of the current replay.
    Replay(ReplayCommand),
    /// Return to the live station.
    LeaveReplay,
    /// Dismissal of the message about the end of a replay.
    CloseReplayEnd,
    /// Folder to open in the desktop file manager.
    OpenFolder(PathBuf),
    /// File of a horizon mask to import into the form.
    ImportMask(PathBuf),
    /// Horizon mask to export to a file.
    ExportMask(Box<HorizonMask>),
}

impl UiCommand {
    /// Returns the command for the session of an antenna.
    pub fn antenna(antenna: AntennaId, command: driver::Command) -> Self {
        Self::Station(contract::Command::Antenna(antenna, command))
    }

    /// Returns the command that makes the selected antenna track the selected pass.
    pub fn track_selected(model: &Model) -> Option<Self> {
        let pass = model.selected_pass().map(PredictedPass::key)?;
        let antenna = model.antenna()?.id();
        Some(Self::Station(contract::Command::Track { antenna, pass, is_agreed: false }))
    }

    /// Returns `true` if a STOP in the same frame cancels the command.
    pub fn is_void_after_stop(&self) -> bool {
        matches!(self, Self::Station(command) if command.row().void_after_stop)
    }

    /// Returns `true` if the command also works in a replay, because it changes nothing outside the
    /// window.
    pub fn is_for_replay(&self) -> bool {
        match self {
            Self::Station(command) => command.row().in_replay,
            // STOP goes to the live station.
            Self::Stop
            | Self::StopAntenna(_)
            | Self::Close
            | Self::ChangeNow
            | Self::KeepStation
            | Self::SelectPass(_)
            | Self::SelectSatellite(_)
            | Self::SelectAntenna(_)
            | Self::SetSpan(_)
            | Self::Show(_)
            | Self::SetTheme(_)
            | Self::SetAppearance(_)
            | Self::ShowCatalog(_)
            | Self::OfferElements { .. }
            | Self::LeaveElements
            | Self::InspectObject(_)
            | Self::ShowEffects(_)
            | Self::ShowTracked(_)
            | Self::ShowMoved(_)
            | Self::EndRehearsal
            | Self::BeginReplay(..)
            | Self::Replay(_)
            | Self::LeaveReplay
            | Self::CloseReplayEnd => true,
            Self::AskToTrack(_)
            | Self::Rehearse(_)
            | Self::ChooseStation(_)
            | Self::ChooseFile(_)
            | Self::OpenFile(..)
            | Self::Save(_)
            | Self::SaveAs(..)
            | Self::SaveLog(_)
            | Self::OpenFolder(_)
            | Self::ImportMask(_)
            | Self::ExportMask(_)
            | Self::TryNotice(_)
            | Self::SetScope(_) => false,
        }
    }
}
