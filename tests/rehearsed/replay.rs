//! A pass of a station in memory, replayed from its record.

use std::{sync::Arc, time::Duration};

use azel::{
    clock::{Instant, Moment},
    contract::{
        Command, Snapshot,
        passes::PredictedPass,
        record::{Peak, PeakBody, PeakChange},
    },
    engine::{Client, film::Projector},
    model::Model,
    record::{Kind, RowKind},
    station::{AntennaId, Station},
};
use jiff::{Timestamp, ToSpan as _};
use serde_json::{Value, json};

use super::{
    recorded::{ISS, next_pass, path_in, reports, rows_in, track},
    scene::Scene,
};
use crate::common::units::{antenna, measured, station, until};

/// Interval, in snapshots, at which the test compares a snapshot without an event.
const BETWEEN: usize = 20;

/// Collects the snapshots of a station until it ends.
async fn watch(mut client: Client) -> Vec<Arc<Snapshot>> {
    let mut shown = Vec::new();
    while client.changed().await {
        shown.push(client.snapshot());
    }
    shown
}

/// Returns all values that a window takes of a snapshot, except the client's look at the record.
fn told(shown: &Snapshot) -> Value {
    let mut told = serde_json::to_value(shown).unwrap();
    told["recorded"] = Value::Null;
    // The film keeps only the rates that Azel computes from these measurements.
    for antenna in told["antennas"].as_array_mut().unwrap() {
        antenna["recent"] = Value::Null;
    }
    let favourites = &shown.pass_lists.favourites;
    let satellites = favourites.satellites.iter().map(|satellite| &satellite.elements);
    let passes = favourites.range(0..favourites.passes.len());
    json!({
        "shown": told,
        "satellites": satellites.collect::<Vec<_>>(),
        "passes": passes.collect::<Vec<_>>(),
    })
}

/// Returns the model that the window makes of a snapshot at `at`, with the ages of its values.
fn modelled(at: Timestamp, shown: &Snapshot) -> Value {
    let passed = Duration::try_from(at.duration_since(shown.moment.utc)).unwrap();
    let mut model =
        Model::before_anything(Moment { utc: at, steady: shown.moment.steady + passed });
    model.take(Arc::new(shown.clone()), |_| None);
    let age_s = |of: Instant| model.steady.saturating_duration_since(of).as_secs_f64();
    let antennas = model.antennas.iter().map(|antenna| {
        let measured = antenna.snapshot.state.measured;
        json!({
            "measured_s": measured.map(|measured| age_s(measured.received)),
            "stop_s": antenna.last_stop.map(age_s),
            "error": antenna.error().map(|error| error.off_beam.degrees()),
        })
    });
    json!({
        "antennas": antennas.collect::<Vec<_>>(),
        "next": model.next_pass().map(PredictedPass::key),
        "peaks": model.peaks,
        "pointing_fitted": model.pointing_fitted,
    })
}

/// Starts a track of the pass on board of the Satrak.
async fn track_on_board(client: &Client) {
    let dish = measured(client, "Dish").await;
    let pass = until("the pass", || {
        let lists = client.snapshot().pass_lists.clone();
        lists.favourites.passes.iter().find(|pass| pass.number() == ISS).map(PredictedPass::key)
    })
    .await;
    client.send(Command::Track { antenna: dish, pass, is_agreed: true }).unwrap();
    until("the track", || antenna(client, "Dish")?.1.tracks).await;
}

/// Enters a peak and fits a pointing model to the record.
async fn fit_pointing(client: &Client) {
    let mast = measured(client, "Mast").await;
    let at = client.now().utc;
    let peak = Peak { body: PeakBody::Sun, time: at, azimuth_deg: 100.0, elevation_deg: 20.0 };
    client.send(Command::ChangePeaks(mast, PeakChange::Added(peak))).unwrap();
    client.send(Command::FitPointing(mast, Vec::new())).unwrap();
    let fitted = until("the fit", || {
        let fitted = client.snapshot().pointing_fitted.clone()?;
        fitted.found.clone()
    })
    .await;
    assert!(fitted.is_ok(), "{fitted:?}");
}

#[tokio::test(start_paused = true)]
async fn a_pass_is_shown_again_as_it_was_at_every_recorded_event() {
    let station = Station { favourites: [ISS].into(), ..station() };
    let pass = next_pass(&station);
    let scene = Scene::recorded(pass.aos.time - 3.minutes(), &station);
    let client = scene.client();
    let watching = tokio::spawn(watch(client.clone()));
    track(&client, "Mast").await;
    track_on_board(&client).await;
    reports(&scene).await;
    fit_pointing(&client).await;
    super::until_recorded("both reports", || {
        (rows_in(scene.folder(), RowKind::Pass).len() == 2).then_some(())
    })
    .await;
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
    let (filmed_from, _) = projector.film().span().unwrap().unwrap();
    let mut compared = 0;
    let mut compare = |at: Timestamp, live: &Snapshot| {
        let again = projector.seek(at).unwrap().unwrap();
        assert_eq!(told(&again), told(live), "at {at}");
        compared += 1;
    };
    for event in &events {
        let place = live.partition_point(|shown| shown.moment.utc < *event);
        // The station published this event after the watch ended.
        let Some(shown) = live.get(place) else { continue };
        let mut film = Projector::open(&file).unwrap();
        let from = film.film().shown_from(*event).unwrap();
        assert_eq!(from, shown.moment.utc, "the first that shows it");
        compare(from, shown);
        // Snapshot that the window showed when the event happened.
        let Some(before) = place.checked_sub(1).and_then(|place| live.get(place)) else { continue };
        if *event <= filmed_from {
            continue;
        }
        let again = film.seek(*event).unwrap().unwrap();
        assert_eq!(told(&again), told(before), "before {event}");
        assert_eq!(modelled(*event, &again), modelled(*event, before), "at {event}");
    }
    for shown in live.iter().step_by(BETWEEN).rev() {
        compare(shown.moment.utc, shown);
    }
    let last = live.last().unwrap();
    assert!(last.peaks.for_antenna(AntennaId(2)).count() == 1 && last.pointing_fitted.is_some());
    println!("{compared} moments of {} snapshots, {} events", live.len(), events.len());
    assert!(compared > 100, "{compared}");
}
