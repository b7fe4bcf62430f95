//! Strip of Operate: passes that the mount can track, or passes that the schedule takes and leaves
//! out.

use std::sync::Arc;

use azel::{
    astro::time::add_seconds,
    contract::automatic::{DayEvent, DayLine, Flown, MissCause},
    model::{Model, UiCommand},
    plan::pass_report::LossCause,
    station::AntennaId,
    ui::theme,
};
use egui::{Key, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    every_view::painted,
    makes, plan,
    rig::{self, LARGE, SIZES, Window, asked, settle},
    states,
};

fn with_plan(size: [f32; 2]) -> Window {
    let mut model = rig::model(states::holding());
    model.shown_mut().schedule = Arc::new(plan::planned(&model));
    rig::window(size, model)
}

/// Returns `true` if the text reads like "11:01Z to 11:14Z". The strip has such a text alone; lanes
/// have it after a name.
fn is_times(words: &str) -> bool {
    words.split(" to ").all(|time| time.ends_with('Z')) && words.contains(" to ")
}

/// Returns the bars of the strip, as a screen reader reads them.
fn bars(window: &Window) -> Vec<String> {
    let options = window.query_all_by_role(Role::ListBoxOption);
    let names = options.filter_map(|node| node.accesskit_node().label());
    let has_times = |name: &String| name.split(", ").nth(1).is_some_and(is_times);
    names.filter(has_times).collect()
}

#[test]
fn each_pass_of_the_strip_is_planned_or_left_out_with_the_reason() {
    for size in SIZES {
        let window = with_plan(size);
        let bars = bars(&window);
        let (planned, left_out): (Vec<_>, Vec<_>) =
            bars.iter().partition(|bar| bar.ends_with(", planned on Satrak"));
        assert!(!planned.is_empty(), "{bars:?}");
        assert!(!left_out.is_empty(), "{bars:?}");
        for bar in left_out {
            assert!(bar.contains(", left out: ") && bar.ends_with(" overlaps by 8:02"), "{bar}");
        }
    }
}

#[test]
fn before_the_first_schedule_the_strip_shows_what_the_mount_can_track() {
    for size in rig::sizes() {
        let window = rig::window(size, rig::model(states::holding()));
        let bars = bars(&window);
        assert!(!bars.is_empty());
        for bar in bars {
            assert!(!bar.contains("planned") && !bar.contains("left out"), "{bar}");
        }
    }
}

#[test]
fn the_pointer_reads_how_a_pass_stands_and_a_key_selects_it() {
    let mut window = with_plan(LARGE);
    let name = bars(&window).into_iter().find(|bar| bar.contains("left out")).unwrap();
    window.get_by_label(&name).hover();
    window.run_steps(8);
    window.get_by_label_contains("\nmax");
    window.get_by_label(&name).focus();
    settle(&mut window);
    window.state_mut().commands.clear();
    window.key_press(Key::Enter);
    let commands = asked(&mut window);
    assert!(matches!(&commands[..], [UiCommand::SelectPass(_)]), "{commands:?}");
}

/// Adds a day on which the antenna missed a part of the pass that is up, and tracked a pass before
/// it.
fn after_two_passes(model: &mut Model) {
    let upcoming = model.pass_lists.favourites.upcoming(model.now);
    let key = upcoming.iter().find(|predicted| !predicted.is_always_up()).unwrap().key();
    let flown = |pass, cause: Option<MissCause>| {
        let lost_s = if cause.is_some() { 250.0 } else { 0.0 };
        let name = "NOAA 20".to_owned();
        let in_beam_s = 742.0 - lost_s;
        let flown = Flown { pass, name, of_s: 742.0, in_beam_s, proved_at: None, cause };
        DayLine { time: model.now, antenna: AntennaId(1), event: DayEvent::Flown(flown) }
    };
    let before = (37_849, add_seconds(model.now, -900.0));
    model.shown_mut().day = Arc::new(vec![
        flown(before, None),
        flown(key, Some(MissCause::Lost(LossCause::OutsideBeam))),
    ]);
}

#[test]
fn passes_that_are_over_are_done_or_missed() {
    for size in rig::sizes() {
        let mut window = with_plan(size);
        after_two_passes(&mut window.state_mut().model);
        settle(&mut window);
        window.get_by_label_contains(", missed 4:10 of 12:22");
        assert!(
            bars(&window).iter().any(|bar| bar.ends_with(", done, 100 % in the beam")),
            "{:?}",
            bars(&window)
        );
    }
}

#[test]
fn each_lane_of_a_high_strip_says_which_antenna_takes_a_pass() {
    let mut model = rig::model(states::holding());
    let second =
        makes::model(makes::pair(), makes::pair_at(azel::contract::driver::Intent::Position));
    model.shown_mut().antennas.extend(second.antennas.clone());
    Arc::make_mut(&mut model.shown_mut().antennas[1].config).id = AntennaId(2);
    model.shown_mut().schedule = Arc::new(plan::planned(&model));
    let window = rig::window([1920.0, 1080.0], model);
    let bars = bars(&window);
    let of = |antenna: &str| {
        let own = bars.iter().filter(|bar| bar.starts_with(antenna));
        own.filter(|bar| bar.ends_with("planned on Satrak")).count()
    };
    assert!(of("Satrak: ") > 0, "{bars:?}");
    assert_eq!(of("Satrak: "), of("Genius: "), "the other lane names who takes it: {bars:?}");
}

#[test]
fn track_is_no_main_action_for_a_pass_that_the_antenna_cannot_get_to() {
    let meteor_at = |seconds: f64| {
        let mut model = rig::model(states::holding());
        let passes = model.pass_lists.favourites.upcoming(model.now);
        let meteor = passes.iter().find(|of| of.satellite.short_name() == "METEOR-M2 4").unwrap();
        let (key, los) = (meteor.key(), meteor.pass.los.time);
        model.selected = Some(key);
        model.now = add_seconds(los, -seconds);
        rig::window(LARGE, model)
    };
    let is_main = |window: &Window| {
        let place = window.get_by_role_and_label(Role::Button, "Track METEOR-M2 4").rect();
        painted::around(window, place, 1.0).contains(&theme::tokens(&window.ctx).sat)
    };
    let in_time = meteor_at(120.0);
    assert!(is_main(&in_time));
    assert!(in_time.query_by_label_contains("is not there before LOS").is_none());
    let too_late = meteor_at(10.0);
    assert!(!is_main(&too_late));
    too_late.get_by_label("Satrak is not there before LOS of METEOR-M2 4.");
    let rows = too_late.query_all_by_role(Role::ListBoxOption);
    let rows: Vec<String> = rows.filter_map(|node| node.accesskit_node().label()).collect();
    let is_it = |row: &String| row.starts_with("METEOR-M2 4, LOS") && row.contains("Is not there");
    assert!(rows.iter().any(is_it), "the row says the same: {rows:?}");
}

#[test]
fn a_row_of_the_list_says_that_the_schedule_leaves_the_pass_out_and_why() {
    let window = with_plan(LARGE);
    let rows = window.query_all_by_role(Role::ListBoxOption);
    let names: Vec<String> = rows.filter_map(|node| node.accesskit_node().label()).collect();
    let of = |name: &str, words: &str| {
        names.iter().any(|row| row.starts_with(name) && row.contains(words))
    };
    assert!(of("NOAA 20, LOS", "Left out: overlaps METEOR-M2 4"), "{names:?}");
    assert!(of("METEOR-M2 4, AOS", "Trackable"), "taken: {names:?}");
    assert!(
        of("METEOR-M2 4, LOS", "Needs 0:39 to get there, leaving 0:05 to track"),
        "is set up and slews: {names:?}"
    );
    assert!(of("EUTELSAT 7C, always up", "Trackable"), "{names:?}");
}
