//! Set-up from nothing to a tracking antenna, in the real app beside the running demonstration:
//! once with the mouse and once with the keyboard alone.

use azel::{
    contract::{antenna::AntennaModel, driver::LinkFinding, link_tests::LinkTestStage},
    controller::SPECS,
    model::{Model, View},
    orbit::bundled,
    sim::satrak::BUNDLED_FILE,
    station,
};
use egui::{Event, Key, Modifiers, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    settings_rig::says,
    unit::{RealWindow, Unit, clock_from, open, step_until, wait_until},
};

/// Max number of actions of a newcomer.
const MAX_ACTIONS: usize = 25;
/// Start of the story, at which NOAA 20 is up.
const UTC: &str = "2026-08-12T11:15:30Z";

/// Operator with a list of actions: a click, a filled field, a key outside a field.
struct Operator {
    window: RealWindow,
    actions: Vec<String>,
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
        self.click(Role::Button, button);
    }

    fn click(&mut self, role: Role, name: &str) {
        self.window.get_by_role_and_label(role, name).click();
        self.actions.push(format!("click {name}"));
        self.window.run_steps(3);
    }

    fn key(&mut self, key: Key) {
        if !self.is_in_field() {
            self.actions.push(format!("key {}", key.name()));
        }
        self.window.key_press(key);
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

    fn is_in_field(&self) -> bool {
        let mut fields = self.window.query_all_by_role(Role::TextInput);
        fields.any(|field| field.accesskit_node().is_focused())
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
            self.click(Role::TextInput, field);
            self.window.key_press_modifiers(Modifiers::COMMAND, Key::A);
        }
        self.window.event(Event::Text(text.to_owned()));
        self.actions.push(format!("fill {field}: {text}"));
        self.window.run_steps(3);
    }

    fn go_on(&mut self, button: &str) {
        if self.keys_alone { self.key(Key::Enter) } else { self.press(button) }
    }

    /// Tracks the selected pass.
    fn track(&mut self, satellite: &str) {
        if self.keys_alone {
            self.key(Key::T);
            self.key(Key::Enter);
        } else {
            self.press(&format!("Track {satellite}"));
        }
    }
}

fn is_reached(model: &Model) -> bool {
    let mut tests = model.link_tests.iter();
    tests.any(|test| {
        let LinkTestStage::Done { finding, .. } = &test.stage else { return false };
        matches!(finding, LinkFinding::Reached { .. })
    })
}

fn set_up_and_track(keys_alone: bool) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("station.toml");
    let elements = bundled().unwrap().iter().cloned().collect();
    let unit = Unit::of_elements(elements, UTC.parse().unwrap());
    let window = open(&path, clock_from(UTC.parse().unwrap()));
    let mut operator = Operator { window, actions: Vec::new(), keys_alone };
    step_until(&mut operator.window, "the set-up opens by itself beside the demo", |model| {
        model.view == View::Setup && model.antennas.len() == 3
    });
    operator.write("Name", "Şile 2");
    operator.write("Locator", "KN41ob");
    operator.write("Altitude", "121");
    operator.go_on("Next: Antennas (Enter)");
    operator.press(&format!("Add {}", SPECS[0].name));
    operator.write("Address of the Satrak", &unit.address.to_string());
    assert!(says(&operator.window, "A new unit has none and cannot track."));
    operator.write("Element file on the unit", BUNDLED_FILE);
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
    let window = &mut operator.window;
    step_until(window, "Operate opens with the next pass selected", |model| {
        !model.demo && model.view == View::Operate && model.selected_pass().is_some()
    });
    step_until(window, "the unit is connected", |model| {
        model.antenna().is_some_and(|of| of.snapshot.state.motion_lock == Some(false))
    });
    let model = window.state().model();
    let saved = station::load(&path, SPECS).unwrap().station;
    assert_eq!(saved, *model.station);
    let addresses: Vec<&str> = saved.antennas.iter().map(|of| &*of.connection.address).collect();
    assert_eq!(addresses, [unit.address.to_string()], "no address of the demo is saved");
    let satellite = model.selected_pass().unwrap().satellite.elements.name().to_owned();
    window.run_steps(3);
    operator.track(&satellite);
    wait_until("it tracks", || {
        operator.window.step();
        let tracks = operator.window.state().model().antenna().is_some_and(AntennaModel::tracks);
        tracks && says(&operator.window, "Tracking")
    });
    assert!(unit.control.state().is_tracking);
    let (actions, with) = (operator.actions, if keys_alone { "keys alone" } else { "mouse" });
    println!("From nothing to tracking {satellite}: {} actions with {with}.", actions.len());
    for (number, action) in (1..).zip(&actions) {
        println!("{number:3}. {action}");
    }
    assert!(actions.len() <= MAX_ACTIONS);
}

#[test]
fn a_newcomer_tracks_with_the_mouse() {
    set_up_and_track(false);
}

#[test]
fn a_newcomer_tracks_with_the_keyboard_alone() {
    set_up_and_track(true);
}
