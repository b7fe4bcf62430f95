//! Service functions: locked, unlocked with care, and locked again.

use std::time::Duration;

use azel::{
    clock::Instant, contract, contract::driver::Command, device::settings::Value, model::UiCommand,
    station::AntennaId,
};
use egui::{Event, Key, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    rig::{self, LARGE, Window, asked, settle},
    settings_rig::{
        apply, change, choose, hold, opened, press, read, says, state_of, unlock, write,
    },
    states,
};

const STATION: &str = "Şile 1";

fn open(size: [f32; 2]) -> Window {
    let mut window = opened(size, read());
    unlock(&mut window, STATION);
    assert!(says(&window, "Open, locks in 10:00"));
    window
}

fn is_locked(window: &Window) -> bool {
    let fields: Vec<_> = window.query_all_by_label("X reduction, new value").collect();
    fields.is_empty() && state_of(window, "X reduction") == "Locked"
}

#[test]
fn it_opens_by_the_name_of_the_station_while_the_antenna_stands() {
    for size in rig::sizes() {
        let mut window = opened(size, read());
        assert!(is_locked(&window));
        press(&mut window, "Unlock");
        window.get_by_role_and_label(Role::TextInput, "Name of the station").focus();
        settle(&mut window);
        window.event(Event::Text("Ankara".to_owned()));
        settle(&mut window);
        let button = window.get_by_role_and_label(Role::Button, "Hold 1 s to unlock");
        assert!(button.accesskit_node().is_disabled());
        window.key_press(Key::Escape);
        settle(&mut window);
        assert!(!says(&window, "Unlock the service functions"), "Esc closes it");
        unlock(&mut window, STATION);
        assert!(!is_locked(&window));
        press(&mut window, "Lock");
        assert!(is_locked(&window));
    }
    let mut snapshot = read();
    snapshot.state.measured = states::moving().state.measured;
    let mut window = opened(LARGE, snapshot);
    press(&mut window, "Unlock");
    assert!(says(&window, "The antenna must be at rest, and tracking must be off."));
}

#[test]
fn a_change_that_is_not_heard_of_may_be_tried_again() {
    for size in rig::sizes() {
        let mut window = open(size);
        for ratio in ["4100", "4200"] {
            write(&mut window, "X reduction", ratio);
            apply(&mut window);
            let commands = asked(&mut window);
            let [
                UiCommand::Station(contract::Command::Antenna(
                    AntennaId(1),
                    Command::WriteSettings(change),
                )),
            ] = commands.as_slice()
            else {
                panic!("{commands:?}")
            };
            assert!(change.is_unlocked && change.group == "reduction");
            window.state_mut().model.steady += Duration::from_secs(4);
            settle(&mut window);
            assert!(says(&window, "Drive reduction: no answer came back. Read again."));
        }
    }
}

#[test]
fn it_locks_by_itself() {
    let still = states::holding().state.measured;
    let moving = states::moving().state.measured;
    for case in ["time", "motion", "link", "antenna", "tracking"] {
        let mut window = open(LARGE);
        write(&mut window, "X reduction", "4100");
        assert_eq!(state_of(&window, "X reduction"), "Edited");
        match case {
            "time" => {
                window.state_mut().model.steady += Duration::from_secs(601);
                settle(&mut window);
            }
            "motion" => {
                change(&mut window, 0, |of| of.state.measured = moving);
                change(&mut window, 0, |of| of.state.measured = still);
            }
            "link" => change(&mut window, 0, |of| of.state.link_since = Some(Instant::now())),
            "tracking" => {
                change(&mut window, 0, |of| of.state.program = states::tracking(0.0).state.program);
                change(&mut window, 0, |of| of.state.program = states::holding().state.program);
            }
            _ => {
                window.state_mut().model.selected_antenna = 1;
                settle(&mut window);
                window.state_mut().model.selected_antenna = 0;
                settle(&mut window);
            }
        }
        assert_eq!(state_of(&window, "X reduction"), "Service locked", "{case}");
        window.state_mut().commands.clear();
        apply(&mut window);
        assert_eq!(asked(&mut window), [], "{case}");
        window.get_by_role_and_label(Role::Button, "Unlock");
    }
}

#[test]
fn the_transmitter_is_switched_on_unlocked_and_confirmed() {
    let mut window = opened(LARGE, read());
    choose(&mut window, "Transmitter (SSPA)", "On");
    assert_eq!(state_of(&window, "Transmitter (SSPA)"), "Service locked");
    assert!(says(&window, "1 change not sent, 1 locked by Service"));
    apply(&mut window);
    assert_eq!(asked(&mut window), []);
    unlock(&mut window, STATION);
    assert_eq!(state_of(&window, "Transmitter (SSPA)"), "Confirm first");
    hold(&mut window, "Hold 1 s to confirm Transmitter (SSPA) On");
    apply(&mut window);
    let commands = asked(&mut window);
    let [
        UiCommand::Station(contract::Command::Antenna(
            AntennaId(1),
            Command::WriteSettings(change),
        )),
    ] = commands.as_slice()
    else {
        panic!("{commands:?}")
    };
    assert!(change.is_unlocked);
    assert_eq!(change.values, [("sspa", Value::Choice(1))].into());
    rig::settle(&mut window);
}
