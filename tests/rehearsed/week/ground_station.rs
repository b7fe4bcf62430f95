//! The station: a computer that can lose its power, and units that keep running.

use std::{
    collections::BTreeMap,
    fs,
    num::NonZeroU32,
    path::{Path, PathBuf},
    sync::{
        Arc,
        atomic::{AtomicBool, AtomicI64, Ordering},
    },
};

use azel::{
    astro::time::add_seconds,
    clock::Clock,
    contract::driver::TimeSync,
    controller::SPECS,
    driver::{Dial, Outside, Stream, UnitLock},
    engine::{Client, Settings, in_place::InPlace},
    job, library,
    makes::{self, DemoAddresses, Surroundings},
    orbit::{Elements, RefreshHours, Source, SourcePlace, bundled, write_omm_json},
    sim::{InMemory, Trouble},
    station::{self, Antenna, AntennaId, Resume, Station},
};
use jiff::Timestamp;
use tokio::task::JoinHandle;

use super::{faults::Faults, source::ElementServer};

const SATELLITES: usize = 60;
/// Revolutions a day that a low orbit exceeds.
const LOW_REV_DAY: f64 = 12.0;

/// A unit and its link.
#[derive(Clone)]
struct Linked {
    antenna: AntennaId,
    unit: Arc<dyn InMemory>,
    is_down: Arc<AtomicBool>,
}

impl Linked {
    fn dial(&self) -> Dial {
        let linked = self.clone();
        Box::new(move || {
            let linked = linked.clone();
            Box::pin(async move {
                if linked.is_down.load(Ordering::Relaxed) {
                    return Err(std::io::ErrorKind::ConnectionRefused.into());
                }
                let (near, far) = tokio::io::duplex(4096);
                tokio::spawn(linked.unit.serve(far));
                Ok(Box::new(near) as Box<dyn Stream>)
            })
        })
    }

    fn set_down(&self, is_down: bool) {
        self.is_down.store(is_down, Ordering::Relaxed);
        if is_down {
            self.unit.drop_clients();
        }
    }
}

pub(super) struct GroundStation {
    pub(super) source: ElementServer,
    station: Station,
    folder: tempfile::TempDir,
    units: Arc<Vec<Linked>>,
    true_clock: Clock,
    /// Lead of the computer's clock over true time, milliseconds.
    ahead_ms: Arc<AtomicI64>,
    running: Option<(InPlace, JoinHandle<()>)>,
    _jobs: job::InPlace,
}

impl GroundStation {
    pub(super) fn new(at: Timestamp, seed: u64, faults: &Faults) -> Self {
        let elements = satellites();
        let mut station = station(&elements, faults);
        let true_clock = Clock::at_speed(at, NonZeroU32::MIN);
        let (site, mechanics) = (station.site, faults.mechanics);
        let units = station.antennas.iter_mut().map(|antenna| {
            let seed = seed.rotate_left(16) ^ u64::from(antenna.id.0);
            let (clock, elements) = (true_clock.clone(), &elements[..]);
            let around = Surroundings { site, clock, elements, mechanics, seed };
            let unit = makes::unit_in_memory(antenna, &around).unwrap();
            // Only a Satrak has a clock that matters.
            unit.set_trouble(Trouble::ClockDrifts(faults.drift_s_day), true);
            Linked { antenna: antenna.id, unit, is_down: Arc::default() }
        });
        let units = Arc::new(units.collect::<Vec<_>>());
        let mut body = Vec::new();
        write_omm_json(&elements, &mut body).unwrap();
        let source = ElementServer::new(body);
        let folder = tempfile::tempdir().unwrap();
        station::save(&station, &folder.path().join("station.toml"), SPECS).unwrap();
        let listed = Source {
            name: "week".to_owned(),
            place: SourcePlace::Web(source.url()),
            refresh: Some(RefreshHours::from(2)),
        };
        library::save_sources(&[listed], &folder.path().join("sources.toml")).unwrap();
        Self {
            source,
            station,
            folder,
            units,
            true_clock,
            ahead_ms: Arc::default(),
            running: None,
            _jobs: job::InPlace::begin(),
        }
    }

    /// Starts the station on the computer.
    pub(super) fn start(&mut self) {
        let place = |name: &str| Some(self.folder.path().join(name));
        let settings = Settings {
            path: place("station.toml"),
            library: place("elements"),
            marks: place("marks"),
            records: place("records").filter(|_| std::env::var_os("AZEL_RECORDED").is_some()),
            ..Settings::default()
        };
        let (clock, ahead_ms) = (self.true_clock.clone(), Arc::clone(&self.ahead_ms));
        let clock = Clock::new(move || {
            add_seconds(clock.utc(), ahead_ms.load(Ordering::Relaxed) as f64 / 1e3)
        });
        let units = Arc::clone(&self.units);
        let dial = Arc::new(move |antenna: &Antenna, _: Arc<dyn UnitLock>| {
            units.iter().find(|linked| linked.antenna == antenna.id).unwrap().dial()
        });
        let time_sync = || TimeSync::Synchronised;
        let outside = Outside { dial, time_sync, ..Outside::from(clock) };
        let (station, run) = InPlace::start(&settings, outside).unwrap();
        self.running = Some((station, tokio::spawn(run)));
    }

    pub(super) fn is_running(&self) -> bool {
        self.running.is_some()
    }

    pub(super) fn client(&self) -> Client {
        self.running.as_ref().unwrap().0.client().clone()
    }

    pub(super) fn true_time(&self) -> Timestamp {
        self.true_clock.utc()
    }

    pub(super) fn names(&self) -> Vec<String> {
        self.station.antennas.iter().map(|antenna| antenna.name.clone()).collect()
    }

    pub(super) fn antennas(&self) -> Vec<AntennaId> {
        self.station.antennas.iter().map(|antenna| antenna.id).collect()
    }

    /// Breaks the link of an antenna, or lets it come up again.
    pub(super) fn set_down(&self, antenna: usize, is_down: bool) {
        self.units[antenna].set_down(is_down);
    }

    /// Steps the clock of the computer by `by_s` seconds.
    pub(super) fn step_clock(&self, by_s: f64) {
        self.ahead_ms.fetch_add((by_s * 1e3).round() as i64, Ordering::Relaxed);
    }

    /// Cuts the power of computer and units. No request reaches a unit any more, and the files stay
    /// unchanged.
    pub(super) async fn cut_power(&mut self) {
        for linked in self.units.iter() {
            linked.set_down(true);
            linked.unit.cut_power();
        }
        let files = files_in(self.folder.path());
        let (station, run) = self.running.take().unwrap();
        drop(station);
        run.await.unwrap();
        for (path, _) in files_in(self.folder.path()) {
            fs::remove_file(path).unwrap();
        }
        for (path, content) in files {
            fs::write(path, content).unwrap();
        }
    }

    pub(super) fn restore_power(&mut self) {
        self.units.iter().for_each(|linked| linked.set_down(false));
        self.start();
    }
}

/// Returns all files below a folder with their content.
fn files_in(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(files_in(&path));
        } else {
            files.insert(path.clone(), fs::read(&path).unwrap());
        }
    }
    files
}

/// Returns elements of the default favourites, and of low satellites from all over the catalog.
fn satellites() -> Vec<Elements> {
    let all = bundled().unwrap();
    let known = Station::default().favourites.numbers();
    let low: Vec<&Elements> =
        all.iter().filter(|elements| elements.mean_motion_rev_day() > LOW_REV_DAY).collect();
    let others = low.iter().copied().step_by(low.len() / SATELLITES);
    let mut chosen: Vec<Elements> = Vec::new();
    for elements in known.iter().filter_map(|number| all.get(*number)).chain(others) {
        let number = elements.catalog_number();
        if chosen.len() < SATELLITES && chosen.iter().all(|known| known.catalog_number() != number)
        {
            chosen.push(elements.clone());
        }
    }
    assert_eq!(chosen.len(), SATELLITES);
    chosen
}

/// Returns the demo station with all rules on that it needs to run without the operator.
fn station(elements: &[Elements], faults: &Faults) -> Station {
    let address = |port: u16| format!("127.0.0.1:{port}");
    let addresses =
        DemoAddresses { satrak: address(4001), genius: address(9006), rc2000c: address(4002) };
    let mut station = Station::demo(&addresses);
    station.favourites = elements.iter().map(Elements::catalog_number).collect();
    for antenna in &mut station.antennas {
        antenna.connects_at_start = antenna.connection.variant().capabilities.waits_for_word;
        antenna.sway_deg += faults.mechanics.sway_deg;
        antenna.resume = Resume::Continue;
        antenna.resume_after_s = 600.0;
        antenna.automatic.is_on_at_start = true;
        antenna.automatic.resumes_after_crash = true;
        antenna.upkeep.sets_clock = true;
    }
    station
}
