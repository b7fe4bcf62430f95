//! Control of antennas whose capabilities differ from a Satrak's: the controls on the card and
//! their commands.

use std::sync::Arc;

use azel::{
    astro::Angle,
    clock::Instant,
    contract::driver::{Command, Intent, LinkState},
    device::AxisMotion,
    model::{Model, UiCommand, View},
    station::{Antenna, AntennaId},
};
use egui::{Key, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    extremes::nothing_overlaps,
    makes,
    rig::{self, SIZES, Window, asked, says, sent, settle},
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

/// Holds a jog key for some frames, and returns the commands.
fn hold(window: &mut Window, key: &str) -> Vec<UiCommand> {
    let key = window.get_by_label(key).rect().center();
    window.drag_at(key);
    let mut commands = asked(window);
    window.drop_at(key);
    commands.extend(asked(window));
    commands.dedup();
    commands
}

fn jog(x_deg_s: f64, y_deg_s: f64) -> [UiCommand; 2] {
    let rates_deg_s = [x_deg_s, y_deg_s];
    [antenna(Command::Jog { rates_deg_s }), antenna(Command::EndJog)]
}

fn genius(intent: Intent) -> Model {
    makes::model(makes::pair(), makes::pair_at(intent))
}

fn rc2000c(intent: Intent) -> Model {
    makes::model(makes::rc2000c(), makes::rc2000c_at(intent))
}

#[test]
fn nothing_is_asked_of_an_rc2000c_before_connect() {
    for size in rig::sizes() {
        let mut window = rig::window(size, makes::model(makes::rc2000c(), makes::rc2000c_off()));
        assert!(says(&window, "Azel sends it nothing until you press Connect"));
        assert!(says(&window, "may lock out somebody at its panel"));
        assert!(says(&window, "Locked: not connected."));
        window.get_by_label_contains("RC2000C: Not connected");
        window.get_by_role_and_label(Role::Button, "Link of RC2000C").click_accesskit();
        settle(&mut window);
        assert!(window.query_by_label("Disconnect").is_none(), "there is no link to close");
        window.get_by_role_and_label(Role::Button, "Link of RC2000C").click_accesskit();
        settle(&mut window);
        window.drag_at(window.get_by_label("Jog clockwise").rect().center());
        assert_eq!(asked(&mut window), []);
        window.get_by_role_and_label(Role::Button, "Connect").focus();
        settle(&mut window);
        window.key_press(Key::Enter);
        assert_eq!(asked(&mut window), [antenna(Command::Connect)]);
    }
}

#[test]
fn every_antenna_can_be_let_go_of_with_the_keyboard() {
    for size in rig::sizes() {
        for model in
            [rig::model(states::holding()), genius(Intent::Standby), rc2000c(Intent::Manual)]
        {
            let name = format!("Link of {}", model.antennas[0].config.name);
            let mut window = rig::window(size, model);
            window.get_by_label(&name).focus();
            settle(&mut window);
            window.key_press(Key::Enter);
            settle(&mut window);
            window.get_by_role_and_label(Role::Button, "Disconnect").focus();
            settle(&mut window);
            window.key_press(Key::Enter);
            assert_eq!(asked(&mut window), [antenna(Command::Disconnect)], "{name}");
        }
    }
}

#[test]
fn letting_go_of_what_moves_is_asked_about() {
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(states::moving()));
        window.get_by_label("Link of Satrak").click();
        settle(&mut window);
        window.get_by_role_and_label(Role::Button, "Disconnect").click();
        assert_eq!(asked(&mut window), []);
        assert!(says(&window, "Disconnect from Satrak? It is moving or tracking,"));
        window.key_press(Key::Enter);
        assert_eq!(asked(&mut window), [antenna(Command::Disconnect)]);
    }
}

#[test]
fn after_letting_go_of_a_satrak_it_can_be_taken_up_again() {
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(makes::rc2000c_off()));
        assert!(says(
            &window,
            "so another program can use it. Press Connect to open the link again."
        ));
        window.get_by_role_and_label(Role::Button, "Connect").click();
        assert_eq!(asked(&mut window), [antenna(Command::Connect)]);
    }
}

#[test]
fn the_keys_of_a_pair_turn_one_rotator_each_at_its_one_speed() {
    for size in rig::sizes() {
        let mut window = rig::window(size, genius(Intent::Manual));
        for (key, commands) in [
            ("Jog clockwise", jog(4.0, 0.0)),
            ("Jog counterclockwise", jog(-4.0, 0.0)),
            ("Jog up", jog(0.0, 4.0)),
            ("Jog down", jog(0.0, -4.0)),
        ] {
            assert_eq!(hold(&mut window, key), commands, "{key}");
        }
        assert!(window.query_by_label_contains("Jog rate").is_none(), "one speed is no choice");
        assert!(window.query_by_label("Jog speed").is_none());
        assert!(window.query_by_label("Step size, degrees").is_none());
        assert!(says(&window, "STOP stops both rotators."));
    }
}

#[test]
fn a_rotator_alone_has_a_second_pair_of_keys_and_no_elevation() {
    for size in rig::sizes() {
        let snapshot = makes::alone_at(Intent::Manual, true);
        let mut window = rig::window(size, makes::model(makes::alone(), snapshot));
        assert_eq!(hold(&mut window, "Jog Other +"), jog(0.0, 4.0));
        assert_eq!(hold(&mut window, "Jog Other −"), jog(0.0, -4.0));
        assert!(window.query_by_label(ELEVATION).is_none());
        assert!(!says(&window, "El: "), "no row in the table");
        assert!(says(&window, "Antenna Mast 043°, no elevation"), "a line in the sky");
        type_into(&mut window, AZIMUTH, "270");
        window.get_by_role_and_label(Role::Button, "Go to").click();
        let azimuth = Some(Angle::from_degrees(270.0));
        let wanted = antenna(Command::Position { azimuth, elevation: None });
        assert_eq!(sent(&mut window), [wanted]);
    }
}

#[test]
fn what_nobody_would_see_turn_is_not_turned() {
    for size in rig::sizes() {
        let snapshot = makes::alone_at(Intent::Manual, false);
        let mut window = rig::window(size, makes::model(makes::alone(), snapshot));
        assert!(says(&window, "The other rotator has no known angle"));
        assert_eq!(hold(&mut window, "Jog Other +"), []);
        assert_eq!(hold(&mut window, "Jog clockwise"), jog(4.0, 0.0));
    }
}

#[test]
fn slow_and_fast_are_chosen_by_name() {
    for size in rig::sizes() {
        let mut window = rig::window(size, rc2000c(Intent::Manual));
        assert_eq!(hold(&mut window, "Jog up"), jog(0.0, 0.5), "slow to begin with");
        window.get_by_role_and_label(Role::RadioButton, "Fast").click();
        settle(&mut window);
        assert_eq!(hold(&mut window, "Jog up"), jog(0.0, 2.0));
        window.key_press(Key::PageDown);
        settle(&mut window);
        assert_eq!(hold(&mut window, "Jog counterclockwise"), jog(-0.5, 0.0));
    }
}

#[test]
fn the_sentence_tells_a_jog_by_its_speed() {
    let mut snapshot = makes::rc2000c_at(Intent::Manual);
    snapshot.jog = Some([-2.0, 0.0]);
    let model = makes::model(makes::rc2000c(), snapshot);
    assert_eq!(states::sentence(&model), "Jogging CCW at speed Fast while the key is held.");
    let mut snapshot = makes::pair_at(Intent::Manual);
    snapshot.jog = Some([0.0, 4.0]);
    let model = makes::model(makes::pair(), snapshot);
    assert_eq!(states::sentence(&model), "Jogging Up while the key is held.");
}

#[test]
fn an_axis_of_more_than_a_turn_takes_what_lies_beyond_it() {
    for size in rig::sizes() {
        let mut window = rig::window(size, rc2000c(Intent::Position));
        type_into(&mut window, AZIMUTH, "400");
        type_into(&mut window, ELEVATION, "42");
        window.get_by_role_and_label(Role::Button, "Go to").click();
        let wanted = Command::Position {
            azimuth: Some(Angle::from_degrees(400.0)),
            elevation: Some(Angle::from_degrees(42.0)),
        };
        assert_eq!(sent(&mut window), [antenna(wanted)]);
        type_into(&mut window, AZIMUTH, "4000");
        window.get_by_role_and_label(Role::Button, "Go to").click();
        assert_eq!(sent(&mut window), []);
        assert!(says(&window, "Azimuth 4000 is outside 0° to 450°."));
    }
}

#[test]
fn without_a_calibration_it_is_turned_by_hand_and_sent_nowhere() {
    for size in rig::sizes() {
        let snapshot = makes::rc2000c_uncalibrated(Intent::Manual);
        let mut window = rig::window(size, makes::model(makes::rc2000c(), snapshot));
        assert!(says(
            &window,
            "The unit reports no angles: they are not calibrated, or a sensor is missing."
        ));
        assert_eq!(hold(&mut window, "Jog up"), jog(0.0, 0.5));
        window.get_by_role_and_label(Role::Button, "Go to").click();
        window.get_by_role_and_label(Role::Button, "Track NOAA 20").click();
        assert_eq!(asked(&mut window), []);
        assert!(says(&window, "Az: Command not known, actual not known"));
    }
}

/// An RC2000C shows no angle of an axis at its limit.
#[test]
fn an_antenna_at_a_limit_is_shown_there_and_says_why_it_has_no_azimuth() {
    for (plus, words, mark) in [
        (false, "At the CCW limit: the unit shows no azimuth there.", "at CCW limit"),
        (true, "At the CW limit: the unit shows no azimuth there.", "at CW limit"),
    ] {
        let mut snapshot = makes::rc2000c_uncalibrated(Intent::Manual);
        let axes = &mut snapshot.state.measured.as_mut().unwrap().axes;
        (axes[0].plus_limit, axes[0].minus_limit) = (plus, !plus);
        for size in rig::sizes() {
            let window = rig::window(size, makes::model(makes::rc2000c(), snapshot.clone()));
            assert!(says(&window, words));
            let name = format!("Antenna RC2000C {mark}");
            assert!(window.query_by_label(&name).is_some(), "{name}");
        }
    }
    let mut snapshot = makes::rc2000c_uncalibrated(Intent::Manual);
    snapshot.state.measured.as_mut().unwrap().axes[1].plus_limit = true;
    for size in rig::sizes() {
        let window = rig::window(size, makes::model(makes::rc2000c(), snapshot.clone()));
        assert!(says(&window, "At the upper limit: the unit shows no elevation there."));
    }
}

#[test]
fn a_set_limit_blocks_its_own_key_and_the_sentence_names_the_way_back() {
    let mut snapshot = makes::rc2000c_at(Intent::Manual);
    snapshot.state.measured.as_mut().unwrap().axes[0].plus_limit = true;
    for size in rig::sizes() {
        let model = makes::model(makes::rc2000c(), snapshot.clone());
        let words = "Stopped: CW limit switch is set. Jog CCW to leave the limit.";
        assert_eq!(states::sentence(&model), words);
        let mut window = rig::window(size, model);
        assert_eq!(hold(&mut window, "Jog clockwise"), []);
        assert_eq!(hold(&mut window, "Jog counterclockwise"), jog(-0.5, 0.0));
    }
}

#[test]
fn alarms_lock_what_moves_and_say_what_to_do() {
    for size in rig::sizes() {
        let snapshot = makes::rc2000c_alarmed(Intent::Manual);
        let mut window = rig::window(size, makes::model(makes::rc2000c(), snapshot));
        assert!(says(&window, "Motion is locked by a fault: Elevation drive. The sensor did not"));
        assert!(says(&window, "Locked by a fault. See Faults."));
        assert_eq!(hold(&mut window, "Jog up"), []);
        if let Some(folded) = window.query_by_label("Faults: 1 fault: Elevation drive") {
            folded.click();
            settle(&mut window);
        }
        window.get_by_label("Details of the checks").click_accesskit();
        settle(&mut window);
        window.get_by_label_contains("Elevation drive: fault. The sensor did not move");
        window.get_by_label("STOP").click();
        assert_eq!(asked(&mut window), [UiCommand::Stop]);
    }
}

#[test]
fn what_the_unit_tells_is_listed_and_folds_to_the_gravest() {
    for size in rig::sizes() {
        let snapshot = makes::rc2000c_alarmed(Intent::Standby);
        let mut window = rig::window(size, makes::model(makes::rc2000c(), snapshot));
        if let Some(folded) = window.query_by_label("Readings: Alarm 3, elevation jammed") {
            folded.click();
            settle(&mut window);
        }
        for line in ["Satellite: TÜRKSAT 4A", "AGC 1: 43 %", "Alarm: 3, elevation jammed"] {
            window.get_by_label(line);
        }
    }
}

#[test]
fn the_modes_are_those_of_the_unit_and_each_is_asked_for() {
    for size in rig::sizes() {
        for model in [genius(Intent::Manual), rc2000c(Intent::Manual)] {
            let mut window = rig::window(size, model);
            for (word, command) in [
                ("Standby", antenna(Command::Standby)),
                ("Manual", antenna(Command::Manual)),
                ("Position", antenna(Command::Hold)),
                ("Track", rig::track_noaa_20()),
            ] {
                window.get_by_role_and_label(Role::RadioButton, word).click();
                assert_eq!(asked(&mut window), [command], "{word}");
            }
            assert!(window.query_by_label_contains("Auto-track").is_none());
            window.get_by_label("Azel follows: nothing");
        }
    }
}

#[test]
fn what_was_typed_for_one_antenna_is_not_for_the_next() {
    let mut model = genius(Intent::Position);
    let second = makes::model(makes::rc2000c(), makes::rc2000c_at(Intent::Position));
    model.shown_mut().antennas.extend(second.antennas.clone());
    Arc::make_mut(&mut model.shown_mut().antennas[1].config).id = AntennaId(2);
    let mut window = rig::window(rig::LARGE, model);
    type_into(&mut window, AZIMUTH, "121");
    window.state_mut().model.selected_antenna = 1;
    settle(&mut window);
    let typed = window.get_by_label(AZIMUTH).value();
    assert_eq!(typed.unwrap_or_default(), "");
}

#[test]
fn no_other_view_shows_what_only_a_satrak_has() {
    for size in rig::sizes() {
        for mut model in [genius(Intent::Standby), rc2000c(Intent::Standby)] {
            model.view = View::Antennas;
            let mut window = rig::window(size, model);
            for word in ["Tracking window", "Satellite and TLE", "GPS", "Clock"] {
                assert!(window.query_by_label(word).is_none(), "{word}");
            }
            asked(&mut window);
            window.state_mut().model.view = View::Console;
            settle(&mut window);
            let words = "Queries, such as STATUS, can be sent. Change settings in Antennas; move \
                         antennas in Operate.";
            assert!(says(&window, words));
            type_into(&mut window, "Query to send", "status");
            assert!(says(&window, "Asks for the status. The answer will appear in the log."));
            window.key_press(Key::Enter);
            let question = UiCommand::antenna(AntennaId(1), Command::Ask("STATUS".into()));
            assert_eq!(asked(&mut window), [question]);
            type_into(&mut window, "Query to send", "TPOS?");
            assert!(says(&window, "Not sent. The unit does not answer this query"));
            window.state_mut().model.view = View::Elements;
            settle(&mut window);
            assert!(window.query_by_label("Upload and verify").is_none());
        }
    }
}

#[test]
fn each_card_of_a_pair_opens_the_service_functions() {
    for size in SIZES {
        for card in [0, 1] {
            let mut model = genius(Intent::Standby);
            model.view = View::Antennas;
            let groups = model.antennas[0].groups();
            let mut window = rig::window(size, model);
            nothing_overlaps(&window);
            let read = groups.iter().map(|group| antenna(Command::ReadGroup(group.key)));
            assert_eq!(asked(&mut window), read.collect::<Vec<_>>(), "each is read once");
            let unlock = window.query_all_by_role_and_label(Role::Button, "Unlock").nth(card);
            unlock.expect("a card for each rotator").click_accesskit();
            settle(&mut window);
            assert!(says(&window, "Unlock the service functions"));
        }
    }
}

#[test]
fn a_motion_by_somebody_else_shows_on_the_chip() {
    let mut snapshot = makes::rc2000c_at(Intent::Standby);
    snapshot.state.measured.as_mut().unwrap().axes[0].motion = AxisMotion::Plus;
    let window = rig::window(rig::LARGE, makes::model(makes::rc2000c(), snapshot));
    let chip = window.get_by_label_contains("RC2000C: Moving");
    assert!(chip.accesskit_node().label().is_some_and(|name| name.contains("link live")));
}

#[test]
fn the_other_antennas_stand_below_and_a_click_shows_one() {
    for size in rig::sizes() {
        let mut model = rig::model(states::holding());
        let genius = Antenna::genius("Mast", "192.168.1.250:9006");
        let mut snapshot = states::holding();
        snapshot.link = LinkState::Up { start: Instant::now() };
        snapshot.state.measured = Some(states::measured(43.0, 12.0, AxisMotion::Still));
        model.shown_mut().antennas.push(rig::antenna(genius, snapshot));
        Arc::make_mut(&mut model.shown_mut().antennas[1].config).id = AntennaId(2);
        let mut window = rig::window(size, model);
        let is_other = |name: &str| name.starts_with("Show Mast: Holding at 43°, 12°");
        let other = |window: &rig::Window| {
            let keys: Vec<_> = window
                .get_all_by_role(Role::Button)
                .filter(|node| node.accesskit_node().label().is_some_and(|name| is_other(&name)))
                .map(|node| node.accesskit_node().label().unwrap_or_default())
                .collect();
            assert_eq!(keys.len(), 1, "{keys:?}");
            keys[0].clone()
        };
        let name = other(&window);
        window.get_by_role_and_label(Role::Button, &name).scroll_to_me();
        window.run_steps(3);
        window.get_by_role_and_label(Role::Button, &name).click();
        assert_eq!(rig::asked(&mut window), [UiCommand::SelectAntenna(1)]);
    }
}
