//! Execution of the commands of the views.

use std::sync::atomic::Ordering;

use super::App;
use crate::{
    contract::{Command, driver, passes::PredictedPass},
    engine::Stopped,
    model::{Appearance, UiCommand, View, replay::ReplayEnd},
    station::AntennaId,
};

impl App {
    /// Sends STOP past every queue to each antenna that STOP concerns, and leaves a replay.
    pub(super) fn stop_all(&mut self) {
        let stopped = self.station.client().stop_all();
        self.leave_replay(Some(ReplayEnd::Stop));
        self.show_stopped(&stopped);
    }

    /// Sends STOP past every queue to one antenna, even if Azel must connect to its unit first.
    /// Leaves a replay.
    pub(super) fn stop_one(&mut self, antenna: AntennaId) {
        let stopped = self.station.client().stop(antenna);
        self.leave_replay(Some(ReplayEnd::Stop));
        self.show_stopped(&stopped);
    }

    /// Marks STOP as pressed from this frame on.
    fn show_stopped(&mut self, stopped: &Stopped) {
        let antennas = self.model.shown_mut().antennas.iter_mut();
        for antenna in
            antennas.filter(|model_antenna| stopped.antennas.contains(&model_antenna.id()))
        {
            antenna.stop_pressed = Some(stopped.instant);
        }
    }

    pub(super) fn carry_out(&mut self, command: UiCommand, ctx: &egui::Context) {
        let model = &mut self.model;
        match command {
            UiCommand::Stop => self.stop_all(),
            UiCommand::StopAntenna(antenna) => self.stop_one(antenna),
            UiCommand::Close => {
                self.may_close.store(true, Ordering::Relaxed);
                ctx.send_viewport_cmd(egui::ViewportCommand::Close);
            }
            UiCommand::SelectPass(key) => model.choose_pass(key),
            UiCommand::BeginReplay(stretch, time) => self.begin_replay(stretch, time),
            UiCommand::CloseReplayEnd => model.replay_end = None,
            // The views handle `AskToTrack` or have no antenna for it; the other two need a replay.
            UiCommand::AskToTrack(_) | UiCommand::Replay(_) | UiCommand::LeaveReplay => {}
            UiCommand::SelectSatellite(number) => {
                if let Some(pass) = model.pass_of(number).map(PredictedPass::key) {
                    model.choose_pass(pass);
                }
            }
            UiCommand::SelectAntenna(index) => {
                model.select_antenna(index);
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
            UiCommand::Show(view) => self.show_view(view),
            UiCommand::SetTheme(name) => {
                let appearance = self.keeper.memory.appearance;
                let chosen = Appearance { theme: name, light_by_day: false, ..appearance };
                self.change_appearance(chosen, ctx);
            }
            UiCommand::SetAppearance(appearance) => {
                self.change_appearance(appearance, ctx);
            }
            UiCommand::TryNotice(sound) => {
                if let Some(notifier) = &self.notifier {
                    notifier.try_out(sound);
                }
            }
            UiCommand::ShowEffects(question) => {
                model.obstacle_effects.ask(*question, model.steady);
            }
            UiCommand::ShowTracked(question) => model.mount_effects.ask(*question, model.steady),
            UiCommand::ShowMoved(question) => model.site_effects.ask(*question, model.steady),
            UiCommand::ShowCatalog(question) => model.catalog_table.question = question,
            UiCommand::OfferElements { offers, is_dropped } => {
                self.offer_elements(offers, is_dropped);
            }
            UiCommand::LeaveElements => self.leave_elements(),
            UiCommand::InspectObject(number) => {
                model.catalog_table.inspected = Some(number);
                self.send(Command::ListOlderSets(number));
            }
            UiCommand::Save(export) => self.save_export(export, None),
            UiCommand::SaveAs(export, path) => self.save_export(export, Some(path)),
            UiCommand::Rehearse(pass) => self.rehearse(pass),
            UiCommand::EndRehearsal => self.end_rehearsal(),
            UiCommand::OpenFolder(folder) => self.open_folder(folder),
            UiCommand::ChooseStation(next) => self.choose_station(next),
            UiCommand::ChooseFile(file) => self.choose_file(file),
            UiCommand::OpenFile(file, path) => self.open_file(file, path),
            UiCommand::ChangeNow => drop(self.change_now()),
            UiCommand::KeepStation => self.stay(),
            UiCommand::ImportMask(path) => self.import_mask(path),
            UiCommand::ExportMask(mask) => self.export_mask(&mask),
            UiCommand::Station(command) => self.send(command),
        }
    }

    pub(super) fn show_view(&mut self, view: View) {
        if self.model.view != view {
            self.model.replay_end = None;
        }
        self.model.view = view;
        self.keeper.memory.keep_view(view);
    }

    fn send(&mut self, command: Command) {
        let Err(command) = self.station.client().send(command) else { return };
        tracing::error!(?command, "the station is too busy to take a command");
        // A lost command must not leave a motion running: send STOP instead.
        if let Command::Antenna(id, driver::Command::Standby | driver::Command::EndJog) = command {
            let stopped = self.station.client().stop(id);
            self.show_stopped(&stopped);
        }
    }
}
