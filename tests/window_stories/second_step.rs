//! Commands that end a track, which take a second step that names the track, by mouse and by key
//! alike.

use azel::{
    contract::{
        self,
        driver::{Command, Snapshot},
        passes::PredictedPass,
    },
    model::UiCommand,
};
use egui::{Key, Role};
use egui_kittest::kittest::Queryable as _;

use crate::window_stories::{
    rig::{self, asked, settle},
    states,
};

fn antenna(command: Command) -> UiCommand {
    let id = rig::model(states::holding()).antennas[0].id();
    UiCommand::Station(contract::Command::Antenna(id, command))
}

/// Returns a window in which the first antenna tracks NOAA 20 and another pass is selected.
fn with_another_selected(size: [f32; 2], snapshot: Snapshot) -> rig::Window {
    let mut model = rig::model(snapshot);
    let tracked = model.antennas[0].tracked_number();
    let lists = model.pass_lists.clone();
    let passes = lists.favourites.upcoming(model.now);
    let mut coming = passes.iter().filter(|it| !it.in_progress(model.now));
    let other = coming.find(|it| Some(it.number()) != tracked);
    model.selected = other.map(PredictedPass::key);
    rig::window(size, model)
}

#[test]
fn a_click_on_a_mode_asks_while_a_track_runs_and_only_then() {
    for size in rig::sizes() {
        for (mode, command, what) in [
            ("Manual", Command::Manual, "Moving by hand ends that."),
            ("Position", Command::Hold, "Position ends that."),
        ] {
            let mut window = rig::window(size, rig::model(states::tracking(0.0)));
            window.get_by_role_and_label(Role::RadioButton, mode).click();
            assert_eq!(asked(&mut window), [], "{mode}");
            window.get_by_label_contains("Satrak tracks NOAA 20 until");
            window.get_by_label_contains(what);
            window.get_by_label("Cancel").click();
            assert_eq!(asked(&mut window), [], "{mode}");
            window.get_by_role_and_label(Role::RadioButton, mode).click();
            settle(&mut window);
            window.key_press(Key::Enter);
            assert_eq!(asked(&mut window), [antenna(command.clone())]);

            let mut window = rig::window(size, rig::model(states::holding()));
            window.get_by_role_and_label(Role::RadioButton, mode).click();
            assert_eq!(asked(&mut window), [antenna(command)]);
        }
        let mut window = rig::window(size, rig::model(states::tracking(0.0)));
        window.get_by_role_and_label(Role::RadioButton, "Standby").click();
        assert_eq!(asked(&mut window), [antenna(Command::Standby)], "Standby is one step");
    }
}

#[test]
fn the_press_of_enter_that_asks_is_no_answer_however_long_it_lasts() {
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(states::tracking(0.0)));
        window.get_by_role_and_label(Role::RadioButton, "Manual").focus();
        settle(&mut window);
        for held in ["pressed", "held"] {
            window.key_down(Key::Enter);
            assert_eq!(asked(&mut window), [], "{held}");
            window.get_by_label_contains("Satrak tracks NOAA 20 until");
        }
        window.key_up(Key::Enter);
        settle(&mut window);
        window.key_press(Key::Enter);
        assert_eq!(asked(&mut window), [antenna(Command::Manual)]);
    }
}

#[test]
fn another_track_names_the_one_that_it_ends() {
    for size in rig::sizes() {
        for by_key in [false, true] {
            let mut window = with_another_selected(size, states::tracking(0.0));
            if by_key {
                window.key_press(Key::T);
            } else {
                let track = window.get_by_role_and_label(Role::RadioButton, "Track");
                track.click();
            }
            assert_eq!(asked(&mut window), []);
            window.get_by_label_contains("Satrak tracks NOAA 20 until");
            window.get_by_label_contains("which rises in");
            window.key_press(Key::Enter);
            let commands = asked(&mut window);
            assert!(
                matches!(commands[..], [UiCommand::Station(contract::Command::Track { .. })]),
                "{commands:?}"
            );
        }
    }
}

#[test]
fn auto_track_is_switched_on_by_a_second_step_and_off_by_one() {
    for (is_on, label) in [(false, "Auto-track: switch on"), (true, "Auto-track: switch off")] {
        let mut snapshot = states::holding();
        snapshot.state.program.as_mut().unwrap().auto = Some(is_on);
        let mut window = rig::window(rig::LARGE, rig::model(snapshot));
        window.get_by_label(label).click();
        if is_on {
            assert_eq!(asked(&mut window), [antenna(Command::AutoTrack(false))]);
            continue;
        }
        assert_eq!(asked(&mut window), []);
        let sentence = "Satrak starts the next pass by itself, even if this computer is off.";
        window.get_by_label_contains(sentence);
        window.key_press(Key::Enter);
        assert_eq!(asked(&mut window), [antenna(Command::AutoTrack(true))]);
    }
}
