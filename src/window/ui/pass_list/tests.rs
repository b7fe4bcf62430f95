use std::{cell::Cell, rc::Rc};

use egui::{Key, Rect, Role, vec2};
use egui_kittest::{
    Harness,
    kittest::{NodeT as _, Queryable as _},
};
use jiff::Timestamp;

use super::*;
use crate::{
    astro::{Angle, AzEl, time::add_seconds},
    contract,
    plan::Loss,
    ui::widgets::testing,
};

const LONG: &str = "A SATELLITE OF 24 LETTER";

fn now() -> Timestamp {
    "2026-11-14T11:06:12Z".parse().unwrap()
}

/// State of the test window, kept from frame to frame.
struct Fixture {
    rows: usize,
    begun: usize,
    /// Number of passes that are over and removed.
    scrolled: usize,
    scope: Scope,
    span_h: u32,
    work: Work,
    made: Option<(usize, Timestamp)>,
    selected: Option<PassListKey>,
    floor_deg: f64,
    thumbnails: bool,
    actions: Vec<UiCommand>,
    state: PassListState,
    /// Highest requested index.
    highest: Rc<Cell<usize>>,
}

impl Fixture {
    fn new(rows: usize) -> Self {
        Self {
            rows,
            begun: 1,
            scrolled: 0,
            scope: Scope::Favourites,
            span_h: 48,
            work: Work::Nothing,
            made: Some((16_089, now())),
            selected: None,
            floor_deg: 10.0,
            thumbnails: true,
            actions: Vec::new(),
            state: PassListState::default(),
            highest: Rc::default(),
        }
    }
}

const NAMES: [&str; 4] = ["NOAA 20", "METEOR-M2 4", "SUOMI NPP", LONG];

/// Returns a pass; the first pass is current, and the others follow each half hour.
fn pass(index: usize, path: &[Sample]) -> PassRow<'_> {
    let aos = add_seconds(now(), 1800.0 * index as f64 - 259.0);
    PassRow {
        key: (100 + index as u32, aos),
        name: NAMES.get(index).copied().unwrap_or("CRYOSAT 2"),
        aos,
        los: add_seconds(aos, 772.0),
        starts_before: false,
        ends_after: false,
        max_elevation_deg: 69.2,
        aos_azimuth_deg: 173.0,
        los_azimuth_deg: 343.0,
        verdict: match index {
            0 => Some(Verdict::Trackable),
            1 => Some(Verdict::Loses { seconds: 11.4, loss: Loss::Keyhole(Angle::ZERO) }),
            2 => Some(Verdict::OutOfReach),
            _ => None,
        },
        clear_s: None,
        path,
    }
}

fn window(fixture: Fixture) -> Harness<'static, Fixture> {
    let width = if fixture.thumbnails { 320.0 } else { 264.0 };
    let path: Vec<Sample> = (0..=40)
        .map(|step| Sample {
            time: now(),
            direction: AzEl::from_degrees(f64::from(step) * 4.0, f64::from(step.min(40 - step))),
        })
        .collect();
    testing::window([width, 636.0], fixture, move |ui, fixture| {
        let highest = Rc::clone(&fixture.highest);
        let (rows, scrolled) = (fixture.rows, fixture.scrolled);
        let row = |index: usize| {
            highest.set(highest.get().max(index));
            Some(pass(index + scrolled, &path))
        };
        let model = PassListModel {
            now: now(),
            rows: fixture.rows,
            begun: fixture.begun,
            total: fixture.rows,
            groups: &[],
            row: &row,
            place: &|key| (0..rows).find(|index| key_of(index + scrolled) == key),
            keys: &|| (0..rows).map(|index| key_of(index + scrolled)).collect(),
            aos_elevation_deg: 5.0,
            scope: fixture.scope,
            span_h: fixture.span_h,
            work: fixture.work,
            made: fixture.made,
            selected: fixture.selected,
            floor_deg: fixture.floor_deg,
            lock: None,
            thumbnails: fixture.thumbnails,
            empty: "No pass above 10° in the next 48 hours.",
            menu: &|_, _, _, _| {},
        };
        let rect = Rect::from_min_size(egui::Pos2::ZERO, vec2(width, 636.0));
        for action in show(ui, rect, &model, &mut fixture.state) {
            match action {
                UiCommand::SelectPass(key) => fixture.selected = Some(key),
                UiCommand::Station(contract::Command::SetElevationFloor(floor_deg)) => {
                    fixture.floor_deg = floor_deg;
                }
                UiCommand::SetScope(scope) => fixture.scope = scope,
                UiCommand::SetSpan(span_h) => fixture.span_h = span_h,
                UiCommand::Station(contract::Command::CancelSearch(_)) => {
                    fixture.work = Work::Cancelled;
                }
                UiCommand::Station(contract::Command::ResumeSearch(_)) => {
                    fixture.work = Work::UnderWay { done: 0, total: 0 }
                }
                other => panic!("{other:?}"),
            }
            fixture.actions.push(action);
        }
    })
}

fn key_of(index: usize) -> PassListKey {
    pass(index, &[]).key
}

#[test]
fn a_row_says_what_it_shows_and_a_click_selects_it() {
    let mut window = window(Fixture::new(8));
    window.get_by_label("NOAA 20, LOS T−08:33, max 69°, Trackable");
    let second = "METEOR-M2 4, AOS T−25:41, max 69°, Loses 12 s at keyhole N";
    window.get_by_role_and_label(Role::ListBoxOption, second).click();
    window.run();
    assert_eq!(window.state().actions, [UiCommand::SelectPass(key_of(1))]);
    let node = window.get_by_label(second);
    assert_eq!(node.accesskit_node().is_selected(), Some(true));
    let other = window.get_by_label_contains("NOAA 20");
    assert_eq!(other.accesskit_node().is_selected(), Some(false));
}

#[test]
fn keys_move_the_selection_and_keep_it_in_view() {
    let mut window = window(Fixture::new(40));
    window.get_by_role_and_label(Role::ListBox, "Passes").focus();
    window.run();
    window.key_press(Key::ArrowDown);
    window.run();
    assert_eq!(window.state().selected, Some(key_of(0)));
    for _ in 0..25 {
        window.key_press(Key::ArrowDown);
        window.run();
    }
    assert_eq!(window.state().selected, Some(key_of(25)));
    let node = window.get_by(|node| node.is_selected() == Some(true));
    assert!(node.rect().bottom() <= 636.0 && node.rect().top() >= 40.0, "{}", node.rect());
    assert!(node.is_focused(), "screen readers are at the row");
    for _ in 0..30 {
        window.key_press(Key::ArrowUp);
        window.run();
    }
    assert_eq!(window.state().selected, Some(key_of(0)));
}

#[test]
fn tab_walks_from_the_drop_down_to_the_list() {
    let mut window = window(Fixture::new(8));
    for _ in 0..6 {
        window.key_press(Key::Tab);
        window.run();
    }
    assert!(window.get_by_role_and_label(Role::ListBox, "Passes").is_focused());
}

#[test]
fn another_floor_is_chosen_from_the_drop_down() {
    let mut window = window(Fixture::new(8));
    window.get_by_role_and_label(Role::ComboBox, "Elevation floor: 10°").click();
    window.run();
    window.get_by_label("Floor 30°").click();
    window.run();
    assert_eq!(
        window.state().actions,
        [UiCommand::Station(contract::Command::SetElevationFloor(30.0))]
    );
    window.get_by_role_and_label(Role::ComboBox, "Elevation floor: 30°");
}

#[test]
fn satellites_and_span_are_chosen_above_the_list() {
    for thumbnails in [true, false] {
        let mut window = window(Fixture { thumbnails, ..Fixture::new(8) });
        window.get_by_role_and_label(Role::RadioButton, "All").click();
        window.run();
        window.get_by_role_and_label(Role::ComboBox, "How far ahead: 48 h").click();
        window.run();
        window.get_by_label("6 h").click();
        window.run();
        let expected = [UiCommand::SetScope(Scope::All), UiCommand::SetSpan(6)];
        assert_eq!(window.state().actions, expected);
        window.get_by_role_and_label(Role::RadioButton, "All").click();
        window.run();
        assert_eq!(window.state().actions.len(), 2, "it is chosen already");
    }
}

#[test]
fn a_search_tells_how_far_it_is_and_can_be_cancelled_and_begun_again() {
    let work = Work::UnderWay { done: 4022, total: 16_089 };
    let mut window = window(Fixture { scope: Scope::All, work, ..Fixture::new(8) });
    window.get_by_label("Searched 4022 of 16\u{2009}089");
    let bar = window.get_by_role(Role::ProgressIndicator);
    assert_eq!(bar.accesskit_node().numeric_value(), Some(25.0));
    window.get_by_role_and_label(Role::Button, "Cancel").click();
    window.run();
    window.get_by_label("Cancelled; list of 11:06Z");
    assert!(window.query_by_label_contains("NOAA 20").is_some(), "the old list stays");
    window.get_by_role_and_label(Role::Button, "Search").click();
    window.run();
    window.get_by_label("Preparing the satellites");
    assert_eq!(
        window.state().actions,
        [
            UiCommand::Station(contract::Command::CancelSearch(Scope::All)),
            UiCommand::Station(contract::Command::ResumeSearch(Scope::All))
        ]
    );
}

#[test]
fn of_a_list_that_is_made_it_says_of_what_and_when() {
    let mut window = window(Fixture { scope: Scope::All, ..Fixture::new(8) });
    window.get_by_label("16\u{2009}089 satellites at 11:06Z");
    window.state_mut().scope = Scope::Favourites;
    window.run();
    assert!(window.query_by_label_contains("satellites at").is_none());
}

#[test]
fn the_list_of_all_satellites_opens_where_the_next_pass_begins() {
    let mut window = window(Fixture { begun: 400, ..Fixture::new(1000) });
    let first_row = |window: &Harness<'_, Fixture>| window.state().state.top.map(|(row, _)| row);
    assert_eq!(first_row(&window), Some(0));
    window.state_mut().scope = Scope::All;
    window.run();
    assert_eq!(first_row(&window), Some(398));
    window.state_mut().begun = 500;
    window.run();
    assert_eq!(first_row(&window), Some(398), "it moves only when it opens");
    window.state_mut().scope = Scope::Favourites;
    window.run();
    assert_eq!(first_row(&window), Some(0));
}

#[test]
fn what_is_read_stays_where_it_is_when_passes_above_end() {
    let mut window = window(Fixture::new(1000));
    window.state_mut().selected = Some(key_of(500));
    window.run();
    let place = |window: &Harness<'_, Fixture>| {
        let selected =
            |node: &egui_kittest::Node<'_>| node.accesskit_node().is_selected() == Some(true);
        let rows = window.get_all_by_role(Role::ListBoxOption);
        rows.into_iter().find(selected).map(|row| row.rect())
    };
    let before = place(&window).expect("its row is in view");
    (window.state_mut().rows, window.state_mut().scrolled) = (970, 30);
    window.run();
    assert_eq!(place(&window), Some(before));
}

#[test]
fn what_is_filtered_begins_at_its_first_hit() {
    for scope in [Scope::Favourites, Scope::All] {
        let mut window = window(Fixture { scope, begun: 300, ..Fixture::new(900) });
        window.state_mut().selected = Some(pass(880, &[]).key);
        window.run();
        window.get_by_role_and_label(Role::Button, "Filter the list").click();
        window.run();
        window.event(egui::Event::Text("c".to_owned()));
        // The list shows the hits; none of them is the selected pass.
        (window.state_mut().rows, window.state_mut().begun) = (60, 0);
        window.run();
        let first = |window: &Harness<'_, Fixture>| {
            let rows = window.get_all_by_role(Role::ListBoxOption);
            let names: Vec<_> = rows.filter_map(|row| row.accesskit_node().label()).collect();
            names.iter().any(|name| name.starts_with("NOAA 20"))
        };
        assert!(first(&window), "{scope:?}");
    }
}

#[test]
fn a_filter_is_opened_typed_and_closed() {
    for thumbnails in [true, false] {
        let mut window = window(Fixture { thumbnails, ..Fixture::new(8) });
        assert!(window.query_by_role(Role::TextInput).is_none());
        window.get_by_role_and_label(Role::Button, "Filter the list").click();
        window.run();
        window.event(egui::Event::Text("iss ".to_owned()));
        window.run();
        assert_eq!(window.state().state.filter.text(), "iss");
        window.get_by_role_and_label(Role::Button, "Close").click();
        window.run();
        assert_eq!(window.state().state.filter.text(), "");
        assert!(window.query_by_role(Role::TextInput).is_none());
    }
}

#[test]
fn the_choices_in_the_head_never_touch() {
    for thumbnails in [true, false] {
        let fixture = Fixture { scope: Scope::All, thumbnails, ..Fixture::new(98_765) };
        let window = window(fixture);
        let place = |name| window.get_by_label(name).rect();
        let count = place("Next passes, 98\u{2009}765 · AOS at 5°");
        assert!(count.right() < place("Elevation floor: 10°").left());
        assert!(place("All").right() < place("Filter the list").left());
        assert!(place("Filter the list").right() < place("How far ahead: 48 h").left());
    }
}

#[test]
fn an_empty_list_says_so() {
    let window = window(Fixture::new(0));
    window.get_by_label("No pass above 10° in the next 48 hours.");
    assert!(window.query_by_role(Role::ListBoxOption).is_none());
}

#[test]
fn only_rows_in_view_are_asked_for() {
    let mut window = window(Fixture::new(1000));
    window.run();
    window.get_by_label("Next passes, 1000 · AOS at 5°");
    assert!(window.state().highest.get() < 12, "{}", window.state().highest.get());
    assert!(window.get_all_by_role(Role::ListBoxOption).count() < 12);
}

#[test]
fn a_long_name_leaves_the_countdown_alone() {
    for thumbnails in [true, false] {
        let mut window = window(Fixture { thumbnails, ..Fixture::new(4) });
        window.run();
        let row = window.get_by_label_contains(LONG).rect();
        let texts = painted_texts(&window, row);
        let name = texts.iter().find(|(text, _)| text.starts_with("A SAT")).unwrap();
        let countdown = texts.iter().find(|(text, _)| text.starts_with("T−")).unwrap();
        assert!(name.1.right() < countdown.1.left(), "{texts:?}");
        assert!(texts.iter().all(|(_, place)| row.contains_rect(*place)), "{texts:?}");
    }
}

/// Returns the texts whose centre lies in `rect`, and their places.
fn painted_texts(window: &Harness<'_, Fixture>, rect: Rect) -> Vec<(String, Rect)> {
    let texts = window.output().shapes.iter().filter_map(|clipped| match &clipped.shape {
        egui::Shape::Text(text) => {
            let place = text.galley.rect.translate(text.pos.to_vec2());
            Some((text.galley.text().to_owned(), place))
        }
        _ => None,
    });
    texts.filter(|(_, place)| rect.contains(place.center())).collect()
}
