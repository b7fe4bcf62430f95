//! Acts of the operator in the Antennas view, on a model made by hand and on the real app.

use std::sync::Arc;

use azel::{
    contract::driver::Snapshot,
    controller::satrak::settings::GROUPS,
    device::settings::{
        Access, Field, GroupState, GroupStates, HeldGroup, Kind, Secret, Value, Values,
    },
    model::View,
};
use egui::{Event, Key, Modifiers, Role};
use egui_kittest::{
    Harness,
    kittest::{By, NodeT as _, Queryable as _},
};

use crate::window_stories::{
    rig::{self, Window, now},
    states,
};

/// Password on the unit. No text may contain it.
pub(crate) const ON_UNIT: &str = "hunter2";

/// Returns a value that every field of this kind can have.
fn usual(field: &Field) -> Value {
    match field.kind {
        Kind::Flag => Value::Flag(false),
        Kind::Choice(choices) => Value::Choice(choices[0].0),
        Kind::Integer { .. } => Value::Integer(1),
        Kind::Decimal { .. } | Kind::Number { .. } => Value::Decimal(3.0),
        Kind::Word(choices) => choices[0].0.into(),
        Kind::Points => Value::Points(Vec::new()),
        Kind::Place { .. } if field.key == "latitude_deg" => Value::Decimal(41.02),
        Kind::Place { .. } => Value::Decimal(29.17),
        Kind::Text(_) => Value::Text("old.txt".to_owned()),
        Kind::Password(_) => Value::Secret(Secret::new(ON_UNIT)),
        Kind::Time => Value::Time(now()),
    }
}

/// Returns complete readings, with default values.
pub(crate) fn held() -> GroupStates {
    let group = |fields: &[Field]| {
        let reported = fields.iter().filter(|field| field.access != Access::Write);
        let values: Values = reported.map(|field| (field.key, usual(field))).collect();
        let held = Some(HeldGroup { values, read_at: now() });
        GroupState { last_read: held, ..GroupState::default() }
    };
    GROUPS.iter().map(|known| (known.key, group(known.fields))).collect()
}

/// Returns a unit at standstill whose settings are read.
pub(crate) fn read() -> Snapshot {
    let mut snapshot = states::holding();
    snapshot.state.link_since = snapshot.state.measured.map(|measured| measured.requested);
    snapshot.state.groups = Arc::new(held());
    snapshot
}

/// Opens the Antennas view on a unit in this state.
pub(crate) fn opened(size: [f32; 2], snapshot: Snapshot) -> Window {
    let mut model = rig::model(snapshot);
    model.view = View::Antennas;
    rig::window(size, model)
}

/// Changes the state of the unit.
pub(crate) fn change(window: &mut Window, index: usize, with: impl FnOnce(&mut Snapshot)) {
    let antenna = &mut window.state_mut().model.shown_mut().antennas[index];
    with(Arc::make_mut(&mut antenna.snapshot));
    rig::settle(window);
}

/// Replaces the text in the field by `words`.
pub(crate) fn write<S>(window: &mut Harness<'_, S>, label: &str, words: &str) {
    let name = format!("{label}, new value");
    let is_input = |role| matches!(role, Role::TextInput | Role::PasswordInput);
    let named: Vec<_> = window.query_all_by_label(&name).collect();
    let field = named.iter().find(|node| is_input(node.accesskit_node().role()));
    field.unwrap_or_else(|| panic!("no field {name}")).focus();
    window.run_steps(2);
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.key_press(Key::Backspace);
    window.event(Event::Text(words.to_owned()));
    window.run_steps(2);
}

/// Opens the choices of a field and takes one.
pub(crate) fn choose<S>(window: &mut Harness<'_, S>, label: &str, word: &str) {
    let name = format!("{label}, new value");
    window.get_by_role_and_label(Role::ComboBox, &name).scroll_to_me();
    window.run_steps(4);
    window.get_by_role_and_label(Role::ComboBox, &name).click();
    window.run_steps(2);
    let offered: Vec<_> = window.query_all_by_role_and_label(Role::Button, word).collect();
    offered.last().unwrap_or_else(|| panic!("{word} is not offered")).click();
    window.run_steps(2);
}

/// Clicks a button, even outside the view.
pub(crate) fn press<S>(window: &mut Harness<'_, S>, name: &str) {
    window.get_by_role_and_label(Role::Button, name).click_accesskit();
    window.run_steps(2);
}

/// Holds a button for longer than a second of the window.
pub(crate) fn hold<S>(window: &mut Harness<'_, S>, name: &str) {
    window.get_by_role_and_label(Role::Button, name).scroll_to_me();
    window.run_steps(4);
    let at = window.get_by_role_and_label(Role::Button, name).rect().center();
    window.drag_at(at);
    // Each step is a quarter of a second.
    window.run_steps(6);
    window.drop_at(at);
    window.run_steps(2);
}

/// Applies the changes with the key.
pub(crate) fn apply<S>(window: &mut Harness<'_, S>) {
    window.key_press_modifiers(Modifiers::COMMAND, Key::Enter);
    window.step();
}

/// Returns the state shown beside a field.
pub(crate) fn state_of<S>(window: &Harness<'_, S>, label: &str) -> String {
    let before = format!("{label}: ");
    let told =
        texts(window).into_iter().find_map(|text| Some(text.strip_prefix(&before)?.to_owned()));
    told.unwrap_or_else(|| panic!("{label} has no state"))
}

/// Opens the service functions.
pub(crate) fn unlock<S>(window: &mut Harness<'_, S>, station: &str) {
    press(window, "Unlock");
    window.get_by_role_and_label(Role::TextInput, "Name of the station").focus();
    window.run_steps(2);
    window.event(Event::Text(station.to_owned()));
    window.run_steps(2);
    hold(window, "Hold 1 s to unlock");
}

/// Returns `true` if one of the texts contains `words`.
pub(crate) fn says<S>(window: &Harness<'_, S>, words: &str) -> bool {
    texts(window).iter().any(|text| text.contains(words))
}

/// Returns all names and values that can be read in the window.
pub(crate) fn texts<S>(window: &Harness<'_, S>) -> Vec<String> {
    let nodes = window.query_all(By::new());
    let said = nodes.flat_map(|node| {
        let node = node.accesskit_node();
        [node.label(), node.value()]
    });
    said.flatten().collect()
}
