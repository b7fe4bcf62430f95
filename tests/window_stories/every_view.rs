//! Checks of every view, and of every popup over a view.

mod contrast;
mod cut;
mod days;
mod order;
mod overlaps;
pub(crate) mod painted;
mod scale;
mod tooltips;
mod tree;
mod units;

use std::{collections::BTreeMap, sync::Arc};

use azel::{
    astro::time::add_seconds,
    contract::{
        self,
        alarms::AlarmKind,
        automatic::Doing,
        driver::{Intent, LinkLoss, LinkState, Snapshot},
    },
    engine::alarms::KeepAlarms,
    model::{DistanceUnit, Model, UiCommand, View},
    station::AntennaId,
};
use egui::{Event, HoveredFile, Key, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use jiff::Timestamp;

use crate::window_stories::{
    automatic, closing, console, elements, horizon, maintenance, makes, plan,
    preferences::{self, write},
    preferences_rules, record,
    rig::{self, LARGE, SMALL, Window, asked, settle},
    settings_rig, setup, states, wide,
};
pub(crate) use days::words;

/// A view in one of its states.
pub(crate) struct Scene {
    pub(crate) name: &'static str,
    open: fn([f32; 2]) -> Window,
}

impl Scene {
    pub(crate) fn open(&self, size: [f32; 2]) -> Window {
        (self.open)(size)
    }
}

/// Opens the view of one of [`SCENES`].
pub(crate) fn scene(name: &str, size: [f32; 2]) -> Window {
    SCENES.iter().find(|scene| scene.name == name).expect("a scene of this name").open(size)
}

const fn named(name: &'static str, open: fn([f32; 2]) -> Window) -> Scene {
    Scene { name, open }
}

pub(crate) const SCENES: [Scene; 50] = [
    named("Operate, tracking", |size| rig::window(size, rig::model(states::tracking(0.04)))),
    named("Operate, three antennas of the demo", |size| rig::window(size, demo())),
    named("Operate, automatic operation", |size| {
        rig::window(size, automatic::scene(automatic::on(&Doing::Rests)))
    }),
    named("Operate, suspended automatic operation", |size| {
        rig::window(size, automatic::suspended_scene())
    }),
    named("Operate, jog", |size| rig::window(size, rig::model(states::manual()))),
    named("Operate, a pair of rotators", |size| {
        rig::window(size, makes::model(makes::pair(), makes::pair_at(Intent::Position)))
    }),
    named("Operate, a rotator alone", |size| {
        rig::window(size, makes::model(makes::alone(), makes::alone_at(Intent::Manual, true)))
    }),
    named("Operate, a unit with alarms", |size| {
        let snapshot = makes::rc2000c_alarmed(Intent::Manual);
        rig::window(size, makes::model(makes::rc2000c(), snapshot))
    }),
    named("Operate, a unit to be connected", |size| {
        rig::window(size, makes::model(makes::rc2000c(), makes::rc2000c_off()))
    }),
    named("Operate, link lost", |size| rig::window(size, lost())),
    named("Operate, locked out", |size| {
        rig::window(size, rig::model(maintenance::locked(states::holding())))
    }),
    named("Operate, no antennas", |size| rig::window(size, without_antennas())),
    named("Operate, drawer of passes", |size| {
        let mut window = rig::window(size, rig::model(states::holding()));
        press(&mut window, Key::P);
        window
    }),
    named("Operate, layers of the sky", |size| {
        opened_by(rig::window(size, rig::model(states::holding())), "Layers")
    }),
    named("Operate, menu of the station", |size| {
        opened_by(rig::window(size, rig::model(states::holding())), "Station Şile 1")
    }),
    named("Operate, menu of the link", |size| {
        opened_by(rig::window(size, rig::model(states::holding())), "Link of Satrak")
    }),
    named("Operate, what else is followed", |size| {
        opened_by(rig::window(size, rig::model(states::holding())), "Follow something else")
    }),
    named("Alarms", |size| opened_by(rig::window(size, alarmed()), "alarm")),
    named("List of keys", |size| {
        let mut window = rig::window(size, rig::model(states::holding()));
        press(&mut window, Key::Questionmark);
        window
    }),
    named("Question", |size| {
        let mut window = rig::window(size, rig::model(states::tracking(0.04)));
        press(&mut window, Key::M);
        window
    }),
    named("Question before closing", |size| {
        closing::asked_about(size, rig::model(states::tracking(0.1)))
    }),
    named("Plan", plan::view),
    named("Plan, details", |size| {
        let mut window = plan::view(size);
        click_if_there(&mut window, "Details");
        window
    }),
    named("Elements", |size| elements::view(size, sources())),
    named("Elements, details", |size| {
        let mut window = elements::view(size, Vec::new());
        click_if_there(&mut window, "Details");
        window
    }),
    named("Elements, selected rows", |size| {
        let mut window = elements::view(size, Vec::new());
        window.get_by_role_and_label(Role::ListBox, "Catalogue").focus();
        settle(&mut window);
        window.key_press(Key::Space);
        settle(&mut window);
        window
    }),
    named("Elements, pasted", |size| {
        let mut window = elements::view(size, Vec::new());
        window.event(Event::Paste("hello".to_owned()));
        settle(&mut window);
        window
    }),
    named("Elements, a file held over it", |size| {
        let mut window = elements::view(size, Vec::new());
        let held = HoveredFile { path: Some("own.json".into()), ..HoveredFile::default() };
        window.input_mut().hovered_files = vec![held];
        settle(&mut window);
        window
    }),
    named("Upload", |size| {
        let mut window = elements::view(size, Vec::new());
        click_if_there(&mut window, "Details");
        opened_by(window, "Upload to")
    }),
    named("Antennas", |size| settings_rig::opened(size, settings_rig::read())),
    named("Antennas, unread", |size| settings_rig::opened(size, rig::quiet())),
    named("Antennas, a Rotator Genius", |size| {
        in_view(size, View::Antennas, makes::model(makes::pair(), makes::pair_at(Intent::Standby)))
    }),
    named("Antennas, an RC2000C", |size| {
        let snapshot = makes::rc2000c_at(Intent::Standby);
        in_view(size, View::Antennas, makes::model(makes::rc2000c(), snapshot))
    }),
    named("Console", console::view),
    named("Record", record::view),
    named("Map", |size| in_view(size, View::Map, rig::model(states::holding()))),
    named("Preferences", preferences::form),
    named("Preferences, a wrong field", |size| {
        let mut window = preferences::form(size);
        write(&mut window, "Latitude", "91");
        window
    }),
    named("Preferences, a selected value", |size| {
        let mut window = preferences::form(size);
        window.get_by_role_and_label(Role::TextInput, "Name").focus();
        settle(&mut window);
        window.key_press(Key::Tab);
        settle(&mut window);
        window
    }),
    named("Preferences, an antenna", preferences::antenna_form),
    named("Horizon and keep-outs", horizon::page),
    named("Satellites and priorities", |size| {
        opened_by(preferences::form(size), "Satellites and priorities")
    }),
    named("Automation rules", preferences_rules::view),
    named("Alarms and sounds", |size| opened_by(preferences::form(size), "Alarms and sounds")),
    named("Appearance", |size| opened_by(preferences::form(size), "Appearance")),
    named("Set-up, site", setup::window),
    named("Set-up, antennas", |size| {
        let mut window = at_step(size, 1);
        let antenna = setup::add_and_test(&mut window, "unit.local:4001");
        setup::tell(&mut window, &antenna, setup::reached());
        window
    }),
    named("Set-up, satellites", |size| at_step(size, 2)),
    named("Set-up, elements", |size| at_step(size, 3)),
    named("Set-up, check and finish", |size| at_step(size, 4)),
];

/// Faults that the checks have found, and the number of things that each check has looked at.
#[derive(Default)]
struct Findings {
    scene: &'static str,
    check: &'static str,
    faults: Vec<String>,
    counts: BTreeMap<&'static str, usize>,
}

impl Findings {
    /// Assigns the following faults and counts to this scene and check.
    fn begin(&mut self, scene: &Scene, check: &'static str) -> &mut Self {
        (self.scene, self.check) = (scene.name, check);
        self
    }

    fn add(&mut self, fault: &str) {
        self.faults.push(format!("{}, {}: {fault}", self.scene, self.check));
    }

    fn count(&mut self, number: usize) {
        *self.counts.entry(self.check).or_default() += number;
    }

    /// Fails on any fault, and on a check that looked at no more than its minimum.
    fn end(self, minima: &[(&str, usize)]) {
        assert!(self.faults.is_empty(), "{} faults\n{}", self.faults.len(), self.faults.join("\n"));
        for (check, min) in minima {
            let count = self.counts.get(check).copied().unwrap_or_default();
            assert!(count > *min, "{check}: only {count} to look at");
        }
    }
}

/// Seconds by which the present moves back, to another day than the scene's times. The times of the
/// next hours then stand out.
const BACK_S: f64 = 36.0 * 3600.0;
/// Seconds by which the present moves back, so that most times of the next hours carry a day and
/// are longer.
const LONG_TIMES_BACK_S: f64 = 12.0 * 3600.0;

/// Sets the present of the scene.
fn set_now(window: &mut Window, now: Timestamp) {
    window.state_mut().model.now = now;
    settle(window);
}

/// Opens each scene once and makes all checks in it, starting with those that do not change it. The
/// smallest window also gets a check with the pixels of 200 %.
fn check_all(size: [f32; 2], minima: &[(&str, usize)]) {
    let mut findings = Findings::default();
    for scene in &SCENES {
        let mut window = scene.open(size);
        cut::check(&window, findings.begin(scene, "cut texts"));
        // A drawer lies over the plot, so the reading order has it after the plot.
        if size != SMALL || scene.name != "Operate, drawer of passes" {
            order::check(&window, findings.begin(scene, "reading order"));
        }
        overlaps::check(&window, findings.begin(scene, "overlaps"));
        tree::check(&window, size, findings.begin(scene, "tree"));
        if size == LARGE {
            contrast::check(&mut window, findings.begin(scene, "contrast"));
        }
        let now = window.state().model.now;
        set_now(&mut window, add_seconds(now, -LONG_TIMES_BACK_S));
        overlaps::check(&window, findings.begin(scene, "overlaps on another day"));
        // A question keeps the words that it had when it opened.
        if scene.name != "Question" {
            set_now(&mut window, add_seconds(now, -BACK_S));
            days::check(&window, findings.begin(scene, "days of times"));
        }
        window.state_mut().model.appearance.distances = DistanceUnit::NauticalMiles;
        set_now(&mut window, now);
        units::check(&window, findings.begin(scene, "units"));
        if size == SMALL {
            window.state_mut().model.appearance.distances = DistanceUnit::default();
            scale::check(scene, size, &mut window, findings.begin(scene, "200 %"));
        }
    }
    findings.end(minima);
}

#[test]
fn in_the_usual_window_every_view_holds_what_all_of_them_must() {
    check_all(
        LARGE,
        &[
            ("cut texts", 1000),
            ("reading order", 1500),
            ("overlaps", 1000),
            ("overlaps on another day", 1000),
            ("tree", 15),
            ("contrast", 10_000),
            ("days of times", 100),
            ("units", 40),
        ],
    );
}

#[test]
fn in_the_smallest_window_every_view_holds_what_all_of_them_must() {
    check_all(
        SMALL,
        &[
            ("cut texts", 1000),
            ("reading order", 1500),
            ("overlaps", 1000),
            ("overlaps on another day", 1000),
            ("tree", 15),
            ("days of times", 100),
            ("units", 5),
            ("200 %", 10),
        ],
    );
}

fn press(window: &mut Window, key: Key) {
    window.key_press(key);
    take_up(window);
}

/// Carries out the requested command of a key, if the command opens something.
fn take_up(window: &mut Window) {
    let opens = |command: &UiCommand| {
        matches!(command, UiCommand::Station(contract::Command::OpenedAlarms))
    };
    if asked(window).iter().any(opens) {
        window.state_mut().model.shown_mut().alarms.unopened = false;
    }
    settle(window);
}

/// Returns the window after a click on the control whose name contains `words`.
fn opened_by(mut window: Window, words: &str) -> Window {
    let is_control = |role| matches!(role, Role::Button | Role::RadioButton);
    let mut found = window.query_all_by_label_contains(words);
    let control = found.find(|node| is_control(node.accesskit_node().role()));
    control.unwrap_or_else(|| panic!("no control {words:?}")).click();
    drop(found);
    take_up(&mut window);
    window
}

fn click_if_there(window: &mut Window, button: &str) {
    if let Some(button) = window.query_by_role_and_label(Role::Button, button) {
        button.click();
    }
    settle(window);
}

fn in_view(size: [f32; 2], view: View, mut model: Model) -> Window {
    model.view = view;
    model.refresh_sky();
    rig::window(size, model)
}

fn demo() -> Model {
    let mut model = wide::three();
    model.shown_mut().demo = true;
    model
}

fn lost() -> Model {
    let mut model = rig::model(rig::quiet());
    let (since, retry_at) = (rig::ago(&model, 42), model.steady);
    let link = LinkState::Lost { start: since, reason: LinkLoss::Silent, retry_at };
    let config = model.station.antennas[0].clone();
    model.shown_mut().antennas =
        vec![rig::antenna(config, Snapshot { link, ..states::tracking(0.0) })];
    model
}

fn without_antennas() -> Model {
    let mut model = rig::model(states::holding());
    model.shown_mut().antennas.clear();
    Arc::make_mut(&mut model.shown_mut().station).antennas.clear();
    model
}

/// Returns a model with an alarm of each rank: new, seen, over and shelved.
fn alarmed() -> Model {
    let mut model = rig::model(states::holding());
    let (of, now) = (Some(AntennaId::FIRST), model.now);
    model.shown_mut().alarms.raise(of, AlarmKind::ClockNotSet, now);
    model.shown_mut().alarms.raise(of, AlarmKind::AutoStaysOn, now);
    model.shown_mut().alarms.acknowledge_all(1, now);
    model.shown_mut().alarms.shelve(0, azel::contract::alarms::ShelveTime::OneHour, now);
    model.shown_mut().alarms.raise(of, AlarmKind::LinkLost(LinkLoss::Closed), now);
    model.shown_mut().alarms.clear(of, now, |kind| matches!(kind, AlarmKind::LinkLost(_)));
    model.shown_mut().alarms.raise(of, AlarmKind::StopNotConfirmed, now);
    model.shown_mut().alarms.raise(None, AlarmKind::Elements("the file is empty".to_owned()), now);
    model
}

fn sources() -> Vec<(azel::orbit::Source, azel::orbit::SourceReport)> {
    let own = elements::file_source();
    let report = elements::report(&own, 71);
    vec![(own, report), elements::server(5.0)]
}

/// Returns a window with the set-up after `steps` of its steps.
fn at_step(size: [f32; 2], steps: usize) -> Window {
    let mut window = setup::window(size);
    setup::write_site(&mut window);
    for next in &setup::NEXT[..steps] {
        setup::press(&mut window, next);
    }
    asked(&mut window);
    window
}
