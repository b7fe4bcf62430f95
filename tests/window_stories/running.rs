//! The real app with a simulated unit behind a real socket.

use std::time::Duration;

use azel::{
    astro::AzEl,
    clock::{Clock, Instant},
    contract::{
        CatalogState,
        driver::{Intent, LinkState, StopState},
    },
    controller::SPECS,
    device::Measured,
    model::{Model, ThemeName, View},
    protocol::satrak::AxisMotion,
    station,
    ui::theme,
};
use egui::{Event, Key, Modifiers, Role};
use egui_kittest::kittest::Queryable as _;

use crate::window_stories::{
    rig::NOAA_20,
    unit::{RealWindow, Unit, clock_from, open, open_demo, step_until, wait_until},
};

fn measured(model: &Model) -> Option<Measured> {
    let antenna = model.antenna()?;
    matches!(antenna.snapshot.link, LinkState::Up { .. })
        .then_some(antenna.snapshot.state.measured?)
}

fn moves(model: &Model) -> bool {
    measured(model).is_some_and(|measured| measured.moving())
}

fn stands(model: &Model) -> bool {
    measured(model).is_some_and(|measured| !measured.moving())
}

fn replies(model: &Model) -> u64 {
    model.antenna().map_or(0, |antenna| antenna.snapshot.state.traffic.replies)
}

fn intent(model: &Model) -> Option<Intent> {
    model.antenna().filter(|antenna| !antenna.snapshot.pending).map(|of| of.snapshot.intent)
}

fn place(window: &RealWindow) -> AzEl {
    measured(window.state().model()).unwrap().direction().unwrap()
}

/// Opens the window of the demo station and waits until its antenna is measured.
fn demo(folder: &tempfile::TempDir) -> RealWindow {
    let mut window = open_demo(folder);
    step_until(&mut window, "the antenna is measured", stands);
    assert!(window.state().model().demo);
    window
}

/// Holds the key of a jog until the condition holds. On a busy machine, a frame longer than the
/// lease rightly ends a jog. The function then presses the key again, as a hand would.
fn hold_jog_until(window: &mut RealWindow, what: &str, is_so: impl Fn(&Model) -> bool) {
    window.get_by_role_and_label(Role::RadioButton, "Manual").click();
    step_until(window, "manual", |model| intent(model) == Some(Intent::Manual));
    let key = window.get_by_label("Jog X+").rect().center();
    let mut press_at = Instant::now();
    wait_until(what, || {
        if Instant::now() >= press_at {
            window.drop_at(key);
            window.drag_at(key);
            press_at = Instant::now() + Duration::from_secs(3);
        }
        window.step();
        is_so(window.state().model())
    });
}

#[test]
fn a_held_jog_moves_the_antenna_and_its_release_stops_it() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = demo(&folder);
    let before = place(&window);
    hold_jog_until(&mut window, "it gets on", |model| {
        measured(model)
            .is_some_and(|now| now.direction().unwrap().separation(before).degrees() > 0.3)
    });
    window.drop_at(window.get_by_label("Jog X+").rect().center());
    step_until(&mut window, "it stands", stands);
    assert_eq!(intent(window.state().model()), Some(Intent::Manual));
}

#[test]
fn esc_stops_a_jog_that_is_held_on_and_it_stays_stopped() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = demo(&folder);
    hold_jog_until(&mut window, "it moves", moves);
    window.key_press(Key::Escape);
    step_until(&mut window, "it is stopped", is_stopped);
    let at = place(&window);
    let heard = replies(window.state().model());
    step_until(&mut window, "it goes on telling", |model| replies(model) > heard + 6);
    assert!(stands(window.state().model()));
    assert_eq!(place(&window), at);
}

#[test]
fn esc_shows_stop_as_pressed_in_its_own_frame() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = demo(&folder);
    window.get_by_role_and_label(Role::Button, "STOP");
    window.event(Event::Key {
        key: Key::Escape,
        physical_key: None,
        pressed: true,
        repeat: false,
        modifiers: Modifiers::NONE,
    });
    window.step();
    window.get_by_role_and_label(Role::Button, "STOP, stopping");
    step_until(&mut window, "it is stopped", is_stopped);
    wait_until("all of them are stopped", || {
        window.step();
        window.query_by_role_and_label(Role::Button, "STOP, all stopped").is_some()
    });
    let pressed = |model: &Model| model.antennas.iter().any(|of| of.stop_pressed.is_some());
    assert!(!pressed(window.state().model()));
}

fn go_to(window: &mut RealWindow, azimuth: &str, elevation: &str) {
    for (field, words) in [("azimuth", azimuth), ("elevation", elevation)] {
        let field = format!("Go to {field}, degrees");
        window.get_by_label(&field).focus();
        window.run_steps(2);
        window.key_press_modifiers(Modifiers::COMMAND, Key::A);
        window.event(Event::Text(words.to_owned()));
        window.run_steps(2);
    }
    window.key_press(Key::Enter);
    window.key_press(Key::Enter);
    step_until(window, "it goes", moves);
}

#[test]
fn esc_stops_from_a_text_field_from_a_question_and_from_another_view() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = demo(&folder);
    window.get_by_role_and_label(Role::RadioButton, "Position").click();
    step_until(&mut window, "position", |model| intent(model) == Some(Intent::Position));
    go_to(&mut window, "90", "30");
    window.get_by_label("Go to azimuth, degrees").focus();
    window.step();
    window.key_press(Key::Escape);
    step_until(&mut window, "it is stopped while typing", is_stopped);
    assert!(far_from(&window, 90.0, 30.0), "stopped, not arrived");

    for (modifiers, key, sign) in
        [(Modifiers::NONE, Key::T, "The antenna moves"), (Modifiers::COMMAND, Key::Num6, "Revert")]
    {
        window.get_by_role_and_label(Role::RadioButton, "Position").click();
        step_until(&mut window, "position", |model| intent(model) == Some(Intent::Position));
        go_to(&mut window, "270", "30");
        step_until(&mut window, "a pass is selected", |model| model.selected_pass().is_some());
        window.get_by_role_and_label(Role::Tab, "Operate").focus();
        window.step();
        window.key_press_modifiers(modifiers, key);
        window.run_steps(2);
        window.get_by_label_contains(sign);
        window.key_press(Key::Escape);
        step_until(&mut window, "it is stopped", is_stopped);
        assert!(far_from(&window, 270.0, 30.0), "stopped, not arrived");
        assert!(window.query_by_label_contains("The antenna moves").is_none());
    }
}

fn far_from(window: &RealWindow, azimuth_deg: f64, elevation_deg: f64) -> bool {
    let target = AzEl::from_degrees(azimuth_deg, elevation_deg);
    place(window).separation(target).degrees() > 5.0
}

fn is_stopped(model: &Model) -> bool {
    let stop = model.antenna().map(|antenna| antenna.snapshot.stop);
    matches!(stop, Some(StopState::Stopped { .. })) && stands(model)
}

#[test]
fn a_satellite_that_is_up_is_tracked_within_the_beam() {
    // NOAA 20 is near its maximum elevation.
    let utc = "2026-08-12T11:14:30Z".parse().unwrap();
    let (unit, folder) = (Unit::start(utc), tempfile::tempdir().unwrap());
    let path = folder.path().join("station.toml");
    station::save(&unit.station(), &path, SPECS).unwrap();
    let mut window = open(&path, clock_from(utc));
    step_until(&mut window, "the antenna is measured", stands);
    step_until(&mut window, "the passes are planned", |model| {
        // Wait for the first plan, because it changes the places of the bars in the strip.
        model.schedule.made_at.is_some() && model.pass_of(NOAA_20).is_some()
    });
    assert!(!window.state().model().demo);
    window.get_by_label_contains("NOAA 20, 11:08Z to 11:21Z").click();
    window.run_steps(2);
    window.get_by_role_and_label(Role::Button, "Track NOAA 20").click();
    step_until(&mut window, "it follows within the beam", |model| {
        let Some(antenna) = model.antenna().filter(|antenna| antenna.tracks()) else {
            return false;
        };
        let half_beam_deg = antenna.config.beam_width_deg / 2.0;
        antenna.error().is_some_and(|error| error.off_beam.degrees() < half_beam_deg)
    });
    assert!(unit.control.state().is_tracking);
    window.key_press(Key::Escape);
    step_until(&mut window, "STOP ends it", |model| stands(model) && !tracks(model));
}

fn tracks(model: &Model) -> bool {
    let program = model.antenna().and_then(|antenna| antenna.snapshot.state.program);
    program.is_some_and(|program| program.enabled)
}

#[test]
fn closing_the_window_during_a_jog_stops_the_antenna() {
    let utc = "2026-08-12T11:14:30Z".parse().unwrap();
    let (unit, folder) = (Unit::start(utc), tempfile::tempdir().unwrap());
    let path = folder.path().join("station.toml");
    station::save(&unit.station(), &path, SPECS).unwrap();
    let mut window = open(&path, clock_from(utc));
    step_until(&mut window, "the antenna is measured", stands);
    hold_jog_until(&mut window, "it moves", moves);
    drop(window);
    assert!(!unit.control.state().is_moving, "standstill is waited for");
    let mut status = None;
    wait_until("another client is taken", || {
        status = unit.status();
        status.is_some()
    });
    wait_until("the unit stands", || {
        unit.status().is_some_and(|status| {
            status.x_motion == AxisMotion::Still && status.y_motion == AxisMotion::Still
        })
    });
    let received = unit.control.received();
    let last = received.iter().rev().find(|(_, frame)| !frame.contains('?')).unwrap();
    let stop = ["STOP=", "TRACK=,0", "TRACK_AUTO_ENABLE=,0"];
    assert!(stop.contains(&last.1.as_str()), "{last:?}");
}

#[test]
fn saving_writes_the_file_and_ends_the_demonstration() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("station.toml");
    let mut window = demo(&folder);
    assert!(!path.exists());
    window.get_by_role_and_label(Role::Tab, "Preferences").click();
    window.run_steps(3);
    window.get_by_role_and_label(Role::TextInput, "Latitude").focus();
    window.run_steps(2);
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.event(Event::Text("-33.5".to_owned()));
    window.run_steps(3);
    window.get_by_role_and_label(Role::Button, "Save and end the demo").click();
    step_until(&mut window, "the demonstration is over", |model| !model.demo);
    let saved = station::load(&path, SPECS).unwrap();
    assert_eq!(saved.notes, []);
    assert_eq!(saved.station, *window.state().model().station);
    assert!((saved.station.site.latitude().degrees() + 33.5).abs() < 1e-9);
    window.run_steps(2);
    window.get_by_label_contains("Saved ");
}

#[test]
fn what_was_chosen_is_there_again_after_the_next_start() {
    let folder = tempfile::tempdir().unwrap();
    let (path, kept) = (folder.path().join("station.toml"), folder.path().join("window.toml"));
    let utc = "2026-08-12T11:14:30Z".parse().unwrap();
    let first = station::Antenna::satrak("First", "127.0.0.1:9");
    let second = station::Antenna { name: "Second".to_owned(), ..first.clone() };
    let antennas = vec![first, second];
    station::save(&station::Station { antennas, ..Default::default() }, &path, SPECS).unwrap();

    let mut window = open(&path, clock_from(utc));
    window.run_steps(3);
    assert!(!kept.exists(), "nothing was chosen yet");
    window.key_press(Key::F2);
    window.key_press_modifiers(Modifiers::COMMAND, Key::L);
    window.key_press(Key::Plus);
    window.run_steps(3);
    drop(window);

    let mut window = open(&path, clock_from(utc));
    window.run_steps(3);
    assert_eq!(window.state().model().selected_antenna, 1);
    assert_eq!(theme::name(&window.ctx), ThemeName::Light);
    window.get_by_role_and_label(Role::ListBox, "Next 8 hours");
}

#[test]
fn the_demo_station_leaves_no_file_behind() {
    let folder = tempfile::tempdir().unwrap();
    drop(demo(&folder));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn settings_that_cannot_be_read_are_not_replaced_by_following_a_satellite() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("station.toml");
    std::fs::write(&path, "name = \"open").unwrap();
    let mut window = open(&path, Clock::system());
    step_until(&mut window, "the elements", |model| {
        matches!(model.catalog, CatalogState::Ready(_))
    });
    window.key_press_modifiers(Modifiers::COMMAND, Key::Num3);
    step_until(&mut window, "the catalogue", |model| model.view == View::Elements);
    window.key_press_modifiers(Modifiers::COMMAND, Key::F);
    window.run_steps(2);
    window.event(Event::Text("43013".to_owned()));
    step_until(&mut window, "the row", |model| {
        model.catalog_table.answer.as_ref().is_some_and(|answer| answer.rows.len() == 1)
    });
    window.run_steps(2);
    window
        .get_by_role_and_label(Role::Button, "Remove NOAA 20 (JPSS-1) from the favourites")
        .click();
    step_until(&mut window, "it is not followed", |model| {
        !model.station.favourites.contains(NOAA_20)
    });
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "name = \"open");
}
