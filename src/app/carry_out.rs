//! Carries out what the views asked for.

use std::sync::{Arc, atomic::Ordering};

use super::{
    App, UiCommand,
    alarms::AlarmKind,
    antenna::AntennaModel,
    forecast::PassKey,
    sources::{self, SourceWork, Task},
};
use crate::{driver, station, ui::theme};

impl App {
    /// Past every queue, to every antenna that it concerns.
    pub(super) fn stop_all(&mut self) {
        for index in 0..self.model.antennas.len() {
            let antenna = self.model.antennas.get(index);
            if antenna.is_some_and(|antenna| antenna.handle.wants_stop()) {
                self.stop_one(index);
            }
        }
        self.stay_open_after_stop();
    }

    /// Past every queue, also to a unit that has to be connected for it.
    pub(super) fn stop_one(&mut self, index: usize) {
        self.note_stop(index);
        if let Some(antenna) = self.model.antennas.get_mut(index) {
            antenna.press_stop();
        }
    }

    pub(super) fn carry_out(&mut self, command: UiCommand, ctx: &egui::Context) {
        self.note_track(&command);
        let model = &mut self.model;
        match command {
            UiCommand::Stop => self.stop_all(),
            UiCommand::StopAntenna(index) => self.stop_one(index),
            UiCommand::Close => {
                self.may_close.store(true, Ordering::Relaxed);
                ctx.send_viewport_cmd(egui::ViewportCommand::Close);
            }
            UiCommand::CloseAfter(how) => self.close_after(how),
            UiCommand::StayOpen => model.closing = None,
            UiCommand::SelectPass(key) => model.selected = Some(key),
            UiCommand::SelectSatellite(number) => {
                model.selected =
                    model.pass_of(number).map(super::forecast::Forecast::key).or(model.selected);
            }
            UiCommand::SelectAntenna(index) => {
                model.selected_antenna = index;
                let antenna = model.antenna();
                self.keeper.memory.antenna = antenna.map(|antenna| antenna.config.name.clone());
            }
            UiCommand::Antenna(antenna, driver::Command::Settle(change)) => {
                self.settle(antenna, change);
            }
            UiCommand::Antenna(antenna, driver::Command::LockOut(lock_out)) => {
                self.set_lock_out(antenna, Some(lock_out));
            }
            UiCommand::Antenna(antenna, driver::Command::Unlock) => {
                self.set_lock_out(antenna, None);
            }
            UiCommand::Antenna(antenna, command) => self.send(antenna, command),
            UiCommand::SaveSettings { antenna } => self.save_copy(antenna),
            UiCommand::CompareSettings { antenna } => self.open_copies(antenna),
            UiCommand::ReadCopy { antenna, path } => {
                if let Some(antenna) = model.antennas.get(antenna) {
                    self.copy_work.read(path, antenna);
                }
            }
            UiCommand::CloseCopy => model.copies.open = None,
            UiCommand::Track { antenna, pass } => self.track(antenna, pass),
            UiCommand::TrackAnyway { antenna, pass } => self.track_on_board(antenna, pass, true),
            UiCommand::SetElevationFloor(floor_deg) => {
                model.station.elevation_floor_deg = floor_deg;
            }
            UiCommand::SetScope(scope) => {
                model.list.scope = scope;
                self.keeper.memory.list = model.list;
            }
            UiCommand::SetSpan(span_h) => {
                model.list.set_span_h(span_h);
                self.keeper.memory.list = model.list;
            }
            UiCommand::CancelSearch => model.forecasts.of_mut(model.list.scope).cancel(),
            UiCommand::ResumeSearch => model.forecasts.of_mut(model.list.scope).resume(),
            UiCommand::Follow { number, is_followed } => self.follow(number, is_followed),
            UiCommand::AddSource(source) => {
                let ask = vec![source.name.clone()];
                let mut list = self.model.sources.list.clone();
                list.push(source);
                self.begin_elements(Task { list: Some(list), ask, forced: false });
            }
            UiCommand::RemoveSource(name) => {
                let mut list = self.model.sources.list.clone();
                list.retain(|source| source.name != name);
                self.begin_elements(Task { list: Some(list), ..Task::default() });
            }
            UiCommand::RefreshSources { names, forced } => {
                self.begin_elements(Task { list: None, ask: names, forced });
            }
            UiCommand::SaveLog(lines) => self.save_log(lines),
            UiCommand::Show(view) => model.view = view,
            UiCommand::SetTheme(name) => {
                theme::set(ctx, name);
                self.keeper.memory.theme = name;
            }
            UiCommand::OpenedAlarms => model.alarms.unopened = false,
            UiCommand::AcknowledgeAlarm(id) => model.alarms.acknowledge(id),
            UiCommand::ShowEffects(question) => model.effects.ask(*question, model.steady),
            UiCommand::ImportMask(path) => self.import_mask(path),
            UiCommand::ExportMask(mask) => self.export_mask(&mask),
            UiCommand::SaveStation(station) => self.save_station(*station),
            UiCommand::TestSource(ask) => self.source_tests.ask(ask, &mut model.source_tests),
            UiCommand::Upload(ask) => self.ask_about_upload(ask),
        }
        (self.wake)();
    }

    pub(super) fn send(&mut self, index: usize, command: driver::Command) {
        let Some(antenna) = self.model.antennas.get_mut(index) else { return };
        if !matches!(command, driver::Command::ReadGroup(_) | driver::Command::EndJog) {
            antenna.asks_unseen = None;
        }
        match command {
            driver::Command::AllowUnguarded => antenna.asks_unguarded = false,
            // By the operator's word, whatever the unit says of itself.
            driver::Command::SeenStanding => {
                let alarms = &mut self.model.alarms;
                alarms.clear(Some(index), |kind| *kind == AlarmKind::StopNotConfirmed);
            }
            _ => {}
        }
        let Err(command) = antenna.handle.send(command) else { return };
        tracing::error!(?command, "the session is too busy to take a command");
        // What ends a motion must not get lost: stop instead.
        if matches!(command, driver::Command::Standby | driver::Command::EndJog) {
            antenna.press_stop();
        }
        self.model.alarms.raise(Some(index), AlarmKind::NotTaken, self.model.now);
    }

    fn track(&mut self, antenna: usize, pass: PassKey) {
        // A pass that is over since it was asked for is not replaced by another.
        let Some(forecast) = self.model.forecasts.find(pass) else { return };
        let by_itself = |antenna: &AntennaModel| antenna.make().capabilities.has_program;
        if !self.model.antennas.get(antenna).is_some_and(by_itself) {
            let follow = self.model.follow_of(forecast);
            return self.send(antenna, driver::Command::Follow(Box::new(follow)));
        }
        self.track_on_board(antenna, pass, false);
    }

    /// One at a time: two would write the same files.
    pub(super) fn begin_elements(&mut self, task: Task) {
        if self.elements_job.is_some() || self.model.sources.is_locked {
            return;
        }
        let work = if task.ask.is_empty() { SourceWork::Reading } else { SourceWork::Asking };
        match sources::start(&self.places, task, self.model.now, Arc::clone(&self.wake)) {
            Ok(job) => {
                self.elements_job = Some(job);
                self.model.sources.work = work;
            }
            Err(error) => tracing::error!(%error, "no thread for the elements"),
        }
    }

    /// The demo station has no file, and one that could not be read is left
    /// alone: there the change lasts as long as the window.
    fn follow(&mut self, number: u32, is_followed: bool) {
        let mut station = self.model.station.clone();
        station.favourites.retain(|known| *known != number);
        if is_followed {
            station.favourites.push(number);
        }
        if !self.model.demo
            && !self.settings_unread
            && let Some(path) = &self.settings_path
            && let Err(error) = station::save(&station, path)
        {
            let text = error.to_string();
            tracing::error!("{text}");
            self.model.alarms.raise(None, AlarmKind::Settings(text), self.model.now);
            return;
        }
        self.model.station = station;
        self.views.station_changed();
    }

    /// The new settings are used once they are safe on disk.
    fn save_station(&mut self, station: station::Station) {
        let now = self.model.now;
        let saved = match &self.settings_path {
            Some(path) => station::save(&station, path).map_err(|error| error.to_string()),
            None => Err("this user has no folder for settings".to_owned()),
        };
        match saved {
            Ok(()) => {
                self.model.alarms.clear(None, |kind| {
                    matches!(kind, AlarmKind::Settings(_) | AlarmKind::Setting(_))
                });
                if std::mem::take(&mut self.model.demo) {
                    self.load_lock_outs();
                }
                self.settings_unread = false;
                self.use_station(station);
                self.demo = None;
                self.views.saved(Ok(now));
            }
            Err(text) => {
                tracing::error!("{text}");
                self.views.saved(Err(text.clone()));
                self.model.alarms.raise(None, AlarmKind::Settings(text), now);
            }
        }
    }
}
