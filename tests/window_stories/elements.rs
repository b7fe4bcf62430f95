//! Sources of elements, and the catalogue.

mod adding;
mod catalogue;
mod detail;
mod sets;

use std::{path::PathBuf, sync::Arc};

use azel::{
    astro::time::add_seconds,
    contract,
    contract::sources::{SourceWork, Sources},
    model::{UiCommand, View},
    orbit::{
        FetchProblem, FileReport, MergeSummary, RefreshHours, RequestLimit, Source, SourcePlace,
        SourceReport,
    },
    secret::Secret,
};
use egui::{Event, Key, Modifiers, Role};
use egui_kittest::{
    Node,
    kittest::{NodeT as _, Queryable as _},
};
use jiff::SignedDuration;

use crate::window_stories::{
    rig::{self, Window, asked, says, settle},
    states,
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

/// Returns the report of a source with this number of objects.
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
        limits: Vec::new(),
        is_set_aside: false,
        newer_elsewhere: 0,
    }
}

/// Returns a server whose last request was `hours_ago`, and its report.
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
    model.shown_mut().sources = Arc::new(Sources { list, reports, ..Sources::default() });
    let mut window = rig::window(size, model);
    if size == rig::SMALL {
        // A low window folds the sources.
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
    UiCommand::Station(contract::Command::RefreshSources { names, forced })
}

#[test]
fn a_source_says_at_its_row_how_many_newer_sets_are_elsewhere() {
    for size in rig::SIZES {
        let source = file_source();
        let report = SourceReport { newer_elsewhere: 12, ..report(&source, 30) };
        let window = view(size, vec![(source, report)]);
        assert!(says(&window, "Other sources have newer elements for 12 of 30."), "{size:?}");
    }
}

#[test]
fn the_view_opens_from_rail_and_key() {
    for size in rig::sizes() {
        let mut window = rig::window(size, rig::model(states::holding()));
        window.get_by_role_and_label(Role::Tab, "Elements").click();
        assert_eq!(asked(&mut window), [UiCommand::Show(View::Elements)]);
        window.key_press_modifiers(Modifiers::COMMAND, Key::Num3);
        assert_eq!(asked(&mut window), [UiCommand::Show(View::Elements)]);
    }
}

#[test]
fn a_source_says_what_it_holds_and_how_old_it_is() {
    for size in rig::sizes() {
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
    for size in rig::sizes() {
        let own = file_source();
        let mut lost = report(&own, 0);
        lost.files[0].problem = Some("No such file".to_owned());
        let (weather, mut silent) = server(1.0);
        silent.fetch_problem = Some(FetchProblem::Answer(403));
        let window = view(size, vec![(own, lost), (weather, silent)]);
        assert!(says(&window, "Cannot be read: No such file: /var/elements/own.tle."));
        assert!(says(&window, "The server answered 403. The previous elements stay in use."));
        let new = Source::celestrak("geo");
        let never = SourceReport { files: Vec::new(), ..report(&new, 0) };
        let window = view(size, vec![(new, never)]);
        assert!(says(&window, "Holds nothing yet."));
        let own = file_source();
        let aside = SourceReport { is_set_aside: true, files: Vec::new(), ..report(&own, 0) };
        let mut window = view(size, vec![(own, aside)]);
        assert!(says(&window, "Set aside: Azel ended while reading this source."));
        click(&mut window, "Read own again");
        assert_eq!(asked(&mut window), [refresh(&["own"], false)]);
    }
}

#[test]
fn a_server_is_asked_at_once_when_it_may_be_and_else_after_a_question() {
    for size in rig::sizes() {
        let mut window = view(size, vec![server(3.0)]);
        click(&mut window, "Fetch weather");
        assert_eq!(asked(&mut window), [refresh(&["weather"], false)]);

        let mut window = view(size, vec![server(0.5)]);
        click(&mut window, "Fetch weather");
        assert_eq!(asked(&mut window), []);
        assert!(says(&window, "The server of weather was asked 30 min ago."));
        click(&mut window, "Cancel");
        assert_eq!(asked(&mut window), []);
        click(&mut window, "Fetch weather");
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
    for size in rig::sizes() {
        let mut window = view(size, vec![server(1.0)]);
        let name = "Refresh of weather: Only when you ask";
        window.get_by_role_and_label(Role::ComboBox, name).click();
        settle(&mut window);
        window.get_by_label("Every 6 h").click();
        let hours = Some(RefreshHours::from(6));
        let wanted = contract::Command::SetRefresh { name: "weather".to_owned(), hours };
        assert_eq!(asked(&mut window), [UiCommand::Station(wanted)]);
        Arc::make_mut(&mut window.state_mut().model.shown_mut().sources).list[0].refresh = hours;
        settle(&mut window);
        window.get_by_role_and_label(Role::ComboBox, "Refresh of weather: Every 6 h");
    }
}

#[test]
fn a_source_is_removed_after_a_question() {
    for size in rig::sizes() {
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
            [UiCommand::Station(contract::Command::RemoveSource("own".to_owned()))]
        );
    }
}

#[test]
fn a_typed_source_is_added_once_it_is_right_and_stays_typed_until_it_is_there() {
    for size in rig::sizes() {
        let mut window = view(size, Vec::new());
        assert!(is_disabled(&window, "Read again"));
        click(&mut window, "Add a source");
        assert!(is_disabled(&window, "Add source"));
        window.get_by_role_and_label(Role::RadioButton, "File").click();
        settle(&mut window);
        write(&mut window, "Name", "own");
        write(&mut window, "Path", "own.tle");
        assert!(says(&window, "Type the whole path, from the root or the drive on."));
        write(&mut window, "Path", "/var/elements/own.tle");
        window.get_by_role_and_label(Role::Button, "Add source").scroll_to_me();
        settle(&mut window);
        click(&mut window, "Add source");
        assert_eq!(
            asked(&mut window),
            [UiCommand::Station(contract::Command::AddSource(file_source()))]
        );
        let path = |window: &Window| {
            window.get_by_role_and_label(Role::TextInput, "Path").value().unwrap_or_default()
        };
        assert_eq!(path(&window), "/var/elements/own.tle", "it may not have been kept");
        Arc::make_mut(&mut window.state_mut().model.shown_mut().sources).list.push(file_source());
        settle(&mut window);
        let form = window.query_by_role_and_label(Role::TextInput, "Path");
        assert!(form.is_none(), "the form closes");
        click(&mut window, "Add a source");
        assert_eq!(path(&window), "", "and opens empty");
    }
}

#[test]
fn while_the_only_source_is_unreachable_the_age_of_the_bundled_elements_comes_first() {
    let source = server(3.0).0;
    let unreachable = SourceReport {
        fetch_problem: Some(FetchProblem::Answer(503)),
        files: Vec::new(),
        newest_epoch: None,
        as_of: None,
        ..report(&source, 0)
    };
    let mut window = view(rig::LARGE, vec![(source, unreachable)]);
    let label = |window: &Window| sources_bar(window).accesskit_node().label().unwrap();
    let in_use = "The elements that come with Azel are in use";
    let young = label(&window);
    assert!(young.ends_with(&format!("weather needs attention. {in_use}.")), "{young}");
    let model = &mut window.state_mut().model;
    model.now = add_seconds(model.now, 200.0 * 24.0 * HOUR_S);
    settle(&mut window);
    let old = label(&window);
    assert!(old.contains(&format!("{in_use}: too old for ")), "{old}");
    assert!(old.ends_with("favourites. weather needs attention."), "{old}");
}

#[test]
fn bundled_elements_that_favourites_still_use_are_told_whatever_another_source_holds() {
    let mut window = view(rig::LARGE, vec![server(3.0)]);
    let label = |window: &Window| sources_bar(window).accesskit_node().label().unwrap();
    let in_use = "The elements that come with Azel are in use";
    assert!(label(&window).ends_with(&format!("{in_use}.")), "{}", label(&window));
    let model = &mut window.state_mut().model;
    model.now = add_seconds(model.now, 200.0 * 24.0 * HOUR_S);
    let all = model.pass_lists.favourites.satellites.len();
    settle(&mut window);
    let old = label(&window);
    assert!(old.contains(&format!("{in_use}: too old for {all} of {all} favourites.")), "{old}");
}

#[test]
fn a_known_server_is_filled_in_and_a_plain_address_is_refused() {
    for size in rig::sizes() {
        let mut window = view(size, vec![server(3.0)]);
        click(&mut window, "Add a source");
        assert!(is_disabled(&window, "CelesTrak weather"), "it is there");
        write(&mut window, "Name", "x");
        write(&mut window, "Address", "http://celestrak.org/x");
        assert!(says(&window, "Type an address that begins with https:// and holds no password."));
        click(&mut window, "CelesTrak stations");
        window.get_by_role_and_label(Role::Button, "Add source").scroll_to_me();
        settle(&mut window);
        click(&mut window, "Add source");
        assert_eq!(
            asked(&mut window),
            [UiCommand::Station(contract::Command::AddSource(Source::celestrak("stations")))]
        );
        click(&mut window, "SatNOGS");
        window.get_by_role_and_label(Role::Button, "Add source").scroll_to_me();
        settle(&mut window);
        click(&mut window, "Add source");
        assert_eq!(
            asked(&mut window),
            [UiCommand::Station(contract::Command::AddSource(Source::satnogs()))]
        );
    }
}

/// Returns Space-Track as a source whose password is missing, and its report.
fn space_track() -> (Source, SourceReport) {
    let source = Source {
        name: "Space-Track".to_owned(),
        place: SourcePlace::SpaceTrack("op@example.org".to_owned()),
        refresh: None,
    };
    let next_fetch = Some(add_seconds(rig::now(), -HOUR_S));
    let fetch_problem = Some(FetchProblem::NoPassword);
    let report = SourceReport { fetch_problem, next_fetch, failures: 1, ..report(&source, 7) };
    (source, report)
}

#[test]
fn space_track_is_added_with_its_log_in_name() {
    for size in rig::sizes() {
        let mut window = view(size, vec![server(3.0)]);
        click(&mut window, "Add a source");
        window.get_by_role_and_label(Role::RadioButton, "Space-Track").click();
        settle(&mut window);
        write(&mut window, "Name", "Space-Track");
        assert!(says(&window, "Type the log-in name."));
        write(&mut window, "Log-in", " op@example.org");
        window.get_by_role_and_label(Role::Button, "Add source").scroll_to_me();
        settle(&mut window);
        click(&mut window, "Add source");
        let wanted = contract::Command::AddSource(space_track().0);
        assert_eq!(asked(&mut window), [UiCommand::Station(wanted)]);
    }
}

#[test]
fn a_missing_or_refused_password_is_told_and_entered_in_a_dialog() {
    for size in rig::sizes() {
        let mut window = view(size, vec![space_track()]);
        assert!(says(&window, "No password is stored for this log-in. The previous elements stay"));
        assert!(says(&window, "Choose Password in Elements to enter it."));
        click(&mut window, "Password of Space-Track");
        assert!(says(&window, "Password of op@example.org"));
        window.event(Event::Text("hunter2".to_owned()));
        settle(&mut window);
        click(&mut window, "Log in (Enter)");
        let wanted = contract::Command::SetSourcePassword {
            name: "Space-Track".to_owned(),
            secret: Secret::new("hunter2"),
            keep: false,
        };
        assert_eq!(asked(&mut window), [UiCommand::Station(wanted)]);
        assert!(!says(&window, "Password of op@example.org"), "the dialog is closed");

        let set = |window: &mut Window, problem, limits| {
            let sources = Arc::make_mut(&mut window.state_mut().model.shown_mut().sources);
            sources.reports[0].fetch_problem = problem;
            sources.reports[0].limits = limits;
            settle(window);
        };
        set(&mut window, Some(FetchProblem::LogIn), Vec::new());
        assert!(says(&window, "The server refused the log-in."));
        assert!(says(&window, "Azel does not try again by itself"));
        assert!(!is_disabled(&window, "Fetch Space-Track"));
        let query = |after_s| {
            let time = add_seconds(rig::now(), after_s);
            vec![RequestLimit { time, pause: SignedDuration::from_hours(1) }]
        };
        set(&mut window, None, query(-0.5 * HOUR_S));
        assert!(is_disabled(&window, "Fetch Space-Track"));
        set(&mut window, None, query(24.0 * HOUR_S));
        assert!(!is_disabled(&window, "Fetch Space-Track"), "the clock was ahead");
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
                sources.problems.push("the list cannot be read".to_owned());
            },
            "The list cannot be read.",
        ),
    ];
    for size in rig::sizes() {
        for (lock, words) in locks {
            let mut window = view(size, vec![server(3.0)]);
            lock(Arc::make_mut(&mut window.state_mut().model.shown_mut().sources));
            settle(&mut window);
            assert!(says(&window, words));
            click(&mut window, "Add a source");
            for button in ["Fetch weather", "Remove weather", "Refresh 1 due", "Add source"] {
                assert!(is_disabled(&window, button), "{button}");
            }
        }
    }
}
