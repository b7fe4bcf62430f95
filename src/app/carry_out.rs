//! Carries out the commands of the views.

use std::sync::atomic::Ordering;

use super::App;
use crate::{
    driver,
    engine::{Command, Stopped, antenna::AntennaModel, passes::PredictedPass},
    model::UiCommand,
    station::AntennaId,
    ui::theme,
};

impl App {
    /// Sends STOP past every queue, to every antenna that it concerns.
    pub(super) fn stop_all(&mut self) {
        let stopped = self.station.client().stop_all();
        self.show_stopped(&stopped);
    }

    /// Sends STOP past every queue, also to a unit that must be connected for it.
    fn stop_one(&mut self, index: usize) {
        let Some(id) = self.id(index) else { return };
        let stopped = self.station.client().stop(id);
        self.show_stopped(&stopped);
    }

    /// Shows STOP as pressed from this frame on.
    fn show_stopped(&mut self, stopped: &Stopped) {
        let antennas = self.model.antennas.iter_mut();
        for antenna in antennas.filter(|of| stopped.antennas.contains(&of.id())) {
            antenna.stop_pressed = Some(stopped.at);
        }
    }

    /// The id of the antenna with this index.
    fn id(&self, index: usize) -> Option<AntennaId> {
        self.model.antennas.get(index).map(AntennaModel::id)
    }

    pub(super) fn carry_out(&mut self, command: UiCommand, ctx: &egui::Context) {
        let model = &mut self.model;
        match command {
            UiCommand::Stop => self.stop_all(),
            UiCommand::StopAntenna(index) => self.stop_one(index),
            UiCommand::Close => {
                self.may_close.store(true, Ordering::Relaxed);
                ctx.send_viewport_cmd(egui::ViewportCommand::Close);
            }
            UiCommand::SelectPass(key) => model.selected = Some(key),
            UiCommand::SelectSatellite(number) => {
                model.selected = model.pass_of(number).map(PredictedPass::key).or(model.selected);
            }
            UiCommand::SelectAntenna(index) => {
                model.selected_antenna = index;
                let antenna = model.antenna();
                self.keeper.memory.antenna = antenna.map(|antenna| antenna.config.name.clone());
            }
            UiCommand::SetScope(scope) => {
                model.list.scope = scope;
                self.keeper.memory.list = model.list;
            }
            UiCommand::SetSpan(span_h) => {
                model.list.set_span_h(span_h);
                self.keeper.memory.list = model.list;
            }
            UiCommand::SaveLog(lines) => self.save_log(lines),
            UiCommand::Show(view) => model.view = view,
            UiCommand::SetTheme(name) => {
                theme::set(ctx, name);
                self.keeper.memory.theme = name;
            }
            UiCommand::ShowEffects(question) => model.effects.ask(*question, model.steady),
            UiCommand::ImportMask(path) => self.import_mask(path),
            UiCommand::ExportMask(mask) => self.export_mask(&mask),
            UiCommand::Antenna(index, command) => {
                self.send_to(index, |id| Command::Antenna(id, command));
            }
            UiCommand::Track { antenna, pass } => {
                self.send_to(antenna, |antenna| Command::Track { antenna, pass, is_agreed: false });
            }
            UiCommand::ProgramTrackPass { antenna, pass } => {
                self.send_to(antenna, |antenna| Command::ProgramTrackPass { antenna, pass });
            }
            UiCommand::TrackAnyway { antenna, pass } => {
                self.send_to(antenna, |antenna| Command::Track { antenna, pass, is_agreed: true });
            }
            UiCommand::SaveSettings { antenna } => self.send_to(antenna, Command::SaveSettings),
            UiCommand::CompareSettings { antenna } => {
                self.send_to(antenna, Command::CompareSettings);
            }
            UiCommand::ReadCopy { antenna, path } => {
                self.send_to(antenna, |antenna| Command::ReadCopy { antenna, path });
            }
            UiCommand::CloseAfter(how) => self.send(Command::CloseAfter(how)),
            UiCommand::StayOpen => self.send(Command::StayOpen),
            UiCommand::CloseCopy => self.send(Command::CloseCopy),
            UiCommand::SetElevationFloor(floor_deg) => {
                self.send(Command::SetElevationFloor(floor_deg));
            }
            UiCommand::CancelSearch => {
                let scope = model.list.scope;
                self.send(Command::CancelSearch(scope));
            }
            UiCommand::ResumeSearch => {
                let scope = model.list.scope;
                self.send(Command::ResumeSearch(scope));
            }
            UiCommand::SetFavourite { number, is_favourite } => {
                self.send(Command::SetFavourite { number, is_favourite });
            }
            UiCommand::AddSource(source) => self.send(Command::AddSource(source)),
            UiCommand::RemoveSource(name) => self.send(Command::RemoveSource(name)),
            UiCommand::RefreshSources { names, forced } => {
                self.send(Command::RefreshSources { names, forced });
            }
            UiCommand::OpenedAlarms => self.send(Command::OpenedAlarms),
            UiCommand::AcknowledgeAlarm(id) => self.send(Command::AcknowledgeAlarm(id)),
            UiCommand::SaveStation(station) => self.send(Command::SaveStation(station)),
            UiCommand::TestSource(ask) => self.send(Command::TestSource(ask)),
            UiCommand::Upload(ask) => self.send(Command::Upload(ask)),
            UiCommand::Station(command) => self.send(command),
        }
        (self.wake)();
    }

    fn send_to(&mut self, index: usize, command: impl FnOnce(AntennaId) -> Command) {
        if let Some(id) = self.id(index) {
            self.send(command(id));
        }
    }

    fn send(&mut self, command: Command) {
        let Err(command) = self.station.client().send(command) else { return };
        tracing::error!(?command, "the station is too busy to take a command");
        // A command that ends a motion must not get lost: stop instead.
        if let Command::Antenna(id, driver::Command::Standby | driver::Command::EndJog) = command {
            let stopped = self.station.client().stop(id);
            self.show_stopped(&stopped);
        }
    }
}
