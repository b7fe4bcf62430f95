//! Every settings form against a real unit: a refused change, a verified change, a change by
//! another client, and a lost link.

use azel::{
    contract::driver::LinkState,
    controller::SPECS,
    device::settings::{GroupState, WriteError, Written},
    protocol::satrak::encode,
    sim::satrak::{Control, Fault},
    station,
};
use egui::{Key, Modifiers, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use tokio::io::{AsyncBufReadExt as _, AsyncWriteExt as _, BufReader};

use crate::window_stories::{
    settings_forms::{ANGLES, FILE, FTP, GENERAL, GPS, IMAGE, REDUCTION, Story, WEB, WINDOW},
    settings_rig::{apply, choose, press, says, state_of, unlock, write},
    unit::{RealWindow, Unit, clock_from, open, step_until},
};

/// Sends `payload` from another client, and returns the unit's answer.
pub(crate) fn ask(control: &Control, payload: &str) -> String {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_time().build().unwrap();
    runtime.block_on(async {
        let (near, far) = tokio::io::duplex(4096);
        let control = control.clone();
        tokio::spawn(async move { control.serve(far).await });
        let (reader, mut writer) = tokio::io::split(near);
        writer.write_all(&encode(payload)).await.unwrap();
        let mut line = String::new();
        BufReader::new(reader).read_line(&mut line).await.unwrap();
        line
    })
}

/// Unit, and a window on all of its settings.
pub(crate) struct Scene {
    pub(crate) unit: Unit,
    pub(crate) window: RealWindow,
    pub(crate) folder: tempfile::TempDir,
}

impl Scene {
    pub(crate) fn open() -> Self {
        let utc = "2026-08-12T11:14:30Z".parse().unwrap();
        let (unit, folder) = (Unit::start(utc), tempfile::tempdir().unwrap());
        let path = folder.path().join("station.toml");
        station::save(&unit.station(), &path, SPECS).unwrap();
        let mut window = open(&path, clock_from(utc));
        window.run_steps(2);
        window.key_press_modifiers(Modifiers::COMMAND, Key::Num4);
        window.run_steps(2);
        let mut scene = Self { unit, window, folder };
        scene.until_said("all groups read");
        scene
    }

    pub(crate) fn until_said(&mut self, words: &str) {
        crate::window_stories::unit::wait_until(words, || {
            self.window.step();
            says(&self.window, words)
        });
    }

    /// Types the values of a round, and returns the field whose state the story checks.
    fn edit(&mut self, round: &[(&'static str, &'static str)]) -> &'static str {
        for (label, words) in round {
            write(&mut self.window, label, words);
            assert_eq!(state_of(&self.window, label), "Edited", "{label}");
        }
        round.last().unwrap().0
    }

    /// Applies the changes, and waits until the field shows `state`.
    pub(crate) fn apply_until(&mut self, field: &str, state: &str) {
        apply(&mut self.window);
        crate::window_stories::unit::wait_until(state, || {
            self.window.step();
            state_of(&self.window, field).starts_with(state)
        });
    }

    pub(crate) fn open_service(&mut self) {
        let station = self.window.state().model().station.name.clone();
        step_until(&mut self.window, "it stands", |model| {
            let measured = model.antennas[0].snapshot.state.measured;
            measured.is_some_and(|measured| !measured.moving())
        });
        unlock(&mut self.window, &station);
        assert!(says(&self.window, "Open, locks in"));
    }

    /// Lets the unit accept the command of a change and hang up. The unit stays out of reach until
    /// the window shows the loss.
    fn lose_link_while_sending(&mut self, group: &str, press: impl FnOnce(&mut RealWindow)) {
        let control = self.unit.control.clone();
        control.set_fault(Fault::HangUp, true);
        press(&mut self.window);
        crate::window_stories::unit::wait_until("the link is lost", || {
            let is_lost = |written: &Written| written.result == Err(WriteError::LinkLost);
            let shown = &self.window.state().model().antennas[0].snapshot;
            let state = shown.state.groups.get(group);
            if state.is_some_and(|state| state.written.as_deref().is_some_and(is_lost)) {
                control.drop_clients();
            }
            self.window.step();
            let link = &self.window.state().model().antennas[0].snapshot.link;
            !link.is_open() && says(&self.window, "the link was lost before it was read back")
        });
        control.set_fault(Fault::HangUp, false);
    }

    /// Waits until the link is up and Azel has read all shown values over it.
    fn link_is_back(&mut self) {
        let lost_at = self.window.state().model().now;
        step_until(&mut self.window, "the link is back", |model| {
            let shown = &model.antennas[0].snapshot;
            let is_new = |state: &GroupState| {
                state.last_read.as_ref().is_some_and(|held| held.read_at > lost_at)
            };
            matches!(shown.link, LinkState::Up { .. }) && shown.state.groups.values().all(is_new)
        });
    }
}

fn drive(story: &Story) {
    let mut scene = Scene::open();
    let control = scene.unit.control.clone();
    if let Some(tab) = story.tab {
        scene.window.get_by_role_and_label(Role::RadioButton, tab).click_accesskit();
        scene.window.run_steps(2);
    }
    if story.is_service {
        scene.open_service();
    }
    let done = if story.group == "image" { "Accepted" } else { "Verified" };
    let [first, second, third] = story.rounds;

    let before = ask(&control, story.query);
    if let Some((label, word)) = story.choice {
        choose(&mut scene.window, label, word);
    }
    let field = scene.edit(first.0);
    control.set_fault(Fault::RefuseSettings, true);
    scene.apply_until(field, "Rejected");
    assert!(says(&scene.window, "the unit answered ERR,7"));
    assert_eq!(ask(&control, story.query), before);
    control.set_fault(Fault::RefuseSettings, false);
    scene.apply_until(field, done);
    let held = ask(&control, story.query);
    assert!(held.contains(first.1), "{held}");

    let field = scene.edit(second.0);
    if let Some(foreign) = story.foreign {
        assert!(ask(&control, foreign).contains(",OK"), "{foreign}");
        let theirs = ask(&control, story.query);
        scene.apply_until(field, "Rejected");
        assert!(says(&scene.window, " was ") && says(&scene.window, " and is now "));
        assert_eq!(ask(&control, story.query), theirs, "nothing was sent");
    }
    scene.apply_until(field, done);
    let held = ask(&control, story.query);
    assert!(held.contains(second.1), "{held}");

    let field = scene.edit(third.0);
    scene.lose_link_while_sending(story.group, |window| apply(window));
    let button = scene
        .window
        .get_all_by_role(Role::Button)
        .find(|node| node.accesskit_node().label().is_some_and(|label| label.starts_with("Apply")));
    assert!(button.unwrap().accesskit_node().is_disabled(), "no Apply without a link");
    assert!(says(&scene.window, ", old: "));
    scene.link_is_back();
    if story.is_service {
        scene.open_service();
    }
    // The unit may have accepted the change just before the link broke.
    if state_of(&scene.window, field) != "Unchanged" {
        scene.apply_until(field, done);
    }
    let held = ask(&control, story.query);
    assert!(held.contains(third.1), "{held}");
}

#[test]
fn general() {
    drive(&GENERAL);
}

#[test]
fn gps() {
    drive(&GPS);
}

#[test]
fn tracking_window() {
    drive(&WINDOW);
}

#[test]
fn satellite_from_a_file() {
    drive(&FILE);
}

#[test]
fn satellite_from_the_web() {
    drive(&WEB);
}

#[test]
fn satellite_by_ftp() {
    drive(&FTP);
}

#[test]
fn angle_calibration() {
    drive(&ANGLES);
}

#[test]
fn drive_reduction() {
    drive(&REDUCTION);
}

#[test]
fn system_image() {
    drive(&IMAGE);
}

#[test]
fn clock() {
    let mut scene = Scene::open();
    let control = scene.unit.control.clone();
    control.set_fault(Fault::RefuseSettings, true);
    press(&mut scene.window, "Set from this PC");
    scene.until_said("the unit answered ERR,7");
    control.set_fault(Fault::RefuseSettings, false);
    assert!(ask(&control, "TIME=,1,2,3,4,5,2020").contains(",OK"));
    press(&mut scene.window, "Set from this PC");
    scene.until_said("Set and read back");
    assert!(ask(&control, "TIME?").contains(",12,8,2026"));
    scene.lose_link_while_sending("clock", |window| press(window, "Set from this PC"));
    assert!(says(&scene.window, "There is no link."));
    scene.link_is_back();
    press(&mut scene.window, "Set from this PC");
    scene.until_said("Set and read back");
}
