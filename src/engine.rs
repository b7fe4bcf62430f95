//! A running station: its antennas, elements, passes, alarms and the work on units, on
//! a thread of its own. A client sends [`Command`]s and takes [`Snapshot`]s and
//! [`Event`]s; the station does not know whether there is one.

pub mod alarms;
pub mod antenna;
mod carry_out;
pub mod claim;
mod claims;
mod clock_watch;
pub mod closing;
mod command;
pub mod copies;
mod demo;
mod handle;
pub mod host_keys;
mod lock_outs;
pub mod on_board;
mod owed;
pub mod passes;
pub mod signals;
mod snapshot;
#[cfg(unix)]
pub mod socket;
pub mod source_tests;
pub mod sources;
pub mod status;
pub mod track_again;
mod turn;
pub mod uploads;
mod write_settings;
mod written;

use std::{
    io,
    path::{Path, PathBuf},
    sync::Arc,
    time::Duration,
};

use jiff::Timestamp;
use tokio::sync::{Notify, mpsc, watch};

use self::{
    alarms::{AlarmKind, Alarms},
    antenna::AntennaModel,
    claim::{Claim, Claims, HeldBy, HolderKind},
    clock_watch::ClockWatch,
    closing::Closing,
    copies::{Copies, CopyWork},
    demo::Demo,
    handle::{AntennaEnds, Published, Request},
    passes::{PassLists, Searches},
    source_tests::SourceTests,
    sources::{Outcome, Places, SourceWork, Sources, Task},
    uploads::Uploads,
};
pub use self::{
    command::{Attention, Command},
    handle::{Client, Event, Handle, Stopped},
    snapshot::{CatalogState, Snapshot},
};
use crate::{
    clock::{Clock, Instant},
    driver::{AntennaHandle, Driver, JOG_LEASE, Outside, TimeSync, Unit},
    job::{Job, Wake},
    makes::{self, DemoAddresses},
    plan::Bounds,
    station::{self, AntennaId, LoadError, LockOuts, Station},
};

/// What the sessions tell is taken at most this often: a change is shown with the next
/// frame of a window.
const BREATH: Duration = Duration::from_millis(10);

/// A motion that the station could not take up for so long is not wanted any more.
const TOO_LATE: Duration = Duration::from_secs(2);

/// Where a station keeps what it keeps.
#[derive(Debug, Clone, Default)]
pub struct Settings {
    /// Where the station file is; `None` for the user's own.
    pub path: Option<PathBuf>,
    /// Where elements from servers are kept; `None` for the user's own folder.
    pub library: Option<PathBuf>,
    /// Where host keys, old uploads and secrets are kept; `None` for the user's
    /// own places.
    pub upload_places: Option<uploads::Places>,
    /// The program that is started as the dead-man; `None` for none.
    pub dead_man: Option<PathBuf>,
    /// Where motions by hand are marked; `None` for nowhere.
    pub marks: Option<PathBuf>,
    /// Where the station and its units are claimed, and in which role; `None` where no
    /// other Azel is looked for.
    pub claims: Option<(PathBuf, HolderKind)>,
}

impl Settings {
    /// Where the station file is, if this user has a place for one.
    pub fn station_path(&self) -> Option<PathBuf> {
        self.path.clone().or_else(station::settings_path)
    }

    /// Where elements from servers are kept, if this user has a place for them.
    pub fn library_path(&self) -> Option<PathBuf> {
        let station = self.station_path();
        let places = Places::new(station.as_deref(), self.library.clone());
        places.library().map(Path::to_path_buf)
    }
}

/// Where a station tells its client what happens.
struct Outbox {
    events: mpsc::Sender<Event>,
    wake: Wake,
}

/// A running station, on its thread.
struct Engine {
    /// UTC of this turn.
    now: Timestamp,
    /// The steady clock of this turn, for ages.
    steady: Instant,
    time_sync: TimeSync,
    station: Arc<Station>,
    catalog: CatalogState,
    catalog_revision: u64,
    sources: Sources,
    antennas: Vec<Antenna>,
    /// How many sessions were begun.
    sessions: u64,
    attention: Attention,
    searches: Searches,
    pass_lists: PassLists,
    uploads: Uploads,
    source_tests: SourceTests,
    alarms: Alarms,
    copies: Copies,
    closing: Option<Closing>,
    // The sessions end before their thread does, and that before their units.
    driver: Driver,
    demo: Option<DemoStation>,
    clock: Clock,
    clock_watch: ClockWatch,
    wake: Wake,
    woken: Arc<Notify>,
    settings_path: Option<PathBuf>,
    places: Places,
    elements_job: Option<Job<Outcome>>,
    /// The last reading of the elements broke off.
    elements_broke_off: bool,
    copy_work: CopyWork,
    upload_desk: uploads::Desk,
    source_desk: source_tests::Desk,
    lock_outs: LockOuts,
    claims: Option<Claims>,
    /// Where it takes STOP from other programs, once it has the station file.
    socket: Option<PathBuf>,
    station_claim: StationClaim,
    /// The second of the clock in which the claims were looked at.
    claims_looked_at: i64,
    /// The settings on disk could not be read: only the operator may replace them.
    settings_unread: bool,
    /// The number of what a client asked for, while it is carried out.
    asked: Option<u64>,
    told: Vec<Event>,
    outbox: Outbox,
    /// What its socket does with it.
    #[cfg_attr(not(unix), allow(dead_code, reason = "there is no socket"))]
    client: Client,
    publish: watch::Sender<Published>,
}

/// One antenna and its session.
struct Antenna {
    shown: AntennaModel,
    /// Tells this session from others of the same antenna.
    session: u64,
    handle: AntennaHandle,
}

/// Who has the station file open.
enum StationClaim {
    /// There is no file yet, or no claim is made.
    None,
    /// This station.
    Ours { _claim: Claim },
    /// Another Azel of this machine.
    Theirs(HeldBy),
}

/// The station with simulated antennas, before and after they run.
enum DemoStation {
    /// The addresses are known once the simulators run.
    Coming,
    Running {
        _demo: Demo,
    },
}

impl Engine {
    /// A station as its settings say.
    fn new(
        settings: &Settings,
        outside: Outside,
        outbox: Outbox,
        requests: mpsc::WeakSender<Request>,
    ) -> io::Result<(Self, Client)> {
        let settings_path = settings.station_path();
        let woken = Arc::new(Notify::new());
        let wake: Wake = {
            let woken = Arc::clone(&woken);
            Arc::new(move || woken.notify_one())
        };
        let clock = outside.clock.clone();
        let driver = Driver::start(outside, Arc::clone(&wake))?
            .guarded_by(settings.dead_man.clone())
            .marking_in(settings.marks.clone());
        let places = Places::new(settings_path.as_deref(), settings.library.clone());
        let elements_job =
            sources::start(&places, Task::default(), clock.utc(), Arc::clone(&wake))?;
        let upload_places = settings.upload_places.clone().or_else(uploads::Places::of_this_user);
        let upload_desk =
            uploads::Desk::new(upload_places.clone(), clock.clone(), Arc::clone(&wake));
        let source_desk = source_tests::Desk::new(upload_places, clock.clone(), Arc::clone(&wake));
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
        );
        let mut engine = Self {
            now: now.utc,
            steady: now.steady,
            time_sync: TimeSync::NotKnown,
            station: Arc::default(),
            demo: None,
            catalog: CatalogState::Loading,
            catalog_revision: 0,
            sources: Sources { work: SourceWork::Reading, ..Sources::default() },
            antennas: Vec::new(),
            sessions: 0,
            attention: Attention::default(),
            searches: Searches::default(),
            pass_lists: PassLists::default(),
            uploads: Uploads::default(),
            source_tests: SourceTests::default(),
            alarms: Alarms::default(),
            copies: Copies::default(),
            closing: None,
            driver,
            clock,
            clock_watch: ClockWatch::default(),
            wake,
            woken,
            copy_work: CopyWork::beside(settings_path.as_deref()),
            settings_path,
            places,
            elements_job: Some(elements_job),
            elements_broke_off: false,
            upload_desk,
            source_desk,
            lock_outs: LockOuts::default(),
            claims: None,
            socket: None,
            station_claim: StationClaim::None,
            claims_looked_at: 0,
            settings_unread: false,
            asked: None,
            told: Vec::new(),
            outbox,
            client: client.clone(),
            publish,
        };
        engine.take_claims(settings.claims.clone());
        engine.load_lock_outs();
        engine.load_station();
        engine.publish();
        Ok((engine, client))
    }

    /// Runs until nobody is there to send requests.
    async fn run(mut self, mut inbox: mpsc::Receiver<Request>) {
        let woken = Arc::clone(&self.woken);
        loop {
            let mut request = tokio::select! {
                biased;
                request = inbox.recv() => match request {
                    Some(request) => Some(request),
                    None => break,
                },
                () = woken.notified() => {
                    // More comes in at the same moment; a request is not kept waiting.
                    match self.clock.timeout(BREATH, inbox.recv()).await {
                        Ok(None) => break,
                        taken => taken.ok().flatten(),
                    }
                }
                () = self.clock.sleep(to_next_second(self.clock.utc())) => {
                    self.set_time();
                    self.take_urgent();
                    self.turn();
                    self.take_urgent();
                    self.publish();
                    continue;
                }
            };
            self.set_time();
            self.take_urgent();
            let mut is_jog_alone = request.is_some();
            while let Some(next) = request {
                is_jog_alone &= next.is_jog();
                self.take_request(next);
                request = inbox.try_recv().ok();
            }
            if is_jog_alone {
                // A key that is held changes nothing but its lease, many times a second.
                continue;
            }
            // What has woken it until now is taken by this turn.
            tokio::select! {
                biased;
                () = woken.notified() => {}
                () = std::future::ready(()) => {}
            }
            self.turn();
            // STOP in the meantime has not reached a session that was opened meanwhile.
            self.take_urgent();
            self.publish();
            (self.outbox.wake)();
        }
        self.take_urgent();
    }

    /// Takes what does not wait behind requests.
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
        let Request { command, number, at } = request;
        let age = self.steady.saturating_duration_since(at);
        if is_jog && age > JOG_LEASE {
            // The key may be up by now; its release comes behind it.
            return;
        }
        if command.may_move() && age > TOO_LATE {
            tracing::error!(?command, ?age, "too late to be carried out");
            return self.alarms.raise(None, AlarmKind::NotTaken, self.now);
        }
        self.asked = Some(number);
        self.carry_out(command);
        self.asked = None;
    }

    fn set_time(&mut self) {
        let now = self.clock.now();
        (self.now, self.steady) = (now.utc, now.steady);
    }

    /// Shows the station as it is now.
    fn publish(&mut self) {
        let last = Arc::clone(&self.publish.borrow().snapshot);
        let snapshot = Arc::new(Snapshot {
            at: self.clock.now(),
            time_sync: self.time_sync,
            station: Arc::clone(&self.station),
            demo: self.demo.is_some(),
            catalog: self.catalog.clone(),
            catalog_revision: self.catalog_revision,
            sources: shared(&self.sources, &last.sources),
            antennas: self.antennas.iter().map(|antenna| antenna.shown.clone()).collect(),
            pass_lists: self.pass_lists.clone(),
            uploads: shared(&self.uploads, &last.uploads),
            source_tests: shared(&self.source_tests, &last.source_tests),
            alarms: self.alarms.clone(),
            copies: shared(&self.copies, &last.copies),
            closing: self.closing.clone(),
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
        self.publish.send_replace(Published { snapshot, ends });
        // What they tell of is shown by now.
        for event in std::mem::take(&mut self.told) {
            if self.outbox.events.try_send(event).is_err() {
                tracing::warn!("an event is not told: nobody reads them");
            }
        }
    }

    /// Tells the client, once what it is about is shown.
    fn tell(&mut self, event: Event) {
        self.told.push(event);
    }

    fn load_station(&mut self) {
        // What ran until now ends once something else is taken into use.
        let _demo = self.demo.take();
        let loaded = match &self.settings_path {
            Some(path) => station::load(path, makes::SPECS),
            None => Err(LoadError::Missing),
        };
        match loaded {
            Ok(loaded) => {
                for note in loaded.notes {
                    self.alarms.raise(None, AlarmKind::Setting(note), self.now);
                }
                self.use_station(loaded.station);
            }
            Err(LoadError::Missing) => {
                self.station_claim = StationClaim::None;
                self.demo = Some(DemoStation::Coming);
                self.use_station(Station {
                    antennas: Vec::new(),
                    ..Station::demo(&DemoAddresses::default())
                });
            }
            Err(error) => {
                let text = error.to_string();
                tracing::error!("{text}");
                self.alarms.raise(None, AlarmKind::Settings(text), self.now);
                // Nothing is connected and nothing is overwritten by itself.
                self.settings_unread = true;
                self.use_station(Station::default());
            }
        }
    }

    /// Takes a station into use. Antennas that stay as they are keep their session.
    fn use_station(&mut self, station: Station) {
        self.keep_locked_out(&station.antennas);
        let mut before = std::mem::take(&mut self.antennas);
        // The antenna may be the same one at a new address: then STOP is owed to both.
        let debts = self.driver.debts().clone();
        let owed: Vec<String> = (before.iter())
            .filter(|antenna| debts.owes(&Unit::of(&antenna.shown.config)))
            .map(|antenna| antenna.shown.config.name.clone())
            .collect();
        // A unit has one place for a client: the old session leaves first.
        before.retain(|antenna| {
            antenna.shown.held_by.is_none() && station.antennas.contains(&antenna.shown.config)
        });
        for config in &station.antennas {
            let bounds = Bounds::of(&station, config);
            let kept = before.iter().position(|antenna| antenna.shown.config == *config);
            let antenna = if let Some(kept) = kept {
                let antenna = before.swap_remove(kept);
                antenna.handle.keep_within(bounds);
                antenna
            } else {
                let antenna = self.open_antenna(config.clone(), bounds);
                if owed.contains(&config.name) {
                    antenna.handle.stop();
                }
                antenna
            };
            self.antennas.push(antenna);
        }
        self.station = Arc::new(station);
        let ids: Vec<AntennaId> = self.antennas.iter().map(|of| of.shown.id()).collect();
        self.alarms.keep_only(&ids);
        // STOP goes to the new sessions from now on.
        self.publish();
    }

    fn open_antenna(&mut self, config: station::Antenna, bounds: Bounds) -> Antenna {
        let claim = self.claim_unit(&config);
        self.open_claimed(config, bounds, claim)
    }

    /// Opens an antenna whose unit is claimed, or leaves it to who has it.
    fn open_claimed(
        &mut self,
        config: station::Antenna,
        bounds: Bounds,
        claim: Result<Option<Claim>, HeldBy>,
    ) -> Antenna {
        self.sessions += 1;
        let (handle, held_by) = match claim {
            Ok(claim) => {
                let lock_out = self.lock_outs.of(&config.connection).cloned();
                // The unit is ours until its session has ended.
                let until_the_end = Box::new(claim);
                (self.driver.open(&config, bounds, lock_out, until_the_end), None)
            }
            Err(held_by) => (Driver::leave_alone(&config), Some(held_by)),
        };
        let mut shown = AntennaModel::new(config, handle.snapshot());
        shown.held_by = held_by;
        Antenna { shown, session: self.sessions, handle }
    }

    /// The place of an antenna, if the station still has it.
    fn place(&self, id: AntennaId) -> Option<usize> {
        self.antennas.iter().position(|antenna| antenna.shown.id() == id)
    }
}

/// A station that breaks down stops what it has moved, before its sessions go.
impl Drop for Engine {
    fn drop(&mut self) {
        if std::thread::panicking() {
            for antenna in &self.antennas {
                antenna.handle.stop();
            }
        }
    }
}

/// What is shared, made anew where it has changed.
fn shared<T: Clone + PartialEq>(now: &T, last: &Arc<T>) -> Arc<T> {
    if *now == **last { Arc::clone(last) } else { Arc::new(now.clone()) }
}

/// To a little before the next full second, with which a window draws anew.
fn to_next_second(now: Timestamp) -> Duration {
    const BEFORE_NS: u64 = 10_000_000;
    let into_ns = u64::from(now.subsec_nanosecond().unsigned_abs());
    let to_ns = (2_000_000_000 - BEFORE_NS - into_ns) % 1_000_000_000;
    // A clock that stands must not make a turn at once, again and again.
    Duration::from_nanos(to_ns).max(Duration::from_millis(5))
}
