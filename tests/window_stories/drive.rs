//! Driving the antenna from its card: track, modes, jog, go to.

use azel::{
    astro::{Angle, time::add_seconds},
    clock::Instant,
    contract::driver::{Command, Intent, LinkState, Snapshot, position_for},
    device::{LastSatellite, Motion, MotionRequest},
    model::UiCommand,
    station::AntennaId,
};
use egui::{Key, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    rig::{self, SIZES, Window, asked, says, settle},
    states,
};

const AZIMUTH: &str = "Go to azimuth, degrees";
const ELEVATION: &str = "Go to elevation, degrees";

fn antenna(command: Command) -> UiCommand {
    UiCommand::antenna(AntennaId(1), command)
}

fn type_into(window: &mut Window, field: &str, words: &str) {
    window.get_by_label(field).focus();
    settle(window);
    window.get_by_label(field).type_text(words);
    settle(window);
}

#[test]
fn the_track_button_tracks_the_selected_pass() {
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(states::holding()));
        window.get_by_role_and_label(Role::Button, "Track NOAA 20").click();
        assert_eq!(asked(&mut window), [rig::track_noaa_20()]);
    }
}

#[test]
fn while_it_is_tracked_there_is_nothing_to_ask_for() {
    for size in rig::sizes() {
        let window = rig::window(size, rig::model(states::tracking(0.0)));
        window.get_by_label("On the unit: NOAA 20");
        window.get_by_label("Selected and tracked: NOAA 20");
        assert!(window.query_by_label("Track NOAA 20").is_none());
    }
}

/// Returns the shown time that the antenna needs to get to the pass, from the text that contains
/// `words`.
fn needs(window: &Window, words: &str) -> String {
    let mut times = window.query_all_by_label_contains(words).filter_map(|node| {
        let node = node.accesskit_node();
        let text = node.label().or(node.value())?;
        let (time, _) = text.split_once("eeds ")?.1.split_once(" to get there")?;
        Some(time.to_owned())
    });
    times.next_back().unwrap_or_else(|| panic!("nothing with {words:?}"))
}

#[test]
fn t_asks_and_only_enter_tracks() {
    // The question names the antenna's position, the position where it meets the satellite, and the
    // time between them.
    let question = "Track NOAA 20 with Satrak? The antenna moves from 343.1°, 5.0° to ";
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(states::holding()));
        let header = needs(&window, "eeds ");
        window.key_press(Key::T);
        assert_eq!(asked(&mut window), [], "only asks");
        window.get_by_label_contains(question);
        assert_eq!(needs(&window, question), header, "as the header tells it");
        window.key_press(Key::Escape);
        assert_eq!(asked(&mut window), []);
        assert!(window.query_by_label_contains(question).is_none());

        window.key_press(Key::T);
        settle(&mut window);
        window.key_press(Key::Enter);
        assert_eq!(asked(&mut window), [rig::track_noaa_20()]);
        assert!(window.query_by_label_contains(question).is_none());
    }
}

#[test]
fn m_asks_while_tracking_and_only_then() {
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(states::holding()));
        window.key_press(Key::M);
        assert_eq!(asked(&mut window), [antenna(Command::Manual)]);

        let mut window = rig::window(size, rig::model(states::tracking(0.0)));
        window.key_press(Key::M);
        assert_eq!(asked(&mut window), []);
        window.get_by_label_contains("Satrak tracks NOAA 20 until");
        window.get_by_label_contains("Moving by hand ends that.");
        window.key_press(Key::Enter);
        assert_eq!(asked(&mut window), [antenna(Command::Manual)]);
    }
}

#[test]
fn m_gives_the_arrows_to_the_jog_pad_and_moves_nothing_itself() {
    let pad = "Jog with the arrow keys";
    for size in rig::sizes() {
        for (before, answers) in
            [(states::holding(), false), (states::manual(), false), (states::tracking(0.0), true)]
        {
            let mut window = rig::window(size, rig::model(before));
            window.key_press(Key::M);
            settle(&mut window);
            if answers {
                assert!(window.query_by_label(pad).is_none_or(|pad| !pad.is_focused()));
                window.key_press(Key::Enter);
            }
            assert_eq!(asked(&mut window), [antenna(Command::Manual)]);
            // The session shows the new mode a moment later.
            window.state_mut().model.shown_mut().antennas[0].snapshot = states::manual().into();
            assert_eq!(asked(&mut window), [], "nothing moves by itself");
            assert!(window.get_by_label(pad).is_focused());
            window.key_press(Key::Enter);
            assert_eq!(asked(&mut window), [], "a second Enter names no direction");

            window.key_down(Key::ArrowUp);
            let jog = antenna(Command::Jog { rates_deg_s: [0.0, 0.5] });
            let held = asked(&mut window);
            assert!(held.len() > 1 && held.iter().all(|command| *command == jog), "{held:?}");
            window.input_mut().focused = false;
            assert_eq!(asked(&mut window), [antenna(Command::EndJog)], "the window was left");
            window.input_mut().focused = true;
            assert_eq!(asked(&mut window), []);
        }
    }
}

#[test]
fn m_waits_for_manual_only_until_something_else_is_done() {
    let mut window = rig::window(rig::LARGE, rig::model(states::holding()));
    window.key_press(Key::M);
    settle(&mut window);
    window.key_press(Key::ArrowDown);
    settle(&mut window);
    window.state_mut().model.shown_mut().antennas[0].snapshot = states::manual().into();
    window.state_mut().commands.clear();
    assert_eq!(asked(&mut window), []);
    window.key_press(Key::ArrowDown);
    let commands = asked(&mut window);
    assert!(matches!(commands[..], [UiCommand::SelectPass(_)]), "{commands:?}");
}

#[test]
fn g_chooses_position_and_asks_while_tracking() {
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(states::holding()));
        window.key_press(Key::G);
        assert_eq!(asked(&mut window), [antenna(Command::Hold)]);

        let mut window = rig::window(size, rig::model(states::manual()));
        window.key_press(Key::G);
        assert_eq!(asked(&mut window), [], "the fields are open in Manual");
        assert!(window.get_by_label("Go to azimuth, degrees").is_focused());

        let mut window = rig::window(size, rig::model(states::tracking(0.0)));
        window.key_press(Key::G);
        assert_eq!(asked(&mut window), []);
        window.get_by_label_contains("Position ends that.");
        window.key_press(Key::Enter);
        assert_eq!(asked(&mut window), [antenna(Command::Hold)]);
    }
}

#[test]
fn enter_answers_the_question_and_nothing_that_had_the_focus() {
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(states::holding()));
        window.get_by_role_and_label(Role::RadioButton, "Position").focus();
        settle(&mut window);
        window.key_press(Key::T);
        settle(&mut window);
        window.key_press(Key::Enter);
        assert_eq!(asked(&mut window), [rig::track_noaa_20()]);
    }
}

#[test]
fn a_mode_is_one_click_but_for_park_which_is_held() {
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(states::manual()));
        for (word, command) in [
            ("Standby", antenna(Command::Standby)),
            ("Manual", antenna(Command::Manual)),
            ("Position", antenna(Command::Hold)),
            ("Track", rig::track_noaa_20()),
        ] {
            window.get_by_role_and_label(Role::RadioButton, word).click();
            assert_eq!(asked(&mut window), [command], "{word}");
        }
        window.get_by_role_and_label(Role::RadioButton, "Park").click();
        assert_eq!(asked(&mut window), []);
        let hold = window.get_by_label("Hold 1 s to park").rect().center();
        window.drag_at(hold);
        window.run_steps(6);
        window.drop_at(hold);
        assert_eq!(asked(&mut window), [antenna(Command::Park)]);
    }
}

#[test]
fn an_arrow_key_that_passes_over_a_mode_does_not_command_it() {
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(states::holding()));
        window.get_by_role_and_label(Role::RadioButton, "Standby").focus();
        settle(&mut window);
        window.key_press(Key::ArrowRight);
        assert_eq!(asked(&mut window), []);
        assert!(window.get_by_role_and_label(Role::RadioButton, "Manual").is_focused());
        window.key_press(Key::Enter);
        assert_eq!(asked(&mut window), [antenna(Command::Manual)]);
    }
}

#[test]
fn a_jog_lasts_as_long_as_its_key_is_held() {
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(states::manual()));
        let key = window.get_by_label("Jog X+").rect().center();
        window.drag_at(key);
        let jog = antenna(Command::Jog { rates_deg_s: [0.5, 0.0] });
        let held = asked(&mut window);
        assert!(held.len() > 1 && held.iter().all(|command| *command == jog), "{held:?}");
        window.drop_at(key);
        assert_eq!(asked(&mut window), [antenna(Command::EndJog)]);
    }
}

#[test]
fn another_view_and_another_antenna_end_the_jog() {
    for size in rig::sizes() {
        for other in [UiCommand::SelectAntenna(1), UiCommand::Show(azel::model::View::Preferences)]
        {
            let mut model = rig::model(states::manual());
            let mut second = model.station.antennas[0].clone();
            second.name = "Mast".to_owned();
            model.shown_mut().antennas.push(rig::antenna(second, states::manual()));
            let mut window = rig::window(size, model);
            window.drag_at(window.get_by_label("Jog X+").rect().center());
            settle(&mut window);
            match other {
                UiCommand::SelectAntenna(index) => {
                    window.state_mut().model.selected_antenna = index;
                }
                _ => window.state_mut().model.view = azel::model::View::Preferences,
            }
            window.state_mut().commands.clear();
            assert_eq!(asked(&mut window), [antenna(Command::EndJog)], "{other:?}");
        }
    }
}

#[test]
fn outside_manual_a_jog_key_does_nothing_and_says_why() {
    for size in rig::sizes() {
        for (snapshot, reason) in [
            (states::holding(), "Locked in Standby. Choose Manual or Position."),
            (states::tracking(0.0), "Locked while tracking. Choose Manual or Position."),
        ] {
            let mut window = rig::window(size, rig::model(snapshot));
            window.get_by_label(reason);
            // A low card has no pad while a target is tracked.
            if let Some(key) = window.query_by_label("Jog X+") {
                window.drag_at(key.rect().center());
            }
            assert_eq!(asked(&mut window), []);
        }
    }
}

#[test]
fn g_leads_to_the_fields_and_what_is_typed_goes_out() {
    for size in rig::sizes() {
        let snapshot = Snapshot { intent: Intent::Position, ..states::holding() };
        let mut window = rig::window(size, rig::model(snapshot));
        // Press a real key, which comes with its letter.
        let g = |pressed| egui::Event::Key {
            key: Key::G,
            physical_key: None,
            pressed,
            repeat: false,
            modifiers: egui::Modifiers::NONE,
        };
        window.input_mut().events.extend([g(true), egui::Event::Text("g".to_owned()), g(false)]);
        settle(&mut window);
        assert!(window.get_by_label(AZIMUTH).is_focused());
        assert_ne!(window.get_by_label(AZIMUTH).value().as_deref(), Some("g"));
        type_into(&mut window, AZIMUTH, "121,5");
        type_into(&mut window, ELEVATION, "8");
        window.key_press(Key::Enter);
        let commands = asked(&mut window);
        assert!(
            commands.iter().all(|command| !command.is_void_after_stop()),
            "Enter shows the way first"
        );
        window.key_press(Key::Enter);
        let target = Command::Position {
            azimuth: Some(Angle::from_degrees(121.5)),
            elevation: Some(Angle::from_degrees(8.0)),
        };
        assert_eq!(asked(&mut window), [antenna(target), antenna(Command::Preview(None))]);
    }
}

#[test]
fn a_bad_number_stays_as_typed_and_nothing_goes_out() {
    for size in rig::sizes() {
        let snapshot = Snapshot { intent: Intent::Position, ..states::holding() };
        let mut window = rig::window(size, rig::model(snapshot));
        type_into(&mut window, AZIMUTH, "12..5");
        type_into(&mut window, ELEVATION, "2");
        window.get_by_role_and_label(Role::Button, "Go to").click();
        assert_eq!(asked(&mut window), []);
        assert_eq!(window.get_by_label(AZIMUTH).value().as_deref(), Some("12..5"));
        assert_eq!(window.get_by_label(ELEVATION).value().as_deref(), Some("2"));
        window.get_by_label_contains("12..5” is not a number");
    }
}

#[test]
fn a_fault_that_locks_motion_locks_the_card_and_not_stop() {
    let mut snapshot = states::manual();
    states::report(&mut snapshot, &[8], rig::now());
    snapshot.state.motion_lock = Some(true);
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(snapshot.clone()));
        assert!(says(&window, "Locked by a fault. See Faults."));
        window.drag_at(window.get_by_label("Jog X+").rect().center());
        settle(&mut window);
        window.drop_at(window.get_by_label("Jog X+").rect().center());
        window.get_by_role_and_label(Role::Button, "Track NOAA 20").click();
        window.get_by_label("STOP").click();
        assert_eq!(asked(&mut window), [UiCommand::Stop]);
    }
}

#[test]
fn without_a_known_fault_the_card_says_why_motion_is_locked() {
    let steady = Instant::now();
    let unnamed = |link| {
        let mut snapshot = Snapshot { link, ..states::manual() };
        snapshot.state.motion_lock = Some(true);
        snapshot
    };
    for (link, wanted) in [
        (LinkState::Stale { as_of: steady }, "Locked: the unit answers late."),
        (LinkState::Up { start: steady }, "Locked: the unit reports a fault without naming it."),
    ] {
        for size in rig::sizes() {
            let mut model = rig::model(unnamed(link.clone()));
            model.steady = steady;
            let window = rig::window(size, model);
            assert!(says(&window, wanted), "{wanted}");
            assert!(!says(&window, "Locked by a fault"), "no fault is known");
        }
    }
}

#[test]
fn a_unit_that_answers_late_or_not_at_all_locks_every_motion_with_that_reason() {
    let silent = "Locked: the unit does not answer.";
    let late = "Locked: the unit answers late.";
    for (reply_s, position_s, wanted) in [(9, 9, silent), (47, 47, silent), (1, 4, late)] {
        for snapshot in [states::manual(), states::holding(), states::tracking(0.0)] {
            let mut model = rig::model(snapshot);
            states::is_late(&mut model, reply_s, position_s);
            let mut window = rig::window(rig::LARGE, model);
            assert_eq!(window.get_all_by_label(wanted).count(), 1, "{reply_s} s");
            assert!(!says(&window, "Choose Manual or Position"), "{reply_s} s");
            window.drag_at(window.get_by_label("Jog X+").rect().center());
            settle(&mut window);
            window.drop_at(window.get_by_label("Jog X+").rect().center());
            for button in ["Track NOAA 20", "Go to"] {
                if let Some(button) = window.query_by_role_and_label(Role::Button, button) {
                    button.click();
                }
                assert_eq!(asked(&mut window), [], "{button} after {reply_s} s");
            }
            window.get_by_label("STOP").click();
            assert_eq!(asked(&mut window), [UiCommand::Stop]);
        }
    }
}

#[test]
fn a_control_is_locked_from_the_moment_at_which_the_gate_refuses() {
    let jog = MotionRequest::Motion(Motion::Jog { x_deg_s: 0.5, y_deg_s: 0.0 });
    let go_to = MotionRequest::Motion(Motion::Position { azimuth: None, elevation: None });
    for position_s in 0..12 {
        let mut model = rig::model(states::manual());
        states::is_late(&mut model, position_s.min(2), position_s);
        for asked in [jog, go_to] {
            let antenna = &model.antennas[0];
            let is_refused = position_for(&asked, &antenna.snapshot.state, model.steady).is_err();
            let is_locked = antenna.no_motion(&asked, model.steady).is_some();
            assert!(is_locked || !is_refused, "{asked:?} after {position_s} s");
            let is_young = position_s == 0;
            assert!(!(is_locked && is_young), "{asked:?} after {position_s} s");
        }
    }
}

#[test]
fn no_motion_is_offered_before_the_position_is_read() {
    let model = rig::model(Snapshot { intent: Intent::Manual, ..rig::quiet() });
    let window = rig::window(rig::LARGE, model);
    window.get_by_label("Locked: the position is not read yet.");
}

#[test]
fn what_was_on_the_unit_is_told_with_its_age_while_it_does_not_answer() {
    let mut snapshot = states::holding();
    let read_at = add_seconds(rig::now(), -48.0);
    let name = "NOAA 20 (JPSS-1)".to_owned();
    snapshot.state.last_satellite = Some(LastSatellite { name, read_at });
    let mut model = rig::model(snapshot);
    states::is_late(&mut model, 30, 30);
    rig::window(rig::LARGE, model).get_by_label("On the unit 48 s ago: NOAA 20");
}

#[test]
fn the_checks_of_a_silent_unit_are_not_known() {
    let mut snapshot = states::holding();
    states::report(&mut snapshot, &[], rig::now());
    let mut model = rig::model(snapshot);
    states::is_late(&mut model, 1, 1);
    assert!(says(&rig::window(rig::LARGE, model), "No faults. All 12 checks passed"));
    let mut snapshot = states::holding();
    states::report(&mut snapshot, &[], rig::now());
    let mut model = rig::model(snapshot);
    states::is_late(&mut model, 9, 9);
    let window = rig::window(rig::LARGE, model);
    window.get_by_label("Not known. Last report 11:15:30Z: no faults.");
    assert!(!says(&window, "All 12 checks passed"));
}

#[test]
fn nothing_moves_when_a_direction_is_refused_in_manual() {
    for (size, below) in SIZES.into_iter().zip(["Details", "Travel"]) {
        let mut window = rig::window(size, rig::model(states::manual()));
        let place = |window: &Window| window.get_by_label_contains(below).rect();
        let before = place(&window);
        type_into(&mut window, "Go to azimuth, degrees", "361");
        window.key_press(Key::Enter);
        settle(&mut window);
        assert!(says(&window, "Azimuth 361 is outside 0° to 360°."), "{size:?}");
        assert_eq!(place(&window), before);
    }
}
