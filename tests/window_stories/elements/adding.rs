//! Elements that the operator adds, and those that Azel keeps for the next start.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::Arc,
};

use azel::{
    contract::{
        self, CatalogState,
        sources::{Copied, SourceWork},
    },
    controller::SPECS,
    library::save_sources,
    model::{Model, UiCommand, View, typed_path::OpenedFile},
    orbit::{RefreshHours, Source, SourcePlace},
    station,
};
use egui::{DroppedFile, DroppedFileHandle, Event, HoveredFile, Key, Modifiers, Role};
use egui_kittest::kittest::Queryable as _;

use super::{METEOR_M2_3, click, refresh, server, view};
use crate::{
    elements_library::{Server, ok},
    window_stories::{
        rig::{self, NOAA_20, asked, says, settle},
        unit::{Unit, clock_from, open, step_until},
    },
};

/// File that the operator holds over the window.
#[derive(Debug)]
struct Held(PathBuf);

impl DroppedFile for Held {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        fs::read(&self.0).map_err(|error| error.to_string())
    }
}

#[test]
fn a_held_file_says_what_it_holds_and_is_kept_or_read_once_after_its_release() {
    let folder = tempfile::tempdir().unwrap();
    let own = newer_elements(&folder);
    let notes = folder.path().join("notes.txt");
    fs::write(&notes, "hello\nworld\n").unwrap();
    for size in rig::sizes() {
        let mut window = view(size, Vec::new());
        let files = [own.clone(), notes.clone()];
        window.input_mut().hovered_files = files
            .iter()
            .map(|path| HoveredFile { path: Some(path.clone()), ..HoveredFile::default() })
            .collect();
        settle(&mut window);
        assert!(says(&window, "Release to read 2 files."));
        assert!(says(&window, "own.json: 1 object, 1 newer than in use"));
        assert!(says(&window, "notes.txt: Left out: it is neither TLE nor OMM."));
        assert!(window.query_by_label("Read once: own.json").is_none(), "nothing is chosen yet");
        // Move the file out of the window again.
        window.input_mut().hovered_files.clear();
        settle(&mut window);
        assert!(!says(&window, "Release to read"));
        window.input_mut().dropped_files =
            files.iter().map(|path| Arc::new(Held(path.clone())) as DroppedFileHandle).collect();
        settle(&mut window);
        assert!(says(&window, "What should be imported?"));
        assert!(window.query_by_label("Read once: notes.txt").is_none());
        assert_eq!(asked(&mut window), []);
        click(&mut window, "Keep as source: own.json");
        let place = SourcePlace::File(own.clone());
        let source = Source { name: "own".to_owned(), place, refresh: None };
        assert_eq!(asked(&mut window), [UiCommand::Station(contract::Command::AddSource(source))]);
        assert!(window.query_by_label("Keep as source: own.json").is_none(), "it is taken");
        click(&mut window, "Close");
        assert!(!says(&window, "What should be imported?"));
    }
}

#[test]
fn pasted_elements_are_told_with_their_refusals_and_taken_once() {
    for size in rig::sizes() {
        let mut window = view(size, Vec::new());
        let text = "[{\"OBJECT_NAME\":\"OBJECT M\"},{\"OBJECT_NAME\":\"NEW\",\"NORAD_CAT_ID\":999999,\
                    \"EPOCH\":\"2026-08-12T00:00:00\",\"MEAN_MOTION\":14.19,\"ECCENTRICITY\":0.0001,\
                    \"INCLINATION\":98.7,\"RA_OF_ASC_NODE\":0,\"ARG_OF_PERICENTER\":0,\
                    \"MEAN_ANOMALY\":0,\"BSTAR\":0}]";
        window.event(Event::Paste(text.to_owned()));
        settle(&mut window);
        assert!(says(&window, "pasted text: 1 object, 1 new, 1 refused"));
        assert!(says(&window, "line 1: OBJECT M: "));
        click(&mut window, "Read once: pasted text");
        let name = "pasted 12 Aug 11:15".to_owned();
        let from = Copied::Text(text.to_owned());
        let wanted = contract::Command::CopyElements { name, origin: from };
        assert_eq!(asked(&mut window), [UiCommand::Station(wanted)]);

        let mut window = view(size, Vec::new());
        window.event(Event::Paste("hello".to_owned()));
        settle(&mut window);
        assert!(says(&window, "None of these files holds elements"));
    }
}

#[test]
fn esc_closes_what_is_to_be_imported_after_what_is_open_above_it() {
    for size in rig::sizes() {
        let mut window = view(size, Vec::new());
        window.event(Event::Paste("hello".to_owned()));
        settle(&mut window);
        click(&mut window, "Add a source");
        for (is_form, is_card) in [(true, true), (false, true), (false, false)] {
            assert_eq!(window.query_by_label("Add source").is_some(), is_form);
            assert_eq!(says(&window, "None of these files holds elements"), is_card);
            window.key_press(Key::Escape);
            settle(&mut window);
        }
        assert_eq!(asked(&mut window), []);
    }
}

#[test]
fn files_are_chosen_by_a_key_and_in_the_form() {
    let mut window = view(rig::LARGE, vec![server(3.0)]);
    window.key_press_modifiers(Modifiers::COMMAND, Key::O);
    assert_eq!(asked(&mut window), [UiCommand::ChooseFile(OpenedFile::Elements)]);
    window.key_press_modifiers(Modifiers::COMMAND, Key::R);
    assert_eq!(asked(&mut window), [refresh(&["weather"], false)]);
    click(&mut window, "Add a source");
    click(&mut window, "Choose files…");
    assert_eq!(asked(&mut window), [UiCommand::ChooseFile(OpenedFile::Elements)]);
}

#[test]
fn enter_in_the_form_adds_the_source() {
    for size in rig::sizes() {
        let mut window = view(size, Vec::new());
        click(&mut window, "Add a source");
        for (field, words) in [("Name", "own"), ("Address", "https://example.org/own.json")] {
            window.get_by_role_and_label(Role::TextInput, field).focus();
            settle(&mut window);
            window.event(Event::Text(words.to_owned()));
            settle(&mut window);
        }
        window.key_press(Key::Enter);
        let place = SourcePlace::Web("https://example.org/own.json".to_owned());
        let source = Source { name: "own".to_owned(), place, refresh: None };
        assert_eq!(asked(&mut window), [UiCommand::Station(contract::Command::AddSource(source))]);
    }
}

/// Returns a time at which sets newer than the bundled ones are not in the future.
pub(super) fn week_later() -> jiff::Timestamp {
    rig::now() + jiff::SignedDuration::from_hours(7 * 24)
}

/// Writes elements of one object, a day newer than the bundled ones, to a file in `folder`. Returns
/// its path.
pub(super) fn newer_elements(folder: &tempfile::TempDir) -> PathBuf {
    let path = folder.path().join("own.json");
    let text = "[{\"OBJECT_NAME\":\"NOAA 20\",\"NORAD_CAT_ID\":43013,\
                \"EPOCH\":\"2026-08-14T00:00:00\",\"MEAN_MOTION\":14.19,\"ECCENTRICITY\":0.0001,\
                \"INCLINATION\":98.7,\"RA_OF_ASC_NODE\":0,\"ARG_OF_PERICENTER\":0,\
                \"MEAN_ANOMALY\":0,\"BSTAR\":0}]";
    fs::write(&path, text).unwrap();
    path
}

pub(super) fn epoch_of_noaa_20(model: &Model) -> Option<jiff::Timestamp> {
    match &model.catalog {
        CatalogState::Ready(catalog) => Some(catalog.get(NOAA_20)?.epoch()),
        CatalogState::Loading | CatalogState::Failed => None,
    }
}

#[test]
fn an_added_file_is_used_and_kept_for_the_next_start() {
    let folder = tempfile::tempdir().unwrap();
    let settings = folder.path().join("station.toml");
    let unit = Unit::start(week_later());
    station::save(&unit.station(), &settings, SPECS).unwrap();
    let path = newer_elements(&folder);
    let mut window = open(&settings, clock_from(week_later()));
    step_until(&mut window, "the elements", |model| epoch_of_noaa_20(model).is_some());
    window.key_press_modifiers(Modifiers::COMMAND, Key::Num3);
    step_until(&mut window, "the view", |model| model.view == View::Elements);
    window.step();
    window.get_by_role_and_label(Role::Button, "Add a source").click();
    window.run_steps(3);
    window.get_by_role_and_label(Role::RadioButton, "File").click();
    window.run_steps(2);
    for (field, words) in [("Name", "own"), ("Path", path.to_str().unwrap())] {
        window.get_by_role_and_label(Role::TextInput, field).focus();
        window.run_steps(2);
        window.event(Event::Text(words.to_owned()));
        window.run_steps(2);
    }
    window.get_by_role_and_label(Role::Button, "Add source").click();
    let is_used = |model: &Model| epoch_of_noaa_20(model) == "2026-08-14T00:00:00Z".parse().ok();
    step_until(&mut window, "the newer elements", is_used);
    drop(window);
    let mut window = open(&settings, clock_from(week_later()));
    step_until(&mut window, "the newer elements again", is_used);
    let kept = std::fs::read_dir(folder.path().join("elements")).unwrap();
    let mut kept: Vec<_> = kept.map(|file| file.unwrap().file_name()).collect();
    kept.sort();
    assert_eq!(kept, ["older-sets.gz", "reading.toml"], "no server was asked");
    let reading = std::fs::read(folder.path().join("elements/reading.toml")).unwrap();
    assert_eq!(reading, b"", "the reading came to its end");
}

#[test]
fn a_server_that_is_set_to_be_asked_is_asked_without_the_operator_and_once() {
    let folder = tempfile::tempdir().unwrap();
    let settings = folder.path().join("station.toml");
    let unit = Unit::start(week_later());
    station::save(&unit.station(), &settings, SPECS).unwrap();
    let text = fs::read_to_string(newer_elements(&folder)).unwrap();
    let server = Server::new(vec![ok("", &text), ok("", &text)]);
    let left_alone = server.source("alone");
    let asked = Source { refresh: Some(RefreshHours::from(6)), ..server.source("asked") };
    save_sources(&[left_alone, asked], &folder.path().join("sources.toml")).unwrap();
    let mut window = open(&settings, clock_from(week_later()));
    step_until(&mut window, "the newer elements", |model| {
        epoch_of_noaa_20(model) == "2026-08-14T00:00:00Z".parse().ok()
    });
    step_until(&mut window, "the end of the work", |model| {
        let sources = &model.sources;
        sources.work == SourceWork::Nothing && sources.reports[1].next_fetch.is_some()
    });
    let requests = server.requests();
    assert!(requests.len() == 1 && requests[0].contains("/asked"), "{requests:?}");
}

#[test]
fn a_followed_satellite_is_kept_in_the_station_file_and_listed() {
    let folder = tempfile::tempdir().unwrap();
    let settings = folder.path().join("station.toml");
    let unit = Unit::start(week_later());
    station::save(&unit.station(), &settings, SPECS).unwrap();
    let mut window = open(&settings, clock_from(week_later()));
    step_until(&mut window, "the elements", |model| epoch_of_noaa_20(model).is_some());
    window.key_press_modifiers(Modifiers::COMMAND, Key::Num3);
    step_until(&mut window, "the view", |model| model.view == View::Elements);
    window.step();
    window.key_press_modifiers(Modifiers::COMMAND, Key::F);
    window.run_steps(2);
    window.event(Event::Text("57166".to_owned()));
    step_until(&mut window, "the row", |model| {
        model.catalog_table.answer.as_ref().is_some_and(|answer| answer.rows.len() == 1)
    });
    window.run_steps(2);
    window.get_by_label_contains("Add METEOR").click();
    step_until(&mut window, "its passes", |model| {
        model.pass_lists.favourites.passes.iter().any(|pass| pass.number() == METEOR_M2_3)
    });
    assert!(station::load(&settings, SPECS).unwrap().station.favourites.contains(METEOR_M2_3));
}
