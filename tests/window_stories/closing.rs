//! The window is closed while something typed is not where it belongs.

use azel::{app::View, driver::Clock};
use egui::{Event, Key, Modifiers, Role, ViewportCommand, ViewportEvent, ViewportId};
use egui_kittest::kittest::Queryable as _;

use crate::{
    settings_desk::{press, says},
    unit::{RealWindow, open},
};

/// The window manager asks; what the window answers.
fn close(window: &mut RealWindow) -> Vec<ViewportCommand> {
    let root = window.input_mut().viewports.entry(ViewportId::ROOT).or_default();
    root.events.push(ViewportEvent::Close);
    window.step();
    if let Some(root) = window.input_mut().viewports.get_mut(&ViewportId::ROOT) {
        root.events.clear();
    }
    answers(window)
}

fn answers(window: &RealWindow) -> Vec<ViewportCommand> {
    let commands = window.output().viewport_output.values().flat_map(|root| &root.commands);
    let closing = |command: &&ViewportCommand| {
        matches!(command, ViewportCommand::Close | ViewportCommand::CancelClose)
    };
    commands.filter(closing).cloned().collect()
}

fn rename_the_station(window: &mut RealWindow) {
    window.key_press_modifiers(Modifiers::COMMAND, Key::Num6);
    window.run_steps(3);
    assert_eq!(window.state().model().view, View::Preferences);
    window.get_all_by_role_and_label(Role::TextInput, "Name").next().unwrap().focus();
    window.run_steps(2);
    window.event(Event::Text("Hill".to_owned()));
    window.run_steps(2);
}

#[test]
fn a_window_with_nothing_to_lose_closes_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = open(&folder.path().join("station.toml"), Clock::system());
    assert_eq!(close(&mut window), []);
    assert!(!says(&window, "Close all the same?"));
}

#[test]
fn a_window_with_unsaved_settings_asks_first() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = open(&folder.path().join("station.toml"), Clock::system());
    rename_the_station(&mut window);
    assert_eq!(close(&mut window), [ViewportCommand::CancelClose]);
    window.run_steps(2);
    assert!(says(&window, "The station settings are not saved. Close all the same?"));

    press(&mut window, "Cancel");
    assert!(!says(&window, "Close all the same?"));
    assert!(says(&window, "Hill"), "what was typed is there");

    assert_eq!(close(&mut window), [ViewportCommand::CancelClose]);
    window.run_steps(2);
    window.get_by_role_and_label(Role::Button, "Close (Enter)").click_accesskit();
    window.step();
    assert_eq!(answers(&window), [ViewportCommand::Close]);
    assert_eq!(close(&mut window), [], "it was asked once");
}
