//! Carries out what the views asked for.

use std::sync::{Arc, atomic::Ordering};

use super::{
    App, UiCommand,
    alarms::AlarmKind,
    antenna::AntennaModel,
    forecast::PassKey,
    sources::{self, SourceWork, Task},
};
use crate::{controller::TrackTarget, driver, station, ui::theme};

impl App {
    /// Past every queue, to every antenna.
    pub(super) fn stop_all(&self) {
        for antenna in &self.model.antennas {
            antenna.handle.stop();
        }
    }

    pub(super) fn carry_out(&mut self, command: UiCommand, ctx: &egui::Context) {
        let model = &mut self.model;
        match command {
            UiCommand::Stop => self.stop_all(),
            UiCommand::Close => {
                self.may_close.store(true, Ordering::Relaxed);
                ctx.send_viewport_cmd(egui::ViewportCommand::Close);
            }
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
        let Some(antenna) = self.model.antennas.get(index) else { return };
        let Err(command) = antenna.handle.send(command) else { return };
        tracing::error!(?command, "the session is too busy to take a command");
        // What ends a motion must not get lost: stop instead.
        if matches!(command, driver::Command::Standby | driver::Command::EndJog) {
            antenna.handle.stop();
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
        let target = TrackTarget {
            catalog_number: forecast.satellite.elements.catalog_number(),
            name: forecast.satellite.elements.name().to_owned(),
            from: self.track_from(forecast.pass.aos.time),
            until: forecast.pass.los.time,
        };
        self.send(antenna, driver::Command::Track(target));
    }

    /// One at a time: two would write the same files.
    fn begin_elements(&mut self, task: Task) {
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
                self.model.demo = false;
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
