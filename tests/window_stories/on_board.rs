//! Reports to the operator about an on-board track.

use std::{
    io::{BufRead as _, BufReader, Write as _},
    net::TcpStream,
    sync::Arc,
};

use azel::{
    astro::{Angle, time::add_seconds},
    contract::{
        self,
        alarms::AlarmKind,
        driver::{OffTargetCause, OnBoardView, Snapshot},
    },
    controller::SPECS,
    device::{Place, settings::Value},
    model::{Model, UiCommand},
    orbit::{bundled, read_elements},
    plan::{
        Supervision,
        on_board::{Cause, Error, Ranked, Unknown},
        pass_report::{self, Explained, Explanation},
    },
    protocol::satrak::encode,
    sim::satrak::BUNDLED_FILE,
    station::{self, AntennaId},
    ui::words,
};
use egui::Key;
use jiff::{Timestamp, tz::TimeZone};

use crate::window_stories::{
    rig::{self, LARGE, asked},
    settings::settles,
    settings_rig::{apply, hold, opened, press, read, says, state_of, texts},
    states,
    unit::{Unit, clock_from, open, step_until},
};

fn elsewhere(off_deg: f64) -> Ranked {
    let place = Place { latitude_deg: 12.3, longitude_deg: 45.6, step_deg: 0.01 };
    let off = Some(Angle::from_degrees(off_deg));
    Ranked { cause: Cause::Place { place, away_km: 1596.1 }, max_error: off }
}

pub(crate) fn found(off_deg: f64) -> Supervision {
    Supervision {
        worst: Error { angle: Angle::from_degrees(off_deg), time: rig::now() },
        is_within_beam: off_deg < 0.44,
        causes: vec![elsewhere(off_deg)],
        unknown: vec![Unknown::Elements],
        lower_minimum_deg: None,
    }
}

pub(crate) fn told(found: Supervision) -> Snapshot {
    let mut snapshot = states::holding();
    snapshot.on_board = Some(OnBoardView { found: Arc::new(found), missing: None, arrives: None });
    snapshot
}

#[test]
fn the_cause_of_an_error_goes_once_the_antenna_is_measured_within_its_beam() {
    let cause = pass_report::Cause::ElevationOffset { offset_deg: 2.0 };
    let causes = vec![Explanation { cause, left_deg: 0.01, share: 0.9, partner: None }];
    let says_cause = |off_deg: f64, error_deg: f64| {
        let mut model = rig::model(states::tracking(off_deg));
        model.shown_mut().antennas[0].explained =
            Some(Explained { causes: causes.clone(), error_deg });
        says(&rig::window(LARGE, model), "The elevation is off by +2.00°")
    };
    assert!(says_cause(2.0, 1.9));
    assert!(!says_cause(0.04, 1.9), "it is inside the beam again");
    assert!(says_cause(0.3, 0.3), "an error within the beam has a cause too");
}

#[test]
fn a_unit_that_would_miss_is_started_by_holding_only() {
    let mut window = rig::window(LARGE, rig::model(told(found(23.0))));
    assert!(says(&window, "The unit's location is 1596 km from this station: 12.30"));
    assert!(says(&window, "Follow it from here instead."));
    assert!(!texts(&window).iter().any(|text| text.ends_with(", Trackable")));
    assert!(texts(&window).iter().any(|text| text.ends_with(", The unit would miss it")));
    hold(&mut window, "Hold 1 s to track anyway");
    let asked = asked(&mut window);
    assert!(
        matches!(
            asked[..],
            [UiCommand::Station(contract::Command::Track {
                antenna: AntennaId(1),
                is_agreed: true,
                ..
            })]
        ),
        "{asked:?}"
    );
}

#[test]
fn a_unit_that_is_a_little_off_or_points_lower_is_told_of() {
    let lower = Supervision { lower_minimum_deg: Some(3.0), ..found(0.2) };
    let window = rig::window(LARGE, rig::model(told(lower)));
    assert!(says(&window, "Up to 0.20° off: the unit's location is 1596 km"));
    assert!(says(&window, "The unit's minimum elevation is 3.0°, the station's 5.0°."));
    assert!(texts(&window).iter().any(|text| text.ends_with(", Trackable")));
}

#[test]
fn the_minimum_of_the_station_is_filled_in_to_be_applied() {
    let mut window = opened(LARGE, read());
    press(&mut window, "Use the station's 5.0°");
    assert_eq!(asked(&mut window), [], "filled in, not sent");
    assert_eq!(state_of(&window, "Minimum elevation"), "Edited");
    apply(&mut window);
    let values = settles(asked(&mut window)).remove(0).values;
    assert_eq!(values, [("minimum_elevation_deg", Value::Decimal(5.0))].into());
}

#[test]
fn a_missed_satellite_is_told_with_the_likeliest_cause() {
    let off = Angle::from_degrees(23.04);
    let missed = AlarmKind::OffTarget {
        deviation: off,
        cause: Some(OffTargetCause::Reported(elsewhere(23.0))),
    };
    let said = words::alarm(&missed, "Satrak", rig::now());
    assert!(said.starts_with("Satrak is 23.0° off its satellite. The unit's location is 1596 km"));
    let unexplained = AlarmKind::OffTarget { deviation: off, cause: None };
    let said = words::alarm(&unexplained, "Satrak", rig::now());
    assert!(said.contains("check its drives, and the age of its elements"), "{said}");
}

/// Sends the payloads to the unit from another client, one after the other.
fn by_another(unit: &Unit, payloads: &[&str]) {
    let mut stream = TcpStream::connect(unit.address).unwrap();
    let mut lines = BufReader::new(stream.try_clone().unwrap()).lines();
    for payload in payloads {
        stream.write_all(&encode(payload)).unwrap();
        let line = lines.next().unwrap().unwrap();
        assert!(line.contains("OK"), "{payload}: {line}");
    }
}

/// Lets another client start a track of a satellite from the unit's file, five minutes after `utc`.
fn track_by_another(unit: &Unit, satellite: &str, utc: Timestamp) {
    let text = |at| TimeZone::UTC.to_datetime(at).strftime("%-H,%-M,%-S,%-d,%-m,%Y").to_string();
    let (from, until) = (add_seconds(utc, 300.0), add_seconds(utc, 900.0));
    let satellite = format!("SATELLITE=,{BUNDLED_FILE},{satellite},1,0");
    let window = format!("START_STOP_TIME=,{},{}", text(from), text(until));
    by_another(unit, &[&satellite, &window, "TRACK=,1"]);
}

#[test]
fn what_the_unit_tracks_unasked_is_compared_by_the_elements_of_the_station() {
    let utc: Timestamp = "2026-08-12T11:14:30Z".parse().unwrap();
    let (unit, folder) = (Unit::start(utc), tempfile::tempdir().unwrap());
    let path = folder.path().join("station.toml");
    station::save(&unit.station(), &path, SPECS).unwrap();
    let catalog = bundled().unwrap();
    let held = catalog.get(rig::station().favourites.numbers()[0]).unwrap().name().to_owned();
    track_by_another(&unit, &held, utc);
    let mut window = open(&path, clock_from(utc));
    step_until(&mut window, "it is compared", |model| {
        model.antenna().is_some_and(|antenna| antenna.snapshot.on_board.is_some())
    });
    assert_eq!(window.state().model().antenna().unwrap().snapshot.target, None);
}

/// Elements of an object that is not in the catalog.
const UNKNOWN: &str = r#"[{"OBJECT_NAME": "HOMEMADE", "OBJECT_ID": "2026-999A",
    "NORAD_CAT_ID": 799999999, "EPOCH": "2026-08-12T00:00:00", "MEAN_MOTION": 15.2,
    "ECCENTRICITY": 0.0005, "INCLINATION": 97.5, "RA_OF_ASC_NODE": 120.0,
    "ARG_OF_PERICENTER": 30.0, "MEAN_ANOMALY": 10.0, "BSTAR": 0.0001}]"#;

#[test]
fn what_the_unit_tracks_that_the_station_has_no_elements_of_is_an_alarm() {
    let utc: Timestamp = "2026-08-12T11:14:30Z".parse().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let unit = Unit::of_elements(read_elements(UNKNOWN).elements, utc);
    let path = folder.path().join("station.toml");
    station::save(&unit.station(), &path, SPECS).unwrap();
    track_by_another(&unit, "HOMEMADE", utc);
    let mut window = open(&path, clock_from(utc));
    let not_compared = AlarmKind::NotCompared { satellite: Some("HOMEMADE".to_owned()) };
    let stands = |model: &Model, is_over: bool| {
        let mut alarms = model.alarms.list().iter();
        alarms.any(|alarm| alarm.kind == not_compared && alarm.is_over() == is_over)
    };
    step_until(&mut window, "it is told", |model| stands(model, false));
    let said = words::alarm(&not_compared, "Satrak", rig::now());
    assert!(said.contains("add a source that has them"), "{said}");
    window.key_press(Key::Escape);
    step_until(&mut window, "it is over", |model| stands(model, true));
}
