//! A pass of a station in memory, shown again from its record.

use std::sync::Arc;

use azel::{
    engine::{Client, Snapshot, film::Projector},
    record::{Kind, RowKind},
    station::Station,
};
use jiff::{Timestamp, ToSpan as _};
use serde_json::{Value, json};

use super::{
    recorded::{ISS, next_pass, path_in, reports, rows_in, track},
    scene::Scene,
};
use crate::common::units::station;

/// Every how many snapshots one without an event is compared.
const BETWEEN: usize = 20;

/// Collects the snapshots of a station until it ends.
async fn watch(mut client: Client) -> Vec<Arc<Snapshot>> {
    let mut shown = Vec::new();
    while client.changed().await {
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

#[tokio::test(start_paused = true)]
async fn a_pass_is_shown_again_as_it_was_at_every_recorded_event() {
    let station = Station { favourites: [ISS].into(), ..station() };
    let pass = next_pass(&station);
    let scene = Scene::recorded(pass.aos.time - 3.minutes(), &station);
    let client = scene.client();
    let watching = tokio::spawn(watch(client.clone()));
    track(&client, "Mast").await;
    reports(&scene).await;
    drop(client);
    let ended = scene.ended().await;
    let (folder, file) = (ended.path(), path_in(ended.path()));
    let live = watching.await.unwrap();
    assert_eq!(rows_in(folder, RowKind::Entry(Kind::Gap)), []);
    let events: Vec<Timestamp> = (RowKind::all())
        .filter(|kind| matches!(kind, RowKind::Entry(_)))
        .flat_map(|kind| rows_in(folder, kind))
        .map(|row| row.time)
        .collect();
    let mut projector = Projector::open(&file).unwrap();
    let mut compared = 0;
    let mut compare = |at: Timestamp, live: &Snapshot| {
        let again = projector.at(at).unwrap().unwrap();
        assert_eq!(told(&again), told(live), "at {at}");
        compared += 1;
    };
    for event in &events {
        let place = live.partition_point(|shown| shown.at.utc < *event);
        // What was published after the watch ended.
        let Some(shown) = live.get(place) else { continue };
        let mut film = Projector::open(&file).unwrap();
        let from = film.film().shown_from(*event).unwrap();
        assert_eq!(from, shown.at.utc, "the first that shows it");
        compare(from, shown);
    }
    for shown in live.iter().step_by(BETWEEN).rev() {
        compare(shown.at.utc, shown);
    }
    println!("{compared} moments of {} snapshots, {} events", live.len(), events.len());
    assert!(compared > 100, "{compared}");
}
