//! Copies of a real unit's settings: Azel saves, compares and takes them over, and saves one before
//! every service change.

use std::fs;

use egui::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    settings_rig::{apply, press, says, state_of, write},
    settings_unit::{Scene, ask},
    unit::{step_until, wait_until},
};

/// Returns the texts of the saved copies.
fn copies(scene: &Scene) -> Vec<String> {
    let entries = fs::read_dir(scene.folder.path().join("settings-copies"));
    let paths = entries.into_iter().flatten().map(|entry| entry.unwrap().path());
    paths.map(|path| fs::read_to_string(path).unwrap()).collect()
}

#[test]
fn a_copy_tells_what_has_changed_since_and_gives_it_back() {
    let mut scene = Scene::open();
    let control = scene.unit.control.clone();
    let before = ask(&control, "SETTINGS?");
    press(&mut scene.window, "Save copy");
    scene.until_said("Saved as ");
    let [copy] = copies(&scene).try_into().unwrap();
    assert!(copy.contains("minimum_elevation_deg = 3.0"), "{copy}");

    assert!(ask(&control, "SETTINGS=,?,?,?,?,?,?,7.5,?,?,4.0,?").contains(",ERR"));
    assert!(ask(&control, "SETTINGS=,?,?,?,?,?,?,7.5,?,?,?,4.0").contains(",OK"));
    press(&mut scene.window, "Read again");
    step_until(&mut scene.window, "the new value is read", |model| {
        let held = &model.antennas[0].snapshot.state.groups["general"].last_read;
        let value = &held.as_ref().unwrap().values["elevation_threshold_deg"];
        *value == azel::device::settings::Value::Decimal(4.0)
    });
    press(&mut scene.window, "Compare with file");
    wait_until("the copy is listed", || {
        scene.window.step();
        let links = scene.window.query_all_by_role(Role::Link);
        links.into_iter().any(|link| link.accesskit_node().label().is_some())
    });
    scene.window.get_by_role(Role::Link).click_accesskit();
    scene.until_said("In the file");
    assert!(says(&scene.window, "Copy of Satrak at "));
    for name in ["General, Minimum elevation", "General, Elevation threshold"] {
        scene.window.get_by_role_and_label(Role::CheckBox, name).click_accesskit();
        scene.window.run_steps(2);
    }
    press(&mut scene.window, "Copy 2 to the form");
    scene.window.run_steps(2);
    assert_eq!(state_of(&scene.window, "Minimum elevation"), "Edited");
    scene.apply_until("Elevation threshold", "Verified");
    assert_eq!(ask(&control, "SETTINGS?"), before);

    press(&mut scene.window, "Compare with file");
    wait_until("the copy is listed", || {
        scene.window.step();
        scene.window.query_by_role(Role::Link).is_some()
    });
    scene.window.get_by_role(Role::Link).click_accesskit();
    scene.until_said("The unit already holds every value in the file.");
}

#[test]
fn another_file_is_refused_with_the_reason() {
    let mut scene = Scene::open();
    let path = scene.folder.path().join("notes.txt");
    fs::write(&path, "[[").unwrap();
    press(&mut scene.window, "Compare with file");
    scene.window.run_steps(2);
    scene.window.get_by_label("Path").focus();
    scene.window.run_steps(1);
    scene.window.get_by_label("Path").type_text(path.to_str().unwrap());
    scene.window.run_steps(2);
    press(&mut scene.window, "Read");
    scene.until_said("it is not TOML");
}

#[test]
fn a_service_setting_waits_for_the_copy() {
    let mut scene = Scene::open();
    scene.open_service();
    write(&mut scene.window, "X reduction", "4100");
    scene.apply_until("X reduction", "Verified");
    let [copy] = copies(&scene).try_into().unwrap();
    assert!(copy.contains("[reduction]\nx = 4000.0"), "{copy}");
}

#[test]
fn without_the_copy_no_service_setting_is_sent() {
    let mut scene = Scene::open();
    // A file with the name of the folder prevents Azel from saving the copy.
    fs::write(scene.folder.path().join("settings-copies"), "").unwrap();
    scene.open_service();
    let before = ask(&scene.unit.control, "REDUCTION?");
    write(&mut scene.window, "X reduction", "4100");
    apply(&mut scene.window);
    step_until(&mut scene.window, "an alarm", |model| {
        model
            .alarms
            .list()
            .iter()
            .any(|alarm| format!("{:?}", alarm.kind).contains("no service setting was sent"))
    });
    assert_eq!(ask(&scene.unit.control, "REDUCTION?"), before);
    assert!(scene.unit.control.received().iter().all(|(_, it)| !it.starts_with("REDUCTION=")));
}
