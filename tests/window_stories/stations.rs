//! Several stations in one window, which shows one at a time.

use std::{fmt::Write as _, fs, path::Path};

use azel::{
    app::App,
    clock::Clock,
    contract::{claim::HolderKind, driver::LinkState},
    controller::SPECS,
    engine::{Handle, Settings},
    model::{KnownStation, Model, NextStation, ThemeName, UiCommand, View, typed_path::OpenedFile},
    orbit::bundled,
    station::{self, Station},
    ui::theme,
};
use egui::{Key, Modifiers, Role};
use egui_kittest::{
    Harness,
    kittest::{NodeT as _, Queryable as _},
};

use crate::window_stories::{
    rig::{self, NOAA_20, SIZES, Window, asked, settle},
    settings_rig::{press, says},
    unit::{RealWindow, Unit, clock_from, step_until, wait_until},
};

const UTC: &str = "2026-08-12T11:14:30Z";

#[test]
fn the_menu_of_every_station_leads_to_the_others_and_to_the_demo() {
    for (size, demo) in SIZES.into_iter().flat_map(|size| [(size, false), (size, true)]) {
        let mut model = rig::model(rig::quiet());
        model.shown_mut().demo = demo;
        let known = |name: &str, path: &str| KnownStation { name: name.into(), path: path.into() };
        model.stations.stations =
            vec![known("Şile 1", "/a.toml"), known("Hill", "/b.toml"), known("Hill", "/c.toml")];
        model.stations.open = Some("/a.toml".into());
        let mut window = rig::window(size, model);
        let file = |path: &str| NextStation::File(path.into());
        let mut entries = vec![
            ("Hill (b)", Some(UiCommand::ChooseStation(file("/b.toml")))),
            ("Hill (c)", Some(UiCommand::ChooseStation(file("/c.toml")))),
            ("Open…", Some(UiCommand::ChooseFile(OpenedFile::Station))),
        ];
        if demo {
            entries.push(("Şile 1", Some(UiCommand::ChooseStation(file("/a.toml")))));
            entries.push(("Demo station", None));
        } else {
            entries.push(("Şile 1", None));
            entries.push(("Demo station", Some(UiCommand::ChooseStation(NextStation::Demo))));
            entries.push(("New station…", Some(UiCommand::ChooseStation(NextStation::New))));
        }
        for (entry, wanted) in entries {
            window.get_by_label("Station Şile 1").click();
            settle(&mut window);
            let entry = window.get_by_role_and_label(Role::Button, entry);
            let rect = entry.rect();
            assert!(rect.right() <= size[0] && rect.bottom() <= size[1], "{rect:?}");
            entry.click();
            assert_eq!(asked(&mut window), Vec::from_iter(wanted));
        }
    }
}

#[test]
fn the_menu_works_with_the_keyboard_alone() {
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(rig::quiet()));
        window.get_by_label("Station Şile 1").focus();
        settle(&mut window);
        window.key_press(Key::Enter);
        settle(&mut window);
        let has_focus = |window: &Window| {
            let entry = window.get_by_role_and_label(Role::Button, "Demo station");
            entry.accesskit_node().is_focused()
        };
        for _ in 0..10 {
            if has_focus(&window) {
                break;
            }
            window.key_press(Key::Tab);
            settle(&mut window);
        }
        assert!(has_focus(&window), "Tab leads into the menu");
        window.key_press(Key::Enter);
        assert_eq!(asked(&mut window), [UiCommand::ChooseStation(NextStation::Demo)]);
    }
}

#[test]
fn a_station_that_is_not_opened_says_why_and_goes_with_enter() {
    for size in rig::sizes() {
        let mut model = rig::model(rig::quiet());
        model.stations.refused = Some("the file is gone: /a.toml".to_owned());
        let mut window = rig::window(size, model);
        for words in ["The station was not opened", "The file is gone: /a.toml", "Şile 1 stays"] {
            assert!(rig::says(&window, words), "{words}");
        }
        window.get_by_role_and_label(Role::Button, "Close (Enter)");
        window.key_press(Key::Enter);
        assert_eq!(asked(&mut window), [UiCommand::KeepStation]);
    }
}

/// Two stations in one folder, each with a unit, and a window on the first.
struct Two {
    units: [Unit; 2],
    window: RealWindow,
    folder: tempfile::TempDir,
}

const NAMES: [&str; 2] = ["Hill", "Field"];
const FILES: [&str; 2] = ["station.toml", "field.toml"];

fn settings(path: &Path) -> Settings {
    Settings {
        path: Some(path.to_owned()),
        library: Some(path.with_file_name("elements")),
        claims: Some((path.with_file_name("run").into(), HolderKind::Window)),
        ..Settings::default()
    }
}

fn open(path: &Path, clock: Clock) -> RealWindow {
    let settings = settings(path);
    Harness::builder()
        .with_size(rig::LARGE)
        .build_eframe(move |cc| App::new(&cc.egui_ctx, &settings, clock).unwrap())
}

impl Two {
    fn open() -> Self {
        let folder = tempfile::tempdir().unwrap();
        // Read the elements first, because the clocks of the units start with the window's clock.
        let catalog = bundled().unwrap();
        let elements = rig::station().favourites.numbers().into_iter();
        let elements: Vec<_> =
            elements.map(|number| catalog.get(number).unwrap().clone()).collect();
        let units = [(); 2].map(|()| Unit::of_elements(elements.clone(), UTC.parse().unwrap()));
        let mut list = String::new();
        for ((unit, name), file) in units.iter().zip(NAMES).zip(FILES) {
            let path = folder.path().join(file);
            let station = Station { name: name.to_owned(), ..unit.station() };
            station::save(&station, &path, SPECS).unwrap();
            writeln!(list, "[[station]]\nname = '{name}'\npath = '{}'", path.display()).unwrap();
        }
        fs::write(folder.path().join("stations.toml"), list).unwrap();
        let window = open(&folder.path().join(FILES[0]), clock_from(UTC.parse().unwrap()));
        let mut two = Self { units, window, folder };
        two.wait_for(NAMES[0]);
        two
    }

    /// Waits until this station is in the window and its unit answers.
    fn wait_for(&mut self, name: &str) {
        step_until(&mut self.window, "the station is in the window", |model| {
            model.station.name == name && !model.stations.is_changing && is_heard(model)
        });
        self.window.run_steps(3);
    }

    /// Picks an entry of the station menu.
    fn pick(&mut self, entry: &str) {
        let name = self.window.state().model().station.name.clone();
        self.window.get_by_label(&format!("Station {name}")).click();
        self.window.run_steps(3);
        self.window.get_by_role_and_label(Role::Button, entry).click();
        self.window.run_steps(3);
    }

    fn track(&mut self) {
        step_until(&mut self.window, "the passes are planned", |model| {
            // Wait for the first plan, because it changes the places of the bars in the strip.
            model.schedule.made_at.is_some() && model.pass_of(NOAA_20).is_some()
        });
        self.window.get_by_label_contains("NOAA 20, 11:08Z to 11:21Z").click();
        self.window.run_steps(2);
        press(&mut self.window, "Track NOAA 20");
        step_until(&mut self.window, "it tracks", |model| model.antenna().unwrap().tracks());
    }

    fn until_it_says(&mut self, words: &str) {
        let window = &mut self.window;
        wait_until(words, || {
            window.step();
            says(window, words)
        });
    }
}

fn is_heard(model: &Model) -> bool {
    model.antenna().is_some_and(|of| {
        matches!(of.snapshot.link, LinkState::Up { .. })
            && of.snapshot.state.motion_lock == Some(false)
    })
}

#[test]
fn the_window_changes_to_another_station_and_back() {
    let mut two = Two::open();
    two.window.key_press_modifiers(Modifiers::COMMAND, Key::L);
    two.window.run_steps(3);
    assert_eq!(theme::name(&two.window.ctx), ThemeName::Light);
    two.pick(NAMES[1]);
    two.wait_for(NAMES[1]);
    assert_eq!(
        two.window.state().model().antenna().unwrap().config.connection.address,
        two.units[1].address.to_string()
    );
    // The second station begins with the look of the first, and keeps its own look from then on.
    assert_eq!(theme::name(&two.window.ctx), ThemeName::Light);
    two.window.key_press_modifiers(Modifiers::COMMAND, Key::L);
    two.window.run_steps(3);
    assert_eq!(theme::name(&two.window.ctx), ThemeName::Night);
    two.window.get_by_role_and_label(Role::Tab, "Map").click();
    two.window.run_steps(3);
    assert!(two.units[0].status().is_some(), "the first unit is free");
    two.pick(NAMES[0]);
    two.wait_for(NAMES[0]);
    assert_eq!(theme::name(&two.window.ctx), ThemeName::Light);
    assert_eq!(two.window.state().model().view, View::Operate);
    two.pick(NAMES[1]);
    two.wait_for(NAMES[1]);
    assert_eq!(theme::name(&two.window.ctx), ThemeName::Night);
    assert_eq!(two.window.state().model().view, View::Map);
    two.pick(NAMES[0]);
    two.wait_for(NAMES[0]);
    let names: Vec<&str> =
        two.window.state().model().stations.stations.iter().map(|known| &*known.name).collect();
    assert_eq!(names, NAMES);
}

#[test]
fn a_change_asks_what_closing_asks_and_waits_for_proved_standstill() {
    let mut two = Two::open();
    two.track();
    two.pick(NAMES[1]);
    two.until_it_says("Change to Field?");
    assert!(says(&two.window, "Satrak tracks NOAA 20 by itself."));
    press(&mut two.window, "Stay");
    two.window.run_steps(3);
    assert!(!says(&two.window, "Change to Field?"));
    assert!(two.units[0].control.state().is_tracking, "it goes on");
    two.pick(NAMES[1]);
    two.until_it_says("Change to Field?");
    press(&mut two.window, "Change and hold");
    two.wait_for(NAMES[1]);
    assert!(!two.units[0].control.state().is_tracking);
    let received = two.units[0].control.received();
    assert!(received.iter().any(|(_, frame)| frame == "STOP="), "{received:?}");
    let next = two.units[1].control.received();
    assert!(!next.iter().any(|(_, frame)| frame == "STOP="));
    assert!(received.last().unwrap().0 < next[0].0, "the old station ends first");
}

#[test]
fn a_change_with_something_typed_asks_first() {
    let mut two = Two::open();
    two.window.key_press_modifiers(Modifiers::COMMAND, Key::Num6);
    two.window.run_steps(3);
    two.window.get_all_by_role_and_label(Role::TextInput, "Name").next().unwrap().focus();
    two.window.run_steps(2);
    two.window.event(egui::Event::Text("Other".to_owned()));
    two.window.run_steps(2);
    two.pick(NAMES[1]);
    two.until_it_says("The station settings are not saved. Change anyway?");
    press(&mut two.window, "Cancel");
    two.window.run_steps(3);
    assert!(says(&two.window, "Other"), "what was typed is there");
    two.pick(NAMES[1]);
    two.until_it_says("The station settings are not saved. Change anyway?");
    press(&mut two.window, "Change (Enter)");
    two.wait_for(NAMES[1]);
    let saved = fs::read_to_string(two.folder.path().join(FILES[0])).unwrap();
    assert!(saved.contains("Hill"), "{saved}");
}

#[test]
fn a_station_that_cannot_be_opened_leaves_the_present_one_as_it_is() {
    let mut two = Two::open();
    two.track();
    let path = two.folder.path().join(FILES[1]);
    let good = fs::read_to_string(&path).unwrap();
    for (text, why) in [
        ("name = ", "The settings are not valid TOML"),
        ("version = 9\n", "The settings have version 9, this program knows 1"),
    ] {
        fs::write(&path, text).unwrap();
        two.pick(NAMES[1]);
        two.until_it_says(why);
        assert!(says(&two.window, "Hill stays as it is."));
        two.window.key_press(Key::Enter);
        two.window.run_steps(3);
        assert!(!says(&two.window, why));
        assert_eq!(fs::read_to_string(&path).unwrap(), text, "it is left alone");
    }
    fs::write(&path, good).unwrap();
    let held = Handle::start(settings(&path), Clock::system(), std::sync::Arc::new(|| {})).unwrap();
    two.pick(NAMES[1]);
    two.until_it_says("It is open in another window of Azel (process ");
    two.window.key_press(Key::Enter);
    two.window.run_steps(3);
    drop(held);
    fs::remove_file(&path).unwrap();
    two.pick(NAMES[1]);
    two.until_it_says("The file is gone");
    two.window.key_press(Key::Enter);
    two.window.run_steps(3);
    assert_eq!(two.window.state().model().stations.stations.len(), 1, "it is not offered again");
    assert!(two.units[0].control.state().is_tracking, "it goes on");
    assert_eq!(two.window.state().model().station.name, NAMES[0]);
}

#[test]
fn the_demo_is_in_the_menu_of_a_station_and_a_new_station_gets_a_file_of_its_own() {
    let mut two = Two::open();
    two.pick("Demo station");
    step_until(&mut two.window, "the demo runs", |model| {
        model.demo && model.antennas.len() == 3 && !model.stations.is_changing
    });
    two.window.run_steps(3);
    assert_eq!(two.window.state().model().view, View::Operate);
    two.pick(NAMES[0]);
    two.wait_for(NAMES[0]);
    two.pick("New station…");
    step_until(&mut two.window, "the set-up opens", |model| {
        model.view == View::Setup && model.antennas.len() == 3
    });
    two.window.run_steps(3);
    for _ in 0..4 {
        press(&mut two.window, "Skip this step");
        two.window.run_steps(3);
    }
    press(&mut two.window, "Finish (Enter)");
    step_until(&mut two.window, "the station is saved", |model| !model.demo);
    assert!(two.folder.path().join("station-2.toml").exists());
    let known = &two.window.state().model().stations.stations;
    assert_eq!(known.len(), 3);
    assert!(known[0].path.ends_with("station-2.toml"));
}
