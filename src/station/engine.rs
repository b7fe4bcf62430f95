//! Station on its own thread: antennas, elements, passes, alarms and the work on units. Clients
//! send [`Command`](crate::contract::Command)s and take [`Snapshot`]s and [`Event`]s. The station
//! also runs without clients.

pub mod alarms;
pub mod antenna;
pub mod automatic;
mod carry_out;
pub mod claim;
mod claims;
mod clock_watch;
pub mod closing;
mod control;
mod copies;
mod demo;
mod element_alarms;
pub mod film;
mod handle;
mod hooks;
pub mod host_keys;
pub mod in_place;
mod learned;
pub mod link_tests;
mod lock_outs;
mod metrics;
pub mod older_sets;
pub mod on_board;
mod opening;
mod owed;
pub mod passes;
pub mod pointing_fit;
mod ports;
#[cfg(unix)]
pub mod reach;
pub mod recorded;
mod recording;
pub mod reminders;
pub mod schedule;
mod settings;
pub mod signals;
#[cfg(unix)]
pub mod socket;
pub mod source_tests;
pub mod sources;
pub mod status;
#[cfg(unix)]
mod stop_elsewhere;
pub mod track_again;
mod turn;
pub mod uploads;
mod use_station;
mod write_settings;

use std::{
    io,
    path::PathBuf,
    sync::{Arc, Weak},
    time::Duration,
};

use jiff::Timestamp;
use tokio::sync::{Notify, mpsc, watch};

use self::{
    automatic::{AtWork, LastRun, RuleUpload},
    claim::{Claim, UnitClaim, lock::Lock},
    claims::{ClaimsInUse, NoClaims},
    clock_watch::ClockWatch,
    copies::CopyWork,
    demo::Demo,
    handle::{AntennaEnds, Published, Request},
    hooks::Hooks,
    learned::LearnedDrives,
    metrics::Metrics,
    passes::Searches,
    pointing_fit::PointingWork,
    ports::Ports,
    recorded::RecordReading,
    recording::Recording,
    schedule::Scheduler,
    sources::{Outcome, Passwords, Places, Task},
};
pub use self::{
    handle::{Client, Handle, Stopped},
    opening::{CannotOpen, look_at},
    recording::{demo_record_path, record_path, records_folder},
    settings::Settings,
};
use crate::{
    clock::{Clock, Instant},
    contract::{
        Attention, CatalogState, CommandOrigin, Event, Snapshot,
        alarms::{AlarmKind, Alarms},
        antenna::AntennaModel,
        automatic::DayLine,
        claim::HeldBy,
        closing::Closing,
        copies::Copies,
        driver::{TimeSync, Unit},
        link_tests::LinkTest,
        older_sets::OlderSets,
        passes::PassLists,
        reminders::Reminder,
        schedule::Planned,
        source_tests::SourceTests,
        sources::Sources,
        uploads::Uploads,
    },
    driver::{AntennaHandle, Driver, JOG_LEASE, Outside},
    engine::{alarms::KeepAlarms, antenna::Recent},
    job::{Job, Wake},
    station::{LockOuts, Station},
};

/// Min time between two readings of the sessions' reports. A window still shows a change in its
/// next frame.
const BREATH: Duration = Duration::from_millis(10);

/// Max age of a motion request; the engine refuses an older one.
const TOO_LATE: Duration = Duration::from_secs(2);

/// Channel of events to the client, with its wake.
struct Outbox {
    events: mpsc::Sender<Event>,
    wake: Wake,
}

/// Running station on its thread.
struct Engine {
    /// UTC of this turn.
    now: Timestamp,
    /// Steady clock of this turn, for ages.
    steady: Instant,
    time_sync: TimeSync,
    station: Arc<Station>,
    /// Time of the last write of the station file.
    station_saved_at: Option<Timestamp>,
    catalog: CatalogState,
    catalog_revision: u64,
    sources: Sources,
    antennas: Vec<Antenna>,
    /// Number of sessions opened so far.
    sessions: u64,
    /// `true` once the antennas of the first station are open.
    has_started: bool,
    attention: Attention,
    searches: Searches,
    pass_lists: PassLists,
    reminders: Vec<Reminder>,
    scheduler: Scheduler,
    schedule: Arc<Planned>,
    /// Outcomes of the passes of this day, and events of automatic operation.
    day: Vec<DayLine>,
    last_run: LastRun,
    learned_drives: LearnedDrives,
    /// Upload that a rule has begun.
    rule_upload: Option<RuleUpload>,
    uploads: Uploads,
    source_tests: SourceTests,
    link_tests: Vec<LinkTest>,
    alarms: Alarms,
    copies: Copies,
    closing: Option<Closing>,
    // Drop order: sessions before their thread, the thread before the record, the record before the
    // simulated units.
    driver: Driver,
    recording: Recording,
    demo: Option<DemoStation>,
    clock: Clock,
    clock_watch: ClockWatch,
    wake: Wake,
    woken: Arc<Notify>,
    settings_path: Option<PathBuf>,
    places: Places,
    elements_job: Option<Job<Outcome>>,
    /// `true` if the elements came with the settings; Azel then reads no sources.
    has_given_elements: bool,
    /// Station whose source priorities the last reading applied.
    ordered_for: Arc<Station>,
    /// Names of sources with a typed password. Azel asks their servers once no other work on
    /// elements is under way.
    typed_passwords: Vec<String>,
    passwords: Option<Passwords>,
    /// Time of the last request to servers without a client.
    refreshed_at: Option<Timestamp>,
    older_sets: Option<Arc<OlderSets>>,
    older_reading: older_sets::Reading,
    record_reading: RecordReading,
    pointing_work: PointingWork,
    /// `true` if the last reading of the elements broke off.
    elements_broke_off: bool,
    copy_work: CopyWork,
    upload_runner: uploads::Runner,
    source_test_runner: source_tests::Runner,
    link_test_runner: link_tests::Runner,
    lock_outs: LockOuts,
    /// Claims in use; `None` if claims are switched off.
    claims: Option<Result<ClaimsInUse, NoClaims>>,
    station_claim: StationClaim,
    /// Sessions that only settle debts, with the claims on their units.
    left_units: Vec<(Unit, Weak<UnitClaim>)>,
    /// Clock second of the last check of the claims.
    claims_looked_at: i64,
    /// `true` if the station file could not be read: only the operator may replace it.
    settings_unread: bool,
    /// Request that the engine is carrying out.
    current_request: Option<CurrentRequest>,
    events: Vec<Event>,
    outbox: Outbox,
    /// Client that the engine hands to the socket.
    #[cfg_attr(not(unix), allow(dead_code, reason = "there is no socket"))]
    client: Client,
    /// Ports for other programs; `None` in a rehearsal.
    ports: Option<Ports>,
    /// Server of metrics; `None` in a rehearsal.
    metrics: Option<Metrics>,
    hooks: Hooks,
    publish: watch::Sender<Published>,
}

/// Request being carried out: its number and its origin.
#[derive(Debug, Clone, Copy)]
struct CurrentRequest {
    number: u64,
    origin: CommandOrigin,
}

/// Antenna and its session.
struct Antenna {
    shown: AntennaModel,
    /// Measurements from which the rates of its axes are computed.
    recent: Recent,
    /// Number that tells sessions of the same antenna apart.
    session: u64,
    handle: AntennaHandle,
    at_work: AtWork,
    hold: Hold,
}

/// Process that holds the unit of an antenna.
enum Hold {
    /// This process; without a claim if Azel ignores other processes.
    Ours(Option<Claim>),
    /// Another process, with its lock; `None` if no lock could be tried.
    Elsewhere(Option<String>),
}

/// Claim on the station file.
enum StationClaim {
    /// No file yet, or claims switched off.
    None,
    /// Claim of this station.
    Ours {
        /// Closed before the lock is released, so that no client asks a closed station.
        #[cfg(unix)]
        _served: Option<socket::Served>,
        claim: Arc<Lock>,
    },
    /// Claim of another Azel on this machine.
    Theirs(HeldBy),
}

/// Demo station with simulated antennas, before and after the simulators run.
enum DemoStation {
    /// Not running yet: the simulators choose the addresses when they start.
    Coming,
    Running {
        _demo: Demo,
    },
}

impl Engine {
    /// Creates a station with these settings, and a driver on a thread of its own.
    fn new(
        settings: &Settings,
        outside: Outside,
        outbox: Outbox,
        requests: mpsc::WeakSender<Request>,
    ) -> io::Result<(Self, Client)> {
        let woken = Arc::new(Notify::new());
        let driver = Driver::start(outside.clone(), wake_of(&woken))?
            .guarded_by(settings.dead_man.clone())
            .marking_in(settings.marks.clone());
        let (mut engine, client) =
            Self::driving(driver, woken, settings, outside, outbox, requests);
        engine.ports = Some(Ports::start(client.clone())?);
        engine.open_ports();
        engine.metrics = Some(Metrics::new(client.clone()));
        engine.open_metrics();
        engine.hooks.enable();
        Ok((engine, client))
    }

    /// Creates a station whose antennas `driver` drives; its wake notifies `woken`.
    #[expect(clippy::too_many_lines, reason = "one line a field")]
    fn driving(
        driver: Driver,
        woken: Arc<Notify>,
        settings: &Settings,
        outside: Outside,
        outbox: Outbox,
        requests: mpsc::WeakSender<Request>,
    ) -> (Self, Client) {
        let settings_path = settings.station_path();
        let wake = wake_of(&woken);
        let clock = outside.clock.clone();
        let link_test_runner = link_tests::Runner::new(outside, Arc::clone(&wake));
        let places = Places::new(settings_path.as_deref(), settings.library.clone());
        let loaded = settings.elements.clone();
        let has_given_elements = loaded.is_some();
        let catalog = loaded.map_or(CatalogState::Loading, CatalogState::Ready);
        let upload_places = settings.upload_places.clone().or_else(uploads::Places::of_this_user);
        let passwords = upload_places.as_ref().map(Passwords::new);
        let upload_runner =
            uploads::Runner::new(upload_places.clone(), clock.clone(), Arc::clone(&wake));
        let source_test_runner =
            source_tests::Runner::new(upload_places, clock.clone(), Arc::clone(&wake));
        let now = clock.now();
        let snapshot = Arc::new(Snapshot::before_anything(now));
        let published = Published { snapshot, ends: Arc::new([]) };
        let (publish, published) = watch::channel(published);
        let client = Client::new(
            requests,
            Arc::clone(&woken),
            driver.orders().clone(),
            published,
            clock.clone(),
            client_origin(settings),
        );
        let mut engine = Self {
            now: now.utc,
            steady: now.steady,
            time_sync: TimeSync::NotKnown,
            station: Arc::default(),
            station_saved_at: None,
            demo: None,
            catalog,
            catalog_revision: 0,
            sources: Sources::default(),
            antennas: Vec::new(),
            sessions: 0,
            has_started: false,
            attention: Attention::default(),
            searches: Searches::default(),
            pass_lists: PassLists::default(),
            reminders: Vec::new(),
            scheduler: Scheduler::default(),
            schedule: Arc::default(),
            day: Vec::new(),
            last_run: LastRun::default(),
            learned_drives: LearnedDrives::default(),
            rule_upload: None,
            uploads: Uploads::default(),
            source_tests: SourceTests::default(),
            link_tests: Vec::new(),
            alarms: Alarms::default(),
            copies: Copies::default(),
            recording: Recording::new(settings.records.clone(), settings.reports.clone()),
            closing: None,
            driver,
            clock,
            clock_watch: ClockWatch::default(),
            wake,
            woken,
            copy_work: CopyWork::new(settings_path.as_deref()),
            settings_path,
            places,
            elements_job: None,
            has_given_elements,
            ordered_for: Arc::default(),
            typed_passwords: Vec::new(),
            passwords,
            refreshed_at: None,
            older_sets: None,
            older_reading: older_sets::Reading::default(),
            record_reading: RecordReading::default(),
            pointing_work: PointingWork::default(),
            elements_broke_off: false,
            upload_runner,
            source_test_runner,
            link_test_runner,
            lock_outs: LockOuts::default(),
            claims: None,
            station_claim: StationClaim::None,
            left_units: Vec::new(),
            claims_looked_at: 0,
            settings_unread: false,
            current_request: None,
            events: Vec::new(),
            outbox,
            client: client.clone(),
            ports: None,
            metrics: None,
            hooks: Hooks::new(now.utc),
            publish,
        };
        engine.take_claims(settings.claims.clone());
        engine.load_lock_outs();
        engine.load_station();
        if !has_given_elements {
            engine.start_elements(Task::default());
        }
        engine.has_started = true;
        engine.start_automatic();
        engine.publish();
        (engine, client)
    }

    /// Runs until the last sender of requests is gone.
    async fn run(mut self, mut inbox: mpsc::Receiver<Request>) {
        let woken = Arc::clone(&self.woken);
        loop {
            // A client's look at another pass needs no wake: the next frame shows the answer.
            let mut is_look_alone = true;
            let mut request = tokio::select! {
                biased;
                request = inbox.recv() => match request {
                    Some(request) => Some(request),
                    None => break,
                },
                () = woken.notified() => {
                    is_look_alone = false;
                    // More wakes may follow at once; a request still interrupts this pause.
                    match self.clock.timeout(BREATH, inbox.recv()).await {
                        Ok(None) => break,
                        lock_result => lock_result.ok().flatten(),
                    }
                }
                () = self.clock.sleep(to_next_second(self.clock.utc())) => {
                    self.set_time();
                    let turn = self.driver.orders().next();
                    self.take_urgent();
                    self.turn(turn);
                    self.take_urgent();
                    self.publish();
                    continue;
                }
            };
            self.set_time();
            let turn = self.driver.orders().next();
            self.take_urgent();
            let mut is_jog_alone = request.is_some();
            while let Some(next) = request {
                is_jog_alone &= next.is_jog();
                is_look_alone &= next.is_look(self.attention.list);
                self.take_request(next);
                request = inbox.try_recv().ok();
            }
            if is_jog_alone {
                // A held jog key only renews its lease, many times a second.
                continue;
            }
            // This turn handles all wakes so far.
            tokio::select! {
                biased;
                () = woken.notified() => is_look_alone = false,
                () = std::future::ready(()) => {}
            }
            self.turn(turn);
            // A STOP pressed during the turn has not reached a session that the turn opened.
            self.take_urgent();
            self.publish();
            if !is_look_alone {
                (self.outbox.wake)();
            }
        }
        self.take_urgent();
        self.set_time();
        self.report_last_passes();
        self.end_automatic();
        self.save_learned_drives(true);
    }

    /// Handles items that must not wait behind requests.
    fn take_urgent(&mut self) {
        let urgent = std::mem::take(&mut *self.client.urgent());
        for stopped in &urgent.stops {
            self.note_stop(stopped);
        }
        if urgent.ends_unasked {
            self.end_unasked();
        }
        if urgent.is_stop_lost {
            self.alarms.raise(None, AlarmKind::StopNotElsewhere, self.now);
        }
        if urgent.has_turned_away {
            tracing::error!("the station was too busy to take what was asked for");
            self.alarms.raise(None, AlarmKind::NotTaken, self.now);
        }
    }

    fn take_request(&mut self, request: Request) {
        let is_jog = request.is_jog();
        let Request { command, origin, number, instant } = request;
        let age = self.steady.saturating_duration_since(instant);
        if is_jog && age > JOG_LEASE {
            // The operator may have released the key; the release command follows.
            return;
        }
        if command.row().void_after_stop && age > TOO_LATE {
            tracing::error!(?command, ?age, "too late to be carried out");
            return self.alarms.raise(None, AlarmKind::NotTaken, self.now);
        }
        self.note_command(&command, origin);
        self.current_request = Some(CurrentRequest { number, origin });
        self.carry_out(command);
        self.current_request = None;
    }

    fn set_time(&mut self) {
        let now = self.clock.now();
        (self.now, self.steady) = (now.utc, now.steady);
    }

    /// Publishes the current state of the station.
    fn publish(&mut self) {
        let last = Arc::clone(&self.publish.borrow().snapshot);
        let snapshot = Arc::new(Snapshot {
            moment: self.clock.now(),
            time_sync: self.time_sync,
            station: Arc::clone(&self.station),
            station_saved_at: self.station_saved_at,
            demo: self.demo.is_some(),
            station_unread: self.settings_unread,
            catalog: self.catalog.clone(),
            catalog_revision: self.catalog_revision,
            sources: shared(&self.sources, &last.sources),
            antennas: self.antennas.iter().map(|antenna| antenna.shown.clone()).collect(),
            pass_lists: self.pass_lists.clone(),
            reminders: shared(&self.reminders, &last.reminders),
            schedule: Arc::clone(&self.schedule),
            swap: self.scheduler.swap(),
            day: shared(&self.day, &last.day),
            older_sets: self.older_sets.clone(),
            recorded: self.record_reading.found.clone(),
            pointing_fitted: self.pointing_work.fitted.clone(),
            peaks: Arc::clone(&self.pointing_work.peaks),
            uploads: shared(&self.uploads, &last.uploads),
            source_tests: shared(&self.source_tests, &last.source_tests),
            link_tests: shared(&self.link_tests, &last.link_tests),
            alarms: self.alarms.clone(),
            copies: shared(&self.copies, &last.copies),
            record: self.recording.status(),
            closing: self.closing.clone(),
            metrics: self.metrics.as_ref().map(Metrics::state).unwrap_or_default(),
            hooks: shared(self.hooks.shown(), &last.hooks),
        });
        let is_same = {
            let ends = &self.publish.borrow().ends;
            let sessions = self.antennas.iter().map(|antenna| antenna.session);
            ends.iter().map(|ends| ends.session).eq(sessions)
        };
        let ends = if is_same {
            Arc::clone(&self.publish.borrow().ends)
        } else {
            let ends = self.antennas.iter().map(|antenna| AntennaEnds {
                id: antenna.shown.id(),
                session: antenna.session,
                is_elsewhere: antenna.shown.held_by.is_some(),
                stopper: antenna.handle.stopper(),
                wire: antenna.handle.wire().clone(),
            });
            ends.collect()
        };
        self.recording.film(&snapshot);
        self.publish.send_replace(Published { snapshot, ends });
        // Events follow the snapshot that shows their subject.
        for event in std::mem::take(&mut self.events) {
            if self.outbox.events.try_send(event).is_err() {
                tracing::warn!("an event is not told: nobody reads them");
            }
        }
    }

    /// Queues an event for the client; the next publication sends it.
    fn tell(&mut self, event: Event) {
        self.events.push(event);
    }
}

/// Stops the antennas of a station that panics, before their sessions end.
impl Drop for Engine {
    fn drop(&mut self) {
        if std::thread::panicking() {
            for antenna in &self.antennas {
                antenna.handle.stop();
            }
        }
    }
}

/// Returns the origin of commands from the client in this process.
fn client_origin(settings: &Settings) -> CommandOrigin {
    settings.claims.as_ref().map_or_else(CommandOrigin::default, |(_, kind)| (*kind).into())
}

/// Returns a wake that notifies `woken`.
fn wake_of(woken: &Arc<Notify>) -> Wake {
    let woken = Arc::clone(woken);
    Arc::new(move || woken.notify_one())
}

/// Returns `last` if it equals `now`, else a new copy of `now`.
fn shared<T: Clone + PartialEq>(now: &T, last: &Arc<T>) -> Arc<T> {
    if *now == **last { Arc::clone(last) } else { Arc::new(now.clone()) }
}

/// Returns the time to shortly before the next full second, when a window redraws.
fn to_next_second(now: Timestamp) -> Duration {
    const BEFORE_NS: u64 = 10_000_000;
    let into_ns = u64::from(now.subsec_nanosecond().unsigned_abs());
    let to_ns = (2_000_000_000 - BEFORE_NS - into_ns) % 1_000_000_000;
    // A stopped clock must not cause one turn after another.
    Duration::from_nanos(to_ns).max(Duration::from_millis(5))
}
