//! A station in tokio's paused time, and the requests to it.

use std::{fs, num::NonZeroU32, path::Path, sync::Arc};

use azel::{
    clock::Clock,
    contract::{Command, automatic::Operation, older_sets::OlderSet},
    controller::SPECS,
    engine::{Client, Settings, in_place::InPlace, uploads},
    job,
    library::History,
    orbit::Elements,
    station::{self, AntennaId, Station},
    transfer::{KeptFiles, KnownHosts, Limits, MemoryKeyring},
};
use jiff::Timestamp;
use tokio::task::JoinHandle;

use crate::common::units::{Units, until};

/// A station, its units, and the folder of its files.
pub(crate) struct Scene {
    pub(crate) units: Units,
    station: InPlace,
    run: JoinHandle<()>,
    clock: Clock,
    folder: tempfile::TempDir,
    keeps: Keeps,
    _jobs: job::InPlace,
}

/// Records that a station keeps besides its file.
#[derive(Clone, Copy, Default)]
struct Keeps {
    /// `true` to keep records of STOPs owed to units.
    marks: bool,
    record: bool,
}

impl Scene {
    pub(crate) fn new(start: Timestamp, station: &Station) -> Self {
        Self::keeping(start, station, Keeps::default())
    }

    /// Starts a station with a record.
    pub(crate) fn recorded(start: Timestamp, station: &Station) -> Self {
        Self::keeping(start, station, Keeps { record: true, ..Keeps::default() })
    }

    /// Starts a station that keeps records of STOPs owed to units.
    pub(super) fn marking(start: Timestamp, station: &Station) -> Self {
        Self::keeping(start, station, Keeps { marks: true, ..Keeps::default() })
    }

    /// Starts a recorded station with these units; `before` is an earlier element set in its
    /// history.
    pub(super) fn with_units(
        units: Units,
        clock: Clock,
        station: &Station,
        before: Option<&Elements>,
    ) -> Self {
        let folder = folder_of(station);
        let older =
            before.map(|set| OlderSet { elements: set.clone(), source: "before".to_owned() });
        History::new(&folder.path().join("elements")).add(older.as_slice()).unwrap();
        Self::begun(units, clock, folder, Keeps { record: true, ..Keeps::default() })
    }

    fn keeping(start: Timestamp, station: &Station, keeps: Keeps) -> Self {
        let clock = Clock::at_speed(start, NonZeroU32::MIN);
        let units = Units::new(&clock);
        Self::begun(units, clock, folder_of(station), keeps)
    }

    /// Starts a station on a clock that the test sets.
    pub(super) fn by(clock: Clock, station: &Station) -> Self {
        let units = Units::new(&clock);
        Self::begun(units, clock, folder_of(station), Keeps::default())
    }

    fn begun(units: Units, clock: Clock, folder: tempfile::TempDir, keeps: Keeps) -> Self {
        let jobs = job::InPlace::begin();
        let place = |name: &str| Some(folder.path().join(name));
        let settings = Settings {
            path: place("station.toml"),
            library: place("elements"),
            records: place("records").filter(|_| keeps.record),
            marks: place("marks").filter(|_| keeps.marks),
            upload_places: Some(upload_places(folder.path())),
            ..Settings::default()
        };
        let (station, run) = InPlace::start(&settings, units.outside(&clock)).unwrap();
        Self { units, station, run: tokio::spawn(run), clock, folder, keeps, _jobs: jobs }
    }

    /// Ends the station in order and returns the folder of its files.
    pub(super) async fn ended(self) -> tempfile::TempDir {
        drop(self.station);
        self.run.await.unwrap();
        self.folder
    }

    /// Ends the station in order, or with its files as after a crash, and starts it again. The
    /// units keep running.
    pub(super) async fn started_again(self, is_crash: bool) -> Self {
        let left = self.folder().join("station.automatic.toml");
        let while_running = fs::read(&left).unwrap();
        let (units, clock, keeps) = (self.units.clone(), self.clock.clone(), self.keeps);
        let folder = self.ended().await;
        if is_crash {
            fs::write(&left, while_running).unwrap();
        }
        Self::begun(units, clock, folder, keeps)
    }

    pub(super) fn folder(&self) -> &Path {
        self.folder.path()
    }

    pub(crate) fn client(&self) -> Client {
        self.station.client().clone()
    }
}

/// Returns places for passwords and files, away from the keyring of the user.
fn upload_places(folder: &Path) -> uploads::Places {
    let session = Arc::<MemoryKeyring>::default();
    uploads::Places {
        known_hosts: KnownHosts::new(folder.join("known_hosts")),
        kept_files: KeptFiles::new(folder.join("uploads")),
        keyring: session.clone(),
        session,
        limits: Limits::default(),
    }
}

/// Creates a folder with the file of the station.
fn folder_of(station: &Station) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    station::save(station, &folder.path().join("station.toml"), SPECS).unwrap();
    folder
}

pub(crate) fn operation(client: &Client, antenna: AntennaId) -> Operation {
    let snapshot = client.snapshot();
    snapshot.antennas.iter().find(|of| of.id() == antenna).unwrap().operation.clone()
}

pub(crate) async fn set_automatic(client: &Client, antenna: AntennaId, is_on: bool) {
    let is_set = || {
        let _ = client.send(Command::SetAutomatic { antenna, is_on });
        (operation(client, antenna).is_on() == is_on).then_some(())
    };
    until("automatic operation", is_set).await;
}
