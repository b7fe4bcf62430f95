//! A rehearsal beside what then happens with the same station, in paused time here.
//! `AZEL_REAL_TIME=1 cargo test --test azel rehearsed::rehearsal -- --nocapture` takes 40 minutes of
//! real time, with a station on threads of its own.

use std::{num::NonZeroU32, path::Path, sync::Arc};

use azel::{
    clock::Clock,
    engine::{Client, Handle, Settings},
    orbit::bundled,
    record::RowKind,
    rehearsal::{Rehearsal, Rehearsed, run},
    station::{self, Station},
};
use jiff::{Timestamp, ToSpan as _};

use super::{
    recorded::rows_in,
    scene::{Scene, set_automatic},
};
use crate::common::units::{self, Units, measured, until};

/// Difference from which two errors are not the same, degrees.
const ALIKE_DEG: f64 = 0.02;
/// Share of an error that is not the same either.
const ALIKE_SHARE: f64 = 0.2;

/// One pass of the dish and one of the mast at the same time: METEOR-M2 4 and NOAA 20.
fn station() -> Station {
    let mut station = Station { favourites: [59_051, 43_013].into(), ..units::station() };
    station.antennas.retain(|antenna| antenna.name != "Horn");
    station
}

#[test]
fn what_was_rehearsed_is_what_then_happens() {
    let is_live = std::env::var_os("AZEL_REAL_TIME").is_some();
    let mut runtime = tokio::runtime::Builder::new_current_thread();
    let runtime = runtime.enable_time().start_paused(!is_live).build().unwrap();
    let from: Timestamp = "2026-08-12T11:04:00Z".parse().unwrap();
    let what = Rehearsal {
        station: station(),
        elements: Arc::new(bundled().unwrap()),
        from,
        hours: 0.2,
        seed: 7,
        faults: Vec::new(),
        speed: None,
    };
    let rehearsed = run(&what, &|_| (), &|| false).unwrap();
    assert_eq!(rehearsed.passes.len(), 2, "{rehearsed:?}");
    assert!(rehearsed.passes.iter().all(|pass| pass.report.is_some()), "{rehearsed:?}");

    let start = from - 10.minutes();
    runtime.block_on(async {
        if is_live {
            let folder = tempfile::tempdir().unwrap();
            let station = live(start, folder.path());
            compare(&rehearsed, station.client(), folder.path()).await;
        } else {
            let scene = Scene::recorded(start, &station());
            compare(&rehearsed, &scene.client(), scene.folder()).await;
        }
    });
}

/// A station with threads of its own, recorded.
fn live(start: Timestamp, folder: &Path) -> Handle {
    let clock = Clock::at_speed(start, NonZeroU32::MIN);
    let path = folder.join("station.toml");
    station::save(&station(), &path).unwrap();
    let settings = Settings {
        path: Some(path),
        library: Some(folder.join("elements")),
        records: Some(folder.join("records")),
        ..Settings::default()
    };
    let units = Units::new(&clock);
    Handle::start(settings, units.outside(&clock), Arc::new(|| {})).unwrap()
}

/// Holds what was rehearsed against what happens with the station whose files are in `folder`.
async fn compare(rehearsed: &Rehearsed, client: &Client, folder: &Path) {
    for name in ["Dish", "Mast"] {
        let antenna = measured(client, name).await;
        set_automatic(client, antenna, true).await;
    }
    let last = rehearsed.passes.iter().map(|pass| pass.los).max().unwrap();
    until("the last pass", || (client.now().utc > last).then_some(())).await;
    for pass in &rehearsed.passes {
        let report = until("the report", || {
            let mut reports = rows_in(folder, RowKind::Pass).into_iter();
            reports.find(|row| {
                row.antenna.as_deref() == Some(&pass.antenna_name)
                    && row.data["satellite"] == pass.satellite
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
            let (clock, by) = (&report["unit_clock_ahead_s"], &report["explanations"]);
            assert!(
                (before - then).abs() <= f64::max(ALIKE_SHARE * then, ALIKE_DEG),
                "{before} {then}, the clock of the unit ahead by {clock}, explained by {by}"
            );
        }
    }
}
