//! Rehearsals compared with the later events of the same station, here in paused time.
//! `AZEL_REAL_TIME=1 cargo test --test azel rehearsed::rehearsal -- --nocapture` takes half an hour
//! of real time, with a station on its own threads.

use std::{num::NonZeroU32, path::Path, sync::Arc};

use azel::{
    clock::Clock,
    contract::rehearsal::Rehearsed,
    controller::SPECS,
    engine::{Client, Handle, Settings},
    makes::DemoAddresses,
    orbit::bundled,
    record::RowKind,
    rehearsal::{Rehearsal, run},
    sim::Mechanics,
    station::{self, Station},
};
use jiff::{SignedDuration, Timestamp, ToSpan as _};

use super::{
    recorded::rows_in,
    scene::{Scene, set_automatic},
};
use crate::common::units::{self, Units, measured, until};

/// Tolerance between two equal errors, degrees.
const ALIKE_DEG: f64 = 0.02;
/// Tolerance between two equal errors, as a share of an error.
const ALIKE_SHARE: f64 = 0.2;

/// Max time from a pass to its report; the next pass of the satellite is later.
const AT_MOST: SignedDuration = SignedDuration::from_mins(10);

/// Counts of the RC2000C at the start of a rehearsal: its park position, 180 and 45 degrees. On the
/// way from there, Azel learns the rates of its axes.
const PARKED: [u16; 2] = [1830, 930];

/// Calibrates the RC2000C of a station, because Azel cannot send an uncalibrated one anywhere.
pub(super) fn calibrated(mut station: Station) -> Station {
    let demo =
        Station::demo(&DemoAddresses { rc2000c: "horn:1".to_owned(), ..DemoAddresses::default() });
    let of_demo = demo.antennas.iter().find(|antenna| antenna.name == "RC2000C").unwrap();
    let horn = station.antennas.iter_mut().find(|antenna| antenna.name == "Horn").unwrap();
    horn.mount = of_demo.mount;
    horn.connection = of_demo.connection.clone();
    station
}

/// Returns a station with the antennas of these names, for passes of METEOR-M2 4 and NOAA 20.
fn station(names: &[&str]) -> Station {
    let mut station =
        calibrated(Station { favourites: [59_051, 43_013].into(), ..units::station() });
    station.antennas.retain(|antenna| names.contains(&&*antenna.name));
    station
}

/// The dish has one pass and the mast another one at the same time.
#[test]
fn what_was_rehearsed_is_what_then_happens() {
    check(&["Dish", "Mast"], 0.2, 2);
}

/// The horn is alone here, because the plan prefers the other antennas.
#[test]
fn what_was_rehearsed_of_an_rc2000c_is_what_then_happens() {
    check(&["Horn"], 0.2, 1);
}

/// Rehearses a station, runs it and compares at least `least` passes.
fn check(names: &[&str], hours: f64, least: usize) {
    let is_live = std::env::var_os("AZEL_REAL_TIME").is_some();
    let mut runtime = tokio::runtime::Builder::new_current_thread();
    let runtime = runtime.enable_time().start_paused(!is_live).build().unwrap();
    let from: Timestamp = "2026-08-12T11:04:00Z".parse().unwrap();
    let station = station(names);
    let what = Rehearsal {
        station: station.clone(),
        elements: Arc::new(bundled().unwrap()),
        start: from,
        hours,
        seed: 7,
        mechanics: Mechanics::default(),
        faults: Vec::new(),
        speed: None,
    };
    let rehearsed = run(&what, &|_| (), &|| false).unwrap();
    assert!(rehearsed.passes.len() >= least, "{rehearsed:?}");
    assert!(rehearsed.passes.iter().all(|pass| pass.report.is_some()), "{rehearsed:?}");

    let start = from - 10.minutes();
    runtime.block_on(async {
        if is_live {
            let folder = tempfile::tempdir().unwrap();
            let live = live(start, folder.path(), &station);
            compare(&rehearsed, live.client(), folder.path(), names).await;
        } else {
            let scene = Scene::recorded(start, &station);
            scene.units.horn.place(PARKED);
            compare(&rehearsed, &scene.client(), scene.folder(), names).await;
        }
    });
}

/// Starts a recorded station with its own threads.
fn live(start: Timestamp, folder: &Path, station: &Station) -> Handle {
    let clock = Clock::at_speed(start, NonZeroU32::MIN);
    let path = folder.join("station.toml");
    station::save(station, &path, SPECS).unwrap();
    let settings = Settings {
        path: Some(path),
        library: Some(folder.join("elements")),
        records: Some(folder.join("records")),
        ..Settings::default()
    };
    let units = Units::new(&clock);
    units.horn.place(PARKED);
    Handle::start(settings, units.outside(&clock), Arc::new(|| {})).unwrap()
}

/// Compares a rehearsal with the events of the station whose files are in `folder`.
async fn compare(rehearsed: &Rehearsed, client: &Client, folder: &Path, names: &[&str]) {
    for name in names {
        let antenna = measured(client, name).await;
        set_automatic(client, antenna, true).await;
    }
    let last = rehearsed.passes.iter().map(|pass| pass.los).max().unwrap();
    until("the last pass", || (client.now().utc > last).then_some(())).await;
    for pass in &rehearsed.passes {
        let report = super::until_recorded("the report", || {
            let mut reports = rows_in(folder, RowKind::Pass).into_iter();
            reports.find(|row| {
                row.antenna.as_deref() == Some(&pass.antenna_name)
                    && row.data["satellite"] == pass.satellite
                    && (pass.start - AT_MOST..pass.end + AT_MOST).contains(&row.time)
            })
        })
        .await;
        let report = &report.data["report"];
        let [rms, worst] = [&report["rms"]["off_deg"], &report["worst"]["error"]["off_deg"]]
            .map(|value| value.as_f64().unwrap());
        let pairs = [(pass.rms_deg().unwrap(), rms), (pass.worst_deg().unwrap(), worst)];
        for (before, then) in pairs {
            println!(
                "{} {}: {before:.3} then {then:.3} deg",
                pass.antenna_name, pass.satellite_name
            );
            let (clock, by) = (&report["unit_clock_ahead_s"], &report["causes"]);
            assert!(
                (before - then).abs() <= f64::max(ALIKE_SHARE * then, ALIKE_DEG),
                "{before} {then}, the clock of the unit ahead by {clock}, explained by {by}"
            );
        }
    }
}
