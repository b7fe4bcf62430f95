//! Log of the links: the operator reads, filters, freezes, selects and copies its lines.

use std::time::Duration;

use azel::{
    astro::time::add_seconds,
    contract::driver::WireLog,
    controller::satrak,
    device::{Direction, Finding, WireLine},
    model::{UiCommand, View},
    protocol::satrak::encode,
};
use egui::{Event, Key, Modifiers, OutputCommand, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    rig::{self, SIZES, SMALL, Window, asked, says, settle},
    states,
};

const STATE: &str = "STATUS?,0,299.49,34.35,1,0,0,0,0,0,0,0,0,0,80.0,35.0,1";

/// Returns a frame on the link, `second` seconds after the start of a story.
pub(crate) fn wire(second: f64, direction: Direction, payload: &str) -> WireLine {
    let bytes = encode(payload);
    let is_reply = direction == Direction::Received;
    WireLine {
        time: add_seconds(rig::now(), second),
        direction,
        length: bytes.len(),
        meaning: Some(satrak::meaning(direction, &bytes)),
        bytes: bytes.into(),
        is_shortened: false,
        finding: Finding::Good,
        reply_after: is_reply.then(|| Duration::from_millis(34)),
        is_poll: false,
    }
}

fn poll(second: f64) -> [WireLine; 2] {
    [(Direction::Sent, "STATUS?"), (Direction::Received, STATE)]
        .map(|(direction, payload)| WireLine { is_poll: true, ..wire(second, direction, payload) })
}

/// Adds a poll, a refused motion, a damaged line and a missing reply to the log.
fn conversation(log: &WireLog) {
    for line in poll(1.0) {
        log.push(line);
    }
    log.push(wire(2.0, Direction::Sent, "MOVE=,-3.5,0"));
    log.push(wire(2.1, Direction::Received, "MOVE=,ERR,7"));
    let finding = Finding::BadChecksum { received: 0, computed: 0x0d };
    log.push(WireLine { finding, ..wire(3.0, Direction::Received, "STOP=,OK") });
    let finding = Finding::NoReply { waited: Duration::from_secs(2), is_repeated: true };
    let missing = wire(4.0, Direction::Received, "");
    log.push(WireLine { finding, bytes: Box::default(), length: 0, reply_after: None, ..missing });
    log.push(wire(5.0, Direction::Sent, "TIME?"));
    log.push(wire(5.1, Direction::Received, "TIME?,11,15,35,12,8,2026,250"));
}

pub(crate) fn view(size: [f32; 2]) -> Window {
    let mut model = rig::model(states::holding());
    model.view = View::Console;
    conversation(&model.wires[0]);
    rig::window(size, model)
}

fn log(window: &Window) -> WireLog {
    window.state().model.wires[0].clone()
}

/// Returns the visible rows from top to bottom.
fn rows(window: &Window) -> Vec<String> {
    let mut rows: Vec<_> = window
        .query_all_by_role(Role::ListBoxOption)
        .map(|node| (node.rect().top(), node.accesskit_node().label().unwrap_or_default()))
        .collect();
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    rows.into_iter().map(|(_, words)| words).collect()
}

pub(crate) fn click(window: &mut Window, button: &str) {
    window.get_by_role_and_label(Role::Button, button).click();
    settle(window);
}

pub(crate) fn row(window: &mut Window, words: &str, modifiers: Modifiers) {
    let node = window.get_by_label_contains(words);
    node.click_modifiers(modifiers);
    settle(window);
}

pub(crate) fn write(window: &mut Window, field: &str, words: &str) {
    window.get_by_role_and_label(Role::TextInput, field).focus();
    settle(window);
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.key_press(Key::Backspace);
    window.event(Event::Text(words.to_owned()));
    settle(window);
}

/// Returns the texts that `act` copied to the clipboard.
pub(crate) fn copied(window: &mut Window, act: impl FnOnce(&mut Window)) -> Vec<String> {
    act(window);
    for _ in 0..4 {
        window.step();
        let commands = &window.output().platform_output.commands;
        for command in commands {
            if let OutputCommand::CopyText(text) = command {
                return text.lines().map(str::to_owned).collect();
            }
        }
    }
    Vec::new()
}

pub(crate) fn is_disabled(window: &Window, button: &str) -> bool {
    window.get_by_role_and_label(Role::Button, button).accesskit_node().is_disabled()
}

#[test]
fn the_view_opens_from_rail_and_key() {
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(states::holding()));
        window.get_by_role_and_label(Role::Tab, "Console").click();
        assert_eq!(asked(&mut window), [UiCommand::Show(View::Console)]);
        window.key_press_modifiers(Modifiers::COMMAND, Key::Num5);
        assert_eq!(asked(&mut window), [UiCommand::Show(View::Console)]);
    }
}

#[test]
fn each_line_says_when_which_way_and_what_it_means() {
    for size in rig::sizes() {
        let mut window = view(size);
        assert_eq!(
            rows(&window),
            [
                "11:15:32.000 Satrak sent $MOVE=,-3.5,0*19: Moves X by \u{2212}3.5 °/s",
                "11:15:32.100 Satrak received $MOVE=,ERR,7*5E: Refused: ERR,7",
                "11:15:33.000 Satrak received $STOP=,OK*0D: Checksum 00, should be 0D. Dropped",
                "11:15:34.000 Satrak: No reply in 2000 ms, asked again",
                "11:15:35.000 Satrak sent $TIME?*2A: Asks for the clock",
                "11:15:35.100 Satrak received $TIME?,11,15,35,12,8,2026,250*0E: \
                 Clock 2026-08-12 11:15:35.250",
            ]
        );
        assert!(says(&window, "6 lines, 2 polls hidden"));
        window.get_by_label("Hide polls").click();
        settle(&mut window);
        let all = rows(&window);
        assert_eq!(all.len(), 8);
        assert!(all[1].ends_with("Az 299.49°, El 34.35°, standing, X+ limit set"), "{}", all[1]);
        assert!(says(&window, "8 lines"));
    }
}

#[test]
fn each_link_is_summed_up() {
    let window = view(rig::LARGE);
    assert!(says(&window, "Satrak, last 10 min: 7 lines, 2 bad, 1 missing, median 34 ms"));
}

#[test]
fn a_filter_shows_what_has_its_text() {
    for size in rig::sizes() {
        let mut window = view(size);
        window.key_press_modifiers(Modifiers::COMMAND, Key::F);
        settle(&mut window);
        window.event(Event::Text("move=".to_owned()));
        settle(&mut window);
        assert_eq!(rows(&window).len(), 2);
        write(&mut window, "Filter the log", "refused");
        assert_eq!(rows(&window).len(), 1);
        write(&mut window, "Filter the log", "no such");
        assert!(rows(&window).is_empty() && says(&window, "No line contains this text."));
        assert!(is_disabled(&window, "Save"));
    }
}

#[test]
fn one_way_of_the_link_can_be_read_alone() {
    for size in rig::sizes() {
        let mut window = view(size);
        let all = rows(&window).len();
        let mut choose = |from: &str, to: &str| {
            let name = format!("Lines of the log: {from}");
            window.get_by_role_and_label(Role::ComboBox, &name).click();
            settle(&mut window);
            window.get_by_label(to).click();
            settle(&mut window);
            rows(&window).len()
        };
        let sent = choose("Both ways", "Sent");
        let received = choose("Sent", "Received");
        assert!(sent > 0 && received > 0 && sent + received == all, "{sent} {received} {all}");
    }
}

#[test]
fn a_pause_freezes_what_is_shown_and_the_rest_comes_afterwards() {
    for size in rig::sizes() {
        let mut window = view(size);
        click(&mut window, "Pause");
        log(&window).push(wire(9.0, Direction::Sent, "VERSION?"));
        settle(&mut window);
        assert_eq!(rows(&window).len(), 6);
        assert!(says(&window, "paused, 1 recorded since"));
        click(&mut window, "Resume");
        assert_eq!(rows(&window).len(), 7);
        assert!(!says(&window, "paused"));
    }
}

#[test]
fn the_newest_line_is_followed_until_the_operator_scrolls_away() {
    for size in rig::sizes() {
        let mut window = view(size);
        let many = |log: &WireLog, from: u32| {
            for second in from..from + 200 {
                log.push(wire(f64::from(second), Direction::Sent, "VERSION?"));
            }
        };
        many(&log(&window), 10);
        settle(&mut window);
        let shown = rows(&window);
        assert!(shown.len() < 60, "only rows in view are drawn");
        assert!(shown.last().unwrap().starts_with("11:18:59.000"), "{shown:?}");
        assert!(is_disabled(&window, "Newest"));
        for second in 220..240 {
            log(&window).push(wire(f64::from(second), Direction::Sent, "VERSION?"));
            window.step();
        }
        assert!(rows(&window).last().unwrap().starts_with("11:19:29.000"));
        row(&mut window, "11:19:29.000", Modifiers::NONE);
        window.key_press(Key::Home);
        settle(&mut window);
        assert!(rows(&window)[0].contains("$MOVE="));
        many(&log(&window), 300);
        settle(&mut window);
        assert!(rows(&window)[0].contains("$MOVE="), "what is read stays");
        click(&mut window, "Newest");
        assert!(rows(&window).last().unwrap().starts_with("11:23:49.000"));
    }
}

#[test]
fn lines_are_selected_with_mouse_and_keys_and_copied() {
    let sent = "2026-08-12T11:15:32.000Z\tSatrak\tsent\t$MOVE=,-3.5,0*19<CR><LF>\t\t\
                Moves X by \u{2212}3.5 °/s";
    let answer = "2026-08-12T11:15:32.100Z\tSatrak\treceived\t$MOVE=,ERR,7*5E<CR><LF>\t34 ms\tRefused: ERR,7";
    for size in rig::sizes() {
        let mut window = view(size);
        assert!(is_disabled(&window, "Copy"));
        row(&mut window, "$MOVE=,-3.5", Modifiers::NONE);
        let by_key = |window: &mut Window| window.event(Event::Copy);
        assert_eq!(copied(&mut window, by_key), [sent]);
        window.key_press_modifiers(Modifiers::SHIFT, Key::ArrowDown);
        settle(&mut window);
        assert_eq!(copied(&mut window, by_key), [sent, answer]);
        let by_button =
            |window: &mut Window| window.get_by_role_and_label(Role::Button, "Copy").click();
        assert_eq!(copied(&mut window, by_button), [sent, answer]);
        row(&mut window, "$TIME?*2A", Modifiers::SHIFT);
        assert_eq!(copied(&mut window, by_key).len(), 5);
        row(&mut window, "ERR,7*5E", Modifiers::COMMAND);
        assert_eq!(copied(&mut window, by_key).len(), 4);
        window.key_press(Key::ArrowDown);
        settle(&mut window);
        assert_eq!(copied(&mut window, by_key).len(), 1);
        window.key_press_modifiers(Modifiers::COMMAND, Key::A);
        settle(&mut window);
        assert_eq!(copied(&mut window, by_key).len(), 6);
    }
}

#[test]
fn the_values_and_bytes_of_the_selected_line_are_shown() {
    for size in SIZES {
        let mut window = view(size);
        window.get_by_label("Hide polls").click();
        settle(&mut window);
        if size == SMALL {
            assert!(!says(&window, "No line selected"));
            click(&mut window, "Details");
        }
        assert!(says(&window, "No line selected"));
        row(&mut window, "$STATUS?,0", Modifiers::NONE);
        for words in [
            "STATUS reply",
            "Satrak, 11:15:31.000Z, 34 ms after the request",
            "2 azimuth: 299.49°",
            "4 limit X+: 1 (set)",
            "16 auto-track: 1 (on)",
            &format!("Bytes, {}, checksum good", encode(STATE).len()),
            "0000 24 53 54 41 54 55 53 3F  $STATUS?",
        ] {
            assert!(says(&window, words), "{words}");
        }
        if size == SMALL {
            click(&mut window, "Close");
            assert!(!says(&window, "STATUS reply"));
        }
    }
}

#[test]
fn hidden_values_are_said_to_be_hidden() {
    for size in SIZES {
        let mut window = view(size);
        let bytes = b"$SATELLITE_FTP?(hidden)\r\n".to_vec();
        let answer = wire(9.0, Direction::Received, "");
        let (length, is_shortened) = (90, true);
        log(&window).push(WireLine { bytes: bytes.into(), length, is_shortened, ..answer });
        settle(&mut window);
        row(&mut window, "$SATELLITE_FTP?", Modifiers::NONE);
        if size == SMALL {
            click(&mut window, "Details");
        }
        assert!(says(&window, "1 values with a password: (hidden)"));
        assert!(says(&window, "Some bytes are not kept"));
        assert!(!says(&window, "0000 24"), "bytes that did not come are not shown as such");
    }
}

#[test]
fn the_log_of_one_antenna_can_be_chosen() {
    for size in rig::sizes() {
        let mut window = view(size);
        let mut config = window.state().model.station.antennas[0].clone();
        config.name = "Mast".to_owned();
        let mast = rig::antenna(config, states::holding());
        let log = WireLog::default();
        log.push(wire(2.05, Direction::Sent, "VERSION?"));
        window.state_mut().model.shown_mut().antennas.push(mast);
        window.state_mut().model.wires.push(log);
        settle(&mut window);
        assert_eq!(rows(&window).len(), 7);
        window.get_by_role_and_label(Role::ComboBox, "Log of All antennas").click();
        settle(&mut window);
        let all: Vec<_> = window.get_all_by_label("Mast").collect();
        all.last().unwrap().click();
        settle(&mut window);
        assert_eq!(rows(&window), ["11:15:32.050 Mast sent $VERSION?*65: Asks for the firmware"]);
    }
}
