//! Antennas view on a unit made by hand.

use std::sync::Arc;

use azel::{
    contract,
    contract::driver::{Command, Intent, LinkLoss, LinkState, Snapshot},
    device::settings::{Change, GroupState, ReadFailure, Value, WriteError, WriteStep, Written},
    model::{UiCommand, View},
    station::AntennaId,
};
use egui::{Event, Key, Modifiers, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    every_view, makes,
    rig::{self, LARGE, SIZES, Window, asked, settle},
    settings_rig::{
        ON_UNIT, apply, change, choose, hold, opened, press, read, says, state_of, texts, write,
    },
    states,
};

/// Returns the changes of settings of antenna 1; fails at any other command.
pub(crate) fn settles(commands: Vec<UiCommand>) -> Vec<Change> {
    let change = |command| match command {
        UiCommand::Station(contract::Command::Antenna(
            AntennaId(1),
            Command::WriteSettings(change),
        )) => change,
        other => panic!("{other:?}"),
    };
    commands.into_iter().map(change).collect()
}

pub(crate) fn group<'a>(snapshot: &'a mut Snapshot, key: &'static str) -> &'a mut GroupState {
    Arc::make_mut(&mut snapshot.state.groups).get_mut(key).unwrap()
}

/// Ends `change` with `result`, as the session does.
fn end(window: &mut Window, change: &Change, result: Result<(), WriteError>) {
    let written = Written { change: change.clone(), time: rig::now(), result };
    self::change(window, 0, |snapshot| {
        let state = group(snapshot, change.group);
        if written.result.is_ok() {
            state.last_read.as_mut().unwrap().values.extend(change.values.clone());
        }
        state.written = Some(Arc::new(written));
    });
}

#[test]
fn the_view_opens_from_rail_and_key_and_leads_to_the_preferences() {
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(states::holding()));
        window.get_by_role_and_label(Role::Tab, "Antennas").click();
        assert_eq!(asked(&mut window), [UiCommand::Show(View::Antennas)]);
        window.key_press_modifiers(Modifiers::COMMAND, Key::Num4);
        assert_eq!(asked(&mut window), [UiCommand::Show(View::Antennas)]);
        let mut window = opened(size, read());
        press(&mut window, "Mount and connection");
        assert_eq!(asked(&mut window), [UiCommand::Show(View::Preferences)]);
    }
}

#[test]
fn a_setting_that_the_unit_never_tells_says_so() {
    for size in rig::sizes() {
        let window = every_view::scene("Antennas, a Rotator Genius", size);
        assert!(says(&window, "Stop offset, on the unit: not reported"));
    }
}

#[test]
fn what_is_not_read_is_asked_for_once_and_says_so() {
    let mut snapshot = read();
    for key in ["general", "web"] {
        *group(&mut snapshot, key) = GroupState::default();
    }
    group(&mut snapshot, "web").failure = Some(ReadFailure::Refused("ERR,1".to_owned()));
    let mut window = opened(LARGE, snapshot);
    let read = |key| UiCommand::antenna(AntennaId(1), Command::ReadGroup(key));
    assert_eq!(asked(&mut window), [read("general"), read("web")]);
    assert_eq!(asked(&mut window), []);
    assert!(says(&window, "not read: General, Web"));
    assert!(says(&window, "Minimum elevation, on the unit: not read"));
    assert_eq!(state_of(&window, "Minimum elevation"), "Not read");
    let inputs: Vec<_> = window.query_all_by_label("Minimum elevation, new value").collect();
    assert!(inputs.is_empty(), "it cannot be typed over");
    window.get_by_role_and_label(Role::RadioButton, "Web").click();
    settle(&mut window);
    assert!(says(&window, "Web: not read: the unit answered ERR,1."));
    press(&mut window, "Read again");
    assert_eq!(asked(&mut window).len(), 13);
}

#[test]
fn a_wrong_value_is_refused_at_its_field_and_the_typing_stays() {
    for size in rig::sizes() {
        let mut window = opened(size, read());
        for (typed, why) in [
            ("91", "Minimum elevation must be a number from 0 to 90°."),
            ("x", "Minimum elevation must be a number from 0 to 90°."),
        ] {
            write(&mut window, "Minimum elevation", typed);
            assert_eq!(state_of(&window, "Minimum elevation"), "Invalid");
            assert!(says(&window, why), "{typed}");
            let name = "Minimum elevation, new value";
            let field = window.get_by_role_and_label(Role::TextInput, name);
            assert_eq!(field.value().as_deref(), Some(typed));
        }
        write(&mut window, "North offset", "1.5");
        assert!(says(&window, "2 changes not sent, 1 invalid"));
        apply(&mut window);
        let changes = settles(asked(&mut window));
        let values = &changes[0].values;
        assert_eq!(*values, [("north_offset_deg", Value::Decimal(1.5))].into());
    }
}

#[test]
fn half_of_what_belongs_together_is_not_sent_without_the_other_half() {
    for (group, [good, value], [bad, typed]) in [
        ("gps", ["Latitude", "41.5N"], ["Longitude", "200E"]),
        ("gps", ["Longitude", "28.9E"], ["Latitude", ""]),
        ("window", ["Start", "2026-08-12 12:00:00"], ["Stop", "noon"]),
        ("window", ["Stop", "2026-08-12 12:10:00"], ["Start", ""]),
    ] {
        let mut window = opened(LARGE, read());
        write(&mut window, good, value);
        assert_eq!(state_of(&window, good), "Edited");
        write(&mut window, bad, typed);
        assert_eq!(state_of(&window, good), "Held back", "{good} with {bad} {typed:?}");
        let why =
            format!("{good} is not sent until {bad} can be sent too: both are sent together.");
        assert!(says(&window, &why));
        assert!(says(&window, "2 changes not sent, 1 invalid, 1 held back by another field"));
        write(&mut window, "North offset", "1.5");
        apply(&mut window);
        let sent: Vec<_> = settles(asked(&mut window)).iter().map(|of| of.group).collect();
        assert_eq!(sent, ["general"], "what does not belong to {group} goes");
    }
}

#[test]
fn apply_waits_with_a_setting_that_points_until_the_antenna_may_be_pointed() {
    for (is_on, auto, why) in [
        (true, Some(false), "The unit tracks: stop it first."),
        (false, Some(true), "Auto-track is on: switch it off first."),
    ] {
        let mut snapshot = read();
        let program = snapshot.state.program.as_mut().unwrap();
        (program.enabled, program.auto) = (is_on, auto);
        let mut window = opened(LARGE, snapshot);
        choose(&mut window, "SSPA auto rule", "Both");
        assert!(!says(&window, why), "the transmitter points nowhere");
        write(&mut window, "Elevation offset", "10");
        assert!(says(&window, why));
        apply(&mut window);
        assert_eq!(asked(&mut window), []);
        let name = "Elevation offset, new value";
        let field = window.get_by_role_and_label(Role::TextInput, name);
        assert_eq!(field.value().as_deref(), Some("10"), "the typing stays");
        change(&mut window, 0, |snapshot| {
            let program = snapshot.state.program.as_mut().unwrap();
            (program.enabled, program.auto) = (false, Some(false));
        });
        assert!(!says(&window, why));
        apply(&mut window);
        let changes = settles(asked(&mut window));
        assert_eq!(changes[0].values.get("elevation_offset_deg"), Some(&Value::Decimal(10.0)));
    }
}

#[test]
fn apply_sends_what_was_changed_with_what_was_seen_and_proves_it() {
    for size in rig::sizes() {
        let mut window = opened(size, read());
        write(&mut window, "Minimum elevation", "5");
        write(&mut window, "Latitude", "41.02N");
        write(&mut window, "North offset", "3,00");
        assert!(says(&window, "1 change not sent"), "what is the same is no edit");
        // Another client changes the value. Azel compares with the value that the operator saw.
        change(&mut window, 0, |snapshot| {
            let values = &mut group(snapshot, "general").last_read.as_mut().unwrap().values;
            values.insert("lead_ms", Value::Integer(90_000));
        });
        press(&mut window, "Apply 1 change (Ctrl Enter)");
        let changes = settles(asked(&mut window));
        let [change_of_general] = changes.as_slice() else { panic!("{changes:?}") };
        let Change { group: key, values, expected: seen, is_unlocked, .. } = change_of_general;
        assert_eq!((*key, *is_unlocked), ("general", false));
        assert_eq!(*values, [("minimum_elevation_deg", Value::Decimal(5.0))].into());
        assert_eq!(seen.as_ref().unwrap()["lead_ms"], Value::Integer(1));
        assert_eq!(state_of(&window, "Minimum elevation"), "Sending");
        apply(&mut window);
        assert_eq!(asked(&mut window), [], "not twice");

        change(&mut window, 0, |of| group(of, "general").step = Some(WriteStep::Sending));
        change(&mut window, 0, |of| group(of, "general").step = None);
        end(&mut window, change_of_general, Err(WriteError::ChangedMeanwhile));
        assert_eq!(state_of(&window, "Minimum elevation"), "Rejected");
        assert!(says(&window, "On the unit: Lead time was 1 ms and is now 90\u{2009}000 ms."));
        apply(&mut window);
        let again = settles(asked(&mut window)).remove(0);
        assert_eq!(again.expected.as_ref().unwrap()["lead_ms"], Value::Integer(90_000));
        assert_ne!(again.ticket, change_of_general.ticket);
        end(&mut window, &again, Ok(()));
        assert_eq!(state_of(&window, "Minimum elevation"), "Verified 11:15:30Z");
        assert!(says(&window, "1 setting read back and verified 11:15:30Z"));
        write(&mut window, "Minimum elevation", "6");
        assert_eq!(state_of(&window, "Minimum elevation"), "Edited");
    }
}

#[test]
fn a_value_that_radiates_is_confirmed_by_holding() {
    for size in rig::sizes() {
        let mut window = opened(size, read());
        choose(&mut window, "Transmitter (SSPA)", "Auto");
        assert_eq!(state_of(&window, "Transmitter (SSPA)"), "Confirm first");
        assert!(says(&window, "1 change not sent, 1 needs confirmation"));
        apply(&mut window);
        assert_eq!(asked(&mut window), []);
        hold(&mut window, "Hold 1 s to confirm Transmitter (SSPA) Auto");
        assert_eq!(state_of(&window, "Transmitter (SSPA)"), "Edited");
        apply(&mut window);
        let values = settles(asked(&mut window)).remove(0).values;
        assert_eq!(values, [("sspa", Value::Choice(2))].into());
    }
}

#[test]
fn revert_drops_the_edits_and_sends_nothing() {
    for size in rig::sizes() {
        let mut window = opened(size, read());
        write(&mut window, "Minimum elevation", "5");
        write(&mut window, "Latitude", "1N");
        assert!(says(&window, "General: 1 edited") && says(&window, "GPS: 1 edited"));
        press(&mut window, "Revert");
        assert_eq!(asked(&mut window), []);
        assert_eq!(state_of(&window, "Minimum elevation"), "Unchanged");
        assert!(says(&window, "Nothing to send."));
    }
}

#[test]
fn leaving_with_edits_asks_nothing_and_keeps_them_counted_on_the_rail() {
    for size in rig::sizes() {
        let mut model = rig::model(read());
        model.view = View::Antennas;
        let mut config = model.station.antennas[0].clone();
        "Mast".clone_into(&mut config.name);
        model.shown_mut().antennas.push(rig::antenna(config, read()));
        let mut window = rig::window(size, model);
        for (leave, wanted) in
            [(Key::Num1, UiCommand::Show(View::Operate)), (Key::F2, UiCommand::SelectAntenna(1))]
        {
            let modifiers = if leave == Key::F2 { Modifiers::NONE } else { Modifiers::COMMAND };
            window.key_press_modifiers(modifiers, leave);
            assert_eq!(asked(&mut window), std::slice::from_ref(&wanted), "nothing is typed");
            write(&mut window, "Minimum elevation", "5");
            window.key_press_modifiers(modifiers, leave);
            assert_eq!(asked(&mut window), [wanted]);
            window.get_by_role_and_label(Role::Tab, "Antennas, 1 edit");
            window.state_mut().model.selected_antenna = 1;
            settle(&mut window);
            assert_eq!(state_of(&window, "Minimum elevation"), "Unchanged", "of the other one");
            window.state_mut().model.selected_antenna = 0;
            settle(&mut window);
            assert_eq!(state_of(&window, "Minimum elevation"), "Edited");
            press(&mut window, "Revert");
        }
    }
}

#[test]
fn without_a_link_the_old_values_stand_hollow_and_the_edits_stay() {
    for size in rig::sizes() {
        let mut window = opened(size, read());
        write(&mut window, "Minimum elevation", "5");
        change(&mut window, 0, |snapshot| {
            let now = azel::clock::Instant::now();
            let reason = LinkLoss::Closed;
            snapshot.link = LinkState::Lost { start: now, reason, retry_at: now };
        });
        assert!(says(&window, "Minimum elevation, on the unit, old: 3.0"));
        assert!(says(&window, "General: values read 0.0 s ago."));
        assert!(says(&window, "Minimum elevation, new value: 5"));
        assert!(says(&window, "1 change not sent, no link"));
        apply(&mut window);
        assert_eq!(asked(&mut window), []);
    }
}

#[test]
fn no_text_ever_has_a_password() {
    for size in rig::sizes() {
        let mut window = opened(size, read());
        window.get_by_role_and_label(Role::RadioButton, "FTP").click_accesskit();
        settle(&mut window);
        assert!(says(&window, "Password, on the unit: hidden"));
        write(&mut window, "Password", "swordfish");
        press(&mut window, "Show the typed password");
        assert_eq!(state_of(&window, "Password"), "Edited");
        apply(&mut window);
        let commands = asked(&mut window);
        let told = format!("{:?} {commands:?}", texts(&window));
        let change = settles(commands).remove(0);
        end(&mut window, &change, Err(WriteError::Refused("ERR,7".to_owned())));
        let told = format!("{told} {:?}", texts(&window));
        for secret in [ON_UNIT, "swordfish"] {
            assert!(!told.contains(secret), "{told}");
        }
        let Some(Value::Secret(sent)) = change.values.get("password") else { panic!() };
        assert_eq!(sent.reveal(), "swordfish");
    }
}

#[test]
fn a_password_that_was_sent_or_dropped_does_not_come_back_by_undo() {
    for size in rig::sizes() {
        for is_sent in [true, false] {
            let mut window = opened(size, read());
            window.get_by_role_and_label(Role::RadioButton, "FTP").click_accesskit();
            settle(&mut window);
            write(&mut window, "Password", "swordfish");
            // After some seconds without typing, the operator could undo the text.
            window.run_steps(300);
            assert_eq!(state_of(&window, "Password"), "Edited");
            if is_sent {
                apply(&mut window);
                let change = settles(asked(&mut window)).remove(0);
                end(&mut window, &change, Ok(()));
            } else {
                press(&mut window, "Revert");
            }
            let before = state_of(&window, "Password");
            assert_ne!(before, "Edited");
            window.get_by_label("Password, new value").focus();
            settle(&mut window);
            for _ in 0..3 {
                window.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Z);
                settle(&mut window);
            }
            assert_eq!(state_of(&window, "Password"), before);
        }
    }
}

#[test]
fn a_section_of_the_list_is_brought_into_view() {
    for size in SIZES {
        let mut window = opened(size, read());
        press(&mut window, "Service");
        settle(&mut window);
        let title = window.get_by_role_and_label(Role::Label, "Service").rect();
        assert!(title.top() > 100.0 && title.bottom() < size[1] - 64.0, "{title:?}");
    }
}

#[test]
fn esc_while_typing_sends_nothing_and_keeps_the_typing() {
    let mut window = opened(LARGE, read());
    write(&mut window, "Minimum elevation", "5");
    window.key_press(Key::Escape);
    assert_eq!(asked(&mut window), []);
    window.event(Event::Text("5".to_owned()));
    settle(&mut window);
    assert_eq!(state_of(&window, "Minimum elevation"), "Edited");
    window.get_by_role_and_label(Role::Button, "STOP").click();
    assert_eq!(asked(&mut window), [UiCommand::Stop]);
}

#[test]
fn every_field_has_a_name_and_the_bar_is_whole() {
    for size in SIZES {
        let window = opened(size, read());
        let apply = window.get_by_role_and_label(Role::Button, "Apply (Ctrl Enter)").rect();
        assert!(apply.right() <= size[0] && apply.bottom() <= size[1], "{apply:?}");
        for role in [Role::TextInput, Role::ComboBox] {
            for node in window.query_all_by_role(role) {
                let name = node.accesskit_node().label().unwrap_or_default();
                assert!(name.ends_with(", new value"), "{name:?}");
                assert!(node.rect().right() <= size[0] - 16.0, "{name}");
            }
        }
    }
}

#[test]
fn a_unit_without_settings_offers_nothing_to_do_with_them() {
    for size in rig::sizes() {
        let mut model = makes::model(makes::rc2000c(), makes::rc2000c_at(Intent::Manual));
        model.view = View::Antennas;
        let mut window = rig::window(size, model);
        assert!(says(&window, "This unit keeps no settings"));
        press(&mut window, "Open Preferences");
        assert_eq!(asked(&mut window), [UiCommand::Show(View::Preferences)]);
        assert!(window.query_by_label("Connect").is_none(), "it has a link");
        for words in ["Save copy", "Compare with file", "Read again", "Revert"] {
            assert!(window.query_by_label(words).is_none(), "{words}");
        }
        assert!(window.query_by_label_contains("Apply").is_none());
    }
}
