//! Demo station: a simulated unit of each make, behind real links.

use std::{collections::BTreeMap, fs, net::TcpStream, sync::Arc};

use azel::{
    app::App,
    astro::{Angle, AzEl},
    clock::Clock,
    contract::{
        self,
        alarms::AlarmKind,
        driver::{Command, LinkState, StopState},
        record::Row,
    },
    controller::SPECS,
    device::{Measured, panel::Act, settings::Value},
    engine::{self, Handle, Settings},
    model::{Model, UiCommand, View},
    record::{Query, Record, RowKind},
    station,
};
use egui::{Key, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use jiff::ToSpan as _;

use crate::window_stories::{
    rig,
    settings_rig::says,
    unit::{RealWindow, clock_from, open_as, open_demo, step_until, wait_until},
};

const SATRAK: usize = 0;
const GENIUS: usize = 1;
const RC2000C: usize = 2;

fn link(model: &Model, antenna: usize) -> LinkState {
    model.antennas[antenna].snapshot.link.clone()
}

fn measured(model: &Model, antenna: usize) -> Option<Measured> {
    let is_up = matches!(link(model, antenna), LinkState::Up { .. });
    model.antennas[antenna].snapshot.state.measured.filter(|_| is_up)
}

/// Returns `true` if the antenna stands at this direction, within the resolution of its sensor.
fn stands_at(model: &Model, antenna: usize, azimuth_deg: f64, elevation_deg: f64) -> bool {
    let wanted = AzEl::from_degrees(azimuth_deg, elevation_deg);
    measured(model, antenna).is_some_and(|measured| {
        let direction = measured.pointing.direction();
        !measured.moving() && direction.is_some_and(|of| of.separation(wanted).degrees() < 1.2)
    })
}

fn send(window: &RealWindow, antenna: usize, command: Command) {
    let id = window.state().model().antennas[antenna].id();
    let command = contract::Command::Antenna(id, command);
    assert!(window.state().station().client().send(command).is_ok());
}

fn go_to(window: &mut RealWindow, antenna: usize, azimuth_deg: f64, elevation_deg: f64) {
    let angle = |degrees| Some(Angle::from_degrees(degrees));
    let (azimuth, elevation) = (angle(azimuth_deg), angle(elevation_deg));
    send(window, antenna, Command::Position { azimuth, elevation });
    step_until(window, "it arrives", |model| stands_at(model, antenna, azimuth_deg, elevation_deg));
}

#[test]
fn every_make_is_there_and_the_one_with_a_panel_waits_for_a_word() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = open_demo(&folder);
    let model = window.state().model();
    assert!(model.demo);
    let keys: Vec<&str> = model.antennas.iter().map(|of| of.spec().key).collect();
    assert_eq!(keys, ["satrak", "genius", "rc2000c"]);
    for antenna in [SATRAK, GENIUS] {
        step_until(&mut window, "it is measured", |model| measured(model, antenna).is_some());
    }
    assert!(matches!(link(window.state().model(), RC2000C), LinkState::Off));
    assert_eq!(window.state().model().wires[RC2000C].next_number(), 0);
}

#[test]
fn the_rc2000c_is_calibrated_and_goes_where_it_is_sent() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = open_demo(&folder);
    send(&window, RC2000C, Command::Connect);
    // The unit starts at 1525 and 750 counts, with 20 counts a degree.
    step_until(&mut window, "it is measured", |model| stands_at(model, RC2000C, 164.75, 36.0));
    go_to(&mut window, RC2000C, 169.0, 33.0);
}

#[test]
fn an_rc2000c_that_tracks_by_itself_is_compared_with_nothing_and_that_is_an_alarm() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = open_demo(&folder);
    send(&window, RC2000C, Command::Connect);
    let is_listed = |model: &Model| {
        let state = &model.antennas[RC2000C].snapshot.state;
        let mut readings = state.readings.iter();
        readings.any(|of| of.label == "Stored satellites" && !of.text.ends_with('…'))
    };
    step_until(&mut window, "its satellites are read", is_listed);
    send(&window, RC2000C, Command::Manual);
    let values = BTreeMap::from([("satellite", Value::Text("GSTAR 3".to_owned()))]);
    send(&window, RC2000C, Command::ActUnseen(Act { action: "to_satellite", values }));
    let not_compared = AlarmKind::NotCompared { satellite: None };
    let is_told = |model: &Model| {
        let mut alarms = model.alarms.list().iter();
        alarms.any(|alarm| {
            alarm.antenna == Some(model.antennas[RC2000C].id()) && alarm.kind == not_compared
        })
    };
    step_until(&mut window, "it is told", is_told);
}

#[test]
fn the_first_track_raises_no_alarm_about_the_unit_however_old_the_bundled_elements_are() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = open_demo(&folder);
    step_until(&mut window, "it is measured", |model| measured(model, SATRAK).is_some());
    step_until(&mut window, "a pass is ahead", |model| model.next_pass().is_some());
    window.key_press(Key::N);
    step_until(&mut window, "it is selected", |model| model.selected_pass().is_some());
    let track = UiCommand::track_selected(window.state().model());
    let Some(UiCommand::Station(track)) = track else { panic!("{track:?}") };
    assert!(window.state().station().client().send(track).is_ok());
    let state = |model: &Model| model.antennas[SATRAK].snapshot.state.clone();
    step_until(&mut window, "the unit holds it", |model| {
        state(model).on_board.satellite.is_some_and(|held| held.catalog_number > 0)
    });
    let heard = window.state().model().wires[SATRAK].next_number();
    step_until(&mut window, "it has told its faults, if any", |model| {
        model.wires[SATRAK].next_number() > heard + 60
    });
    let alarms = &window.state().model().alarms;
    let of_unit = alarms.list().iter().find(|alarm| matches!(alarm.kind, AlarmKind::Check(_)));
    assert!(of_unit.is_none(), "{of_unit:?}");
}

#[test]
fn the_genius_goes_where_it_is_sent() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = open_demo(&folder);
    step_until(&mut window, "it is measured", |model| stands_at(model, GENIUS, 173.0, 0.0));
    go_to(&mut window, GENIUS, 181.0, 7.0);
}

#[test]
fn a_demo_that_was_asked_for_opens_without_the_set_up() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("station-2.toml");
    let mut window = open_as(&path, Clock::system(), App::without_set_up);
    step_until(&mut window, "the antennas are there", |model| model.antennas.len() == 3);
    let model = window.state().model();
    assert!(model.demo && model.view == View::Operate);
    window.run_steps(2);
    window.get_by_role_and_label(Role::Button, "Set up your station");
}

#[test]
fn a_station_of_somebody_else_is_not_overwritten_by_the_set_up() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = open_demo(&folder);
    let path = folder.path().join("station.toml");
    let theirs = "name = 'Theirs'\n";
    fs::write(&path, theirs).unwrap();
    window.get_by_role_and_label(Role::Tab, "Preferences").click();
    window.run_steps(3);
    window.get_by_role_and_label(Role::Button, "Save and end the demo").click();
    wait_until("it is told", || {
        window.step();
        says(&window, "Not saved: a station has been set up elsewhere meanwhile")
    });
    assert!(window.state().model().demo, "it goes on");
    assert_eq!(fs::read_to_string(&path).unwrap(), theirs);
}

#[test]
fn a_pass_under_way_is_reported_before_a_station_of_ones_own_comes_into_use() {
    let folder = tempfile::tempdir().unwrap();
    let records = folder.path().join("records");
    let settings = Settings {
        path: Some(folder.path().join("station.toml")),
        library: Some(folder.path().join("elements")),
        records: Some(records.clone()),
        dead_man: Some(env!("CARGO_BIN_EXE_azel").into()),
        ..Settings::default()
    };
    let running = Handle::start(settings, clock_from(rig::now()), Arc::new(|| ())).unwrap();
    let client = running.client();
    // Azel refuses the track until it knows the faults of the unit.
    wait_until("the track", || {
        let shown = client.snapshot();
        if shown.antennas.get(SATRAK).is_some_and(azel::contract::antenna::AntennaModel::tracks) {
            return true;
        }
        let now = client.now().utc;
        let satrak = shown.antennas.get(SATRAK);
        let satrak = satrak.filter(|satrak| satrak.snapshot.state.measured.is_some());
        let passes = shown.pass_lists.favourites.upcoming(now);
        let pass = passes.iter().find(|pass| pass.in_progress(now));
        let Some((satrak, pass)) = satrak.zip(pass) else { return false };
        let (antenna, pass) = (satrak.id(), pass.key());
        client.send(contract::Command::ProgramTrackPass { antenna, pass }).unwrap();
        false
    });
    let tracked_at = client.now().utc;
    // The station takes the track up within a second.
    wait_until("the pass", || client.now().utc > tracked_at + 2.seconds());
    let own = station::Station { antennas: Vec::new(), ..station::Station::default() };
    client.send(contract::Command::SaveStation(Box::new(own))).unwrap();
    wait_until("the station of one's own", || !client.snapshot().demo);
    let query = Query { row_kinds: vec![RowKind::Pass], ..Query::default() };
    let mut passes = Vec::new();
    let mut record = Record::open(&engine::demo_record_path(&records)).unwrap();
    let mut take = |row: Row| {
        passes.push(row.data);
        true
    };
    record.read(&query, &mut take).unwrap();
    let [pass] = &passes[..] else { panic!("{passes:?}") };
    assert_eq!(pass["report"]["tracked_by"], "program_track", "{pass}");
}

#[test]
fn the_simulators_end_with_the_demonstration() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = open_demo(&folder);
    let addresses = window.state().model().antennas.iter().take(2);
    let addresses: Vec<String> =
        addresses.map(|antenna| antenna.config.connection.address.clone()).collect();
    window.get_by_role_and_label(Role::Tab, "Preferences").click();
    window.run_steps(3);
    window.get_by_role_and_label(Role::Button, "Save and end the demo").click();
    step_until(&mut window, "the demonstration is over", |model| !model.demo);
    let saved = station::load(&folder.path().join("station.toml"), SPECS).unwrap();
    assert_eq!(saved.notes, []);
    assert_eq!(saved.station, *window.state().model().station);
    for address in addresses {
        wait_until("nobody listens", || TcpStream::connect(&address).is_err());
    }
}

#[test]
fn esc_takes_no_panel_and_the_card_stops_the_unit_all_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = open_demo(&folder);
    let is_off = |model: &Model| link(model, RC2000C) == LinkState::Off;
    step_until(&mut window, "the Satrak is measured", |model| measured(model, SATRAK).is_some());
    assert!(is_off(window.state().model()));
    window.key_press(Key::Escape);
    let others =
        |model: &Model| matches!(model.antennas[SATRAK].snapshot.stop, StopState::Stopped { .. });
    step_until(&mut window, "the others are stopped", others);
    let said = &window.state().model().antennas[RC2000C].snapshot;
    assert_eq!((&said.link, said.stop), (&LinkState::Off, StopState::Ready));

    window.key_press(Key::F3);
    window.run_steps(3);
    window.get_by_role_and_label(Role::Button, "Connect and STOP RC2000C").click();
    step_until(&mut window, "it is stopped", |model| {
        matches!(model.antennas[RC2000C].snapshot.stop, StopState::Stopped { .. })
    });
    step_until(&mut window, "it is let go of", is_off);
}

#[test]
fn the_band_of_the_demonstration_and_the_rail_keep_their_places_in_all_views() {
    let views = [
        View::Operate,
        View::Plan,
        View::Elements,
        View::Antennas,
        View::Console,
        View::Map,
        View::Preferences,
    ];
    for size in rig::SIZES {
        let seen = views.map(|view| {
            let mut model = rig::model(rig::quiet());
            model.shown_mut().demo = true;
            model.view = view;
            let window = rig::window(size, model);
            let words = window.get_by_label_contains("Demo station:");
            let words = words.accesskit_node().label().unwrap_or_default();
            let button = window.get_by_role_and_label(Role::Button, "Set up your station").rect();
            let first = window.get_by_role_and_label(Role::Tab, "Operate").rect();
            (words, button, first)
        });
        for (view, other) in views.iter().zip(&seen) {
            assert_eq!(*other, seen[0], "{view:?} at {size:?}");
        }
    }
}
