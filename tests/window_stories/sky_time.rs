//! Sky of another time, with the planned places of satellites and antennas. Nothing moves.

use std::sync::Arc;

use azel::{
    astro::time::add_seconds,
    contract::{
        driver::{Command, Snapshot},
        schedule::Planned,
    },
    model::{
        Model, UiCommand, View,
        plan::{PlannedActivity, Pose},
    },
    plan::schedule::{Entry, Schedule},
    station::{AntennaId, BetweenPasses},
};
use egui::{Key, Role, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use jiff::Timestamp;

use crate::window_stories::{
    plan,
    rig::{self, LARGE, Window, asked, settle},
    sky::zenith,
    states,
};

const SPAN_S: f64 = 12.0 * 3600.0;

fn planned(snapshot: Snapshot) -> Model {
    let mut model = rig::model(snapshot);
    let until = Some(add_seconds(model.now, SPAN_S));
    model.shown_mut().schedule = Arc::new(Planned { end: until, ..plan::planned(&model) });
    model
}

fn window(size: [f32; 2]) -> Window {
    let mut window = rig::window(size, planned(states::holding()));
    window.state_mut().commands.clear();
    window
}

fn says(window: &Window, words: &str) -> bool {
    window.query_all_by_label_contains(words).next().is_some()
}

fn press(window: &mut Window, key: Key) {
    window.key_press(key);
    settle(window);
}

/// Gives the slider the focus.
fn focus(window: &mut Window) {
    window.get_by_role_and_label(Role::Slider, "Time of the sky").focus();
    settle(window);
}

/// Drags the slider to a quarter of the plan.
fn drag(window: &mut Window) {
    let slider = window.get_by_role_and_label(Role::Slider, "Time of the sky").rect();
    window.drag_at(slider.left_center() + vec2(6.0, 0.0));
    window.step();
    let to = slider.left_center() + vec2(slider.width() / 4.0, 0.0);
    window.hover_at(to);
    window.step();
    window.drop_at(to);
    settle(window);
}

/// Returns the view with the sky of a later time.
pub(crate) fn later(size: [f32; 2]) -> Window {
    let mut window = window(size);
    drag(&mut window);
    window
}

/// Returns the name of the mark of NOAA 20, which has its place in words.
fn noaa_20(window: &Window) -> Option<String> {
    let mark = window.query_by_label_contains("NOAA 20, azimuth")?;
    mark.accesskit_node().label()
}

#[test]
fn keys_move_the_sky_on_and_home_is_now() {
    for size in rig::sizes() {
        let mut window = window(size);
        let now = noaa_20(&window).expect("NOAA 20 is up");
        assert!(says(&window, "Sky now."));
        focus(&mut window);
        press(&mut window, Key::ArrowRight);
        press(&mut window, Key::ArrowRight);
        assert!(says(&window, "Sky at 11:17:30Z, in 2:00. The slider moves no antenna."));
        assert_ne!(noaa_20(&window).expect("still up"), now);
        press(&mut window, Key::PageUp);
        assert!(says(&window, "Sky at 11:27:30Z, in 12:00."));
        assert_eq!(noaa_20(&window), None, "it has set by then");
        press(&mut window, Key::ArrowLeft);
        assert!(says(&window, "Sky at 11:26:30Z, in 11:00."));
        press(&mut window, Key::End);
        assert!(says(&window, "Sky at 23:15:30Z, in 12:00:00."));
        press(&mut window, Key::Home);
        assert!(says(&window, "Sky now."));
        assert_eq!(noaa_20(&window), Some(now));
        assert_eq!(asked(&mut window), []);
    }
}

#[test]
fn the_slider_is_dragged_and_its_button_returns_to_now() {
    for size in rig::sizes() {
        let mut window = window(size);
        drag(&mut window);
        assert!(says(&window, ". The slider moves no antenna."));
        assert!(says(&window, "Satrak planned, "));
        let slider = window.get_by_role_and_label(Role::Slider, "Time of the sky");
        let value = slider.accesskit_node().value().unwrap();
        assert!(value.starts_with("Sky at 14:"), "{value}");
        press(&mut window, Key::Home);
        assert!(says(&window, "Sky now."));
        press(&mut window, Key::PageUp);
        assert!(says(&window, "Sky at 11:25:30Z, in 10:00."), "the touch gave it the focus");
        window.get_by_role_and_label(Role::Button, "Now").click();
        settle(&mut window);
        assert!(says(&window, "Sky now."));
        assert!(!says(&window, "Satrak planned, "));
        assert!(window.query_by_role_and_label(Role::Button, "Now").is_none());
        assert_eq!(asked(&mut window), []);
    }
}

#[test]
fn no_click_and_no_menu_of_another_time_points_an_antenna() {
    for size in rig::sizes() {
        let mut window = window(size);
        drag(&mut window);
        let at = zenith(&window) + vec2(0.0, 60.0);
        window.drag_at(at);
        window.drop_at(at);
        settle(&mut window);
        assert!(window.query_by_label("Point here").is_none());
        assert!(says(&window, "To point an antenna, go back to now."));
        window.hover_at(at);
        for pressed in [true, false] {
            window.event(egui::Event::PointerButton {
                pos: at,
                button: egui::PointerButton::Secondary,
                pressed,
                modifiers: egui::Modifiers::NONE,
            });
        }
        settle(&mut window);
        assert!(window.query_by_label("Copy azimuth and elevation").is_some());
        assert!(window.query_by_label_contains("Point Satrak here").is_none());
        assert!(window.query_by_label_contains("Track with").is_none());
        assert_eq!(asked(&mut window), []);
    }
}

#[test]
fn what_was_clicked_now_is_dropped_with_the_sky_of_now() {
    let mut window = window(LARGE);
    let at = zenith(&window) + vec2(0.0, 60.0);
    window.drag_at(at);
    window.drop_at(at);
    settle(&mut window);
    assert!(window.query_by_label("Point here").is_some());
    window.state_mut().commands.clear();
    focus(&mut window);
    press(&mut window, Key::ArrowRight);
    assert!(window.query_by_label("Point here").is_none());
    let end = UiCommand::antenna(AntennaId(1), Command::Preview(None));
    assert_eq!(asked(&mut window), [end]);
    press(&mut window, Key::Home);
    assert!(window.query_by_label("Point here").is_none(), "it does not come back by itself");
}

#[test]
fn stop_and_the_card_stay_live() {
    for size in rig::sizes() {
        let mut window = window(size);
        drag(&mut window);
        window.get_by_role_and_label(Role::Button, "STOP").click();
        assert_eq!(asked(&mut window), [UiCommand::Stop]);
        window.get_by_role_and_label(Role::RadioButton, "Manual").click();
        assert_eq!(asked(&mut window), [UiCommand::antenna(AntennaId(1), Command::Manual)]);
        assert!(says(&window, ". The slider moves no antenna."), "the sky stays where it was");
        assert!(says(&window, "Antenna, azimuth"), "the live mark as well");
    }
}

#[test]
fn another_view_and_another_station_show_the_sky_of_now() {
    let mut window = window(LARGE);
    drag(&mut window);
    window.state_mut().model.view = View::Plan;
    settle(&mut window);
    window.state_mut().model.view = View::Operate;
    settle(&mut window);
    assert!(says(&window, "Sky now."));
    drag(&mut window);
    window.state_mut().views.station_changed();
    settle(&mut window);
    assert!(says(&window, "Sky now."));
}

#[test]
fn a_time_that_has_come_is_now() {
    let mut window = window(LARGE);
    focus(&mut window);
    press(&mut window, Key::ArrowRight);
    let now = add_seconds(window.state().model.now, 61.0);
    window.state_mut().model.now = now;
    settle(&mut window);
    assert!(says(&window, "Sky now."));
}

#[test]
fn without_a_schedule_there_is_only_now() {
    let mut window = rig::window(LARGE, rig::model(states::holding()));
    assert!(says(&window, "There is no plan yet to look ahead with."));
    drag(&mut window);
    assert!(says(&window, "Sky now."));
}

/// Returns two passes of the antenna, hours apart. The way from the end of the first to the start
/// of the second leads from 60° of elevation over the zenith to 60°.
fn two_entries(model: &mut Model, between: BetweenPasses) -> [Entry; 2] {
    let mut station = (*model.station).clone();
    station.antennas[0].automatic.between_passes = between;
    model.shown_mut().antennas[0].config = Arc::new(station.antennas[0].clone());
    model.shown_mut().station = Arc::new(station);
    let mut entries = model.schedule.schedule.entries.clone();
    entries.retain(|entry| entry.start > model.now);
    let first = entries[0].clone();
    let later = |at| add_seconds(at, 4.0 * 3600.0);
    let second = Entry { start: later(first.start), end: later(first.end), ..first.clone() };
    let spare_s = second.start.duration_since(first.end).as_secs_f64() - 40.0 - 12.0;
    let entries = [
        Entry { axes_deg: [[90.0, 90.0], [60.0, 90.0]], ..first },
        Entry {
            axes_deg: [[120.0, 90.0], [90.0, 90.0]],
            slew_s: 40.0,
            set_up_s: 12.0,
            spare_s: Some(spare_s),
            ..second
        },
    ];
    let schedule = Schedule { entries: entries.to_vec(), ..Schedule::default() };
    let until = model.schedule.end;
    model.shown_mut().schedule = Arc::new(Planned { schedule, end: until, ..Planned::default() });
    entries
}

fn pose(model: &Model, at: Timestamp) -> (PlannedActivity, f64) {
    let Pose { doing, pointing } = model.pose_at(&model.antennas[0], at).expect("a pose");
    (doing, pointing.elevation.unwrap().degrees())
}

#[test]
fn an_antenna_points_along_its_pass_and_holds_slews_and_waits_between() {
    let mut model = planned(states::holding());
    let [first, second] = two_entries(&mut model, BetweenPasses::Stay);
    let next = (second.pass.satellite, second.pass.aos);
    let middle = add_seconds(first.start, 120.0);
    let satellite = model.pass_lists.satellite(first.pass.satellite).unwrap();
    let look = satellite.propagator.look_from(model.station.site, middle).unwrap();
    let (doing, elevation_deg) = pose(&model, middle);
    assert_eq!(doing, PlannedActivity::Tracks((first.pass.satellite, first.pass.aos)));
    assert!((elevation_deg - look.direction.elevation_deg()).abs() < 1e-9);
    // The antenna sets out a minute early: 12 s of set-up, 40 s of slew, and the rest to spare.
    for (before_s, doing, elevation_deg) in [
        (130.0, PlannedActivity::Stays, 60.0),
        (101.0, PlannedActivity::Stays, 60.0),
        (80.0, PlannedActivity::SlewsTo(next), 90.0),
        (59.0, PlannedActivity::WaitsFor(next), 60.0),
        (1.0, PlannedActivity::WaitsFor(next), 60.0),
    ] {
        let (done, measured_deg) = pose(&model, add_seconds(second.start, -before_s));
        assert_eq!(done, doing, "{before_s} s before");
        assert!((measured_deg - elevation_deg).abs() < 1e-6, "{before_s} s: {measured_deg}");
    }
    let (doing, elevation_deg) = pose(&model, add_seconds(second.end, 600.0));
    assert_eq!(doing, PlannedActivity::Stays);
    assert!((elevation_deg - 90.0).abs() < 1e-6);
}

#[test]
fn where_it_is_between_passes_follows_its_setting() {
    let mut model = planned(states::holding());
    let [first, second] = two_entries(&mut model, BetweenPasses::Wait);
    let next = (second.pass.satellite, second.pass.aos);
    let (doing, _) = pose(&model, add_seconds(first.end, 60.0));
    assert_eq!(doing, PlannedActivity::WaitsFor(next), "it goes on at once");

    let mut model = planned(states::holding());
    let [first, _] = two_entries(&mut model, BetweenPasses::Park);
    let (doing, _) = pose(&model, add_seconds(first.end, 1.0));
    assert_eq!(doing, PlannedActivity::SlewsToPark);
    let (doing, elevation_deg) = pose(&model, add_seconds(first.end, 600.0));
    assert_eq!(doing, PlannedActivity::Parked);
    let park = model.antennas[0].config.park_direction();
    assert!((elevation_deg - park.elevation_deg()).abs() < 0.01, "{elevation_deg}");
}

#[test]
fn before_its_first_pass_it_holds_where_it_stands_and_without_passes_nothing_is_planned() {
    let mut model = planned(states::holding());
    let [first, _] = two_entries(&mut model, BetweenPasses::Park);
    let stands = model.antennas[0].snapshot.state.measured.unwrap().direction().unwrap();
    let at = add_seconds(first.start, -1200.0);
    let (doing, elevation_deg) = pose(&model, at);
    assert_eq!(doing, PlannedActivity::Stays);
    assert!((elevation_deg - stands.elevation_deg()).abs() < 0.1, "{elevation_deg}");
    model.shown_mut().schedule = Arc::default();
    assert_eq!(model.pose_at(&model.antennas[0], at), None);
}
