//! Questions sent from the console, saving of its lines, and the complete console in every window.

use std::fs;

use azel::{
    clock::Instant,
    contract::driver::{Command, LinkLoss, LinkState},
    controller::SPECS,
    model::{Model, ThemeName, UiCommand, View},
    protocol::satrak::encode,
    station::{self, AntennaId},
    ui::theme,
};
use egui::{Event, Key, Modifiers, Rect, Role, pos2, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    console::{click, is_disabled, row, view, write},
    rig::{self, SIZES, SMALL, asked, says, settle},
    states,
    unit::{Unit, clock_from, open, step_until, wait_until},
};

#[test]
fn the_shown_lines_are_saved_and_it_is_said_where() {
    for size in rig::sizes() {
        let mut window = view(size);
        click(&mut window, "Save");
        let commands = asked(&mut window);
        let [UiCommand::SaveLog(lines)] = commands.as_slice() else { panic!("{commands:?}") };
        assert_eq!(lines.len(), 6);
        window.state_mut().views.log_saved(Ok("/data/console/a.txt".into()));
        settle(&mut window);
        assert!(says(&window, "Saved to /data/console/a.txt"));
        window.state_mut().views.log_saved(Err("the disk is full".to_owned()));
        settle(&mut window);
        assert!(says(&window, "Not saved: the disk is full"));
    }
}

#[test]
fn a_query_is_sent_once_its_frame_stands_there() {
    let ask = |question: &str| UiCommand::antenna(AntennaId(1), Command::Ask(question.into()));
    for size in rig::sizes() {
        let mut window = view(size);
        assert!(is_disabled(&window, "Send"));
        assert!(says(&window, "can be sent. Change settings"));
        write(&mut window, "Query to send", "tpos?");
        let frame = String::from_utf8(encode("TPOS?")).unwrap();
        assert!(says(&window, &format!("sends {}", frame.trim_end())));
        assert!(says(
            &window,
            "Asks for the position with its time. The answer will appear in the \
                               log."
        ));
        click(&mut window, "Send");
        assert_eq!(asked(&mut window), [ask("TPOS?")]);
        write(&mut window, "Query to send", "REDUCTION");
        window.key_press(Key::Enter);
        assert_eq!(asked(&mut window), [ask("REDUCTION?")]);
        window.get_by_role_and_label(Role::ComboBox, "Pick a query").click();
        settle(&mut window);
        window.get_by_label("ERRSTATUS?  Asks for the faults").click();
        settle(&mut window);
        click(&mut window, "Send");
        assert_eq!(asked(&mut window), [ask("ERRSTATUS?")]);
    }
}

#[test]
fn the_field_keeps_the_focus_after_enter() {
    for size in rig::sizes() {
        let mut window = view(size);
        write(&mut window, "Query to send", "TPOS?");
        for _ in 0..2 {
            window.key_press(Key::Enter);
            assert_eq!(asked(&mut window).len(), 1);
            let field = window.get_by_role_and_label(Role::TextInput, "Query to send");
            assert!(field.accesskit_node().is_focused());
        }
    }
}

#[test]
fn earlier_queries_come_back_with_the_arrow_keys() {
    let mut window = view(SMALL);
    for query in ["TPOS?", "STATUS?"] {
        write(&mut window, "Query to send", query);
        window.key_press(Key::Enter);
        settle(&mut window);
    }
    write(&mut window, "Query to send", "REDU");
    let mut press = |key| {
        window.key_press(key);
        settle(&mut window);
        window.get_by_label("Query to send").value().unwrap_or_default()
    };
    assert_eq!([Key::ArrowUp, Key::ArrowUp].map(&mut press), ["STATUS?", "TPOS?"]);
    assert_eq!([Key::ArrowDown, Key::ArrowDown].map(&mut press), ["STATUS?", "REDU"]);
}

#[test]
fn nothing_but_queries_is_sent_and_the_reason_stands_there() {
    for size in rig::sizes() {
        let mut window = view(size);
        for (typed, reason) in [
            ("TRACK=,1", "Not sent. This moves the antenna"),
            ("SETTINGS=,?", "Not sent. This changes the unit: settings belong to the Antennas"),
            ("LOAD_IMAGE=,x", "Not sent. This is a service function"),
            ("STOP=", "Not sent. STOP has its own button"),
            ("HELLO?", "Not sent. Not a word of the Satrak document."),
        ] {
            write(&mut window, "Query to send", typed);
            assert!(says(&window, reason), "{typed}");
            assert!(is_disabled(&window, "Send"));
            window.key_press(Key::Enter);
            assert_eq!(asked(&mut window), [], "{typed}");
        }
    }
}

#[test]
fn without_a_link_nothing_is_sent() {
    let since = Instant::now();
    let reason = LinkLoss::Silent;
    let mut snapshot = states::holding();
    snapshot.link = LinkState::Lost { start: since, reason, retry_at: since };
    let mut model = rig::model(snapshot);
    model.view = View::Console;
    let mut window = rig::window(SMALL, model);
    write(&mut window, "Query to send", "STATUS?");
    assert!(says(&window, "Not sent. There is no link."));
    window.key_press(Key::Enter);
    assert_eq!(asked(&mut window), []);
    assert!(says(&window, "Nothing has been sent or received yet."));
}

#[test]
fn every_control_is_whole_and_named_in_every_window_and_theme() {
    for size in SIZES {
        for name in [ThemeName::Dark, ThemeName::Light, ThemeName::Night] {
            for demo in [false, true] {
                let mut window = view(size);
                window.state_mut().model.shown_mut().demo = demo;
                theme::set(&window.ctx, name);
                write(&mut window, "Query to send", "SATELLITE_HTTP?");
                row(&mut window, "ERR,7*5E", Modifiers::NONE);
                if size == SMALL {
                    click(&mut window, "Details");
                }
                let whole = Rect::from_min_size(pos2(0.0, 0.0), vec2(size[0], size[1]));
                let roles = [Role::Button, Role::TextInput, Role::ComboBox, Role::CheckBox];
                let mut places: Vec<(String, Rect)> = Vec::new();
                for node in roles.into_iter().flat_map(|role| window.query_all_by_role(role)) {
                    let label = node.accesskit_node().label().unwrap_or_default();
                    assert!(!label.is_empty(), "a control without a name at {:?}", node.rect());
                    assert!(whole.contains_rect(node.rect()), "{label} at {:?}", node.rect());
                    for (other, place) in &places {
                        let common = place.intersect(node.rect());
                        let touch = common.width() <= 1.0 || common.height() <= 1.0;
                        assert!(touch, "{label} and {other} at {common:?}");
                    }
                    places.push((label, node.rect()));
                }
            }
        }
    }
}

#[test]
fn the_app_records_asks_and_saves() {
    let folder = tempfile::tempdir().unwrap();
    let settings = folder.path().join("station.toml");
    let unit = Unit::start(rig::now());
    station::save(&unit.station(), &settings, SPECS).unwrap();
    let mut window = open(&settings, clock_from(rig::now()));
    window.key_press_modifiers(Modifiers::COMMAND, Key::Num5);
    let is_read = |model: &Model| {
        let settings = model.antennas.first().map(|one| one.snapshot.state.on_board.offsets);
        model.view == View::Console && settings.flatten().is_some()
    };
    step_until(&mut window, "the unit is read", is_read);
    window.get_by_role_and_label(Role::TextInput, "Query to send").focus();
    window.run_steps(2);
    window.event(Event::Text("REDUCTION?".to_owned()));
    window.run_steps(2);
    window.key_press(Key::Enter);
    wait_until("the answer", || {
        window.step();
        window.query_by_label_contains("Drive scales").is_some()
    });
    window.get_by_role_and_label(Role::Button, "Save").click();
    wait_until("the file", || {
        window.step();
        window.query_by_label_contains("Saved to ").is_some()
    });
    let files: Vec<_> = fs::read_dir(folder.path().join("console")).unwrap().collect();
    let text = fs::read_to_string(files[0].as_ref().unwrap().path()).unwrap();
    assert!(text.starts_with("# Azel console, saved 2026-08-12T"), "{text}");
    assert!(text.contains("\tSatrak\tsent\t$REDUCTION?*"), "{text}");
    assert!(!text.contains("$STATUS?*"), "only what is shown");
}
