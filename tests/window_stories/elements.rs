//! Sources of elements, and the catalogue.

use std::sync::Arc;

use std::{
    fs,
    path::{Path, PathBuf},
};

use azel::{
    astro::time::add_seconds,
    device::HeldSatellite,
    engine::{
        self, CatalogState,
        older_sets::OlderSets,
        sources::{Copied, SourceWork, Sources},
    },
    library::{OlderSet, save_sources},
    makes,
    model::{Model, UiCommand, View},
    orbit::{
        FetchProblem, FileReport, MergeSummary, RefreshHours, Refusal, RefusalReason, Source,
        SourcePlace, SourceReport, read_elements, write_omm_json,
    },
    station::{self, Frequency, Priority},
};
use egui::{DroppedFile, DroppedFileHandle, Event, HoveredFile, Key, Modifiers, Role};
use egui_kittest::{
    Node,
    kittest::{NodeT as _, Queryable as _},
};

use crate::elements_library::{Server, ok};
use crate::window_stories::{
    rig::{self, NOAA_20, SIZES, Window, asked, says, settle},
    states,
    unit::{Unit, clock_from, open, step_until},
};

const HOUR_S: f64 = 3600.0;
const METEOR_M2_3: u32 = 57_166;

pub(crate) fn file_source() -> Source {
    Source {
        name: "own".to_owned(),
        place: SourcePlace::File("/var/elements/own.tle".into()),
        refresh: None,
    }
}

/// Report of a source with this number of objects.
pub(crate) fn report(source: &Source, objects: usize) -> SourceReport {
    let path = PathBuf::from("/var/elements/own.tle");
    let file = FileReport { path, objects, merge: MergeSummary::default(), problem: None };
    SourceReport {
        source: source.name.clone(),
        files: vec![file],
        as_of: Some(add_seconds(rig::now(), -3.0 * HOUR_S)),
        newest_epoch: Some(add_seconds(rig::now(), -20.0 * HOUR_S)),
        fetch_problem: None,
        failures: 0,
        next_fetch: None,
        is_set_aside: false,
    }
}

/// A server whose last request was `hours_ago`.
pub(crate) fn server(hours_ago: f64) -> (Source, SourceReport) {
    let source = Source::celestrak("weather");
    let next = add_seconds(rig::now(), (2.0 - hours_ago) * HOUR_S);
    let report = SourceReport { next_fetch: Some(next), ..report(&source, 71) };
    (source, report)
}

pub(crate) fn view(size: [f32; 2], sources: Vec<(Source, SourceReport)>) -> Window {
    let mut model = rig::model(states::holding());
    model.view = View::Elements;
    let (list, reports) = sources.into_iter().unzip();
    model.sources = Arc::new(Sources { list, reports, ..Sources::default() });
    let mut window = rig::window(size, model);
    if size == rig::SMALL {
        // In a low window they are folded.
        sources_bar(&window).click();
        settle(&mut window);
    }
    window
}

fn sources_bar(window: &Window) -> Node<'_> {
    window.get_by(|node| {
        let label = node.label().unwrap_or_default();
        node.role() == Role::Button && label.contains(" source") && label.contains(": ")
    })
}

fn write(window: &mut Window, field: &str, words: &str) {
    window.get_by_role_and_label(Role::TextInput, field).focus();
    settle(window);
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.key_press(Key::Backspace);
    window.event(Event::Text(words.to_owned()));
    settle(window);
}

fn click(window: &mut Window, button: &str) {
    window.get_by_role_and_label(Role::Button, button).click();
    settle(window);
}

fn is_disabled(window: &Window, button: &str) -> bool {
    window.get_by_role_and_label(Role::Button, button).accesskit_node().is_disabled()
}

fn refresh(names: &[&str], forced: bool) -> UiCommand {
    let names = names.iter().map(|name| (*name).to_owned()).collect();
    UiCommand::Station(engine::Command::RefreshSources { names, forced })
}

#[test]
fn the_view_opens_from_rail_and_key() {
    for size in SIZES {
        let mut window = rig::window(size, rig::model(states::holding()));
        window.get_by_role_and_label(Role::Tab, "Elements").click();
        assert_eq!(asked(&mut window), [UiCommand::Show(View::Elements)]);
        window.key_press_modifiers(Modifiers::COMMAND, Key::Num3);
        assert_eq!(asked(&mut window), [UiCommand::Show(View::Elements)]);
    }
}

#[test]
fn a_source_says_what_it_holds_and_how_old_it_is() {
    for size in SIZES {
        let own = file_source();
        let held = report(&own, 12);
        let window = view(size, vec![(own, held), server(1.0)]);
        assert!(says(&window, "own, /var/elements/own.tle."));
        let held = "12 objects, newest epoch 2026-08-11, 20 h 0 min old. Changed 3 h 0 min ago.";
        assert!(says(&window, held));
        assert!(says(&window, "71 objects"));
        assert!(says(&window, "Asked 60 min ago. It may be asked again from 12:15:30Z."));
        assert!(says(&window, "16\u{2009}089 objects from 1 source."));
    }
}

#[test]
fn a_source_says_what_is_wrong_and_what_is_true_meanwhile() {
    for size in SIZES {
        let own = file_source();
        let mut lost = report(&own, 0);
        lost.files[0].problem = Some("No such file".to_owned());
        let (weather, mut silent) = server(1.0);
        silent.fetch_problem = Some(FetchProblem::Answer(403));
        let window = view(size, vec![(own, lost), (weather, silent)]);
        assert!(says(&window, "Cannot be read: No such file: /var/elements/own.tle."));
        assert!(says(&window, "The server answered 403. What was held stays."));
        let new = Source::celestrak("geo");
        let never = SourceReport { files: Vec::new(), ..report(&new, 0) };
        let window = view(size, vec![(new, never)]);
        assert!(says(&window, "Holds nothing yet."));
        let own = file_source();
        let aside = SourceReport { is_set_aside: true, files: Vec::new(), ..report(&own, 0) };
        let mut window = view(size, vec![(own, aside)]);
        assert!(says(&window, "Set aside: Azel ended while it read this source."));
        click(&mut window, "Read own again");
        assert_eq!(asked(&mut window), [refresh(&["own"], false)]);
    }
}

#[test]
fn a_server_is_asked_at_once_when_it_may_be_and_else_after_a_question() {
    for size in SIZES {
        let mut window = view(size, vec![server(3.0)]);
        click(&mut window, "Ask weather");
        assert_eq!(asked(&mut window), [refresh(&["weather"], false)]);

        let mut window = view(size, vec![server(0.5)]);
        click(&mut window, "Ask weather");
        assert_eq!(asked(&mut window), []);
        assert!(says(&window, "The server of weather was asked 30 min ago."));
        click(&mut window, "Cancel");
        assert_eq!(asked(&mut window), []);
        click(&mut window, "Ask weather");
        window.key_press(Key::Enter);
        assert_eq!(asked(&mut window), [refresh(&["weather"], true)]);
        click(&mut window, "Read again");
        assert_eq!(asked(&mut window), [refresh(&[], false)], "no server is due");

        let mut window = view(size, vec![server(3.0), (file_source(), report(&file_source(), 1))]);
        click(&mut window, "Refresh 1 due");
        assert_eq!(asked(&mut window), [refresh(&["weather"], false)], "never forced for all");
    }
}

#[test]
fn a_server_is_set_to_be_asked_by_itself() {
    for size in SIZES {
        let mut window = view(size, vec![server(1.0)]);
        let name = "Refresh of weather: Only when you ask";
        window.get_by_role_and_label(Role::ComboBox, name).click();
        settle(&mut window);
        window.get_by_label("Every 6 h").click();
        let hours = Some(RefreshHours::from(6));
        let wanted = engine::Command::SetRefresh { name: "weather".to_owned(), hours };
        assert_eq!(asked(&mut window), [UiCommand::Station(wanted)]);
        Arc::make_mut(&mut window.state_mut().model.sources).list[0].refresh = hours;
        settle(&mut window);
        window.get_by_role_and_label(Role::ComboBox, "Refresh of weather: Every 6 h");
    }
}

#[test]
fn a_source_is_removed_after_a_question() {
    for size in SIZES {
        let own = file_source();
        let held = report(&own, 12);
        let mut window = view(size, vec![(own, held)]);
        click(&mut window, "Read own again");
        assert_eq!(asked(&mut window), [refresh(&["own"], false)]);
        click(&mut window, "Remove own");
        assert_eq!(asked(&mut window), []);
        window.key_press(Key::Enter);
        assert_eq!(
            asked(&mut window),
            [UiCommand::Station(engine::Command::RemoveSource("own".to_owned()))]
        );
    }
}

#[test]
fn a_typed_source_is_added_once_it_is_right_and_stays_typed_until_it_is_there() {
    for size in SIZES {
        let mut window = view(size, Vec::new());
        assert!(is_disabled(&window, "Read again"));
        click(&mut window, "Add a source");
        assert!(is_disabled(&window, "Add source"));
        window.get_by_role_and_label(Role::RadioButton, "File").click();
        settle(&mut window);
        write(&mut window, "Name", "own");
        write(&mut window, "Path", "own.tle");
        assert!(says(&window, "Cannot be added: the path does not start at the root."));
        write(&mut window, "Path", "/var/elements/own.tle");
        window.get_by_role_and_label(Role::Button, "Add source").scroll_to_me();
        settle(&mut window);
        click(&mut window, "Add source");
        assert_eq!(
            asked(&mut window),
            [UiCommand::Station(engine::Command::AddSource(file_source()))]
        );
        let path = |window: &Window| {
            window.get_by_role_and_label(Role::TextInput, "Path").value().unwrap_or_default()
        };
        assert_eq!(path(&window), "/var/elements/own.tle", "it may not have been kept");
        Arc::make_mut(&mut window.state_mut().model.sources).list.push(file_source());
        settle(&mut window);
        assert_eq!(path(&window), "");
    }
}

#[test]
fn a_group_of_celestrak_is_filled_in_and_a_plain_address_is_refused() {
    for size in SIZES {
        let mut window = view(size, vec![server(3.0)]);
        click(&mut window, "Add a source");
        assert!(is_disabled(&window, "CelesTrak weather"), "it is there");
        write(&mut window, "Name", "x");
        write(&mut window, "Address", "http://celestrak.org/x");
        assert!(says(&window, "Cannot be added: the address is not a plain https address."));
        click(&mut window, "CelesTrak stations");
        window.get_by_role_and_label(Role::Button, "Add source").scroll_to_me();
        settle(&mut window);
        click(&mut window, "Add source");
        assert_eq!(
            asked(&mut window),
            [UiCommand::Station(engine::Command::AddSource(Source::celestrak("stations")))]
        );
    }
}

type Lock = fn(&mut Sources);

#[test]
fn nothing_is_taken_while_servers_are_asked_or_the_list_is_unreadable() {
    let locks: [(Lock, &str); 2] = [
        (|sources| sources.work = SourceWork::Asking, "The servers are being asked."),
        (
            |sources| {
                sources.is_locked = true;
                sources.problem = Some("the list cannot be read".to_owned());
            },
            "The list cannot be read.",
        ),
    ];
    for size in SIZES {
        for (lock, words) in locks {
            let mut window = view(size, vec![server(3.0)]);
            lock(Arc::make_mut(&mut window.state_mut().model.sources));
            settle(&mut window);
            assert!(says(&window, words));
            click(&mut window, "Add a source");
            for button in ["Ask weather", "Remove weather", "Refresh 1 due", "Add source"] {
                assert!(is_disabled(&window, button), "{button}");
            }
        }
    }
}

/// The names of the rows in view.
fn rows(window: &Window) -> Vec<String> {
    let rows = window.query_all_by_role(Role::ListBoxOption);
    let names = rows.map(|row| row.accesskit_node().label().unwrap_or_default());
    // Not those of the passes of the selected object.
    names.filter(|name| name.contains(", elements ")).collect()
}

#[test]
fn the_catalog_is_searched_by_name_number_and_designator() {
    for size in SIZES {
        let mut window = view(size, Vec::new());
        window.key_press_modifiers(Modifiers::COMMAND, Key::F);
        settle(&mut window);
        window.event(Event::Text("meteor-m2 3".to_owned()));
        settle(&mut window);
        assert_eq!(rows(&window).len(), 1);
        window.get_by_label_contains("METEOR-M2 3, 57166, elements ");
        write(&mut window, "Search the catalogue", "43013");
        window.get_by_label_contains("NOAA 20 (JPSS-1), 43013, elements ");
        write(&mut window, "Search the catalogue", "1998-067A");
        window.get_by_label_contains("ISS (ZARYA), 25544, ");
        write(&mut window, "Search the catalogue", "no such");
        assert!(says(&window, "No object matches \"no such\"."));
    }
}

#[test]
fn groups_choose_what_is_shown() {
    for size in SIZES {
        let mut window = view(size, Vec::new());
        let chip = |window: &mut Window, name: &str| {
            window.get_by_role_and_label(Role::RadioButton, name).click();
            settle(window);
        };
        chip(&mut window, "Favourites, 5");
        assert_eq!(rows(&window).len(), 5);
        write(&mut window, "Search the catalogue", "starlink");
        assert!(says(&window, "No object matches \"starlink\" here. Choose All"));
        chip(&mut window, "All, 16\u{2009}089");
        assert!(rows(&window).len() > 5);
    }
}

#[test]
fn a_click_on_a_head_sorts_and_the_next_one_turns_the_order() {
    for size in SIZES {
        let mut window = view(size, Vec::new());
        write(&mut window, "Search the catalogue", "meteor");
        click(&mut window, "Sort by number");
        let up = rows(&window);
        click(&mut window, "Sort by number, ascending");
        let mut down = rows(&window);
        down.reverse();
        assert!(up.len() > 2);
        assert_eq!(up, down);
        for column in ["epoch age", "next pass", "source", "maximum elevation", "priority"] {
            click(&mut window, &format!("Sort by {column}"));
            assert_eq!(rows(&window).len(), up.len(), "{column}");
        }
    }
}

#[test]
fn only_rows_in_view_are_built() {
    for size in SIZES {
        let window = view(size, Vec::new());
        assert!((5..40).contains(&rows(&window).len()), "{}", rows(&window).len());
    }
}

fn favour(number: u32, is_favourite: bool) -> UiCommand {
    let numbers = vec![number];
    UiCommand::Station(engine::Command::SetFavourites { numbers, is_favourite })
}

#[test]
fn satellites_are_followed_and_unfollowed_by_their_star() {
    for size in SIZES {
        let mut window = view(size, Vec::new());
        write(&mut window, "Search the catalogue", "57166");
        click(&mut window, "Add METEOR-M2 3 to the favourites");
        assert_eq!(asked(&mut window), [favour(METEOR_M2_3, true)]);
        write(&mut window, "Search the catalogue", "43013");
        click(&mut window, "Remove NOAA 20 (JPSS-1) from the favourites");
        assert_eq!(asked(&mut window), [favour(NOAA_20, false)]);
    }
}

#[test]
fn rows_are_marked_by_mouse_and_keys_and_changed_together() {
    for size in SIZES {
        let mut window = view(size, Vec::new());
        write(&mut window, "Search the catalogue", "meteor-m2");
        click(&mut window, "Sort by number");
        let count = rows(&window).len();
        assert!(count >= 3);
        let at = |window: &Window, index: usize| {
            let name = rows(window)[index].clone();
            window.get_by_role_and_label(Role::ListBoxOption, &name).rect().center()
        };
        let first = at(&window, 0);
        window.hover_at(first);
        window.drag_at(first);
        window.drop_at(first);
        settle(&mut window);
        window.key_press_modifiers(Modifiers::SHIFT, Key::ArrowDown);
        settle(&mut window);
        assert!(says(&window, "2 selected"));
        window.key_press(Key::ArrowDown);
        settle(&mut window);
        window.key_press(Key::Space);
        settle(&mut window);
        assert!(says(&window, "3 selected"));
        window.key_press(Key::Num1);
        let commands = asked(&mut window);
        let [UiCommand::Station(engine::Command::SetPriority { numbers, priority })] =
            &commands[..]
        else {
            panic!("{commands:?}");
        };
        assert_eq!((numbers.len(), priority.number()), (3, 1));
        window.key_press(Key::F);
        let commands = asked(&mut window);
        let is_of_all = |command: &UiCommand| {
            matches!(command, UiCommand::Station(engine::Command::SetFavourites { numbers, .. })
                if numbers.len() == 3)
        };
        assert!(commands.iter().all(is_of_all) && commands.len() == 1, "{commands:?}");
        click(&mut window, "Clear");
        assert!(!says(&window, "selected"));
        window.get_by_role_and_label(Role::ListBox, "Catalogue").focus();
        settle(&mut window);
        window.key_press_modifiers(Modifiers::COMMAND, Key::A);
        settle(&mut window);
        assert!(says(&window, &format!("{count} selected")));
    }
}

#[test]
fn the_selected_row_is_shown_in_detail_with_its_priority() {
    for size in SIZES {
        let mut window = view(size, Vec::new());
        if size == rig::SMALL {
            click(&mut window, "Details");
        }
        assert!(says(&window, "NOAA 20 (JPSS-1), 43013, 2017-073A"));
        assert!(says(&window, "Inclination: 98."));
        assert!(says(&window, "Priority 3"));
        click(&mut window, "More important");
        let numbers = vec![NOAA_20];
        let priority = Priority::ALL[1];
        let wanted = engine::Command::SetPriority { numbers, priority };
        assert_eq!(asked(&mut window), [UiCommand::Station(wanted)]);
    }
}

fn detail(window: &mut Window, size: [f32; 2]) {
    if size == rig::SMALL {
        click(window, "Details");
    }
}

#[test]
fn the_detail_says_what_each_antenna_holds() {
    for size in SIZES {
        let mut window = view(size, Vec::new());
        detail(&mut window, size);
        assert!(says(&window, "Satrak: Does not say what it holds."));
        let hold = |window: &mut Window, number: u32, name: &str| {
            let antenna = &mut window.state_mut().model.antennas[0];
            Arc::make_mut(&mut antenna.snapshot).state.on_board.satellite = Some(HeldSatellite {
                catalog_number: number,
                name: name.to_owned(),
                maximum_elevation_deg: None,
            });
            settle(window);
        };
        hold(&mut window, METEOR_M2_3, "METEOR-M2 3");
        assert!(says(&window, "Satrak: Holds another satellite, METEOR-M2 3."));
        hold(&mut window, NOAA_20, "NOAA 20");
        assert!(says(&window, "Satrak: Holds this satellite; it does not tell the epoch"));
        let model = &mut window.state_mut().model;
        let mut genius = station::Antenna::genius("Genius", "192.168.1.250:9006");
        genius.id = station::AntennaId(7);
        model.antennas.push(rig::antenna(genius, rig::quiet()));
        settle(&mut window);
        assert!(says(&window, "Genius: Azel tracks with it, same set."));
    }
}

#[test]
fn the_detail_lists_the_next_passes_and_opens_one_on_the_sky_plot() {
    for size in SIZES {
        let mut window = view(size, Vec::new());
        detail(&mut window, size);
        assert!(says(&window, "Next passes, max ≥ 10°"));
        let key = window.state().model.catalog_table.detail.as_ref().unwrap().passes[0].key();
        let passes: Vec<_> = window.query_all_by_label_contains("Pass at ").collect();
        assert_eq!(passes.len(), 3);
        passes[0].scroll_to_me();
        settle(&mut window);
        let passes: Vec<_> = window.query_all_by_label_contains("Pass at ").collect();
        passes[0].click();
        let wanted = [UiCommand::SelectPass(key), UiCommand::Show(View::Operate)];
        assert_eq!(asked(&mut window), wanted);
    }
}

#[test]
fn older_sets_stand_against_the_one_in_use() {
    for size in SIZES {
        let mut window = view(size, Vec::new());
        detail(&mut window, size);
        assert!(says(&window, "Sets held, against the one in use, at "));
        let model = &mut window.state_mut().model;
        let CatalogState::Ready(catalog) = &model.catalog else { unreachable!() };
        let mut text = Vec::new();
        write_omm_json([catalog.get(NOAA_20).unwrap()], &mut text).unwrap();
        let mut list: serde_json::Value = serde_json::from_slice(&text).unwrap();
        list[0]["EPOCH"] = "2026-08-10T02:04:00".into();
        let elements = read_elements(&list.to_string()).elements.remove(0);
        let sets = vec![OlderSet { elements, source: "weather".to_owned() }];
        let older = OlderSets { catalog_number: NOAA_20, sets };
        model.older_sets = Some(Arc::new(older));
        settle(&mut window);
        assert!(says(&window, "Set of 10 Aug 02:04 from weather: "));
    }
}

#[test]
fn frequencies_are_changed_beside_the_elements() {
    let mut window = view([1440.0, 1200.0], Vec::new());
    let own = Frequency::read_list("43013 7812 HRD").unwrap();
    Arc::make_mut(&mut window.state_mut().model.station).frequencies = own;
    settle(&mut window);
    assert!(says(&window, "7812.000 MHz HRD"));
    click(&mut window, "Edit frequencies");
    let field = "Frequencies, one a line";
    window.get_by_role_and_label(Role::MultilineTextInput, field).focus();
    settle(&mut window);
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.event(Event::Text("x".to_owned()));
    settle(&mut window);
    assert!(is_disabled(&window, "Save frequencies"));
    assert!(says(&window, "Each line must be MHz and a name"));
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.event(Event::Text("7812 HRD, X band".to_owned()));
    settle(&mut window);
    click(&mut window, "Save frequencies");
    let frequencies = Frequency::read_list("43013 7812 HRD, X band").unwrap();
    let wanted = engine::Command::SetFrequencies { satellite: NOAA_20, frequencies };
    assert_eq!(asked(&mut window), [UiCommand::Station(wanted)]);
    assert!(!says(&window, "Each line must be"));
}

#[test]
fn the_elements_are_copied_as_tle_and_omm() {
    for size in SIZES {
        let mut window = view(size, Vec::new());
        detail(&mut window, size);
        for (button, start) in
            [("TLE", "NOAA 20 (JPSS-1)\n1 43013U"), ("OMM", "[\n{\"OBJECT_NAME\"")]
        {
            window.get_by_role_and_label(Role::Button, button).click();
            window.step();
            let copied = copied(&window);
            assert!(copied.starts_with(start), "{button}: {copied}");
        }
    }
}

/// The text that was copied in the last frame.
fn copied(window: &Window) -> String {
    let commands = &window.output().platform_output.commands;
    let text = commands.iter().find_map(|command| match command {
        egui::OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    });
    text.unwrap_or_default()
}

#[test]
fn refused_records_have_their_place_and_reason() {
    for size in SIZES {
        let own = file_source();
        let mut held = report(&own, 12);
        held.files[0].merge.refused = vec![Refusal {
            line: 1207,
            object: Some("OBJECT M".to_owned()),
            reason: RefusalReason::Checksum { line: 2, found: 7, expected: 4 },
        }];
        let mut window = view(size, vec![(own, held)]);
        assert!(!says(&window, "own, line 1207"));
        window.get_by_label_contains("1 refused record. What was held before stays").click();
        settle(&mut window);
        let words = "own, line 1207, OBJECT M: The checksum of line 2 is 7, the line gives 4.";
        assert!(says(&window, words));
    }
}

#[test]
fn what_is_typed_in_the_preferences_is_not_overtaken() {
    let mut window = view(rig::LARGE, Vec::new());
    window.state_mut().model.view = View::Preferences;
    settle(&mut window);
    write(&mut window, "Latitude", "1");
    window.state_mut().model.view = View::Elements;
    settle(&mut window);
    write(&mut window, "Search the catalogue", "43013");
    assert!(is_disabled(&window, "Remove NOAA 20 (JPSS-1) from the favourites"));
    window.get_by_role_and_label(Role::CheckBox, "Mark all that are shown").click();
    settle(&mut window);
    assert!(says(&window, "Save or revert the preferences before the favourites change."));
}

#[test]
fn without_elements_there_is_still_a_way_to_add_some() {
    for size in SIZES {
        let mut window = view(size, Vec::new());
        window.state_mut().model.catalog = CatalogState::Failed;
        settle(&mut window);
        assert!(says(&window, "There are no elements."));
        assert!(says(&window, "There is nothing to search."));
        click(&mut window, "Add a source");
        click(&mut window, "CelesTrak active");
        assert!(!is_disabled(&window, "Add source"));
    }
}

#[test]
fn every_control_is_whole_in_every_window() {
    for size in [rig::LARGE, [1200.0, 800.0], rig::SMALL] {
        let window = view(size, vec![server(3.0)]);
        for role in [Role::Button, Role::TextInput, Role::RadioButton, Role::CheckBox] {
            for node in window.query_all_by_role(role) {
                let name = node.accesskit_node().label().unwrap_or_default();
                // The last row may be cut.
                let is_of_row = name.ends_with("favourites") || name.starts_with("Mark ");
                let most = if is_of_row { size[1] + 50.0 } else { size[1] };
                let rect = node.rect();
                assert!(rect.right() <= size[0] && rect.bottom() <= most, "{name} {rect}");
            }
        }
    }
}

/// A file in the hand of the operator.
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
    for size in SIZES {
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
        // Moved out of the window again.
        window.input_mut().hovered_files.clear();
        settle(&mut window);
        assert!(!says(&window, "Release to read"));
        window.input_mut().dropped_files =
            files.iter().map(|path| Arc::new(Held(path.clone())) as DroppedFileHandle).collect();
        settle(&mut window);
        assert!(says(&window, "What shall be taken?"));
        assert!(window.query_by_label("Read once: notes.txt").is_none());
        assert_eq!(asked(&mut window), []);
        click(&mut window, "Keep as source: own.json");
        let place = SourcePlace::File(own.clone());
        let source = Source { name: "own".to_owned(), place, refresh: None };
        assert_eq!(asked(&mut window), [UiCommand::Station(engine::Command::AddSource(source))]);
        assert!(window.query_by_label("Keep as source: own.json").is_none(), "it is taken");
        click(&mut window, "Close");
        assert!(!says(&window, "What shall be taken?"));
    }
}

#[test]
fn pasted_elements_are_told_with_their_refusals_and_taken_once() {
    for size in SIZES {
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
        let wanted = engine::Command::CopyElements { name, from };
        assert_eq!(asked(&mut window), [UiCommand::Station(wanted)]);

        let mut window = view(size, Vec::new());
        window.event(Event::Paste("hello".to_owned()));
        settle(&mut window);
        assert!(says(&window, "None of these holds elements"));
    }
}

#[test]
fn files_are_chosen_by_a_key_and_in_the_form() {
    let mut window = view(rig::LARGE, vec![server(3.0)]);
    window.key_press_modifiers(Modifiers::COMMAND, Key::O);
    assert_eq!(asked(&mut window), [UiCommand::ChooseElementFiles]);
    window.key_press_modifiers(Modifiers::COMMAND, Key::R);
    assert_eq!(asked(&mut window), [refresh(&["weather"], false)]);
    click(&mut window, "Add a source");
    click(&mut window, "Choose files…");
    assert_eq!(asked(&mut window), [UiCommand::ChooseElementFiles]);
}

/// Elements of one object as a file in `folder`, a day newer than the bundled ones.
fn newer_elements(folder: &tempfile::TempDir) -> PathBuf {
    let path = folder.path().join("own.json");
    let text = "[{\"OBJECT_NAME\":\"NOAA 20\",\"NORAD_CAT_ID\":43013,\
                \"EPOCH\":\"2026-08-14T00:00:00\",\"MEAN_MOTION\":14.19,\"ECCENTRICITY\":0.0001,\
                \"INCLINATION\":98.7,\"RA_OF_ASC_NODE\":0,\"ARG_OF_PERICENTER\":0,\
                \"MEAN_ANOMALY\":0,\"BSTAR\":0}]";
    fs::write(&path, text).unwrap();
    path
}

fn epoch_of_noaa_20(model: &Model) -> Option<jiff::Timestamp> {
    match &model.catalog {
        CatalogState::Ready(catalog) => Some(catalog.get(NOAA_20)?.epoch()),
        CatalogState::Loading | CatalogState::Failed => None,
    }
}

#[test]
fn an_added_file_is_used_and_kept_for_the_next_start() {
    let folder = tempfile::tempdir().unwrap();
    let settings = folder.path().join("station.toml");
    let unit = Unit::start(rig::now());
    station::save(&unit.station(), &settings).unwrap();
    let path = newer_elements(&folder);
    let mut window = open(&settings, clock_from(rig::now()));
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
    let mut window = open(&settings, clock_from(rig::now()));
    step_until(&mut window, "the newer elements again", is_used);
    let kept = std::fs::read_dir(folder.path().join("elements")).unwrap();
    let kept: Vec<_> = kept.map(|file| file.unwrap().file_name()).collect();
    assert_eq!(kept, ["older-sets.gz"], "no server was asked, and the reading came to its end");
}

#[test]
fn a_server_that_is_set_to_be_asked_is_asked_without_the_operator_and_once() {
    let folder = tempfile::tempdir().unwrap();
    let settings = folder.path().join("station.toml");
    let unit = Unit::start(rig::now());
    station::save(&unit.station(), &settings).unwrap();
    let text = fs::read_to_string(newer_elements(&folder)).unwrap();
    let server = Server::new(vec![ok("", &text), ok("", &text)]);
    let left_alone = server.source("alone");
    let asked = Source { refresh: Some(RefreshHours::from(6)), ..server.source("asked") };
    save_sources(&[left_alone, asked], &folder.path().join("sources.toml")).unwrap();
    let mut window = open(&settings, clock_from(rig::now()));
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
    let unit = Unit::start(rig::now());
    station::save(&unit.station(), &settings).unwrap();
    let mut window = open(&settings, clock_from(rig::now()));
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
    assert!(
        station::load(&settings, makes::SPECS).unwrap().station.favourites.contains(METEOR_M2_3)
    );
}

#[test]
fn a_favourite_without_a_pass_is_there_to_be_uploaded() {
    let mut model = rig::model(states::holding());
    model.view = View::Elements;
    model.selected = None;
    let window = rig::window(rig::LARGE, model);
    assert!(!says(&window, "Click a satellite in the table"));
    assert!(window.query_by_label("Upload to Satrak").is_some());
}
