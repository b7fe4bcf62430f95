//! A pass of a station in memory, shown again from its record.

use std::{num::NonZeroU32, sync::Arc, thread};

use azel::{
    engine::{Client, Snapshot, film::Projector, record_path},
    record::RowKind,
    station::Station,
};
use jiff::{Timestamp, ToSpan as _};
use serde_json::{Value, json};

use super::{
    super::serve::record,
    recorded::{ISS, next_pass, rows, track},
    scene::{self, Scene, until},
};

/// Every how many snapshots one without an event is compared.
const BETWEEN: usize = 20;

/// Collects the snapshots of a station until it ends.
fn watch(mut client: Client) -> Vec<Arc<Snapshot>> {
    let runtime = tokio::runtime::Builder::new_current_thread().build().unwrap();
    let mut shown = Vec::new();
    while runtime.block_on(client.changed()) {
        shown.push(client.snapshot());
    }
    shown
}

/// All that a window takes of a snapshot, but for what a client looks at of the record.
fn told(shown: &Snapshot) -> Value {
    let mut told = serde_json::to_value(shown).unwrap();
    told["recorded"] = Value::Null;
    let favourites = &shown.pass_lists.favourites;
    let satellites = favourites.satellites.iter().map(|satellite| &satellite.elements);
    let passes = favourites.range(0..favourites.passes.len());
    json!({
        "shown": told,
        "satellites": satellites.collect::<Vec<_>>(),
        "passes": passes.collect::<Vec<_>>(),
    })
}

#[test]
fn a_pass_is_shown_again_as_it_was_at_every_recorded_event() {
    let station = Station { favourites: [ISS].into(), ..scene::station() };
    let pass = next_pass(&station);
    let speed = NonZeroU32::new(30).unwrap();
    let scene = Scene::recorded(pass.aos.time - 3.minutes(), speed, &station);
    let client = scene.client();
    let witness = client.clone();
    let watching = thread::Builder::new().name("watches".to_owned()).spawn(|| watch(witness));
    track(&client, "Mast");
    until("its report", || (!rows(&scene, RowKind::Pass).is_empty()).then_some(()));
    let file = record_path(&scene.folder().join("records"), &scene.folder().join("station.toml"));
    drop(client);
    drop(scene.station);
    let live = watching.unwrap().join().unwrap();
    assert_eq!(record::rows(&file, RowKind::Entry(azel::record::Kind::Gap)), []);
    let events: Vec<Timestamp> = (RowKind::all())
        .filter(|kind| matches!(kind, RowKind::Entry(_)))
        .flat_map(|kind| record::rows(&file, kind))
        .map(|row| row.time)
        .collect();
    let mut projector = Projector::open(&file).unwrap();
    let mut compared = 0;
    let mut compare = |at: Timestamp, live: &Snapshot| {
        let again = projector.at(at).unwrap().unwrap();
        assert_eq!(told(&again), told(live), "at {at}");
        compared += 1;
    };
    let mut missed = 0;
    for event in &events {
        let place = live.partition_point(|shown| shown.at.utc < *event);
        // What was published after the watch ended.
        let Some(shown) = live.get(place) else { continue };
        let mut film = Projector::open(&file).unwrap();
        let from = film.film().shown_from(*event).unwrap();
        // The watch may have missed the first snapshot that showed it.
        if from == shown.at.utc {
            compare(from, shown);
        } else {
            missed += 1;
        }
    }
    for shown in live.iter().step_by(BETWEEN).rev() {
        compare(shown.at.utc, shown);
    }
    println!("{compared} moments of {} snapshots, {} events", live.len(), events.len());
    assert!(missed * 10 < events.len(), "{missed} of {}", events.len());
    assert!(compared > 100, "{compared}");
}
