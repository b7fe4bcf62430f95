//! Commands of the views, carried out once a frame after everything is drawn.

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

/// A command of a view: for the station, past it, or for the window itself.
#[derive(Debug, Clone, PartialEq)]
pub enum UiCommand {
    /// Stop every antenna that is connected or was moved from here.
    Stop,
    /// Stop this antenna, also where that takes a connection.
    StopAntenna(AntennaId),
    Station(contract::Command),
    /// Close the window at once.
    Close,
    /// Change the station of the window.
    ChooseStation(NextStation),
    /// Open a file that the operator chooses in the dialog of the desktop: change to its station, or
    /// offer its elements.
    ChooseFile(OpenedFile),
    /// Open the file whose path the operator has typed.
    OpenFile(OpenedFile, PathBuf),
    /// Change to the station that the operator was asked about.
    ChangeNow,
    /// Stay with the station in the window.
    KeepStation,
    SelectPass(PassListKey),
    /// Ask whether the selected antenna is to track this pass; the second step of the views
    /// takes it.
    AskToTrack(PassListKey),
    /// Show the present or next pass of this satellite.
    SelectSatellite(u32),
    /// Select the antenna at this place.
    SelectAntenna(usize),
    /// List the passes of these satellites.
    SetScope(Scope),
    /// List the passes of this many hours from now on.
    SetSpan(u32),
    Show(View),
    /// Use this theme, whatever the Sun does.
    SetTheme(ThemeName),
    SetAppearance(Appearance),
    /// Show and sound an example of an alarm or a reminder.
    TryNotice(Sound),
    /// Write these lines of the console to a file.
    SaveLog(Vec<Arc<ConsoleLine>>),
    /// Show these objects in the table of the catalog.
    ShowCatalog(catalog_table::Question),
    /// Read these files and texts, which the operator holds over the window or has dropped.
    OfferElements {
        offers: Vec<Offer>,
        is_dropped: bool,
    },
    /// Drop what is offered as elements.
    LeaveElements,
    /// Show this object in detail in the Elements view.
    InspectObject(u32),
    /// Save this to a file that the operator names in the dialog of the desktop.
    Save(Export),
    /// Save this to a file whose path the operator has typed.
    SaveAs(Export, TypedPath),
    /// Work out the effects of keep-outs on the passes to come.
    ShowEffects(Box<obstacles::Question>),
    /// Work out how much of the passes to come an antenna tracks.
    ShowTracked(Box<mounts::Question>),
    /// Work out the passes to come over an edited site.
    ShowMoved(Box<sites::Question>),
    /// Rehearse the plan, or this pass of it, against simulated units.
    Rehearse(Option<PassListKey>),
    /// Cancel the rehearsal, or forget the last one.
    EndRehearsal,
    /// Show a stretch of the record again, from this moment on.
    BeginReplay(Stretch, Timestamp),
    /// Change the replay that is shown.
    Replay(ReplayCommand),
    /// Show the present again.
    LeaveReplay,
    /// Show no more why a replay has ended.
    CloseReplayEnd,
    /// Show this folder in the file manager of the desktop.
    OpenFolder(PathBuf),
    /// Read a horizon mask from this file into the form.
    ImportMask(PathBuf),
    /// Write this horizon mask to a file.
    ExportMask(Box<HorizonMask>),
}

impl UiCommand {
    /// A command for the session of an antenna.
    pub fn antenna(antenna: AntennaId, command: driver::Command) -> Self {
        Self::Station(contract::Command::Antenna(antenna, command))
    }

    /// Tracks the selected pass with the selected antenna.
    pub fn track_selected(model: &Model) -> Option<Self> {
        let pass = model.selected_pass().map(PredictedPass::key)?;
        let antenna = model.antenna()?.id();
        Some(Self::Station(contract::Command::Track { antenna, pass, is_agreed: false }))
    }

    /// Returns `true` if a STOP in the same frame voids the command.
    pub fn is_void_after_stop(&self) -> bool {
        matches!(self, Self::Station(command) if command.row().void_after_stop)
    }

    /// Returns `true` if a replay takes the command, because it changes nothing outside the window.
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
