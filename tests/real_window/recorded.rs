//! A recorded pass for the pictures, tracked in tokio's paused time.

use std::{
    num::NonZeroU32,
    path::{Path, PathBuf},
    time::Duration,
};

use azel::{
    clock::Clock,
    contract::{Command, record::PassQuery},
    controller::SPECS,
    engine::{Settings, demo_record_path, in_place::InPlace, record_path},
    job,
    orbit::{Pass, PassSearch, Propagator, bundled, passes},
    record::passes as recorded,
    sim::{InMemory as _, Trouble},
    station::{self, Station},
};
use jiff::{Timestamp, ToSpan as _};

use crate::units::{Units, antenna, measured, station, until};

const ISS: u32 = 25_544;
/// Delay of the unit's clock, which the report of the pass explains.
const LATE: Duration = Duration::from_millis(1500);
const BEFORE_AOS: Duration = Duration::from_mins(4);

/// The record of a station whose Satrak has tracked a pass of the ISS with its clock late.
pub(super) struct Tracked {
    _folder: tempfile::TempDir,
    record: PathBuf,
}

impl Tracked {
    pub(super) fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("station.toml");
        let records = folder.path().join("records");
        let record = record_path(&records, &file);
        let station = Station { favourites: [ISS].into(), ..station() };
        station::save(&station, &file, SPECS).expect("a station file");
        let settings = Settings {
            path: Some(file),
            library: Some(folder.path().join("elements")),
            records: Some(records),
            ..Settings::default()
        };
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .start_paused(true)
            .build()
            .expect("a runtime");
        runtime.block_on(track(&station, &settings, &record));
        Self { _folder: folder, record }
    }

    /// Copies the record to the place of the demo station's record in the folder `records`.
    pub(super) fn put(&self, records: &Path) {
        std::fs::create_dir_all(records).expect("a folder");
        std::fs::copy(&self.record, demo_record_path(records)).expect("a record");
    }
}

/// Returns the highest pass of the last day. The record does not keep older passes as Azel showed
/// them.
fn last_pass(station: &Station) -> Pass {
    let now = Timestamp::now();
    let catalog = bundled().expect("elements");
    let propagator = Propagator::new(catalog.get(ISS).expect("the ISS")).expect("an orbit");
    let search = PassSearch {
        aos_elevation: station.aos_elevation(),
        floor: station.elevation_floor(),
        ..PassSearch::new(station.site, now - 26.hours(), now - 2.hours())
    };
    let all = passes(&propagator, &search, &|| false);
    let elevation_deg = |of: &Pass| of.max_elevation().degrees();
    let highest = all.into_iter().max_by(|a, b| elevation_deg(a).total_cmp(&elevation_deg(b)));
    highest.expect("a pass")
}

/// Tracks the next pass to its end, until its report is in `record`.
async fn track(station: &Station, settings: &Settings, record: &Path) {
    let from = last_pass(station).aos.time - BEFORE_AOS;
    let clock = Clock::at_speed(from, NonZeroU32::MIN);
    let units = Units::new(&clock);
    let _jobs = job::InPlace::begin();
    let (running, run) = InPlace::start(settings, units.outside(&clock)).expect("a station");
    let run = tokio::spawn(run);
    let client = running.client().clone();
    let dish = measured(&client, "Dish").await;
    assert!(units.dish.set_trouble(Trouble::ClockLate(LATE), true));
    let listed = || {
        let lists = client.snapshot().pass_lists.clone();
        Some(lists.favourites.passes.first()?.key())
    };
    let pass = until("the pass", listed).await;
    client.send(Command::Track { antenna: dish, pass, is_agreed: true }).expect("a command");
    until("the track", || antenna(&client, "Dish")?.1.tracks).await;
    let query = PassQuery { count: 1, ..PassQuery::default() };
    while recorded(record, &query).is_ok_and(|page| page.all == 0) {
        tokio::time::sleep(Duration::from_secs(5)).await;
    }
    drop((client, running));
    run.await.expect("its end");
}
