//! Declared settings and actions of each make: every change and every action has an outcome that
//! the operator sees.

use std::collections::BTreeSet;

use azel::{
    contract::driver::{Command, Event},
    controller::SPECS,
    device::{
        Variant,
        panel::{Act, Action},
        settings::{Access, Change, Field, Group, Kind, Secret, Value, Values, WriteError},
    },
    sim::{Control, Unit, rc2000c, rotator_genius, satrak},
    station::{Antenna, ControllerSpec, Station},
};
use jiff::Timestamp;

use crate::common::rig::{self, Rig};

const START: Timestamp = Timestamp::UNIX_EPOCH;
/// Time limit of an outcome, and time for which the tests watch an idle unit, seconds.
const OUTCOME_S: u64 = 20;

/// Returns one antenna for each variant of the make, found by trying each choice of the connection.
fn antennas(spec: &'static ControllerSpec) -> Vec<Antenna> {
    let usual = spec.antenna("Dish", "in memory");
    let mut antennas = vec![usual.clone()];
    for setting in spec.settings {
        let kind = &setting.field.kind;
        for choice in kind.choices().unwrap_or_default() {
            let mut antenna = usual.clone();
            antenna.connection.put(setting, kind.read(choice).unwrap()).unwrap();
            antennas.push(antenna);
        }
    }
    let of_variant = |wanted: &&'static Variant| {
        let found = antennas.iter().find(|antenna| std::ptr::eq(variant(antenna), *wanted));
        found.unwrap_or_else(|| panic!("a variant of {spec:?} is not reached")).clone()
    };
    spec.variants.iter().map(of_variant).collect()
}

fn variant(antenna: &Antenna) -> &'static Variant {
    (antenna.connection.spec().variant)(&antenna.connection)
}

/// Returns a valid value of the field.
fn some_value(field: &Field) -> Value {
    match field.kind {
        Kind::Flag => Value::Flag(false),
        Kind::Choice(choices) => Value::Choice(choices[0].0),
        Kind::Integer { min, .. } => Value::Integer(min),
        Kind::Decimal { min, .. } | Kind::Number { min, .. } => Value::Decimal(min),
        Kind::Word(choices) => choices[0].0.into(),
        Kind::Points => Value::Points(Vec::new()),
        Kind::Place { .. } => Value::Decimal(0.0),
        Kind::Text(_) => Value::Text("A".to_owned()),
        Kind::Password(_) => Value::Secret(Secret::new("A")),
        Kind::Time => Value::Time(START),
    }
}

/// Starts a rig and brings it to Manual after the first readings.
async fn in_manual<U: Unit>(antenna: &Antenna, control: Control<U>) -> Rig<Control<U>> {
    let mut rig = Rig::new(control, START, |dial, clock| rig::session(antenna, dial, clock));
    rig.send(Command::Connect);
    let is_known = |shown: &azel::contract::driver::Snapshot| {
        shown.state.measured.is_some() && shown.state.motion_lock == Some(false)
    };
    rig.until("it is read", OUTCOME_S, is_known).await;
    rig.send(Command::Manual);
    rig.seconds(10.0).await;
    rig
}

/// Writes the current values of a group to the unit again.
async fn write_settings<U: Unit>(rig: &mut Rig<Control<U>>, group: &'static Group, ticket: u64) {
    rig.send(Command::ReadGroup(group.key));
    rig.seconds(5.0).await;
    let held = rig.shown().state.groups.get(group.key).and_then(|held| held.last_read.clone());
    let held = held.map(|held| held.values).unwrap_or_default();
    let fields = group.fields.iter().filter(|field| field.access != Access::Read);
    let values: Values = fields
        .map(|field| {
            let held = held.get(field.key).cloned();
            (field.key, held.unwrap_or_else(|| some_value(field)))
        })
        .collect();
    if values.is_empty() {
        return;
    }
    let change = Change { ticket, group: group.key, values, expected: None, is_unlocked: true };
    rig.send(Command::WriteSettings(change));
    let is_over = |shown: &azel::contract::driver::Snapshot| {
        let written = shown.state.groups.get(group.key).and_then(|held| held.written.as_ref());
        written.is_some_and(|written| {
            let is_known = written.result != Err(WriteError::NoSuchSetting);
            assert!(is_known, "{} is declared and not taken", group.key);
            written.change.ticket == ticket
        })
    };
    rig.until(group.key, OUTCOME_S, is_over).await;
}

/// Watches the unit for [`OUTCOME_S`]. Returns its new requests, the labels of its readings and the
/// events, but no angles.
async fn seen<U: Unit>(rig: &mut Rig<Control<U>>) -> (BTreeSet<String>, Vec<String>, Vec<Event>) {
    rig.events();
    let before = rig.control.received().len();
    rig.seconds(OUTCOME_S as f64).await;
    let asked = rig.control.received().into_iter().skip(before);
    let asked = asked.map(|(_, request)| format!("{request:?}")).collect();
    let shown = rig.shown();
    let readings = shown.state.readings.iter().map(|reading| reading.label.to_string());
    (asked, readings.collect(), rig.events())
}

async fn act<U: Unit>(rig: &mut Rig<Control<U>>, action: &'static Action) {
    rig.stop();
    rig.seconds(OUTCOME_S as f64).await;
    rig.send(Command::Manual);
    let idle = seen(rig).await;
    assert_eq!(idle.2, [], "before {}", action.key);
    let values = action.fields.iter().map(|field| (field.key, some_value(field))).collect();
    rig.send(Command::ActUnseen(Act { action: action.key, values }));
    let acted = seen(rig).await;
    let is_new = !acted.0.is_subset(&idle.0) || acted.1 != idle.1 || !acted.2.is_empty();
    assert!(is_new, "{} is declared and not taken", action.key);
}

/// Tries all settings and actions of one antenna, with units made by `unit`.
async fn takes_all<U: Unit>(antenna: &Antenna, unit: impl Fn() -> Control<U>) {
    let Variant { groups, actions, .. } = variant(antenna);
    let mut rig = in_manual(antenna, unit()).await;
    for (group, ticket) in groups.iter().zip(1..) {
        write_settings(&mut rig, group, ticket).await;
    }
    let mut rig = in_manual(antenna, unit()).await;
    for action in *actions {
        act(&mut rig, action).await;
    }
}

#[tokio::test(start_paused = true)]
async fn each_group_and_each_action_that_a_make_declares_is_taken() {
    for spec in SPECS {
        for antenna in antennas(spec) {
            match spec.key {
                "satrak" => {
                    let options = satrak::Options::new(Station::default().site, START);
                    takes_all(&antenna, || satrak::Control::new(&options)).await;
                }
                "genius" => {
                    let mut options = rotator_genius::Options::default();
                    options.rotators[1] = rotator_genius::RotatorOptions::elevation();
                    takes_all(&antenna, || rotator_genius::Control::new(&options)).await;
                }
                "rc2000c" => {
                    let options = rc2000c::Options::default();
                    takes_all(&antenna, || rc2000c::Control::new(&options)).await;
                }
                other => panic!("{other} has no simulator here"),
            }
        }
    }
}
