//! Lock-out of a unit for work at the antenna.

use std::sync::Arc;

use azel::{
    contract::{
        self,
        alarms::AlarmKind,
        driver::{Command, Intent, LinkState, Snapshot},
    },
    controller::SPECS,
    model::UiCommand,
    station::{self, AntennaId, LockOut},
};
use egui::{Event, Key, Modifiers, Role};
use egui_kittest::{
    Harness,
    kittest::{NodeT as _, Queryable as _},
};

use crate::window_stories::{
    makes,
    rig::{self, SIZES, Window, asked, settle},
    settings_rig::{hold, press},
    states,
    unit::{RealWindow, Unit, clock_from, open, step_until},
};

const HOLD: &str = "Hold 1 s to lock out";
const TAKE_OFF: &str = "Hold 1 s to remove the lock-out";

fn lock_out() -> LockOut {
    let since = "2026-08-12T09:30:00Z".parse().unwrap();
    LockOut { operator: "Ada".to_owned(), reason: "gear box open".to_owned(), start: since }
}

/// Returns `snapshot` with a lock-out.
pub(crate) fn locked(snapshot: Snapshot) -> Snapshot {
    Snapshot { lock_out: Some(lock_out()), ..snapshot }
}

fn is_possible(window: &Window) -> bool {
    !window.get_by_role_and_label(Role::Button, HOLD).accesskit_node().is_disabled()
}

fn write<S>(window: &mut Harness<'_, S>, field: &str, words: &str) {
    window.get_by_role_and_label(Role::TextInput, field).focus();
    window.run_steps(2);
    window.event(Event::Text(words.to_owned()));
    window.run_steps(2);
}

/// Opens the dialog from the menu of the link.
fn ask_for_lock_out<S>(window: &mut Harness<'_, S>, antenna: &str) {
    press(window, &format!("Link of {antenna}"));
    press(window, "Lock out…");
    window.run_steps(4);
}

#[test]
fn a_name_and_a_reason_are_needed_and_then_a_second() {
    for size in rig::sizes() {
        for snapshot in [states::holding(), makes::rc2000c_off()] {
            let mut window = rig::window(size, rig::model(snapshot));
            ask_for_lock_out(&mut window, "Satrak");
            assert!(!is_possible(&window));
            write(&mut window, "Your name", " Ada ");
            assert!(!is_possible(&window));
            write(&mut window, "Reason", "gear box open");
            settle(&mut window);
            assert!(is_possible(&window));
            hold(&mut window, HOLD);
            let wanted = LockOut { start: rig::now(), ..lock_out() };
            assert_eq!(
                asked(&mut window),
                [UiCommand::antenna(AntennaId(1), Command::LockOut(wanted))]
            );
            assert!(window.query_by_label(HOLD).is_none(), "the dialog is closed");
        }
    }
}

#[test]
fn what_ends_is_named_and_asked_about() {
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(states::tracking(0.1)));
        ask_for_lock_out(&mut window, "Satrak");
        let what = "Satrak tracks NOAA 20 by itself. STOP is sent first and ends that.";
        assert!(rig::says(&window, what));
        write(&mut window, "Your name", "Ada");
        write(&mut window, "Reason", "gear box open");
        settle(&mut window);
        hold(&mut window, HOLD);
        assert_eq!(asked(&mut window), [], "asked first");
        assert!(rig::says(&window, &format!("{what} Lock out Satrak anyway?")));
        press(&mut window, "Lock out (Enter)");
        let asked = asked(&mut window);
        assert!(
            matches!(
                asked[..],
                [UiCommand::Station(contract::Command::Antenna(AntennaId(1), Command::LockOut(_)))]
            ),
            "{asked:?}"
        );
    }
}

#[test]
fn it_is_shown_on_chip_card_and_lists_and_taken_off_by_a_hold() {
    for size in SIZES {
        let mut model = rig::model(locked(states::holding()));
        let other = locked(Snapshot::before_anything(LinkState::Off));
        model.shown_mut().antennas.push(rig::antenna(makes::rc2000c(), other));
        let mut window = rig::window(size, model);
        for chip in ["Satrak: In maintenance, link live", "RC2000C: In maintenance, link off"] {
            window.get_by_label(chip);
        }
        let words = "In maintenance, locked out by Ada since Wed 2026-08-12 09:30:00Z: gear box \
                     open. Only queries and STOP go to it.";
        assert!(rig::says(&window, words));
        assert!(rig::says(&window, "In maintenance by Ada"));
        if window.query_all_by_label_contains(", max ").next().is_none() {
            window.key_press(Key::P);
            settle(&mut window);
        }
        assert!(window.get_all_by_label_contains(", max ").count() > 0);
        let listed = window.get_all_by_label_contains("In maintenance").count();
        assert!(listed > 5, "in the list of passes too: {listed}");
        if size == rig::SMALL {
            window.key_press(Key::P);
            settle(&mut window);
        }

        press(&mut window, "Remove…");
        settle(&mut window);
        for told in ["Ada", "gear box open", "Wed 2026-08-12 09:30:00Z"] {
            assert!(rig::says(&window, told), "{told}");
        }
        window.get_by_label(TAKE_OFF);
        press(&mut window, "Cancel");
        assert_eq!(asked(&mut window), []);
        press(&mut window, "Remove…");
        settle(&mut window);
        hold(&mut window, TAKE_OFF);
        assert_eq!(asked(&mut window), [UiCommand::antenna(AntennaId(1), Command::Unlock)]);
    }
}

#[test]
fn until_it_is_read_back_it_is_being_locked_out() {
    for size in rig::sizes() {
        let locking = Snapshot { locking: true, ..locked(states::holding()) };
        let window = rig::window(size, rig::model(locking));
        window.get_by_label_contains("Satrak: Being locked out");
        assert!(rig::says(&window, "Being locked out by Ada"));
        assert!(rig::says(&window, "The unit has not confirmed yet that auto-track is off."));
    }
}

/// Opens a window and locks the antenna out, as Ada, by holding the button.
fn locked_out_by_ada(path: &std::path::Path, clock: azel::clock::Clock) -> RealWindow {
    let mut window = open(path, clock);
    let is_up = |model: &azel::model::Model| {
        model.antenna().is_some_and(|of| of.snapshot.state.measured.is_some())
    };
    step_until(&mut window, "the antenna is measured", is_up);
    ask_for_lock_out(&mut window, "Satrak");
    write(&mut window, "Your name", "Ada");
    write(&mut window, "Reason", "gear box open");
    window.run_steps(2);
    hold(&mut window, HOLD);
    window
}

#[test]
fn it_is_kept_across_a_restart_and_moves_again_when_it_is_taken_off() {
    let utc = "2026-08-12T11:14:30Z".parse().unwrap();
    let (unit, folder) = (Unit::start(utc), tempfile::tempdir().unwrap());
    let path = folder.path().join("station.toml");
    station::save(&unit.station(), &path, SPECS).unwrap();
    let mut window = locked_out_by_ada(&path, clock_from(utc));
    let is_locked = |model: &azel::model::Model| {
        let snapshot = &model.antenna().unwrap().snapshot;
        snapshot.lock_out.is_some() && !snapshot.locking
    };
    step_until(&mut window, "it is locked out", is_locked);
    let file = folder.path().join("lock-outs.toml");
    assert!(std::fs::read_to_string(&file).unwrap().contains("gear box open"));
    drop(window);

    let mut window = open(&path, clock_from(utc));
    step_until(&mut window, "it is locked out again", is_locked);
    let moves = |frame: &String| frame.contains('=') && !frame.contains("STOP");
    let received = || unit.control.received().into_iter().map(|(_, frame)| frame);
    let before = received().filter(moves).count();
    window.get_by_role_and_label(Role::RadioButton, "Manual").click();
    window.run_steps(4);
    step_until(&mut window, "it is refused", |model| model.antenna().unwrap().news.is_some());
    assert_eq!(window.state().model().antenna().unwrap().snapshot.intent, Intent::Standby);
    assert_eq!(received().filter(moves).count(), before);

    press(&mut window, "Remove…");
    window.run_steps(2);
    hold(&mut window, TAKE_OFF);
    step_until(&mut window, "it is taken off", |model| {
        model.antenna().unwrap().snapshot.lock_out.is_none()
    });
    assert!(!std::fs::read_to_string(&file).unwrap().contains("gear box open"));
}

#[test]
fn another_address_in_the_settings_is_locked_out_as_well() {
    let utc = "2026-08-12T11:14:30Z".parse().unwrap();
    let (unit, other) = (Unit::start(utc), Unit::start(utc));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("station.toml");
    station::save(&unit.station(), &path, SPECS).unwrap();
    let mut window = locked_out_by_ada(&path, clock_from(utc));
    let is_locked = |model: &azel::model::Model| {
        model.antenna().is_some_and(|antenna| antenna.snapshot.lock_out.is_some())
    };
    step_until(&mut window, "it is locked out", is_locked);

    window.get_by_role_and_label(Role::Tab, "Preferences").click();
    window.run_steps(3);
    let name = unit.station().antennas[0].name.clone();
    window.get_by_role_and_label(Role::RadioButton, &name).click();
    window.run_steps(3);
    let address = other.address.to_string();
    let old = unit.address.to_string();
    let is_field = |node: &egui_kittest::Node<'_>| node.accesskit_node().role() == Role::TextInput;
    window.get_all_by_value(&old).find(is_field).expect("its address").focus();
    window.run_steps(2);
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.event(Event::Text(address.clone()));
    window.run_steps(2);
    window.get_by_role_and_label(Role::Button, "Save and use").click();
    let is_moved = |model: &azel::model::Model| {
        model.antenna().is_some_and(|antenna| antenna.config.connection.address == address)
    };
    step_until(&mut window, "the new address is used", is_moved);
    let snapshot = Arc::clone(&window.state().model().antenna().unwrap().snapshot);
    let by = snapshot.lock_out.as_ref().map(|lock_out| lock_out.operator.as_str());
    assert!(by.is_none_or(|by| by == "Ada"), "{by:?}");
    step_until(&mut window, "it is locked out too", is_locked);
    let file = std::fs::read_to_string(folder.path().join("lock-outs.toml")).unwrap();
    assert_eq!(file.matches("gear box open").count(), 2, "{file}");
}

#[test]
fn a_list_that_cannot_be_read_locks_out_everything_and_says_so() {
    let utc = "2026-08-12T11:14:30Z".parse().unwrap();
    let (unit, folder) = (Unit::start(utc), tempfile::tempdir().unwrap());
    let path = folder.path().join("station.toml");
    station::save(&unit.station(), &path, SPECS).unwrap();
    std::fs::write(folder.path().join("lock-outs.toml"), "version = 1\n[[lock").unwrap();
    let mut window = open(&path, clock_from(utc));
    let snapshot = &window.state().model().antenna().unwrap().snapshot;
    assert_eq!(snapshot.lock_out.as_ref().unwrap().operator, "Azel", "from the first frame");
    let alarms: Vec<String> = window
        .state()
        .model()
        .alarms
        .list()
        .iter()
        .map(|alarm| azel::ui::words::alarm(&alarm.kind, "Azel", rig::now()))
        .collect();
    assert!(alarms.iter().any(|words| words.starts_with("Every unit is locked out")), "{alarms:?}");
    window.run_steps(2);
    press(&mut window, "Remove…");
    window.run_steps(2);
    hold(&mut window, TAKE_OFF);
    step_until(&mut window, "it is taken off", |model| {
        model.antenna().unwrap().snapshot.lock_out.is_none()
    });
    drop(window);
    let window = open(&path, clock_from(utc));
    assert_eq!(window.state().model().antenna().unwrap().snapshot.lock_out, None);
    let alarms = window.state().model().alarms.list();
    assert!(!alarms.iter().any(|alarm| matches!(alarm.kind, AlarmKind::LockOuts(_))));
}
