//! Files that open by a typed path, because the desktop shows no dialogs.

use std::{fs, path::Path};

use azel::{
    app::App,
    controller::SPECS,
    desktop::file_dialog::NoDialog,
    model::{
        UiCommand, View,
        intake::Offer,
        typed_path::{OpenedFile, PathPurpose, PathRequest},
    },
    station::{self, Station},
};
use egui::{Event, Key, Modifiers, Role};
use egui_kittest::kittest::Queryable as _;

use crate::window_stories::{
    rig::{self, SIZES, Window, asked, says, settle},
    settings_rig, states,
    unit::{RealWindow, clock_from, open_as, step_until, wait_until},
};

#[test]
fn without_a_dialog_of_the_desktop_the_path_of_a_file_to_open_is_typed() {
    let ask = |window: &mut Window, file| {
        let (purpose, path) = (PathPurpose::Open(file), "/home/op/".into());
        let request = PathRequest { purpose, path, reason: NoDialog.to_string() };
        window.state_mut().views.ask_for_path(request);
        settle(window);
    };
    for size in SIZES {
        let mut window = rig::window(size, rig::model(states::holding()));
        for (file, title) in [
            (OpenedFile::Station, "Open a station file"),
            (OpenedFile::Elements, "Open a file of elements"),
        ] {
            ask(&mut window, file);
            assert!(says(&window, title) && says(&window, "This desktop shows no file dialogs"));
            let can_be_dropped = file == OpenedFile::Elements;
            assert_eq!(says(&window, "Files can also be dropped"), can_be_dropped, "{size:?}");
            window.event(Event::Text("own".to_owned()));
            settle(&mut window);
            window.key_press(Key::Enter);
            assert_eq!(asked(&mut window), [UiCommand::OpenFile(file, "/home/op/own".into())]);
            assert!(!says(&window, title), "{size:?}");
            ask(&mut window, file);
            window.get_by_role_and_label(Role::Button, "Open (Enter)").click();
            assert_eq!(asked(&mut window), [UiCommand::OpenFile(file, "/home/op/".into())]);
            ask(&mut window, file);
            window.key_press(Key::Escape);
            assert_eq!(asked(&mut window), [], "{size:?}");
            assert!(!says(&window, title), "{size:?}");
        }
    }
}

/// Types `path` once Azel asks for the path.
fn type_path(window: &mut RealWindow, path: &Path) {
    wait_until("the path is asked for", || {
        window.step();
        window.query_by_role_and_label(Role::TextInput, "Path of the file").is_some()
    });
    window.run_steps(3);
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.event(Event::Text(path.display().to_string()));
    window.run_steps(3);
    window.key_press(Key::Enter);
}

fn save(path: &Path, name: &str) {
    let station = Station { name: name.to_owned(), antennas: Vec::new(), ..rig::station() };
    station::save(&station, path, SPECS).unwrap();
}

#[test]
fn a_desktop_without_dialogs_opens_the_station_and_the_elements_of_a_typed_path() {
    let folder = tempfile::tempdir().unwrap();
    let [hill, field] = ["hill.toml", "field.toml"].map(|name| folder.path().join(name));
    save(&hill, "Hill");
    save(&field, "Field");
    let mut window = open_as(&hill, clock_from(rig::now()), App::without_file_dialogs);
    step_until(&mut window, "the station", |model| model.station.name == "Hill");
    window.run_steps(3);
    window.get_by_label("Station Hill").click();
    window.run_steps(3);
    window.get_by_role_and_label(Role::Button, "Open…").click();
    let missing = folder.path().join("missing.toml");
    type_path(&mut window, &missing);
    wait_until("the path is asked for again", || {
        window.step();
        settings_rig::says(&window, "There is no such file.")
    });
    type_path(&mut window, &field);
    step_until(&mut window, "the other station", |model| {
        model.station.name == "Field" && !model.stations.is_changing
    });
    window.run_steps(3);
    window.get_by_role_and_label(Role::Tab, "Elements").click();
    step_until(&mut window, "the elements", |model| model.view == View::Elements);
    window.run_steps(3);
    window.key_press_modifiers(Modifiers::COMMAND, Key::O);
    let elements = folder.path().join("own.tle");
    fs::write(&elements, "no elements").unwrap();
    type_path(&mut window, &elements);
    step_until(&mut window, "the file", |model| {
        let intake = model.intake.as_ref();
        intake.is_some_and(|intake| intake.offers == [Offer::File(elements.clone())])
    });
}
