//! One turn: reads all new reports and updates the published state.

use std::sync::Arc;

use super::{
    Antenna, DemoStation, Engine,
    alarms::{alarm_of, is_over},
    demo::Demo,
    owed,
    sources::Task,
};
use crate::{
    astro::Angle,
    clock::Moment,
    contract::{
        CatalogState,
        alarms::{AlarmKind, Work},
        automatic::Interruption,
        driver::{Event, LeftMoving, LinkState, Refusal, Safety, StopState, TimeSync},
        sources::SourceWork,
    },
    device::panel::CheckState,
    engine::{alarms::KeepAlarms, antenna::refresh, automatic::Operate, on_board::off_because},
    job::Job,
    station::Station,
};

impl Engine {
    /// Handles all reports since the last turn. `turn` is the number of the station's own requests,
    /// drawn before the last check for a STOP.
    pub(super) fn turn(&mut self, turn: u64) {
        self.set_time();
        self.watch_clock();
        self.watch_driver();
        self.watch_claims();
        self.open_ports();
        self.open_metrics();
        self.take_catalog();
        self.ask_with_typed_passwords();
        self.follow_source_orders();
        self.refresh_by_itself();
        self.judge_epochs_again();
        self.take_older_sets();
        self.take_recorded();
        self.take_pointing_fit();
        self.take_copies();
        self.look_for_passes();
        self.look_after_schedule();
        self.watch_element_age();
        for index in 0..self.antennas.len() {
            self.take_antenna(index);
        }
        let antennas = self.antennas.iter().map(|antenna| &*antenna.shown.config);
        let strangers = owed::strangers(self.driver.debts(), antennas);
        owed::tell(&mut self.alarms, strangers, self.now);
        self.run_automatic(turn);
        self.remind();
        self.alarms.pass_time(self.now);
        self.forget_tracks();
        self.watch_closing();
        self.poll_uploads();
        self.source_test_runner.poll(&mut self.source_tests);
        self.link_test_runner.poll(&mut self.link_tests);
        self.keep_learned_drives();
        self.record_turn();
        self.run_hooks();
    }

    /// Checks the clock before anything uses UTC. After a step, automatic operation waits for the
    /// time service. Azel suspends it unless the service synchronises the clock.
    fn watch_clock(&mut self) {
        let now = Moment { utc: self.now, steady: self.steady };
        if self.clock_watch.was_set(now, self.clock.asleep()) {
            self.clock_watch.is_in_doubt = true;
            self.clock_watch.ask_again();
        }
        let answer = if self.clock.is_of_system() {
            self.clock_watch.poll(self.steady, self.driver.time_sync(), &self.wake)
        } else {
            Some((self.driver.time_sync())())
        };
        let Some(answer) = answer else { return };
        self.time_sync = answer;
        if std::mem::take(&mut self.clock_watch.is_in_doubt) && answer != TimeSync::Synchronised {
            for antenna in &mut self.antennas {
                antenna.shown.operation.suspend(Interruption::Clock, self.now);
            }
        }
    }

    fn look_for_passes(&mut self) {
        let CatalogState::Ready(catalog) = &self.catalog else { return };
        let list = self.attention.list;
        self.searches.refresh(catalog, &self.station, list, self.now, &self.wake);
        self.pass_lists = self.searches.shown();
        let kind = AlarmKind::BrokeOff(Work::Passes);
        if self.searches.broke_off() {
            self.alarms.raise(None, kind, self.now);
        } else {
            self.alarms.clear(None, self.now, |alarm_kind| *alarm_kind == kind);
        }
    }

    fn watch_driver(&mut self) {
        match self.driver.stood_for() {
            Some(stood) => {
                self.alarms.raise(None, AlarmKind::DriverStands(stood), self.now);
            }
            None => {
                self.alarms
                    .clear(None, self.now, |kind| matches!(kind, AlarmKind::DriverStands(_)));
            }
        }
    }

    fn take_catalog(&mut self) {
        let Some(end) = Job::take(&mut self.elements_job) else { return };
        let (alarms, now) = (&mut self.alarms, self.now);
        let Ok(outcome) = end else {
            alarms.raise(None, AlarmKind::BrokeOff(Work::Elements), now);
            self.sources.work = SourceWork::Nothing;
            // Retry only once: the library now sets aside the source that broke the reading off.
            if !std::mem::replace(&mut self.elements_broke_off, true) {
                self.begin_elements(Task::default());
            } else if matches!(self.catalog, CatalogState::Loading) {
                self.catalog = CatalogState::Failed;
            }
            return;
        };
        self.elements_broke_off = false;
        alarms.clear(None, now, |kind| {
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
        for text in outcome.bundled_problem.iter().chain(&outcome.sources.problems) {
            tracing::error!("{text}");
            alarms.raise(None, AlarmKind::Elements(text.clone()), now);
        }
        self.sources = outcome.sources;
        self.watch_sources();
        if outcome.catalog.is_empty() {
            self.catalog = CatalogState::Failed;
            return;
        }
        self.catalog = CatalogState::Ready(Arc::new(outcome.catalog));
        self.catalog_revision += 1;
        self.read_older_sets();
        if matches!(self.demo, Some(DemoStation::Coming)) {
            self.start_demo();
        }
    }

    fn start_demo(&mut self) {
        let CatalogState::Ready(catalog) = &self.catalog else { return };
        // The simulated unit must be able to track everything that the operator can select.
        let elements = catalog.iter().cloned().collect();
        match Demo::start(&self.station, elements) {
            Ok(demo) => {
                let antennas = Station::demo(&demo.addresses).antennas;
                self.demo = Some(DemoStation::Running { _demo: demo });
                let station = Station { antennas, ..Station::clone(&self.station) };
                self.use_station(station);
            }
            Err(error) => tracing::error!(%error, "the demo station did not start"),
        }
    }

    fn take_antenna(&mut self, index: usize) {
        let pass_lists = &self.pass_lists;
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        antenna.shown.snapshot = antenna.handle.snapshot();
        let (shown, recent) = (&mut antenna.shown, &mut antenna.recent);
        shown.tally.stops.follow(&shown.snapshot);
        refresh(shown, recent, self.station.site, |number| pass_lists.satellite(number));
        let mut events = Vec::new();
        while let Some(event) = antenna.handle.next_event() {
            events.push(event);
        }
        for event in events {
            self.take_event(index, event);
        }
        self.watch_control(index);
        self.tell_lock_out(index);
        self.tell_orbit(index);
        self.judge_unit(index);
        self.watch_state(index);
        self.watch_on_board(index);
    }

    pub(super) fn take_event(&mut self, index: usize, mut event: Event) {
        let now = self.now;
        let Some(shown) = self.antennas.get(index).map(|antenna| &antenna.shown) else { return };
        if let Event::Safety(Safety::OffTarget { off_deg, cause }) = &mut event {
            let reported = cause.take().map(|cause| *cause);
            let deviation = Angle::from_degrees(*off_deg);
            *cause = off_because(shown, deviation, reported).map(Box::new);
        }
        let id = shown.id();
        let antenna = Some(id);
        match &event {
            Event::Back { .. } | Event::Connected(_) => {
                self.alarms.clear(antenna, self.now, |kind| matches!(kind, AlarmKind::LinkLost(_)));
            }
            Event::Stopped => {
                self.alarms.clear(antenna, self.now, |kind| *kind == AlarmKind::StopNotConfirmed);
            }
            _ => {}
        }
        self.recording.event(id, &event, self.clock.now());
        self.take_closing_event(id, &event);
        self.take_automatic_event(index, &event);
        if let Event::Safety(Safety::AsksToResume { name, .. }) = &event {
            self.offer_resume(index, name);
        }
        if let Some(kind) = alarm_of(&event) {
            self.alarms.raise(antenna, kind, now);
        }
        if let Some(Antenna { shown: antenna, .. }) = self.antennas.get_mut(index) {
            if event == Event::NotSent(Refusal::Unguarded) {
                antenna.asks_unguarded = true;
            }
            if let Event::NotSent(Refusal::Unseen { act, .. }) = &event {
                antenna.asks_unseen = Some(act.clone());
            }
            if event == Event::Stopped {
                // The station may have missed all snapshots between the press and standstill.
                antenna.stop_pressed = None;
            }
            antenna.news = Some((event, now));
        }
    }

    /// Raises and clears alarms that follow from the state, not from an event.
    fn watch_state(&mut self, index: usize) {
        let Some(antenna) = self.antennas.get_mut(index) else { return };
        let snapshot = Arc::clone(&antenna.shown.snapshot);
        let loses_positions =
            snapshot.link.is_open() && snapshot.state.traffic.loses_positions(self.steady);
        antenna.shown.loses_positions = loses_positions;
        let (alarms, now, antenna_id) = (&mut self.alarms, self.now, Some(antenna.shown.id()));
        if snapshot.stop == StopState::Ready
            && snapshot.state.measured.is_some_and(|measured| !measured.moving())
        {
            alarms.clear(antenna_id, now, |kind| *kind == AlarmKind::StopNotConfirmed);
        }
        if let LinkState::Lost { reason, .. } = &snapshot.link {
            alarms.restate(antenna_id, &AlarmKind::LinkLost(reason.clone()));
        }
        match snapshot.left_moving {
            Some(LeftMoving { start }) => {
                let matter = Safety::LeftMoving { start, asks: true };
                alarms.raise(antenna_id, AlarmKind::Safety(matter), now);
            }
            None => alarms.clear(antenna_id, now, |kind| {
                matches!(kind, AlarmKind::Safety(Safety::LeftMoving { asks: true, .. }))
            }),
        }
        let silent = AlarmKind::Safety(Safety::SilentInMotion);
        if snapshot.silent {
            alarms.raise(antenna_id, silent, now);
        } else {
            alarms.clear(antenna_id, now, |kind| *kind == silent);
        }
        if loses_positions {
            alarms.raise(antenna_id, AlarmKind::LosesPositions, now);
        } else {
            alarms.clear(antenna_id, now, |kind| *kind == AlarmKind::LosesPositions);
        }
        if !snapshot.locking {
            alarms.clear(antenna_id, now, |kind| *kind == AlarmKind::LockOutUnproved);
        }
        let checks = &snapshot.state.checks;
        if snapshot.link == LinkState::Off {
            // While Azel wants no link, these alarms are not wanted either.
            alarms.clear(antenna_id, now, |kind| {
                matches!(kind, AlarmKind::LinkLost(_) | AlarmKind::Check(_))
            });
        } else {
            for check in checks.iter() {
                if matches!(check.state, CheckState::Caution | CheckState::Fault) {
                    alarms.raise(antenna_id, AlarmKind::Check(check.clone()), now);
                }
            }
            alarms.clear(
                antenna_id,
                now,
                |kind| matches!(kind, AlarmKind::Check(old) if is_over(old, checks)),
            );
        }
        if let Some(explanation) = snapshot.state.unreadable {
            alarms.raise(antenna_id, AlarmKind::Unreadable(explanation), now);
        } else {
            alarms.clear(antenna_id, now, |kind| matches!(kind, AlarmKind::Unreadable(_)));
        }
        if let Some(clock) = snapshot.state.on_board.clock {
            if clock.is_set && clock.is_surely_off() {
                alarms.raise(antenna_id, AlarmKind::ClockOff(clock.ahead_s), now);
            } else if !clock.is_set || !clock.may_be_off() {
                alarms.clear(antenna_id, now, |kind| matches!(kind, AlarmKind::ClockOff(_)));
            }
            if clock.is_set {
                alarms.clear(antenna_id, now, |kind| *kind == AlarmKind::ClockNotSet);
            } else {
                alarms.raise(antenna_id, AlarmKind::ClockNotSet, now);
            }
        }
    }
}
