//! Passes and look angles saved to files for other programs.

use std::fs;

use azel::{
    app::App,
    contract::passes::PredictedPass,
    controller::SPECS,
    desktop::file_dialog::NoDialog,
    export::{EventFormat, ListFormat},
    model::{
        UiCommand,
        export::{Export, SavedFile},
        typed_path::{PathPurpose, PathRequest, TypedPath},
    },
    station,
};
use egui::{Event, Key, Modifiers, Role};
use egui_kittest::kittest::Queryable as _;

use crate::window_stories::{
    rig::{self, NOAA_20, SIZES, Window, asked, says, settle},
    states,
    unit::{Unit, clock_from, open_as, step_until, wait_until},
};

fn choose(window: &mut Window, form: &str) -> Vec<UiCommand> {
    asked(window);
    window.get_by_role_and_label(Role::Button, "Save passes to a file").click();
    settle(window);
    window.get_by_label(form).click();
    asked(window)
}

#[test]
fn the_listed_passes_and_the_selected_one_are_saved() {
    for size in SIZES {
        let model = rig::model(states::holding());
        let listed: Vec<_> = model.upcoming().iter().map(PredictedPass::key).collect();
        let of_noaa_20 = model.pass_of(NOAA_20).map(PredictedPass::key).unwrap();
        let mut window = rig::window(size, model);
        if size == rig::SMALL {
            window.get_by_label("Passes").click();
            settle(&mut window);
        }
        let saved = choose(&mut window, "Listed passes as iCalendar…");
        let wanted = Export::Passes { keys: listed.into(), format: EventFormat::Ics };
        assert_eq!(saved, [UiCommand::Save(wanted)]);
        let saved = choose(&mut window, "Az/el of the selected pass as CSV…");
        let wanted = Export::Looks { pass: of_noaa_20, format: ListFormat::Csv };
        assert_eq!(saved, [UiCommand::Save(wanted)]);
    }
}

#[test]
fn only_the_found_passes_are_saved_while_the_list_is_filtered() {
    let mut window = rig::window(rig::LARGE, rig::model(states::holding()));
    window.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::F);
    settle(&mut window);
    window.event(egui::Event::Text("43013".to_owned()));
    settle(&mut window);
    let saved = choose(&mut window, "Listed passes as CSV…");
    let [UiCommand::Save(Export::Passes { keys, .. })] = &saved[..] else { panic!("{saved:?}") };
    assert!(!keys.is_empty() && keys.iter().all(|(number, _)| *number == NOAA_20), "{keys:?}");
}

#[test]
fn without_a_dialog_of_the_desktop_the_path_is_typed() {
    let export = Export::HandOverSheet;
    let ask = |window: &mut Window, path: &str, replaces| {
        let purpose = PathPurpose::Save { export: export.clone(), replaces };
        let request = PathRequest { purpose, path: path.into(), reason: NoDialog.to_string() };
        window.state_mut().views.ask_for_path(request);
        settle(window);
    };
    let typed = |path: &str, replaces| {
        [UiCommand::SaveAs(export.clone(), TypedPath { path: path.into(), replaces })]
    };
    for size in SIZES {
        let mut window = rig::window(size, rig::model(states::holding()));
        ask(&mut window, "/home/op/sheet.html", false);
        assert!(says(&window, "This desktop shows no file dialogs"), "{size:?}");
        window.key_press(Key::Enter);
        assert_eq!(asked(&mut window), typed("/home/op/sheet.html", false));
        assert!(!says(&window, "This desktop shows no file dialogs"));
        // Another path does not replace a file.
        ask(&mut window, "/home/op/sheet.html", true);
        window.get_by_role_and_label(Role::Button, "Replace it (Enter)");
        window.event(Event::Text("2".to_owned()));
        settle(&mut window);
        window.get_by_role_and_label(Role::Button, "Save (Enter)").click();
        assert_eq!(asked(&mut window), typed("/home/op/sheet.html2", false));
        ask(&mut window, "/home/op/sheet.html", true);
        window.get_by_role_and_label(Role::Button, "Replace it (Enter)").click();
        assert_eq!(asked(&mut window), typed("/home/op/sheet.html", true));
        ask(&mut window, "/home/op/sheet.html", false);
        window.get_by_role_and_label(Role::Button, "Cancel").click();
        assert_eq!(asked(&mut window), []);
        assert!(!says(&window, "This desktop shows no file dialogs"));
    }
}

#[test]
fn a_desktop_without_dialogs_saves_to_the_typed_path() {
    let folder = tempfile::tempdir().unwrap();
    let settings = folder.path().join("station.toml");
    let unit = Unit::start(rig::now());
    station::save(&unit.station(), &settings, SPECS).unwrap();
    let mut window = open_as(&settings, clock_from(rig::now()), App::without_file_dialogs);
    step_until(&mut window, "the passes", |model| !model.upcoming().is_empty());
    window.run_steps(3);
    window.get_by_role_and_label(Role::Button, "Save passes to a file").click();
    window.run_steps(3);
    window.get_by_label("Listed passes as CSV…").click();
    wait_until("the path is asked for", || {
        window.step();
        window.query_by_role_and_label(Role::TextInput, "Path of the file").is_some()
    });
    let path = folder.path().join("own.csv");
    window.run_steps(3);
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.event(Event::Text(path.display().to_string()));
    window.run_steps(3);
    window.key_press(Key::Enter);
    wait_until("the file", || {
        window.step();
        path.exists()
    });
    assert!(fs::read_to_string(&path).unwrap().lines().count() > 1);
}

#[test]
fn what_came_of_it_is_told_over_the_views_until_it_is_closed() {
    let mut window = rig::window(rig::LARGE, rig::model(states::holding()));
    let tell = |window: &mut Window, result| {
        window.state_mut().views.file_saved(result);
        settle(window);
    };
    let saved = |path: &str, left_out| Ok(SavedFile { path: path.into(), left_out });
    tell(&mut window, saved("/home/operator/passes.csv", 0));
    assert!(says(&window, "Saved: /home/operator/passes.csv"));
    window.get_by_label("Close the note of the file").click();
    settle(&mut window);
    assert!(!says(&window, "Saved: "));
    tell(&mut window, saved("/home/operator/own.tle", 3));
    assert!(says(&window, "Saved without 3 objects that a TLE cannot hold: /home/"));
    tell(&mut window, Err("the disk is full".to_owned()));
    assert!(says(&window, "Nothing was saved: the disk is full."));
}
