//! Steps of an axis by a set amount, and the rate of a jog.

use azel::{contract::driver::Command, model::UiCommand, station::AntennaId};
use egui::{Key, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    rig::{self, SIZES, Window, asked, says, settle},
    states,
};

const STEP: &str = "Step size, degrees";

fn antenna(command: Command) -> UiCommand {
    UiCommand::antenna(AntennaId(1), command)
}

/// Replaces the text in the field.
fn write(window: &mut Window, field: &str, words: &str) {
    window.get_by_label(field).focus();
    settle(window);
    window.key_press_modifiers(egui::Modifiers::COMMAND, Key::A);
    window.key_press(Key::Delete);
    settle(window);
    window.get_by_label(field).type_text(words);
    settle(window);
}

fn step(x_deg: f64, y_deg: f64) -> UiCommand {
    antenna(Command::Step { steps_deg: [x_deg, y_deg] })
}

fn press_with_shift(window: &mut Window, key: Key) {
    window.key_press_modifiers(egui::Modifiers::SHIFT, key);
}

#[test]
fn a_step_key_steps_once_by_the_size_in_the_field() {
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(states::manual()));
        for (key, wanted) in [
            ("Step X+", step(0.5, 0.0)),
            ("Step X−", step(-0.5, 0.0)),
            ("Step Y+", step(0.0, 0.5)),
            ("Step Y−", step(0.0, -0.5)),
        ] {
            window.get_by_role_and_label(Role::Button, key).click();
            assert_eq!(asked(&mut window), [wanted], "{key}");
        }
        press_with_shift(&mut window, Key::ArrowUp);
        assert_eq!(asked(&mut window), [step(0.0, 0.5)], "the clicked key has the focus");
        write(&mut window, STEP, "2,25");
        window.get_by_role_and_label(Role::Button, "Step X+").click();
        assert_eq!(asked(&mut window), [step(2.25, 0.0)]);
    }
}

#[test]
fn shift_and_an_arrow_step_once_with_the_pad_or_a_step_key_focused() {
    for size in rig::sizes() {
        for focus in ["Jog Y+", "Step X−"] {
            let mut window = rig::window(size, rig::model(states::manual()));
            press_with_shift(&mut window, Key::ArrowRight);
            assert_eq!(asked(&mut window), [], "nothing of it has the focus");
            window.get_by_label(focus).focus();
            settle(&mut window);
            for (key, wanted) in [
                (Key::ArrowRight, step(0.5, 0.0)),
                (Key::ArrowLeft, step(-0.5, 0.0)),
                (Key::ArrowUp, step(0.0, 0.5)),
                (Key::ArrowDown, step(0.0, -0.5)),
            ] {
                press_with_shift(&mut window, key);
                assert_eq!(asked(&mut window), [wanted], "{key:?}");
                assert!(window.get_by_label(focus).is_focused());
            }
        }
    }
}

#[test]
fn outside_manual_there_is_no_step() {
    for size in rig::sizes() {
        for snapshot in [states::holding(), states::tracking(0.0)] {
            let mut window = rig::window(size, rig::model(snapshot));
            assert!(window.query_by_label("Step X+").is_none());
            window.get_by_role_and_label(Role::Button, "STOP").focus();
            press_with_shift(&mut window, Key::ArrowRight);
            assert_eq!(asked(&mut window), []);
        }
    }
}

#[test]
fn a_step_that_cannot_be_is_refused_in_its_place() {
    for size in SIZES {
        for (typed, wanted) in [
            ("6", "Step 6 is outside 0.01° to 5°."),
            ("x", "Step “x” is not a number."),
            ("", "Step is empty."),
        ] {
            let mut window = rig::window(size, rig::model(states::manual()));
            write(&mut window, STEP, typed);
            assert!(says(&window, wanted), "{typed}");
            window.get_by_role_and_label(Role::Button, "Step Y−").click();
            assert_eq!(asked(&mut window), []);
            window.get_by_label("Jog X+").focus();
            settle(&mut window);
            press_with_shift(&mut window, Key::ArrowRight);
            assert_eq!(asked(&mut window), []);
        }
    }
}

#[test]
fn a_held_jog_takes_no_step_and_a_limit_blocks_only_its_own() {
    for size in rig::sizes() {
        let mut snapshot = states::manual();
        snapshot.state.measured.as_mut().unwrap().axes[0].plus_limit = true;
        let mut window = rig::window(size, rig::model(snapshot));
        window.get_by_label("Jog X−").focus();
        settle(&mut window);
        press_with_shift(&mut window, Key::ArrowRight);
        assert_eq!(asked(&mut window), []);
        press_with_shift(&mut window, Key::ArrowLeft);
        assert_eq!(asked(&mut window), [step(-0.5, 0.0)]);
        window.key_down(Key::ArrowUp);
        settle(&mut window);
        press_with_shift(&mut window, Key::ArrowLeft);
        let jog = antenna(Command::Jog { rates_deg_s: [0.0, 0.5] });
        assert!(asked(&mut window).iter().all(|command| *command == jog));
    }
}

#[test]
fn page_up_and_down_change_the_rate_in_manual_and_not_while_typing() {
    let rate =
        |window: &Window| window.get_by_label_contains("Jog rate").accesskit_node().numeric_value();
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(states::manual()));
        window.key_press(Key::PageUp);
        settle(&mut window);
        assert_eq!(rate(&window), Some(1.0));
        window.get_by_label("Go to azimuth, degrees").focus();
        settle(&mut window);
        window.key_press(Key::PageDown);
        settle(&mut window);
        assert_eq!(rate(&window), Some(1.0), "while typing");
        window.get_by_label("Jog X+").focus();
        settle(&mut window);
        window.key_press(Key::PageDown);
        settle(&mut window);
        assert_eq!(rate(&window), Some(0.5), "once, with the pad focused");

        let mut window = rig::window(size, rig::model(states::holding()));
        window.key_press(Key::PageUp);
        settle(&mut window);
        assert_eq!(rate(&window), Some(0.5), "locked");
    }
}
