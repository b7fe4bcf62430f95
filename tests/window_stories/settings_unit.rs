//! Every settings form against a real unit: refused, verified, changed by
//! another client meanwhile, and the link lost in the middle.

use std::time::Duration;

use azel::{
    controller::settings::{SettleError, SettleStep, Settled},
    driver::LinkState,
    protocol::satrak::encode,
    sim::satrak::{Control, Fault},
    station,
};
use egui::{Key, Modifiers, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use tokio::io::{AsyncBufReadExt as _, AsyncWriteExt as _, BufReader};

use crate::{
    settings_desk::{apply, choose, press, says, state_of, unlock, write},
    unit::{RealWindow, Unit, clock_from, open, step_until},
};

/// A form, and what is done with it.
struct Story {
    group: &'static str,
    /// The tab under which it stands.
    tab: Option<&'static str>,
    is_service: bool,
    /// What is chosen beforehand, and goes along with the first change.
    choice: Option<(&'static str, &'static str)>,
    /// Typed one after the other, with what the unit answers to `query` then;
    /// the last is the field whose state is looked at.
    rounds: [(&'static [(&'static str, &'static str)], &'static str); 3],
    query: &'static str,
    /// What another client sends meanwhile; `None` where the unit reports
    /// nothing that could change.
    foreign: Option<&'static str>,
}

const GENERAL: Story = Story {
    group: "general",
    tab: None,
    is_service: false,
    choice: Some(("Clock from GPS", "Off")),
    rounds: [
        (&[("Azimuth offset", "0.15"), ("Elevation threshold", "4")], "SETTINGS?,0,0,0.15,"),
        (&[("Elevation threshold", "5")], ",0,5.0"),
        (&[("Elevation threshold", "6.5")], ",0,6.5"),
    ],
    query: "SETTINGS?",
    foreign: Some("SETTINGS=,?,?,?,?,?,?,7.5,?,?,?,?"),
};

const GPS: Story = Story {
    group: "gps",
    tab: None,
    is_service: false,
    choice: Some(("Position from GPS", "Off")),
    rounds: [
        (&[("Latitude", "41.5")], "GPS_SETTINGS?,0,41.50N,"),
        (&[("Latitude", "33.86S")], ",33.86S,"),
        (&[("Latitude", "1N")], ",1.00N,"),
    ],
    query: "GPS_SETTINGS?",
    foreign: Some("GPS_SETTINGS=,0,41.50N,12.00W"),
};

const WINDOW: Story = Story {
    group: "window",
    tab: None,
    is_service: false,
    choice: None,
    rounds: [
        (
            &[("Start", "2026-08-12 12:00:00"), ("Stop", "2026-08-12 12:10:00")],
            "START_STOP_TIME?,12,0,0,12,8,2026,12,10,0,12,8,2026",
        ),
        (&[("Stop", "2026-08-12 12:11:30Z")], ",12,11,30,12,8,2026"),
        (&[("Stop", "2026-08-12 12:12:00")], ",12,12,0,12,8,2026"),
    ],
    query: "START_STOP_TIME?",
    foreign: Some("START_STOP_TIME=,11,59,0,12,8,2026,12,10,0,12,8,2026"),
};

const FILE: Story = Story {
    group: "file",
    tab: Some("File"),
    is_service: false,
    choice: Some(("Keep the present track", "On")),
    rounds: [
        (
            &[("TLE file", "active.txt"), ("Satellite", "NOAA 20 (JPSS-1)")],
            ",NOAA 20 (JPSS-1),1,43013",
        ),
        (&[("Satellite", "ISS (ZARYA)")], ",ISS (ZARYA),"),
        (&[("Satellite", "SUOMI NPP")], ",SUOMI NPP,"),
    ],
    query: "SATELLITE?",
    foreign: Some("SATELLITE=,active.txt,NOAA 20 (JPSS-1),9,1"),
};

const WEB: Story = Story {
    group: "web",
    tab: Some("Web"),
    is_service: false,
    choice: Some(("When a fetch fails", "Continue")),
    rounds: [
        (&[("Web address", "https://example.org/a?b=1,2")], "/a?b=1%2C2,1,1"),
        (&[("Update period", "3")], ",3,1"),
        (&[("Update period", "4")], ",4,1"),
    ],
    query: "SATELLITE_HTTP?",
    foreign: Some("SATELLITE_HTTP=,https://example.org/b,1,1,0"),
};

const FTP: Story = Story {
    group: "ftp",
    tab: Some("FTP"),
    is_service: false,
    choice: Some(("When a fetch fails", "Continue")),
    rounds: [
        (
            &[
                ("Server address", "10.0.1.2"),
                ("User", "username"),
                ("Password", "hunter2"),
                ("TLE file", "active.txt"),
                ("Satellite", "ISS (ZARYA)"),
                ("Port", "2121"),
            ],
            "SATELLITE_FTP?,10.0.1.2,username,hunter2,2121,active.txt,ISS (ZARYA),",
        ),
        (&[("Password", "hunter3")], ",hunter3,"),
        (&[("Password", "hunter4")], ",hunter4,"),
    ],
    query: "SATELLITE_FTP?",
    foreign: Some("SATELLITE_FTP=,10.9.9.9,username,hunter2,2121,active.txt,ISS (ZARYA),1,1"),
};

const ANGLES: Story = Story {
    group: "angles",
    tab: None,
    is_service: true,
    choice: None,
    rounds: [
        (&[("X sensor reference", "29130")], "ANGLE_SETTINGS?,29130,160.0,"),
        (&[("X sensor reference", "29131")], ",29131,"),
        (&[("X sensor reference", "29132")], ",29132,"),
    ],
    query: "ANGLE_SETTINGS?",
    foreign: Some("ANGLE_SETTINGS=,0,29130,150.0,7282,40.0"),
};

const REDUCTION: Story = Story {
    group: "reduction",
    tab: None,
    is_service: true,
    choice: None,
    rounds: [
        (&[("X reduction", "4100")], "REDUCTION?,4100,4000"),
        (&[("X reduction", "4200")], "REDUCTION?,4200,"),
        (&[("X reduction", "4300")], "REDUCTION?,4300,"),
    ],
    query: "REDUCTION?",
    foreign: Some("REDUCTION=,4100,3900"),
};

const IMAGE: Story = Story {
    group: "image",
    tab: None,
    is_service: true,
    choice: None,
    rounds: [
        (&[("Image file", "a.json")], "LOAD_IMAGE?,"),
        (&[("Image file", "b.json")], "LOAD_IMAGE?,"),
        (&[("Image file", "c.json")], "LOAD_IMAGE?,"),
    ],
    query: "LOAD_IMAGE?",
    foreign: None,
};

/// What another client of the unit is answered.
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

/// A unit, and the window on its settings, all of them read.
pub(crate) struct Scene {
    pub(crate) unit: Unit,
    pub(crate) window: RealWindow,
    pub(crate) folder: tempfile::TempDir,
}

impl Scene {
    pub(crate) fn open() -> Self {
        let utc = "2026-08-12T11:14:30Z".parse().unwrap();
        // Slow enough to break the link in the middle of a change.
        let delay = Duration::from_millis(100);
        let (unit, folder) = (Unit::with_delay(utc, delay..=delay), tempfile::tempdir().unwrap());
        let path = folder.path().join("station.toml");
        station::save(&unit.station(), &path).unwrap();
        let mut window = open(&path, clock_from(utc));
        window.run_steps(2);
        window.key_press_modifiers(Modifiers::COMMAND, Key::Num4);
        window.run_steps(2);
        let mut scene = Self { unit, window, folder };
        scene.until_said("all groups read");
        scene
    }

    pub(crate) fn until_said(&mut self, words: &str) {
        crate::unit::wait_until(words, || {
            self.window.step();
            says(&self.window, words)
        });
    }

    /// Types what a round says; returns the field whose state is looked at.
    fn edit(&mut self, round: &[(&'static str, &'static str)]) -> &'static str {
        for (label, words) in round {
            write(&mut self.window, label, words);
            assert_eq!(state_of(&self.window, label), "Edited", "{label}");
        }
        round.last().unwrap().0
    }

    /// Applies, and waits until the field says so.
    pub(crate) fn apply_until(&mut self, field: &str, state: &str) {
        apply(&mut self.window);
        crate::unit::wait_until(state, || {
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

    /// Ends the link before the answer to the command of a change.
    fn lose_link_while_sending(&mut self, group: &str) {
        let handle = &self.window.state().model().antennas[0].handle;
        crate::unit::wait_until("it is sent", || {
            let step = handle.snapshot().state.held.get(group).and_then(|state| state.step);
            step == Some(SettleStep::Sending)
        });
        self.unit.control.drop_clients();
        step_until(&mut self.window, "the change is over", |model| {
            let antenna = &model.antennas[0].snapshot;
            let settled = antenna.state.held.get(group).and_then(|state| state.settled.clone());
            let lost = |settled: &Settled| settled.result == Err(SettleError::LinkLost);
            !antenna.link.is_open() && settled.as_deref().is_some_and(lost)
        });
        self.window.run_steps(2);
        assert!(says(&self.window, "the link was lost before it was read back"));
    }

    fn link_is_back(&mut self) {
        step_until(&mut self.window, "the link is back", |model| {
            matches!(model.antennas[0].snapshot.link, LinkState::Up { .. })
        });
        self.until_said("all groups read");
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
    let done = if story.group == "image" { "Taken" } else { "Verified" };
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
        assert!(says(&scene.window, " was ") && says(&scene.window, " now."));
        assert_eq!(ask(&control, story.query), theirs, "nothing was sent");
    }
    scene.apply_until(field, done);
    let held = ask(&control, story.query);
    assert!(held.contains(second.1), "{held}");

    let field = scene.edit(third.0);
    apply(&mut scene.window);
    scene.lose_link_while_sending(story.group);
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
    // What was sent may have been taken just before the link went.
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
    scene.until_said("Set and read again");
    assert!(ask(&control, "TIME?").contains(",12,8,2026"));
    press(&mut scene.window, "Set from this PC");
    scene.lose_link_while_sending("clock");
    assert!(says(&scene.window, "There is no link."));
    scene.link_is_back();
    press(&mut scene.window, "Set from this PC");
    scene.until_said("Set and read again");
}
