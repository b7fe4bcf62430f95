//! Metrics of a station for monitoring programs.

mod assets;
mod open_metrics;
mod station_file;

use std::time::Duration;

use azel::{
    astro::Angle,
    contract::{Command, driver},
    engine::Client,
    sim::satrak,
    station::Station,
};
use tokio::{
    io::{AsyncReadExt as _, AsyncWriteExt as _, DuplexStream},
    time::{Instant, sleep},
};

use crate::{
    common::units::{self, measured, start, until},
    rehearsed::scene::Scene,
};
use open_metrics::{Families, parse};

const GET: &str = "GET /metrics HTTP/1.1\r\nHost: 127.0.0.1:9464\r\n\r\n";

/// Connects to the server of metrics.
fn connect(client: &Client) -> DuplexStream {
    let (near, far) = tokio::io::duplex(1024);
    let client = client.clone();
    tokio::spawn(async move { client.scrape(far).await });
    near
}

/// Sends a request and returns the head and the body of the response.
async fn ask(client: &Client, request: &str) -> (String, String) {
    let mut stream = connect(client);
    stream.write_all(request.as_bytes()).await.unwrap();
    let mut response = String::new();
    stream.read_to_string(&mut response).await.unwrap();
    let (head, body) = response.split_once("\r\n\r\n").expect("a head");
    (head.to_owned(), body.to_owned())
}

async fn scrape(client: &Client) -> Families {
    let (head, body) = ask(client, GET).await;
    assert!(head.starts_with("HTTP/1.1 200 OK\r\n"), "{head}");
    parse(&body)
}

/// Returns the only value of a metric for an antenna, in a metric with states the one of `state`.
fn value(families: &Families, name: &str, antenna: &str, state: Option<&str>) -> Option<f64> {
    let samples = &families.get(name).unwrap_or_else(|| panic!("no {name}")).samples;
    let found = samples.iter().filter(|(labels, _)| {
        labels.get("antenna").is_some_and(|name| name == antenna)
            && state.is_none_or(|state| labels.values().any(|value| value == state))
    });
    let values: Vec<f64> = found.map(|(_, value)| *value).collect();
    assert!(values.len() <= 1, "{name}: {values:?}");
    values.first().copied()
}

/// Returns the station with its antennas at work.
async fn running(station: &Station) -> (Scene, Client) {
    let scene = Scene::recorded(start(), station);
    let client = scene.client();
    for antenna in &station.antennas {
        measured(&client, &antenna.name).await;
    }
    (scene, client)
}

#[tokio::test(start_paused = true)]
async fn a_scrape_shows_links_positions_and_the_station() {
    let mut station = units::station();
    "Dish \"A\"\\B".clone_into(&mut station.antennas[2].name);
    let (scene, client) = running(&station).await;
    let families = scrape(&client).await;
    for name in ["Dish", "Mast", "Dish \"A\"\\B"] {
        assert_eq!(value(&families, "azel_link_state", name, Some("up")), Some(1.0), "{name}");
        assert_eq!(value(&families, "azel_link_state", name, Some("lost")), Some(0.0));
        let azimuth_deg = value(&families, "azel_azimuth_degrees", name, None);
        let snapshot = client.snapshot();
        let mut models = snapshot.antennas.iter();
        let model = models.find(|model| model.config.name == name).unwrap();
        let state = &model.snapshot.state;
        let shown = state.measured.unwrap().pointing.azimuth.map(Angle::degrees);
        assert_eq!(azimuth_deg, shown, "{name}: {:?}", (state.measured, state.link_since));
        assert!(value(&families, "azel_position_age_seconds", name, None).unwrap() < 3.0);
        assert_eq!(value(&families, "azel_automatic", name, Some("off")), Some(1.0));
        assert_eq!(value(&families, "azel_stops", name, None), Some(0.0));
        assert_eq!(value(&families, "azel_stop_latency_seconds", name, None), None);
        assert_eq!(value(&families, "azel_pointing_error_degrees", name, None), None);
    }
    let (labels, _) = &families["azel_station"].samples[0];
    assert_eq!((&*labels["station"], &*labels["mode"]), ("Station", "live"));
    assert_eq!(families["azel_time_synchronised"].samples, [], "the computer does not know");
    assert!(families["azel_elements_max_age_seconds"].samples[0].1 > 0.0);
    assert!(families["azel_record_size_bytes"].samples[0].1 >= 0.0);
    assert!(scene.units.all_stand());
}

#[tokio::test(start_paused = true)]
async fn old_positions_are_absent_and_their_age_grows() {
    let (scene, client) = running(&units::station()).await;
    scene.units.dish.set_fault(satrak::Fault::Silence, true);
    sleep(Duration::from_mins(1)).await;
    let families = scrape(&client).await;
    assert_eq!(value(&families, "azel_azimuth_degrees", "Dish", None), None);
    assert_eq!(value(&families, "azel_moving", "Dish", None), None);
    assert!(value(&families, "azel_position_age_seconds", "Dish", None).unwrap() > 50.0);
    assert_eq!(value(&families, "azel_link_state", "Dish", Some("up")), Some(0.0));
    assert_eq!(value(&families, "azel_alarms", "Dish", Some("warning")), Some(1.0));
    assert!(value(&families, "azel_azimuth_degrees", "Mast", None).is_some());
    scene.units.dish.set_fault(satrak::Fault::Silence, false);
    until("the link", || {
        let snapshot = client.snapshot();
        snapshot.antennas[0].is_live().then_some(())
    })
    .await;
    sleep(Duration::from_secs(2)).await;
    let families = scrape(&client).await;
    assert!(value(&families, "azel_azimuth_degrees", "Dish", None).is_some());
}

#[tokio::test(start_paused = true)]
async fn a_stop_shows_its_latency_and_its_proof() {
    let (scene, client) = running(&units::station()).await;
    let dish = client.snapshot().antennas[0].id();
    client.send(Command::Antenna(dish, driver::Command::Manual)).unwrap();
    until("motion", || {
        let jog = driver::Command::Jog { rates_deg_s: [1.0, 0.0] };
        client.send(Command::Antenna(dish, jog)).unwrap();
        (!scene.units.all_stand()).then_some(())
    })
    .await;
    client.stop(dish);
    until("the proof", || client.snapshot().antennas[0].tally.stops.proof).await;
    let families = scrape(&client).await;
    let seconds = |name| value(&families, name, "Dish", None);
    assert_eq!((seconds("azel_stops"), seconds("azel_stops_proved")), (Some(1.0), Some(1.0)));
    assert!(seconds("azel_stop_latency_seconds").unwrap() < 0.05);
    let proof_s = seconds("azel_stop_proof_seconds").unwrap();
    assert!((0.05..12.0).contains(&proof_s), "{proof_s}");
    assert_eq!(seconds("azel_stop_pending_seconds"), Some(0.0));
    assert_eq!(value(&families, "azel_stops", "Mast", None), Some(0.0));
}

#[tokio::test(start_paused = true)]
async fn only_get_and_head_of_the_metrics_are_answered() {
    let (_scene, client) = running(&units::station()).await;
    let (head, body) = ask(&client, &GET.replace("GET", "HEAD")).await;
    assert!(head.starts_with("HTTP/1.1 200 OK\r\n") && body.is_empty(), "{head}");
    let content_type = "application/openmetrics-text; version=1.0.0; charset=utf-8";
    assert!(head.contains(&format!("Content-Type: {content_type}\r\n")), "{head}");
    for (request, status) in [
        (GET.replace("GET", "POST"), "405 Method Not Allowed"),
        (GET.replace("/metrics", "/stop"), "404 Not Found"),
        ("P 100 40\n".to_owned(), "400 Bad Request"),
        (format!("GET /metrics HTTP/1.1\r\nX: {}", "a".repeat(9000)), "431 Request Header"),
        (format!("{GET}POST /stop HTTP/1.1\r\n\r\n"), "200 OK"),
    ] {
        let (head, _) = ask(&client, &request).await;
        assert!(head.starts_with(&format!("HTTP/1.1 {status}")), "{head}");
    }
}

#[tokio::test(start_paused = true)]
async fn clients_that_send_or_read_nothing_are_ended() {
    let (_scene, client) = running(&units::station()).await;
    let begun = Instant::now();
    let mut silent = connect(&client);
    silent.write_all(b"GET /met").await.unwrap();
    let mut response = String::new();
    silent.read_to_string(&mut response).await.unwrap();
    assert!(response.starts_with("HTTP/1.1 408 "), "{response}");
    assert!((2..4).contains(&begun.elapsed().as_secs()), "{:?}", begun.elapsed());
    // The response is larger than the buffer of the connection.
    let (mut near, far) = tokio::io::duplex(1024);
    near.write_all(GET.as_bytes()).await.unwrap();
    let begun = Instant::now();
    client.scrape(far).await;
    assert!((4..8).contains(&begun.elapsed().as_secs()), "{:?}", begun.elapsed());
    // A client that stays connected after the response ends too.
    let mut stays = connect(&client);
    stays.write_all(GET.as_bytes()).await.unwrap();
    let mut response = Vec::new();
    stays.read_to_end(&mut response).await.unwrap();
    assert!(response.ends_with(b"# EOF\n"));
}
