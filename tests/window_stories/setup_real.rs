//! From nothing to a saved station, in the real app beside the running demonstration: once with
//! the mouse and once with the keyboard alone.

use azel::{
    clock::Clock,
    driver::{LinkFinding, LinkState},
    engine::link_tests::LinkTestStage,
    makes,
    model::{Model, View},
    station,
};
use egui::{Event, Key, Modifiers, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::unit::{RealWindow, Unit, open, step_until};

/// An operator who counts what is done.
struct Operator {
    window: RealWindow,
    actions: usize,
    keys_alone: bool,
}

impl Operator {
    /// Clicks a button, or goes to it by Tab and presses Enter.
    fn press(&mut self, button: &str) {
        if self.keys_alone {
            self.tab_to(Role::Button, button);
            self.key(Key::Enter);
            return;
        }
        self.window.get_by_role_and_label(Role::Button, button).click();
        self.actions += 1;
        self.window.run_steps(3);
    }

    fn key(&mut self, key: Key) {
        self.window.key_press(key);
        self.actions += 1;
        self.window.run_steps(3);
    }

    fn tab_to(&mut self, role: Role, name: &str) {
        for _ in 0..60 {
            if self.has_focus(role, name) {
                return;
            }
            self.key(Key::Tab);
        }
        panic!("Tab does not lead to {name}");
    }

    fn has_focus(&self, role: Role, name: &str) -> bool {
        let found = self.window.query_by_role_and_label(role, name);
        found.is_some_and(|node| node.accesskit_node().is_focused())
    }

    /// Goes to a field, unless it has the focus, and types.
    fn write(&mut self, field: &str, text: &str) {
        if self.keys_alone {
            self.tab_to(Role::TextInput, field);
        } else if !self.has_focus(Role::TextInput, field) {
            self.window.get_by_role_and_label(Role::TextInput, field).click();
            self.actions += 1;
            self.window.run_steps(3);
            self.window.key_press_modifiers(Modifiers::COMMAND, Key::A);
        }
        self.window.event(Event::Text(text.to_owned()));
        self.actions += 1;
        self.window.run_steps(3);
    }

    fn go_on(&mut self, button: &str) {
        if self.keys_alone { self.key(Key::Enter) } else { self.press(button) }
    }
}

fn is_reached(model: &Model) -> bool {
    let mut tests = model.link_tests.iter();
    tests.any(|test| {
        let LinkTestStage::Done { finding, .. } = &test.stage else { return false };
        matches!(finding, LinkFinding::Reached { .. })
    })
}

fn set_up(keys_alone: bool) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("station.toml");
    let unit = Unit::start("2026-08-12T11:15:30Z".parse().unwrap());
    let window = open(&path, Clock::system());
    let mut operator = Operator { window, actions: 0, keys_alone };
    step_until(&mut operator.window, "the set-up opens by itself beside the demo", |model| {
        model.view == View::Setup && model.antennas.len() == 3
    });
    operator.write("Name", "Şile 2");
    operator.write("Locator", "KN41ob");
    operator.write("Altitude", "121");
    operator.go_on("Next: Antennas (Enter)");
    operator.press(&format!("Add {}", makes::SPECS[0].name));
    operator.write("Address of the Satrak", &unit.address.to_string());
    operator.press("Test link of Satrak");
    step_until(&mut operator.window, "the unit answers", is_reached);
    let has_focus = operator.has_focus(Role::Button, "Test again of Satrak");
    assert_eq!(has_focus, keys_alone, "the focus stays on the button");
    assert!(!path.exists(), "nothing is written before the last step");
    if keys_alone {
        operator.tab_to(Role::Button, "Next: Satellites (Enter)");
    }
    for button in [
        "Next: Satellites (Enter)",
        "Next: Elements (Enter)",
        "Next: Check and finish (Enter)",
        "Finish (Enter)",
    ] {
        operator.go_on(button);
    }
    let Operator { mut window, actions, .. } = operator;
    step_until(&mut window, "Operate opens with the next pass selected", |model| {
        !model.demo && model.view == View::Operate && model.selected_pass().is_some()
    });
    let connected = |model: &Model| {
        let links = model.antennas.iter().map(|antenna| &antenna.snapshot.link);
        links.into_iter().all(|link| matches!(link, LinkState::Up { .. }))
    };
    step_until(&mut window, "the unit is connected", connected);
    let saved = station::load(&path, makes::SPECS).unwrap().station;
    assert_eq!(saved, *window.state().model().station);
    let addresses: Vec<&str> = saved.antennas.iter().map(|of| &*of.connection.address).collect();
    assert_eq!(addresses, [unit.address.to_string()], "no address of the demo is saved");
    let with = if keys_alone { "keys alone" } else { "mouse" };
    println!("from nothing to a saved station: {actions} actions with {with}");
}

#[test]
fn a_station_is_set_up_with_the_mouse() {
    set_up(false);
}

#[test]
fn a_station_is_set_up_with_the_keyboard_alone() {
    set_up(true);
}
