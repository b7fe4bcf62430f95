//! STOP, with any popup open and after any result of the previous STOP.

use std::time::Duration;

use azel::{
    clock::Instant,
    contract::{
        alarms::AlarmKind,
        driver::{Intent, LinkLoss, LinkState, Snapshot, StopState},
    },
    engine::{
        alarms::KeepAlarms,
        antenna::{Recent, refresh},
    },
    model::{Model, UiCommand, View},
    station::{Antenna, AntennaId},
    ui::words,
};
use egui::{Key, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    makes,
    rig::{self, SIZES, Window, asked, settle},
    states,
};

/// Clicks STOP, which must be named `name` and be the only command.
fn stop_stops(window: &mut Window, name: &str) {
    window.state_mut().commands.clear();
    window.get_by_role_and_label(Role::Button, name).click();
    assert_eq!(asked(window), [UiCommand::Stop], "{name}");
}

#[test]
fn stop_goes_out_in_every_state_of_the_last_one() {
    for size in SIZES {
        let since = states::moving().state.measured.unwrap().received;
        let stopped = StopState::Stopped { time: since };
        for (stop, of, name) in [
            (StopState::Ready, states::moving(), "STOP"),
            (StopState::Stopping { start: since }, states::moving(), "STOP, stopping"),
            (stopped, states::holding(), "STOP, all stopped"),
            (stopped, states::moving(), "STOP"),
        ] {
            let mut window = rig::window(size, rig::model(Snapshot { stop, ..of }));
            stop_stops(&mut window, name);
        }
    }
}

#[test]
fn a_stop_that_is_not_proved_says_what_to_do_and_can_be_repeated() {
    let alarm = words::alarm(&AlarmKind::StopNotConfirmed, "Satrak", rig::now());
    assert!(alarm.ends_with("Use the local panel."), "{alarm}");
    for size in SIZES {
        let mut model = rig::model(states::moving());
        let since = rig::ago(&model, 4);
        let snapshot =
            Snapshot { stop: StopState::NotConfirmed { start: since }, ..states::moving() };
        model.shown_mut().antennas =
            vec![rig::antenna(model.station.antennas[0].clone(), snapshot)];
        let text = states::sentence(&model);
        assert!(text.contains("after STOP. Use the local panel."), "{text}");
        let mut window = rig::window(size, model);
        stop_stops(&mut window, &format!("STOP, not confirmed: {text}"));
    }
}

#[test]
fn stop_goes_out_while_the_alarm_list_is_open() {
    for size in SIZES {
        let mut model = rig::model(states::moving());
        let now = model.now;
        model.shown_mut().alarms.raise(
            Some(AntennaId::FIRST),
            AlarmKind::LinkLost(LinkLoss::Closed),
            now,
        );
        let mut window = rig::window(size, model);
        window.get_by_label("1 alarm, 1 new").click();
        settle(&mut window);
        window.get_by_label_contains("Acknowledge: ");
        stop_stops(&mut window, "STOP");
    }
}

#[test]
fn stop_goes_out_while_a_question_is_asked() {
    for size in SIZES {
        let mut window = rig::window(size, rig::model(states::holding()));
        window.key_press(Key::T);
        settle(&mut window);
        window.get_by_label_contains("Track NOAA 20 with Satrak? The antenna moves");
        stop_stops(&mut window, "STOP");
    }
}

#[test]
fn stop_goes_out_from_the_preferences_also_while_typing() {
    for size in SIZES {
        let mut model = rig::model(states::moving());
        model.view = View::Preferences;
        let mut window = rig::window(size, model);
        window.get_by_role_and_label(Role::TextInput, "Latitude").focus();
        settle(&mut window);
        stop_stops(&mut window, "STOP");
    }
}

#[test]
fn stop_goes_out_without_link_and_without_antennas() {
    for size in SIZES {
        let mut model = rig::model(states::moving());
        let since = model.steady;
        let link = LinkState::Lost { start: since, reason: LinkLoss::Silent, retry_at: since };
        let snapshot = Snapshot { link, ..states::moving() };
        model.shown_mut().antennas =
            vec![rig::antenna(model.station.antennas[0].clone(), snapshot)];
        stop_stops(&mut rig::window(size, model), "STOP");

        let mut model = rig::model(states::moving());
        model.shown_mut().antennas.clear();
        stop_stops(&mut rig::window(size, model), "STOP");
    }
}

#[test]
fn stop_is_the_first_control_in_the_order_of_tab() {
    for size in SIZES {
        let mut window = rig::window(size, rig::model(states::moving()));
        window.key_press(Key::Tab);
        settle(&mut window);
        window.key_press(Key::Enter);
        assert_eq!(asked(&mut window), [UiCommand::Stop]);
    }
}

#[test]
fn what_else_stop_stops_is_told_at_the_button_on_every_view() {
    let about = "Stops every antenna. Genius: STOP stops both rotators.";
    for size in SIZES {
        for view in [View::Operate, View::Console, View::Map] {
            let mut model = rig::model(states::holding());
            model
                .shown_mut()
                .antennas
                .push(rig::antenna(makes::pair(), makes::pair_at(Intent::Standby)));
            model.view = view;
            let mut window = rig::window(size, model);
            let stop = window.get_by_role_and_label(Role::Button, "STOP");
            assert_eq!(stop.accesskit_node().description().as_deref(), Some(about));
            window.hover_at(window.get_by_role_and_label(Role::Button, "STOP").rect().center());
            window.run_steps(8);
            assert!(rig::says(&window, about), "pointed at");
            stop_stops(&mut window, "STOP");
        }
    }
}

#[test]
fn stop_shows_as_pressed_while_the_session_says_nothing() {
    for size in SIZES {
        for snapshot in [
            states::moving(),
            Snapshot {
                stop: StopState::Stopped {
                    time: states::holding().state.measured.unwrap().received,
                },
                ..states::holding()
            },
        ] {
            let mut model = rig::model(snapshot);
            let site = model.station.site;
            model.shown_mut().antennas[0].stop_pressed = Some(Instant::now());
            for _ in 0..2 {
                refresh(&mut model.shown_mut().antennas[0], &mut Recent::default(), site, |_| None);
            }
            assert!(states::sentence(&model).contains("STOP was pressed"));
            let mut window = rig::window(size, model);
            stop_stops(&mut window, "STOP, stopping");
        }
    }
}

#[test]
fn what_stop_leaves_alone_is_named_beside_it_and_has_a_stop_of_its_own() {
    let left_out = "RC2000C is not connected: STOP does not reach it.";
    for size in SIZES {
        let mut model = rig::model(states::holding());
        let off = Snapshot::before_anything(LinkState::Off);
        let second = Antenna { id: AntennaId(2), ..makes::rc2000c() };
        model.shown_mut().antennas.push(rig::antenna(second, off));
        model.selected_antenna = 1;
        let mut window = rig::window(size, model);
        let stop = window.get_by_role_and_label(Role::Button, "STOP");
        let about = stop.accesskit_node().description().unwrap();
        assert_eq!(about, format!("Reaches 1 of 2 antennas. {left_out}"));
        window.get_by_label(&format!("STOP reaches 1 of 2 antennas. {left_out}"));
        stop_stops(&mut window, "STOP");

        let own = window.get_by_role_and_label(Role::Button, "Connect and STOP RC2000C");
        let about = own.accesskit_node().description().unwrap();
        assert!(about.contains("takes control from anybody at its panel"), "{about}");
        own.click();
        assert_eq!(asked(&mut window), [UiCommand::StopAntenna(AntennaId(2))]);
    }
}

#[test]
fn stop_shows_as_pressed_until_the_session_tells_of_it() {
    let mut model = rig::model(states::moving());
    let site = model.station.site;
    let later = rig::soon(&model);
    for told in [
        StopState::Stopping { start: later },
        StopState::Stopped { time: later },
        StopState::NotConfirmed { start: later },
    ] {
        let snapshot = Snapshot { stop: told, ..states::moving() };
        model.shown_mut().antennas =
            vec![rig::antenna(model.station.antennas[0].clone(), snapshot)];
        model.shown_mut().antennas[0].stop_pressed = Some(Instant::now());
        refresh(&mut model.shown_mut().antennas[0], &mut Recent::default(), site, |_| None);
        assert_eq!(model.antennas[0].stop_pressed, None, "{told:?}");
    }
}

#[test]
fn after_a_stop_the_bar_says_in_words_what_was_left_alone() {
    for size in SIZES {
        let mut model = rig::model(states::holding());
        let at = model.steady;
        let stopped = Snapshot { stop: StopState::Stopped { time: at }, ..states::holding() };
        model.shown_mut().antennas = vec![rig::antenna(model.station.antennas[0].clone(), stopped)];
        let off = || Snapshot::before_anything(LinkState::Off);
        model.shown_mut().antennas.push(rig::antenna(makes::rc2000c(), off()));
        model
            .shown_mut()
            .antennas
            .push(rig::antenna(makes::pair(), Snapshot { unproved: true, ..off() }));
        let window = rig::window(size, model);
        let said = "RC2000C is not connected: STOP does not reach it.";
        window.get_by_label(said);
        window.get_by_label(&format!("STOP reaches 2 of 3 antennas. {said}"));
        window.get_by_role_and_label(Role::Button, "STOP, all stopped");
    }
}

#[test]
fn a_station_that_shows_nothing_new_says_so() {
    let mut model = rig::model(states::holding());
    model.watch_station(Some(Duration::from_secs(3)));
    let text = |model: &Model| {
        let alarms = model.alarms.list().iter().filter(|alarm| !alarm.is_over());
        alarms.map(|alarm| words::alarm(&alarm.kind, "Azel", rig::now())).collect::<Vec<_>>()
    };
    let told = text(&model);
    assert!(told.len() == 1 && told[0].starts_with("What is shown is 3"), "{told:?}");
    model.watch_station(Some(Duration::from_secs(4)));
    assert!(text(&model)[0].starts_with("What is shown is 4"));
    model.watch_station(None);
    assert_eq!(text(&model), [""; 0]);
}
