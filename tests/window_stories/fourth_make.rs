//! Make that the library does not know. The tests describe and drive it here, read it from the
//! station file, set it up in the form and move it.

mod lever;

use std::{
    sync::{Arc, mpsc},
    time::Duration,
};

use azel::{
    astro::{Angle, AzEl},
    clock::{Clock, Instant},
    contract::driver::{Command, Event, Intent, Safety, Snapshot, StopState},
    controller::SPECS,
    device::Pointing,
    driver::{AntennaHandle, Driver},
    model::View,
    plan::Bounds,
    station::{self, Antenna, ControllerSpec, Station},
};
use egui::{Key, Role};
use egui_kittest::kittest::Queryable as _;

use self::lever::{CODE, GEAR, SHAFTS, SPEC, unit};
use crate::window_stories::{
    makes::{alone, alone_at, model},
    preferences::{self, open, saved, write},
    rig::{self, SIZES, asked, says, settle},
};

/// Time limit of any wait in these tests.
const PATIENCE: Duration = Duration::from_secs(20);

fn all_specs() -> Vec<&'static ControllerSpec> {
    let mut specs = SPECS.to_vec();
    specs.push(&SPEC);
    specs
}

fn at(shown: &Snapshot, azimuth_deg: f64, elevation_deg: f64) -> bool {
    let there = Pointing::from(AzEl::from_degrees(azimuth_deg, elevation_deg));
    let measured = shown.state.measured.map(|measured| measured.pointing);
    let off = measured.and_then(|measured| measured.separation(there));
    off.is_some_and(|off| off.degrees() < 0.01)
}

#[test]
fn its_antenna_is_read_from_the_station_file_and_comes_back_as_it_was_saved() {
    const TEXT: &str = "[[antenna]]\n[antenna.connection]\ncontroller = 'lever'\n\
        address = 'tower:7'\ncode = 'eureka'\nlength = 3\n\
        [antenna.connection.drive]\ngear = 'reverse'\nshafts = 4\noil = true\n";
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("station.toml");
    std::fs::write(&path, TEXT).unwrap();
    let loaded = station::load(&path, &all_specs()).unwrap();
    let notes: Vec<&str> = loaded.notes.iter().map(|note| &*note.place).collect();
    assert_eq!(
        notes,
        [
            "antenna[0].connection.drive.gear",
            "antenna[0].connection.drive.oil",
            "antenna[0].connection.length"
        ]
    );
    let [antenna] = &loaded.station.antennas[..] else { panic!("{:?}", loaded.station) };
    let connection = &antenna.connection;
    assert_eq!((&*antenna.name, antenna.beam_width_deg.round()), ("Lever", 7.0));
    assert_eq!((connection.text(&CODE), connection.text(&GEAR)), ("eureka", "low"));
    assert_eq!(connection.whole(&SHAFTS), 4);

    let mut station = loaded.station.clone();
    station.antennas[0].connection.put(&GEAR, "high").unwrap();
    station::save(&station, &path, &all_specs()).unwrap();
    let again = station::load(&path, &all_specs()).unwrap();
    assert_eq!(again.station, station);
    let places: Vec<_> = again.notes.iter().map(|note| note.place.as_str()).collect();
    // The save repaired the entry of the gear; the other bad entries still stand in the file.
    assert_eq!(places, ["antenna[0].connection.drive.oil", "antenna[0].connection.length"]);

    let known = station::load(&path, SPECS).unwrap();
    assert_eq!(known.station.antennas, [], "without its description it is not known");
}

#[test]
fn its_own_settings_are_fields_of_the_form() {
    for size in rig::sizes() {
        let antenna = SPEC.antenna("Lever", SPEC.default_address);
        let mut model = model(antenna.clone(), rig::quiet());
        (model.view, Arc::make_mut(&mut model.shown_mut().station).antennas) =
            (View::Preferences, vec![antenna]);
        let mut window = rig::window(size, model);
        open(&mut window, "Lever");
        assert!(says(&window, "Lever. Archimedes Lever, "));
        assert!(says(&window, "It takes no orders so.") && says(&window, "Drive"));
        write(&mut window, "Address of the Lever", "tower:8");
        write(&mut window, "Access code", "eureka");
        assert!(!says(&window, "It takes no orders so."));
        let gear = window.get_by_role_and_label(Role::RadioButton, "High gear");
        gear.scroll_to_me();
        settle(&mut window);
        window.get_by_role_and_label(Role::RadioButton, "High gear").click();
        settle(&mut window);
        write(&mut window, "Shafts", "5");
        assert!(says(&window, "Shafts must be a whole number from 1 to 4."));
        write(&mut window, "Shafts", "3");
        window.get_by_role_and_label(Role::Button, "Save and use").click();
        let station: Station = saved(preferences::asked(&mut window));
        let connection = &station.antennas[0].connection;
        assert_eq!((&*connection.address, connection.text(&CODE)), ("tower:8", "eureka"));
        assert_eq!((connection.text(&GEAR), connection.whole(&SHAFTS)), ("high", 3));
    }
}

#[test]
fn on_one_shaft_it_shows_and_turns_the_azimuth_alone() {
    let mut antenna = SPEC.antenna("Lever", SPEC.default_address);
    antenna.connection.put(&SHAFTS, 1).unwrap();
    antenna.mount = alone().mount;
    for size in rig::sizes() {
        let snapshot = alone_at(Intent::Manual, false);
        let mut window = rig::window(size, model(antenna.clone(), snapshot));
        assert!(window.query_by_label("Jog clockwise").is_some());
        let second = ["Jog up", "Jog down", "Jog Other +", "Jog Other −"];
        assert!(second.iter().all(|key| window.query_by_label(key).is_none()));
        assert!(!says(&window, "has no known angle") && !says(&window, "El: "));
        window.get_by_label("Jog clockwise").focus();
        settle(&mut window);
        window.key_down(Key::ArrowUp);
        settle(&mut window);
        window.key_up(Key::ArrowUp);
        settle(&mut window);
        assert_eq!(asked(&mut window), [], "there is no axis up");
    }
}

#[test]
fn it_is_told_its_settings_read_sent_and_stopped_and_shown() {
    let (address, heard) = unit();
    let mut antenna: Antenna = SPEC.antenna("Lever", &address);
    antenna.connection.put(&CODE, "eureka").unwrap();
    let (woke, woken) = mpsc::sync_channel(1);
    let wake = Arc::new(move || {
        let _ = woke.try_send(());
    });
    let driver = Driver::start(Clock::new(jiff::Timestamp::now), wake).unwrap();
    let handle: AntennaHandle =
        driver.open(&antenna, Bounds::of_antenna(&antenna), Default::default(), None, Box::new(()));
    let until = |is_so: &dyn Fn(&Snapshot) -> bool| {
        let since = Instant::now();
        while !is_so(&handle.snapshot()) {
            woken.recv_timeout(PATIENCE).unwrap();
            assert!(Instant::now() - since < PATIENCE, "{:?}", handle.snapshot());
        }
    };
    let next = || heard.recv_timeout(PATIENCE).unwrap();
    until(&|shown| at(shown, 10.0, 20.0));
    handle
        .send(Command::Position {
            azimuth: Some(Angle::from_degrees(200.0)),
            elevation: Some(Angle::from_degrees(40.0)),
        })
        .unwrap();
    until(&|shown| at(shown, 200.0, 40.0));
    handle.stop();
    until(&|shown| matches!(shown.stop, StopState::Stopped { .. }));
    assert_eq!([next(), next(), next()], ["C eureka low 2", "G 200 40", "S"]);

    let mut shown = model(antenna, Snapshot::clone(&handle.snapshot()));
    shown.view = View::Operate;
    let window = rig::window(SIZES[0], shown);
    assert!(says(&window, "200.00"), "the card shows where it is");
}

#[test]
fn a_controller_that_breaks_down_is_started_again_with_stop() {
    let (address, heard) = unit();
    let antenna: Antenna = SPEC.antenna("Lever", &address);
    let (woke, woken) = mpsc::sync_channel(1);
    let wake = Arc::new(move || {
        let _ = woke.try_send(());
    });
    let driver = Driver::start(Clock::new(jiff::Timestamp::now), wake).unwrap();
    let mut handle: AntennaHandle =
        driver.open(&antenna, Bounds::of_antenna(&antenna), Default::default(), None, Box::new(()));
    let to = |azimuth: f64, elevation: f64| Command::Position {
        azimuth: Some(Angle::from_degrees(azimuth)),
        elevation: Some(Angle::from_degrees(elevation)),
    };
    let next = || heard.recv_timeout(PATIENCE).unwrap();
    while !at(&handle.snapshot(), 10.0, 20.0) {
        woken.recv_timeout(PATIENCE).unwrap();
    }
    assert!(next().starts_with("C "));
    handle.send(to(180.0, 45.0)).unwrap();
    let broke = Event::Safety(Safety::SessionBroke);
    while !std::iter::from_fn(|| handle.next_event()).any(|event| event == broke) {
        woken.recv_timeout(PATIENCE).unwrap();
    }
    assert_eq!(next(), "S", "the first word of the next session");
    while !matches!(handle.snapshot().stop, StopState::Stopped { .. }) {
        woken.recv_timeout(PATIENCE).unwrap();
    }
    handle.send(to(200.0, 40.0)).unwrap();
    while !at(&handle.snapshot(), 200.0, 40.0) {
        woken.recv_timeout(PATIENCE).unwrap();
    }
}
