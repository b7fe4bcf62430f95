//! Once a frame, drawn or not: take what has come in and keep the model right.

use std::{sync::Arc, time::Duration, time::Instant};

use super::{
    App,
    alarms::{AlarmKind, Work, alarm_of, is_over},
    demo::Demo,
    model::CatalogState,
    owed,
    sources::{SourceWork, Task},
};
use crate::{
    controller::{AxisMotion, panel::CheckState},
    driver::{Event, LinkState, Refusal, Safety, StopState},
    station::Station,
};

/// A unit whose clock is further off than this misses a low satellite.
const CLOCK_OFF_S: f64 = 1.0;
/// While something moves, the numbers run.
const MOVING_FRAME: Duration = Duration::from_millis(100);

impl App {
    /// Takes everything that has come in since the last frame.
    pub(super) fn think(&mut self) {
        self.model.now = self.clock.utc();
        self.model.steady = Instant::now();
        let time_sync = self.clock_watch.poll(self.model.steady, &self.wake);
        self.model.time_sync = time_sync.unwrap_or(self.model.time_sync);
        self.watch_driver();
        self.take_catalog();
        self.take_copies();
        self.take_log_file();
        self.take_mask_file();
        if let CatalogState::Ready(catalog) = &self.model.catalog {
            let catalog = Arc::clone(catalog);
            let renewed = self.model.forecasts.refresh(
                &catalog,
                &self.model.station,
                self.model.list,
                self.model.now,
                &self.wake,
            );
            let lists = &self.model.forecasts;
            let alarms = &mut self.model.alarms;
            let kind = AlarmKind::BrokeOff(Work::Passes);
            if lists.favourites.broke_off() || lists.all.broke_off() {
                alarms.raise(None, kind, self.model.now);
            } else {
                alarms.clear(None, |known| *known == kind);
            }
            if renewed && self.model.selected_pass().is_none() {
                self.model.selected = self.model.next_pass().map(super::forecast::Forecast::key);
            }
        }
        for index in 0..self.model.antennas.len() {
            self.take_antenna(index);
        }
        let antennas = self.model.antennas.iter().map(|antenna| &antenna.config);
        let strangers = owed::strangers(self.driver.debts().units(), antennas);
        owed::tell(&mut self.model.alarms, strangers, self.model.now);
        self.forget_tracks();
        self.watch_closing();
        self.poll_uploads();
        self.source_tests.poll(&mut self.model.source_tests);
        self.work_on_effects();
        self.model.refresh_sky();
        self.remember();
    }

    fn watch_driver(&mut self) {
        match self.driver.stood_for() {
            Some(stood) => {
                self.model.alarms.raise(None, AlarmKind::DriverStands(stood), self.model.now);
            }
            None => {
                self.model.alarms.clear(None, |kind| matches!(kind, AlarmKind::DriverStands(_)));
            }
        }
    }

    /// Keeps what the operator has changed for the next start.
    pub(super) fn remember(&mut self) {
        self.keeper.memory.views = self.views.kept();
        self.keeper.keep(&self.wake);
    }

    fn take_catalog(&mut self) {
        let Some(end) = super::Job::take(&mut self.elements_job) else { return };
        let (alarms, now) = (&mut self.model.alarms, self.model.now);
        let Ok(outcome) = end else {
            alarms.raise(None, AlarmKind::BrokeOff(Work::Elements), now);
            self.model.sources.work = SourceWork::Nothing;
            // Once: the source that it broke off at is set aside now.
            if !std::mem::replace(&mut self.elements_broke_off, true) {
                self.begin_elements(Task::default());
            } else if matches!(self.model.catalog, CatalogState::Loading) {
                self.model.catalog = CatalogState::Failed;
            }
            return;
        };
        self.elements_broke_off = false;
        alarms.clear(None, |kind| {
            matches!(
                kind,
                AlarmKind::Elements(_)
                    | AlarmKind::SourceSetAside(_)
                    | AlarmKind::BrokeOff(Work::Elements)
            )
        });
        for report in outcome.sources.reports.iter().filter(|report| report.is_set_aside) {
            alarms.raise(None, AlarmKind::SourceSetAside(report.source.clone()), now);
        }
        for text in outcome.bundled_problem.iter().chain(&outcome.sources.problem) {
            tracing::error!("{text}");
            alarms.raise(None, AlarmKind::Elements(text.clone()), now);
        }
        self.model.sources = outcome.sources;
        if outcome.catalog.is_empty() {
            self.model.catalog = CatalogState::Failed;
            return;
        }
        self.model.catalog = CatalogState::Ready(Arc::new(outcome.catalog));
        if self.model.demo && self.demo.is_none() {
            self.start_demo();
        }
    }

    fn start_demo(&mut self) {
        let CatalogState::Ready(catalog) = &self.model.catalog else { return };
        // Whatever can be selected can be tracked.
        let elements = catalog.iter().cloned().collect();
        match Demo::start(&self.model.station, elements) {
            Ok(demo) => {
                let antennas = Station::demo(&demo.addresses).antennas;
                self.demo = Some(demo);
                let station = Station { antennas, ..self.model.station.clone() };
                self.use_station(station);
            }
            Err(error) => tracing::error!(%error, "the demo station did not start"),
        }
    }

    fn take_antenna(&mut self, index: usize) {
        let forecasts = &self.model.forecasts;
        let Some(antenna) = self.model.antennas.get_mut(index) else { return };
        antenna.refresh(self.model.station.site, |number| forecasts.satellite(number));
        let mut events = Vec::new();
        while let Some(event) = antenna.handle.next_event() {
            events.push(event);
        }
        for event in events {
            self.take_event(index, event);
        }
        self.tell_lock_out(index);
        self.tell_orbit(index);
        self.judge_unit(index);
        self.watch_state(index);
        self.watch_on_board(index);
    }

    fn take_event(&mut self, index: usize, event: Event) {
        let now = self.model.now;
        let antenna = Some(index);
        match &event {
            Event::Back { .. } | Event::Connected(_) => {
                self.model.alarms.clear(antenna, |kind| matches!(kind, AlarmKind::LinkLost(_)));
            }
            Event::Stopped => {
                self.model.alarms.clear(antenna, |kind| *kind == AlarmKind::StopNotConfirmed);
            }
            _ => {}
        }
        self.take_closing_event(index, &event);
        if let Event::Safety(Safety::AsksToResume { name, .. }) = &event {
            self.offer_resume(index, name);
        }
        if let Some(kind) = alarm_of(&event) {
            self.model.alarms.raise(antenna, kind, now);
        }
        if let Some(antenna) = self.model.antennas.get_mut(index) {
            if event == Event::NotSent(Refusal::Unguarded) {
                antenna.asks_unguarded = true;
            }
            if let Event::NotSent(Refusal::Unseen { act, .. }) = &event {
                antenna.asks_unseen = Some(act.clone());
            }
            if event == Event::Stopped {
                // The snapshots between press and standstill may all have been missed.
                antenna.stop_pressed = None;
            }
            antenna.news = Some((event, now));
        }
    }

    /// Alarms that follow from the state rather than from an event.
    fn watch_state(&mut self, index: usize) {
        let Some(antenna) = self.model.antennas.get(index) else { return };
        let snapshot = Arc::clone(&antenna.snapshot);
        let (alarms, now, of) = (&mut self.model.alarms, self.model.now, Some(index));
        if snapshot.stop == StopState::Ready
            && snapshot.state.measured.is_some_and(|measured| !measured.moving())
        {
            alarms.clear(of, |kind| *kind == AlarmKind::StopNotConfirmed);
        }
        match snapshot.left_moving {
            Some(since) => {
                let matter = Safety::LeftMoving { since, asks: true };
                alarms.raise(of, AlarmKind::Safety(matter), now);
            }
            None => alarms.clear(of, |kind| {
                matches!(kind, AlarmKind::Safety(Safety::LeftMoving { asks: true, .. }))
            }),
        }
        let silent = AlarmKind::Safety(Safety::SilentInMotion);
        if snapshot.silent {
            alarms.raise(of, silent, now);
        } else {
            alarms.clear(of, |kind| *kind == silent);
        }
        if !snapshot.locking {
            alarms.clear(of, |kind| *kind == AlarmKind::LockOutUnproved);
        }
        let checks = &snapshot.state.checks;
        if snapshot.link == LinkState::Off {
            // Nobody wants to know while the unit is left to others.
            alarms.clear(of, |kind| matches!(kind, AlarmKind::LinkLost(_) | AlarmKind::Check(_)));
        } else {
            for check in checks.iter() {
                if matches!(check.state, CheckState::Caution | CheckState::Fault) {
                    alarms.raise(of, AlarmKind::Check(check.clone()), now);
                }
            }
            alarms.clear(of, |kind| matches!(kind, AlarmKind::Check(old) if is_over(old, checks)));
        }
        if let Some(why) = snapshot.state.unreadable {
            alarms.raise(of, AlarmKind::Unreadable(why), now);
        } else {
            alarms.clear(of, |kind| matches!(kind, AlarmKind::Unreadable(_)));
        }
        if let Some(clock) = snapshot.state.on_board.clock {
            let off = clock.is_set && clock.ahead_s.abs() > CLOCK_OFF_S;
            if off {
                alarms.raise(of, AlarmKind::ClockOff(clock.ahead_s), now);
            } else {
                alarms.clear(of, |kind| matches!(kind, AlarmKind::ClockOff(_)));
            }
            if clock.is_set {
                alarms.clear(of, |kind| *kind == AlarmKind::ClockNotSet);
            } else {
                alarms.raise(of, AlarmKind::ClockNotSet, now);
            }
        }
    }

    /// The next frame: ten a second while metal moves or a key is held, else on
    /// the full second. Whatever comes in asks for its own.
    pub(super) fn schedule_repaint(&self, ctx: &egui::Context) {
        let lively = self.model.antennas.iter().any(|antenna| {
            let snapshot = &antenna.snapshot;
            let axes = snapshot.state.measured.map(|measured| measured.axes);
            snapshot.jog.is_some()
                || axes.is_some_and(|axes| axes.iter().any(|axis| axis.motion != AxisMotion::Still))
        });
        let into_second = self.model.now.subsec_nanosecond();
        let to_next = Duration::from_nanos(1_000_000_000 - u64::from(into_second.unsigned_abs()));
        let wait = if lively { MOVING_FRAME.min(to_next) } else { to_next };
        // A clock that stands at the second when the frame comes early would
        // ask for a frame at once, again and again.
        let wait = wait.max(Duration::from_millis(5));
        ctx.request_repaint_after_for(wait, egui::ViewportId::ROOT);
    }
}
