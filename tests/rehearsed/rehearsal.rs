//! A rehearsal beside what then happens with the same station. Here its clock runs at 10 times real
//! time, at which a busy computer takes the time of a position too late, so that only what is far off
//! is found. `AZEL_SPEED=1 cargo test --test processes rehearsed::rehearsal -- --nocapture` takes 25
//! minutes of real time and compares as closely as a rehearsal has to be.

use std::{
    num::NonZeroU32,
    sync::Arc,
    thread,
    time::{Duration, Instant},
};

use azel::{
    orbit::bundled,
    record::RowKind,
    rehearsal::{Rehearsal, run},
    station::Station,
};
use jiff::{Timestamp, ToSpan as _};

use super::{
    recorded::rows,
    scene::{self, Scene, measured, set_automatic, until},
};

const USUAL_SPEED: u32 = 10;
/// Difference in real time from which two errors are not the same, degrees.
const ALIKE_DEG: f64 = 0.02;
/// Share of an error that is not the same either.
const ALIKE_SHARE: f64 = 0.2;
/// What a busy computer adds to both for each multiple of real time.
const BUSY_DEG: f64 = 0.005;
const BUSY_SHARE: f64 = 0.03;

/// One pass of the dish and one of the mast at the same time: METEOR-M2 4 and NOAA 20.
fn station() -> Station {
    let mut station = Station { favourites: [59_051, 43_013].into(), ..scene::station() };
    station.antennas.retain(|antenna| antenna.name != "Horn");
    station
}

#[test]
fn what_was_rehearsed_is_what_then_happens() {
    let speed = std::env::var("AZEL_SPEED").map_or(USUAL_SPEED, |text| text.parse().unwrap());
    let speed = NonZeroU32::new(speed).unwrap();
    let busy = f64::from(speed.get() - 1);
    let (alike_deg, share) = (ALIKE_DEG + BUSY_DEG * busy, ALIKE_SHARE + BUSY_SHARE * busy);
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

    // To read the elements takes long by a clock at speed.
    let scene = Scene::recorded(from - 10.minutes(), speed, &station());
    let client = scene.client();
    for name in ["Dish", "Mast"] {
        let antenna = measured(&client, name);
        set_automatic(&client, antenna, true);
    }
    let last = rehearsed.passes.iter().map(|pass| pass.los).max().unwrap();
    let patience = Instant::now() + Duration::from_mins(40);
    while client.now().utc < last {
        assert!(Instant::now() < patience);
        thread::sleep(scene::LOOK);
    }
    for pass in &rehearsed.passes {
        let report = until("the report", || {
            let mut reports = rows(&scene, RowKind::Pass).into_iter();
            reports.find(|row| {
                row.antenna.as_deref() == Some(&pass.antenna_name)
                    && row.data["satellite"] == pass.satellite
            })
        });
        let report = &report.data["report"];
        let [rms, worst] = [&report["rms"]["off_deg"], &report["worst"]["error"]["off_deg"]]
            .map(|value| value.as_f64().unwrap());
        let pairs = [(pass.rms_deg().unwrap(), rms), (pass.worst_deg().unwrap(), worst)];
        for (before, then) in pairs {
            println!(
                "{} {}: {before:.3} then {then:.3} deg",
                pass.antenna_name, pass.satellite_name
            );
            assert!((before - then).abs() <= f64::max(share * then, alike_deg), "{before} {then}");
        }
    }
}
