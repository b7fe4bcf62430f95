//! Rehearsal: carries out the plan of a station against simulated units.
//!
//! All tasks share one runtime on one thread in tokio's paused time. Time passes only when engine,
//! sessions and simulators have nothing left to do, and jobs end as they start. A rehearsal
//! therefore runs as fast as the machine can, and repeats exactly.

mod fault;
mod pass;
mod units;

use std::{
    io,
    num::NonZeroU32,
    pin::pin,
    sync::Arc,
    thread,
    time::{Duration, Instant},
};

use jiff::Timestamp;
use tokio::sync::mpsc;

pub use self::fault::{Fault, FaultKind, WrongFault};
use self::{pass::Passes, units::Units};
use crate::{
    astro::time::{add_seconds, seconds_between},
    clock::Clock,
    contract::{Command, Snapshot, driver, rehearsal::Rehearsed},
    controller::SPECS,
    engine::{Client, Settings, in_place::InPlace, uploads},
    job,
    orbit::Catalog,
    record::PassNote,
    sim::Mechanics,
    station::{self, Antenna, SaveError, Station},
    transfer::{KeptFiles, KnownHosts, Limits, MemoryKeyring},
};

/// Lead before the rehearsal for links and a first plan, seconds.
const LEAD_S: f64 = 120.0;
/// Max time from the end of the rehearsal to the end of its last pass, seconds.
const LONGEST_PASS_S: f64 = 6.0 * 3600.0;
/// Max number of pending pass reports.
const REPORTS: usize = 64;

/// Station, time and faults of a rehearsal.
#[derive(Debug, Clone)]
pub struct Rehearsal {
    /// Station to copy; a rehearsal never changes its file.
    pub station: Station,
    pub elements: Arc<Catalog>,
    pub start: Timestamp,
    pub hours: f64,
    pub seed: u64,
    /// Imperfections of all axes.
    pub mechanics: Mechanics,
    pub faults: Vec<Fault>,
    /// Multiple of real time; `None` runs at full speed. The speed does not affect the result.
    pub speed: Option<NonZeroU32>,
}

#[derive(Debug, thiserror::Error)]
pub enum RehearsalError {
    #[error("there is no antenna with a simulated unit")]
    NoAntenna,
    #[error("there is no antenna {0} for a fault")]
    UnknownAntenna(String),
    #[error("the unit of {0} cannot have this fault")]
    ImpossibleFault(String),
    #[error("the copy of the station cannot be written: {0}")]
    Copy(#[from] SaveError),
    #[error("the rehearsal cannot be started: {0}")]
    Start(#[from] io::Error),
    #[error("the rehearsed station broke down")]
    BrokeDown,
    #[error("it was cancelled")]
    Cancelled,
}

/// Runs a rehearsal on this thread. Calls `tell` with each simulated time.
pub fn run(
    rehearsal: &Rehearsal,
    tell: &dyn Fn(Timestamp),
    is_cancelled: &dyn Fn() -> bool,
) -> Result<Rehearsed, RehearsalError> {
    let _jobs = job::InPlace::begin();
    // Mark the log lines: they concern no real unit.
    let _said = tracing::error_span!("rehearsal").entered();
    let runtime =
        tokio::runtime::Builder::new_current_thread().enable_time().start_paused(true).build()?;
    let folder = tempfile::tempdir()?;
    let rehearsed = runtime.block_on(async {
        let start = add_seconds(rehearsal.start, -LEAD_S);
        let clock = Clock::at_speed(start, NonZeroU32::MIN);
        let mut station = rehearsal.station.clone();
        // An upload would go to a real server.
        for antenna in &mut station.antennas {
            antenna.upkeep.uploads_elements = false;
        }
        let (units, left_out) = Units::new(
            &mut station,
            &rehearsal.elements,
            rehearsal.mechanics,
            rehearsal.seed,
            &clock,
        )?;
        let units = Arc::new(units);
        for fault in &rehearsal.faults {
            units.suffer(fault, rehearsal.start, &clock)?;
        }
        let path = folder.path().join("station.toml");
        station::save(&station, &path, SPECS)?;
        let (reports, receiver) = mpsc::channel(REPORTS);
        let settings = Settings {
            path: Some(path),
            library: Some(folder.path().join("elements")),
            upload_places: Some(upload_places(folder.path())),
            elements: Some(Arc::clone(&rehearsal.elements)),
            reports: Some(reports),
            ..Settings::default()
        };
        let (running, run) = InPlace::start(&settings, units.outside(&clock))?;
        let client = running.client().clone();
        switch_on(&client, &station.antennas);
        let passes =
            Passes::new(rehearsal.start, add_seconds(rehearsal.start, rehearsal.hours * 3600.0));
        let watch =
            Watch { client, notes: receiver, passes, pace: Pace::new(start, rehearsal.speed) };
        let mut run = pin!(run);
        tokio::select! {
            biased;
            watched = watch.until_the_end(tell, is_cancelled) => {
                watched.map(|passes| passes.rehearsed(rehearsal, &station, left_out))
            }
            () = &mut run => Err(RehearsalError::BrokeDown),
        }
    });
    // Do not wait for the sessions: no real unit needs their end.
    runtime.shutdown_background();
    rehearsed
}

/// Returns places inside `folder`: a rehearsal uploads nothing and reads no user data.
fn upload_places(folder: &std::path::Path) -> uploads::Places {
    let session = Arc::<MemoryKeyring>::default();
    uploads::Places {
        known_hosts: KnownHosts::new(folder.join("known_hosts")),
        kept_files: KeptFiles::new(folder.join("uploads")),
        keyring: session.clone(),
        session,
        limits: Limits::default(),
    }
}

/// Connects the antennas, and switches their automatic operation on.
fn switch_on(client: &Client, antennas: &[Antenna]) {
    for antenna in antennas {
        let waits = antenna.connection.variant().capabilities.waits_for_word;
        let connect = Command::Antenna(antenna.id, driver::Command::Connect);
        let switch_on = Command::SetAutomatic { antenna: antenna.id, is_on: true };
        for command in waits.then_some(connect).into_iter().chain([switch_on]) {
            // The queue holds these commands for any station.
            if client.send(command).is_err() {
                tracing::error!(antenna = antenna.name, "not switched on for the rehearsal");
            }
        }
    }
}

/// Watch over a rehearsed station.
struct Watch {
    client: Client,
    notes: mpsc::Receiver<PassNote>,
    passes: Passes,
    pace: Pace,
}

impl Watch {
    async fn until_the_end(
        mut self,
        tell: &dyn Fn(Timestamp),
        is_cancelled: &dyn Fn() -> bool,
    ) -> Result<Passes, RehearsalError> {
        while self.client.changed().await {
            if is_cancelled() {
                return Err(RehearsalError::Cancelled);
            }
            let snapshot = self.client.snapshot();
            self.look(&snapshot);
            let now = snapshot.moment.utc;
            let over_s = seconds_between(self.passes.end(), now);
            if over_s > LONGEST_PASS_S || over_s > 0.0 && self.passes.are_over(now) {
                return Ok(self.passes);
            }
            tell(now);
            self.pace.keep(now);
        }
        Err(RehearsalError::BrokeDown)
    }

    fn look(&mut self, snapshot: &Snapshot) {
        self.passes.take_plan(snapshot);
        self.passes.take_day(&snapshot.day);
        while let Ok(note) = self.notes.try_recv() {
            self.passes.take_report(note);
        }
    }
}

/// Pace of a rehearsal with a set speed.
struct Pace {
    start: Timestamp,
    begun: Instant,
    speed: Option<NonZeroU32>,
}

impl Pace {
    fn new(start: Timestamp, speed: Option<NonZeroU32>) -> Self {
        Self { start, begun: Instant::now(), speed }
    }

    /// Blocks the thread until `now` is due; the simulated time waits too.
    fn keep(&self, now: Timestamp) {
        let Some(speed) = self.speed else { return };
        let passed_s = seconds_between(self.start, now) / f64::from(speed.get());
        let due = Duration::try_from_secs_f64(passed_s).unwrap_or_default();
        thread::sleep(due.saturating_sub(self.begun.elapsed()));
    }
}
