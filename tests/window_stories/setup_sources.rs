//! Step of the set-up about the elements: Azel adds a typed source, or says why not.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use azel::{
    contract,
    contract::sources::SourceWork,
    model::UiCommand,
    orbit::{Source, SourcePlace},
};
use egui::{Key, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    preferences::write,
    rig::{self, SIZES, Window, asked, says, settle},
    setup::{self, NEXT, press, write_site},
};

/// Returns the set-up at the step about the elements, with the form of a file.
fn at_elements(size: [f32; 2]) -> Window {
    let mut window = setup::window(size);
    write_site(&mut window);
    for next in NEXT.into_iter().take(3) {
        press(&mut window, next);
    }
    window.get_by_role_and_label(Role::RadioButton, "File").click();
    settle(&mut window);
    window
}

fn fill(window: &mut Window, name: &str, path: &str) {
    write(window, "Name", name);
    write(window, "Path", path);
}

fn file(name: &str, path: &str) -> Source {
    Source { name: name.to_owned(), place: SourcePlace::File(PathBuf::from(path)), refresh: None }
}

fn addition(source: Source) -> UiCommand {
    UiCommand::Station(contract::Command::AddSource(source))
}

fn is_at(window: &Window, step: &str) -> bool {
    window.query_by_role_and_label(Role::Heading, step).is_some()
}

fn text(window: &Window, field: &str) -> String {
    window.get_by_role_and_label(Role::TextInput, field).value().unwrap_or_default()
}

fn press_enter(window: &mut Window) {
    window.key_press(Key::Enter);
    settle(window);
}

#[cfg(unix)]
const PATH: &str = "/srv/own.json";
#[cfg(windows)]
const PATH: &str = "C:\\own.json";

#[test]
fn enter_adds_the_typed_source_and_the_next_enter_goes_on() {
    for size in SIZES {
        let mut window = at_elements(size);
        fill(&mut window, "own", PATH);
        assert!(says(&window, "Enter adds the source. Press Enter again to continue."), "{size:?}");
        press_enter(&mut window);
        assert_eq!(asked(&mut window), [addition(file("own", PATH))], "{size:?}");
        assert!(is_at(&window, "Elements"), "{size:?}");
        // The server of another source may answer slowly.
        let sources = Arc::make_mut(&mut window.state_mut().model.shown_mut().sources);
        sources.work = SourceWork::Asking;
        settle(&mut window);
        press_enter(&mut window);
        assert!(is_at(&window, "Check and finish"), "{size:?}");
        assert_eq!(asked(&mut window), [], "{size:?}");
    }
}

#[test]
fn next_adds_the_typed_source() {
    for size in rig::sizes() {
        let mut window = at_elements(size);
        fill(&mut window, "own", PATH);
        press(&mut window, NEXT[3]);
        assert_eq!(asked(&mut window), [addition(file("own", PATH))]);
        assert!(is_at(&window, "Check and finish"));
        Arc::make_mut(&mut window.state_mut().model.shown_mut().sources)
            .list
            .push(file("own", PATH));
        settle(&mut window);
        press(&mut window, "Back");
        assert_eq!(text(&window, "Name"), "", "it is in the list");
    }
}

fn tab(window: &Window, step: &str) -> String {
    let tabs = window.get_all_by_role(Role::Tab);
    let names = tabs.filter_map(|tab| tab.accesskit_node().label());
    names.into_iter().find(|name| name.contains(&format!(": {step},"))).unwrap()
}

fn choose(window: &mut Window, step: &str) {
    let name = tab(window, step);
    window.get_by_role_and_label(Role::Tab, &name).click();
    settle(window);
}

#[test]
fn a_click_on_another_step_adds_the_typed_source() {
    for size in rig::sizes() {
        let mut window = at_elements(size);
        choose(&mut window, "Satellites");
        assert_eq!(asked(&mut window), [], "nothing is typed");
        choose(&mut window, "Elements");
        fill(&mut window, "own", PATH);
        choose(&mut window, "Site");
        assert_eq!(asked(&mut window), [addition(file("own", PATH))], "{size:?}");
        assert!(is_at(&window, "Site") && tab(&window, "Elements").contains(", done,"));
    }
}

#[test]
fn a_click_on_another_step_keeps_a_source_that_cannot_be_added() {
    for size in SIZES {
        let mut window = at_elements(size);
        write(&mut window, "Path", "own.json");
        let name = tab(&window, "Site");
        let site = window.get_by_role_and_label(Role::Tab, &name);
        assert!(site.accesskit_node().is_disabled(), "{size:?}");
        choose(&mut window, "Site");
        assert!(is_at(&window, "Elements"), "{size:?}");
        assert!(says(&window, "This source is not added yet: type the whole path"), "{size:?}");
        assert_eq!(asked(&mut window), [], "{size:?}");
        // The operator can go back, and the form keeps the typed text.
        press(&mut window, "Back");
        press(&mut window, NEXT[2]);
        assert_eq!(text(&window, "Path"), "own.json", "{size:?}");
    }
}

#[test]
fn a_skipped_source_stays_typed_and_the_end_says_so() {
    let words = "A source is typed but not added, and Finish drops it.";
    for size in SIZES {
        let mut window = at_elements(size);
        fill(&mut window, "own", PATH);
        press(&mut window, "Skip this step");
        assert!(is_at(&window, "Check and finish") && says(&window, words), "{size:?}");
        assert_eq!(asked(&mut window), [], "{size:?}");
        press(&mut window, "Back");
        assert_eq!((text(&window, "Name"), text(&window, "Path")), ("own".into(), PATH.into()));
        press(&mut window, NEXT[3]);
        assert_eq!(asked(&mut window), [addition(file("own", PATH))], "{size:?}");
        assert!(!says(&window, words), "{size:?}");
    }
}

#[test]
fn a_source_without_a_typed_name_has_that_of_its_file() {
    for size in SIZES {
        let mut window = at_elements(size);
        write(&mut window, "Path", PATH);
        press_enter(&mut window);
        let name = Path::new(PATH).file_stem().unwrap().to_str().unwrap();
        assert_eq!(asked(&mut window), [addition(file(name, PATH))], "{size:?}");
    }
}

#[test]
fn a_source_that_cannot_be_added_keeps_the_step_and_says_why() {
    for size in SIZES {
        let mut window = at_elements(size);
        let is_kept = |window: &mut Window, why: &str| {
            press_enter(window);
            let next = window.get_by_role_and_label(Role::Button, NEXT[3]);
            let is_locked = next.accesskit_node().is_disabled();
            assert!(is_locked && is_at(window, "Elements"), "{size:?} {why}");
            assert!(says(window, why), "{size:?} {why}");
            assert_eq!(asked(window), [], "{size:?} {why}");
        };
        fill(&mut window, "own", "own.json");
        is_kept(
            &mut window,
            "This source is not added yet: type the whole path, from the root or the drive on.",
        );
        fill(&mut window, "own", PATH);
        Arc::make_mut(&mut window.state_mut().model.shown_mut().sources).work = SourceWork::Reading;
        settle(&mut window);
        is_kept(
            &mut window,
            "This source is not added yet: wait until the other sources are read.",
        );
        assert_eq!(text(&window, "Name"), "own");
        // Empty fields do not block the next step.
        for field in ["Name", "Path"] {
            write(&mut window, field, "x");
            window.key_press(Key::Backspace);
            settle(&mut window);
        }
        press_enter(&mut window);
        assert!(is_at(&window, "Check and finish"), "{size:?}");
    }
}

#[test]
fn the_search_says_that_the_first_enter_adds_and_the_second_goes_on() {
    for size in SIZES {
        let mut window = setup::window(size);
        write_site(&mut window);
        press(&mut window, NEXT[0]);
        press(&mut window, NEXT[1]);
        press(&mut window, "Remove all");
        write(&mut window, "Search the catalogue", "25544");
        assert!(says(&window, "Enter adds the first. Press Enter again to continue."), "{size:?}");
        press_enter(&mut window);
        assert!(says(&window, "1 chosen") && is_at(&window, "Satellites"), "{size:?}");
        press_enter(&mut window);
        assert!(is_at(&window, "Elements"), "{size:?}");
    }
}
