//! Bar at the top, with alarms, chips and theme, and the table of the axes.

use azel::{
    astro::Angle,
    clock::Instant,
    contract::{
        self,
        alarms::{AlarmKind, ShelveTime, Work},
        driver::{Intent, LinkLoss, LinkState, Snapshot, StopState},
    },
    controller::satrak::checks,
    device::{Motion, MotionRequest},
    engine::alarms::KeepAlarms,
    model::{Model, ThemeName, UiCommand, View},
    station::{AntennaId, Note, NoteReason},
    ui::{format, theme, words},
};
use egui::{Key, Modifiers, Order, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use jiff::ToSpan as _;

use crate::window_stories::{
    every_view::scene,
    rig::{self, SIZES, Window, asked, says, settle},
    states,
};

/// Carries out the commands of the alarm list, as the app does.
fn carry_out(window: &mut Window) -> Vec<UiCommand> {
    let commands = asked(window);
    let model = &mut window.state_mut().model;
    for command in &commands {
        match command {
            UiCommand::Station(contract::Command::OpenedAlarms) => {
                model.shown_mut().alarms.unopened = false;
            }
            UiCommand::Station(contract::Command::AcknowledgeAlarm(id)) => {
                model.shown_mut().alarms.acknowledge(*id, rig::now());
            }
            UiCommand::Station(contract::Command::AcknowledgeAlarms { newest }) => {
                let now = model.now;
                model.shown_mut().alarms.acknowledge_all(*newest, now);
            }
            UiCommand::Station(contract::Command::ShelveAlarm { id, time }) => {
                let now = model.now;
                model.shown_mut().alarms.shelve(*id, *time, now);
            }
            UiCommand::Station(contract::Command::UnshelveAlarm(id)) => {
                model.shown_mut().alarms.unshelve(*id);
            }
            other => panic!("{other:?}"),
        }
    }
    settle(window);
    commands
}

#[test]
fn the_alarm_list_leaves_the_countdown_of_the_pass_free() {
    for size in SIZES {
        let window = scene("Alarms", size);
        let countdown = window.get_by_label("LOS T−05:56").rect();
        let open = window.ctx.memory(|memory| {
            let mut layers = memory.areas().visible_layer_ids().into_iter();
            let list = layers.find(|layer| layer.order == Order::Foreground)?;
            memory.area_rect(list.id)
        });
        let list = open.expect("the list is open");
        assert!(window.ctx.content_rect().contains_rect(list), "{list:?}");
        assert!(list.left() >= countdown.right(), "{size:?}: {list:?} {countdown:?}");
        // The first pixels of the list are a shadow.
        let bar = if size[1] < 720.0 { 48.0 } else { 56.0 };
        assert!(list.top() >= bar, "{size:?}: {list:?} is over the bar");
        for button in window.query_all_by_label_contains("Acknowledge: ") {
            assert!(list.contains_rect(button.rect()), "{size:?}: {:?} {list:?}", button.rect());
        }
    }
}

#[test]
fn alarms_are_told_in_words_with_their_antenna() {
    let note =
        |reason| AlarmKind::Setting(Note { place: "antenna.park".to_owned(), line: None, reason });
    for (kind, wanted) in [
        (AlarmKind::LinkLost(LinkLoss::Closed), "Satrak does not reply: the unit closed"),
        (
            AlarmKind::StopNotConfirmed,
            "Satrak is still not known to have stopped after STOP. Use the",
        ),
        (
            AlarmKind::StopRefused("ERR,7".to_owned()),
            "Satrak answered ERR,7 to STOP. Use the local",
        ),
        (
            AlarmKind::JogLeaseOver,
            "Satrak: the jog was stopped because the window did not renew it",
        ),
        (
            AlarmKind::Refused(MotionRequest::Motion(Motion::StartProgram), "ERR,7".to_owned()),
            "Track: Satrak answered ERR,7",
        ),
        (AlarmKind::Check(checks(None)[7].clone()), "Satrak: X motor. Do not move X"),
        (
            AlarmKind::Unreadable("It writes commas."),
            "Satrak: its position cannot be read. It writes commas.",
        ),
        (
            AlarmKind::LinkLost(LinkLoss::Unreadable),
            "Satrak answers, but its answers cannot be read.",
        ),
        (
            AlarmKind::DriverStands(std::time::Duration::from_millis(600)),
            "For 0.6 s no command could be sent, not even STOP.",
        ),
        (
            AlarmKind::BrokeOff(Work::Elements),
            "Reading the elements failed inside Azel. The previous elements stay in use;",
        ),
        (AlarmKind::BrokeOff(Work::Passes), "The search for passes failed inside Azel."),
        (
            AlarmKind::SourceSetAside("noaa".to_owned()),
            "The source noaa is not read: Azel ended while reading it.",
        ),
        (AlarmKind::ClockOff(-2.0), "The clock of Satrak is 2.0 s behind."),
        (note(NoteReason::Unknown), "Setting antenna.park is not known."),
        (AlarmKind::Elements("the file is empty".to_owned()), "The file is empty"),
    ] {
        let said = words::alarm(&kind, "Satrak", rig::now());
        assert!(said.starts_with(wanted), "{said}");
        assert!(said.ends_with('.') || !wanted.ends_with('.'), "{said}");
    }
}

#[test]
fn an_alarm_is_opened_acknowledged_and_stays_until_it_is_over() {
    for size in rig::sizes() {
        let mut model = rig::model(states::holding());
        let (now, kind) = (model.now, AlarmKind::LinkLost(LinkLoss::Closed));
        model.shown_mut().alarms.raise(Some(AntennaId::FIRST), kind.clone(), now);
        model.shown_mut().alarms.raise(
            None,
            AlarmKind::Elements("the file is empty".to_owned()),
            now,
        );
        let text = words::alarm(&kind, "Satrak", rig::now());
        let mut window = rig::window(size, model);
        window.get_by_label("2 alarms, 2 new").click();
        assert_eq!(carry_out(&mut window), [UiCommand::Station(contract::Command::OpenedAlarms)]);
        window.get_by_label(&format!("{text}, 11:15:30Z, new"));
        window.get_by_label(&format!("Acknowledge: {text}")).click();
        assert_eq!(
            carry_out(&mut window),
            [UiCommand::Station(contract::Command::AcknowledgeAlarm(0))]
        );
        window.get_by_label(&format!("{text}, 11:15:30Z, seen"));
        window.get_by_label("2 alarms, 1 new");
        window.state_mut().model.shown_mut().alarms.clear(
            Some(AntennaId::FIRST),
            rig::now(),
            |_| true,
        );
        settle(&mut window);
        window.get_by_label(&format!("{text}, 11:15:30Z, over since 11:15:30Z"));
        window.get_by_label("1 alarm, 1 new");
    }
}

#[test]
fn an_alarm_that_is_over_and_new_says_so_with_its_times_and_repeats() {
    for size in rig::sizes() {
        let mut model = rig::model(states::holding());
        let (now, kind) = (model.now, AlarmKind::LinkLost(LinkLoss::Closed));
        let of = Some(AntennaId::FIRST);
        for minutes in [-1441_i64, -2] {
            let at = now + minutes.minutes();
            model.shown_mut().alarms.raise(of, kind.clone(), at);
            model.shown_mut().alarms.clear(of, at + 15.seconds(), |_| true);
        }
        let text = words::alarm(&kind, "Satrak", rig::now());
        let mut window = rig::window(size, model);
        window.get_by_label("1 alarm, 1 new").click();
        carry_out(&mut window);
        let first = format::moment(now - 1441_i64.minutes(), now);
        window.get_by_label(&format!(
            "{text}, {first}, 2 times, last 11:13:30Z, new, over since 11:13:45Z"
        ));
    }
}

#[test]
fn all_alarms_are_acknowledged_at_once() {
    for size in rig::sizes() {
        let mut model = rig::model(states::holding());
        for kind in [AlarmKind::ClockNotSet, AlarmKind::AutoStaysOn] {
            let now = model.now;
            model.shown_mut().alarms.raise(Some(AntennaId::FIRST), kind, now);
        }
        let mut window = rig::window(size, model);
        window.get_by_label("2 alarms, 2 new").click();
        carry_out(&mut window);
        window.get_by_label("Acknowledge all").click();
        let wanted = contract::Command::AcknowledgeAlarms { newest: 1 };
        assert_eq!(carry_out(&mut window), [UiCommand::Station(wanted)]);
        window.get_by_label("1 alarm, seen");
        assert!(!says(&window, "Acknowledge"));
    }
}

#[test]
fn a_seen_alarm_is_shelved_and_taken_back_but_no_top_priority_one() {
    for size in rig::sizes() {
        let mut model = rig::model(states::holding());
        let of = Some(AntennaId::FIRST);
        for kind in [AlarmKind::ClockNotSet, AlarmKind::StopNotConfirmed] {
            let now = model.now;
            model.shown_mut().alarms.raise(of, kind, now);
        }
        let now = model.now;
        model.shown_mut().alarms.acknowledge_all(1, now);
        let text = words::alarm(&AlarmKind::ClockNotSet, "Satrak", rig::now());
        let mut window = rig::window(size, model);
        window.get_by_label("2 alarms, seen").click();
        carry_out(&mut window);
        assert_eq!(window.get_all_by_label_contains("Shelve: ").count(), 1);
        window.get_by_label(&format!("Shelve: {text}")).click();
        assert_eq!(carry_out(&mut window), []);
        window.get_by_label(&format!("Shelve for 1 h: {text}")).click();
        let wanted = contract::Command::ShelveAlarm { id: 0, time: ShelveTime::OneHour };
        assert_eq!(carry_out(&mut window), [UiCommand::Station(wanted)]);
        window.get_by_label("1 alarm, seen");
        window.get_by_label(&format!("{text}, 11:15:30Z, shelved to 12:15:30Z"));
        window.get_by_label(&format!("Unshelve: {text}")).click();
        let wanted = contract::Command::UnshelveAlarm(0);
        assert_eq!(carry_out(&mut window), [UiCommand::Station(wanted)]);
        window.get_by_label(&format!("{text}, 11:15:30Z, seen"));
    }
}

#[test]
fn a_acknowledges_the_newest_alarm_in_every_view() {
    for size in rig::sizes() {
        for view in [View::Operate, View::Preferences] {
            let mut model = rig::model(states::holding());
            model.view = view;
            for kind in [AlarmKind::ClockNotSet, AlarmKind::AutoStaysOn] {
                let now = model.now;
                model.shown_mut().alarms.raise(Some(AntennaId::FIRST), kind, now);
            }
            let mut window = rig::window(size, model);
            for id in [1, 0] {
                window.key_press(Key::A);
                assert_eq!(
                    carry_out(&mut window),
                    [UiCommand::Station(contract::Command::AcknowledgeAlarm(id))]
                );
            }
            window.key_press(Key::A);
            assert_eq!(carry_out(&mut window), []);
        }
    }
}

#[test]
fn a_station_file_that_could_not_be_read_is_told_above_every_view() {
    for size in rig::sizes() {
        for view in [View::Operate, View::Plan, View::Elements, View::Preferences] {
            let mut model = rig::model(states::holding());
            (model.shown_mut().station_unread, model.view) = (true, view);
            let window = rig::window(size, model);
            assert!(
                rig::says(&window, "The station file could not be read: no antenna"),
                "{size:?} {view:?}"
            );
        }
    }
}

#[test]
fn no_antenna_is_to_be_set_up_over_a_station_file_that_could_not_be_read() {
    for view in [View::Operate, View::Antennas] {
        for is_unread in [true, false] {
            let mut model = rig::model(states::holding());
            model.shown_mut().antennas.clear();
            (model.shown_mut().station_unread, model.view) = (is_unread, view);
            let window = rig::window(rig::SMALL, model);
            assert_eq!(window.query_by_label("Set up an antenna").is_none(), is_unread, "{view:?}");
        }
    }
}

#[test]
fn a_chip_says_in_words_how_its_link_stands() {
    let now = Instant::now();
    let lost = LinkState::Lost { start: now, reason: LinkLoss::Silent, retry_at: now };
    for size in rig::sizes() {
        for (link, wanted) in [
            (LinkState::Off, "Satrak: Not connected, link off"),
            (LinkState::Connecting { start: now }, "Satrak: Connecting, link off"),
            (LinkState::Up { start: now }, "Satrak: Holding, link live"),
            (LinkState::Stale { as_of: now }, "Satrak: Late, 0.0 s ago, link late"),
            (lost.clone(), "Satrak: No reply 0.0 s, link lost"),
        ] {
            let mut model = rig::model(Snapshot { link, ..states::holding() });
            model.steady = now;
            rig::window(size, model).get_by_role_and_label(Role::Button, wanted);
        }
    }
}

#[test]
fn tag_sentence_and_chip_judge_a_link_alike() {
    for (reply_s, position_s, tag, chip, sentence) in [
        (35, 2, "No reply", "Satrak: No reply 35 s, link silent", "No reply from Satrak for 35 s."),
        (
            35,
            40,
            "No reply",
            "Satrak: No reply 35 s, link silent",
            "No reply from Satrak for 35 s.",
        ),
        (1, 5, "Answers late", "Satrak: Late, 5.0 s ago, link late", "Satrak answers late: its"),
        (2, 2, "Answers late", "Satrak: Late, 2.0 s ago, link late", "Holding"),
    ] {
        let mut model = rig::model(states::holding());
        states::is_late(&mut model, reply_s, position_s);
        let told = states::sentence(&model);
        assert!(told.starts_with(sentence), "{told}");
        let window = rig::window(rig::LARGE, model);
        window.get_by_role_and_label(Role::Label, tag);
        window.get_by_role_and_label(Role::Button, chip);
    }
}

#[test]
fn a_chip_says_what_its_antenna_does() {
    let since = Instant::now();
    for (snapshot, wanted) in [
        (states::tracking(0.0), "Tracking"),
        (states::moving(), "Moving"),
        (Snapshot { jog: Some([0.5, 0.0]), ..states::moving() }, "Jogging"),
        (
            Snapshot { stop: StopState::Stopping { start: since }, ..states::tracking(0.0) },
            "Stopping",
        ),
        (Snapshot { stop: StopState::Stopped { time: since }, ..states::holding() }, "Stopped"),
        (rig::quiet(), "Reading"),
    ] {
        let window = rig::window(rig::LARGE, rig::model(snapshot));
        window.get_by_label(&format!("Satrak: {wanted}, link live"));
    }
}

#[test]
fn chips_and_function_keys_select_antennas() {
    for size in rig::sizes() {
        let mut model = rig::model(states::holding());
        let mut second = model.station.antennas[0].clone();
        second.name = "Mast".to_owned();
        model.shown_mut().antennas.push(rig::antenna(second, states::holding()));
        let mut window = rig::window(size, model);
        window.get_by_label("Mast: Holding, link live").click();
        assert_eq!(asked(&mut window), [UiCommand::SelectAntenna(1)]);
        window.key_press(Key::F1);
        window.key_press(Key::F2);
        window.key_press(Key::F3);
        let wanted = [UiCommand::SelectAntenna(0), UiCommand::SelectAntenna(1)];
        assert_eq!(asked(&mut window), wanted, "there is no third");
    }
}

#[test]
fn ctrl_l_goes_round_the_themes_and_moves_nothing() {
    for size in SIZES {
        let mut window = rig::window(size, rig::model(states::tracking(0.0)));
        let places = |window: &Window| -> Vec<egui::Rect> {
            window.get_all_by_role(Role::Button).map(|node| node.rect()).collect()
        };
        let before = places(&window);
        for wanted in [ThemeName::Light, ThemeName::Night, ThemeName::Dark] {
            window.key_press_modifiers(Modifiers::COMMAND, Key::L);
            assert_eq!(asked(&mut window), [UiCommand::SetTheme(wanted)]);
            theme::set(&window.ctx, wanted);
            settle(&mut window);
            assert_eq!(places(&window), before);
        }
    }
}

#[test]
fn the_table_says_whether_it_compares_with_a_command_or_a_prediction() {
    let aim = Some(azel::astro::AzEl::from_degrees(136.0, 20.0).into());
    let going = Snapshot { intent: Intent::Position, aim, ..states::moving() };
    for size in rig::sizes() {
        for (snapshot, wanted) in [
            (going.clone(), "Az: Command 136.00, actual 120.00, error −16.00"),
            (going.clone(), "El: Command 20.00, actual 30.00, error +10.00"),
            (states::holding(), "Az: Command not known, actual 343.10, error not known"),
            (states::tracking(0.04), "El: Predicted "),
            (states::tracking(0.04), "error +0.04"),
        ] {
            let window = rig::window(size, rig::model(snapshot));
            assert!(says(&window, wanted), "{wanted}: {:?}", rows(&window));
        }
    }
}

fn rows(window: &Window) -> Vec<String> {
    let rows = window.get_all_by_label_contains("actual");
    rows.filter_map(|node| node.accesskit_node().value()).collect()
}

/// Returns two antennas, the first off its satellite; the one at `selected` is selected.
fn off_target(selected: usize) -> Model {
    let mut model = rig::model(states::tracking(2.0));
    let mut second = model.station.antennas[0].clone();
    (second.name, second.id) = ("Mast".to_owned(), AntennaId(2));
    model.shown_mut().antennas.push(rig::antenna(second, states::holding()));
    model.selected_antenna = selected;
    let off = AlarmKind::OffTarget { deviation: Angle::from_degrees(2.0), cause: None };
    let now = model.now;
    model.shown_mut().alarms.raise(Some(AntennaId::FIRST), off, now);
    model
}

#[test]
fn an_antenna_with_a_red_alarm_is_in_alarm_at_its_chip_and_on_the_cards() {
    let chip =
        |window: &Window| window.query_by_label("Satrak: Alarm: Tracking, link live").is_some();
    let header = |window: &Window| window.query_by_label_contains("Alarm: Satrak is").is_some();
    let line = |window: &Window| window.query_by_label_contains("Show Satrak: Alarm: ").is_some();
    for size in SIZES {
        let window = rig::window(size, off_target(0));
        assert_eq!(
            (chip(&window), header(&window), line(&window)),
            (true, true, false),
            "{size:?}"
        );
        assert!(window.query_by_label_contains("Show Mast: Alarm").is_none(), "{size:?}");
        window.get_by_label("Mast: Holding, link live");
        let window = rig::window(size, off_target(1));
        // A wide window has a card for each of two antennas.
        assert!(chip(&window) && (line(&window) || header(&window)), "{size:?}");
    }
}

#[test]
fn an_alarm_that_is_seen_stays_at_the_antenna_and_one_that_is_over_does_not() {
    let is_in_alarm = |model: Model| {
        let window = rig::window(rig::LARGE, model);
        window.query_by_label_contains("Satrak: Alarm: ").is_some()
    };
    let mut seen = off_target(0);
    let id = seen.alarms.list()[0].id;
    let now = seen.now;
    seen.shown_mut().alarms.acknowledge(id, now);
    assert!(is_in_alarm(seen));
    let mut shelved = off_target(0);
    let now = shelved.now;
    shelved.shown_mut().alarms.shelve(id, ShelveTime::OneHour, now);
    assert!(!is_in_alarm(shelved));
    let mut over = off_target(0);
    let now = over.now;
    over.shown_mut().alarms.clear(Some(AntennaId::FIRST), now, |_| true);
    assert!(!is_in_alarm(over));
    let mut slight = rig::model(states::tracking(0.0));
    let now = slight.now;
    slight.shown_mut().alarms.raise(Some(AntennaId::FIRST), AlarmKind::ClockNotSet, now);
    assert!(!is_in_alarm(slight));
}
