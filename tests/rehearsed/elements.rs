//! Elements and their sources.

use std::sync::Arc;

use azel::{
    contract::Command,
    engine::Client,
    orbit::{
        Catalog, Elements, FetchProblem, Source, SourcePlace, SourceReport, bundled, read_elements,
        write_omm_json,
    },
    rehearsal::{Rehearsal, run},
    secret::Secret,
    sim::Mechanics,
    station::Station,
};
use jiff::Timestamp;

use super::scene::Scene;
use crate::common::units::{self, until};

const SPACE_TRACK: &str = "Space-Track";

fn report(client: &Client) -> Option<SourceReport> {
    let sources = Arc::clone(&client.snapshot().sources);
    sources.reports.iter().find(|report| report.source == SPACE_TRACK).cloned()
}

#[tokio::test(start_paused = true)]
async fn a_password_that_is_typed_while_elements_are_read_is_used_afterwards() {
    // Without favourites, Azel asks no server on its own, and the test counts the attempts.
    let station = Station { favourites: [].into(), ..units::station() };
    let scene = Scene::new("2026-08-12T11:00:00Z".parse().unwrap(), &station);
    let client = scene.client();
    until("the start", || client.snapshot().sources.is_free().then_some(())).await;
    let place = SourcePlace::SpaceTrack("op".to_owned());
    let source = Source { name: SPACE_TRACK.to_owned(), place, refresh: None };
    client.send(Command::AddSource(source)).unwrap();
    let first = until("the first attempt", || report(&client)).await;
    assert_eq!((first.fetch_problem, first.failures), (Some(FetchProblem::NoFavourites), 1));
    let read = Command::RefreshSources { names: Vec::new(), forced: false };
    let (name, secret) = (SPACE_TRACK.to_owned(), Secret::new("hunter2"));
    for command in [read, Command::SetSourcePassword { name, secret, keep: false }] {
        client.send(command).unwrap();
    }
    until("another attempt", || report(&client).filter(|report| report.failures == 2)).await;
}

/// Returns these elements under another name.
fn renamed(elements: &Elements) -> Elements {
    let mut text = Vec::new();
    write_omm_json([elements], &mut text).unwrap();
    let mut list: serde_json::Value = serde_json::from_slice(&text).unwrap();
    list[0]["OBJECT_NAME"] = "GIVEN".into();
    read_elements(&list.to_string()).elements.remove(0)
}

#[test]
fn a_rehearsal_keeps_its_elements_though_a_satellite_prefers_a_source() {
    let (bundled, mut elements) = (bundled().unwrap(), Catalog::default());
    let mut station = Station { favourites: [59_051, 43_013].into(), ..units::station() };
    station.antennas.retain(|antenna| antenna.name == "Dish");
    for number in [59_051, 43_013] {
        let mut text = Vec::new();
        write_omm_json([&renamed(bundled.get(number).unwrap())], &mut text).unwrap();
        elements.merge(read_elements(&String::from_utf8(text).unwrap()), "given");
        station.favourites.set_sources(number, vec!["own".to_owned()]);
    }
    let from: Timestamp = "2026-08-12T11:04:00Z".parse().unwrap();
    let what = Rehearsal {
        station,
        elements: Arc::new(elements),
        start: from,
        hours: 0.2,
        seed: 7,
        mechanics: Mechanics::default(),
        faults: Vec::new(),
        speed: None,
    };
    let rehearsed = run(&what, &|_| (), &|| false).unwrap();
    assert!(!rehearsed.passes.is_empty());
    for pass in &rehearsed.passes {
        assert_eq!(pass.satellite_name, "GIVEN");
    }
}
