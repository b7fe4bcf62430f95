//! Tests of the strip from the operator's view.

use egui::{Key, Rect, Role, vec2};
use egui_kittest::{
    Harness,
    kittest::{NodeT as _, Queryable as _},
};
use jiff::Timestamp;

use super::{Bar, BarName, Lane, State, SunSpan, TimelineModel, show};
use crate::{model::UiCommand, ui::widgets::testing};

const FULL: egui::Vec2 = vec2(632.0, 208.0);
const SMALL: egui::Vec2 = vec2(672.0, 80.0);

fn time(time: &str) -> Timestamp {
    format!("2026-11-14T{time}Z").parse().unwrap()
}

fn bar(number: u32, name: &'static str, aos: &str, los: &str, max: f64) -> Bar<'static> {
    Bar {
        key: (number, time(aos)),
        name: BarName::Known(name),
        aos: time(aos),
        los: time(los),
        max_elevation_deg: Some(max),
        loses: false,
        state: State::Mount { can_track: true },
    }
}

fn bars() -> Vec<Bar<'static>> {
    vec![
        Bar { loses: true, ..bar(59_051, "METEOR-M2 4", "11:34:54", "11:46:45", 34.0) },
        bar(43_013, "NOAA 20", "11:01:53", "11:14:45", 69.2),
        Bar {
            state: State::Mount { can_track: false },
            ..bar(25_544, "ISS", "12:36:06", "12:43:01", 52.0)
        },
        bar(54_754, "SWOT", "17:00:00", "17:20:00", 80.0),
        bar(38_771, "METOP-B", "17:10:00", "17:26:00", 40.0),
        bar(37_849, "SUOMI NPP", "23:53:03", "23:59:00", 24.0),
    ]
}

type Picked = Option<(u32, Timestamp)>;

/// Returns a window that shows only the strip and records the clicked bar.
fn window(size: egui::Vec2, bars: Vec<Bar<'static>>) -> Harness<'static, Picked> {
    testing::window(size, None, move |ui, picked: &mut Picked| {
        let model = TimelineModel {
            now: time("11:06:12"),
            hours: if size == SMALL { 4.0 } else { 12.0 },
            lanes: &[Lane { name: "Satrak", bars: bars.clone() }],
            main: 0,
            time: None,
            is_planned: false,
            selected: *picked,
            sun: &[
                SunSpan { start: time("04:10:00"), end: time("14:45:00"), up: true },
                SunSpan { start: time("14:45:00"), end: time("23:59:00"), up: false },
            ],
            says: &|_, _| String::new(),
            menu: &|_, _, _, _| {},
        };
        let mut commands = Vec::new();
        show(ui, Rect::from_min_size(egui::Pos2::ZERO, size), &model, &mut commands);
        for command in commands {
            if let UiCommand::SelectPass(key) = command {
                *picked = Some(key);
            }
        }
    })
}

#[test]
fn a_bar_is_found_by_name_and_a_click_selects_it() {
    let mut window = window(FULL, bars());
    window.get_by_role_and_label(Role::ListBox, "Next 12 hours");
    let noaa = "NOAA 20, 11:01Z to 11:14Z, max 69°";
    assert!(!window.get_by_label(noaa).accesskit_node().is_selected().unwrap_or(false));
    window.get_by_role_and_label(Role::ListBoxOption, noaa).click();
    window.run();
    assert_eq!(*window.state(), Some((43_013, time("11:01:53"))));
    assert_eq!(window.get_by_label(noaa).accesskit_node().is_selected(), Some(true));
}

#[test]
fn names_tell_what_the_mount_cannot_do() {
    let window = window(FULL, bars());
    window.get_by_label("METEOR-M2 4, 11:34Z to 11:46Z, max 34°, part lost");
    window.get_by_label("ISS, 12:36Z to 12:43Z, max 52°, out of reach");
    assert!(window.query_by_label_contains("SUOMI").is_none(), "begins after the strip");
}

#[test]
fn tab_walks_in_the_order_of_time_and_enter_selects() {
    let mut window = window(FULL, bars());
    window.key_press(Key::Tab);
    window.run();
    window.key_press(Key::Tab);
    window.run();
    window.key_press(Key::Enter);
    window.run();
    assert_eq!(*window.state(), Some((59_051, time("11:34:54"))));
}

#[test]
fn of_two_bars_that_overlap_the_later_is_above_and_both_can_be_clicked() {
    let mut window = window(FULL, bars());
    let swot = window.get_by_label_contains("SWOT").rect();
    let metop = window.get_by_label_contains("METOP-B").rect();
    assert!(swot.intersects(metop));
    window.hover_at(metop.left_center() + vec2(1.0, 0.0));
    window.run();
    let middle = swot.intersect(metop).center();
    click_at(&mut window, middle);
    assert_eq!(*window.state(), Some((38_771, time("17:10:00"))));
    click_at(&mut window, swot.left_top() + vec2(2.0, 3.0));
    assert_eq!(*window.state(), Some((54_754, time("17:00:00"))));
}

fn click_at(window: &mut Harness<'static, Picked>, place: egui::Pos2) {
    window.hover_at(place);
    for pressed in [true, false] {
        window.event(egui::Event::PointerButton {
            pos: place,
            button: egui::PointerButton::Primary,
            pressed,
            modifiers: egui::Modifiers::NONE,
        });
    }
    window.run();
}

#[test]
fn pointing_at_a_bar_tells_its_times() {
    let mut window = window(FULL, bars());
    window.get_by_label_contains("METEOR").hover();
    window.run_steps(8);
    window.get_by_label("METEOR-M2 4\n11:34:54Z to 11:46:45Z\nmax 34°, part lost");
}

#[test]
fn the_small_form_shows_four_hours_and_no_sun() {
    let window = window(SMALL, bars());
    window.get_by_label_contains("NOAA 20");
    window.get_by_label_contains("ISS");
    assert!(window.query_by_label_contains("SWOT").is_none(), "begins in six hours");
    assert!(window.query_by_label("sunset 14:45Z").is_none());
}

#[test]
fn day_and_night_are_named() {
    let window = window(FULL, Vec::new());
    window.get_by_label("day");
    window.get_by_label("sunset 14:45Z");
    assert!(window.query_by_role(Role::ListBoxOption).is_none());
}

#[test]
fn a_strip_without_passes_or_room_is_fine() {
    window(SMALL, Vec::new()).run();
    window(vec2(60.0, 130.0), bars()).run();
    window(vec2(20.0, 8.0), bars()).run();
}

/// Returns the texts of the last frame with their places.
fn texts(harness: &Harness<'_, Picked>) -> Vec<(String, Rect)> {
    fn collect(shape: &egui::Shape, found: &mut Vec<(String, Rect)>) {
        match shape {
            egui::Shape::Vec(shapes) => shapes.iter().for_each(|outline| collect(outline, found)),
            egui::Shape::Text(text) => {
                let place = text.galley.rect.translate(text.pos.to_vec2());
                found.push((text.galley.text().to_owned(), place));
            }
            _ => {}
        }
    }
    let mut found = Vec::new();
    for clipped in &harness.output().shapes {
        collect(&clipped.shape, &mut found);
    }
    found
}

#[test]
fn the_name_of_the_first_bar_stays_clear_of_the_name_of_its_lane() {
    for size in [FULL, SMALL] {
        let first = bar(43_013, "SENTINEL-6A", "11:06:13", "11:09:45", 12.0);
        let mut harness = window(size, vec![first]);
        harness.run();
        let all = texts(&harness);
        let place =
            |words: &[&str]| all.iter().find(|(name, _)| words.contains(&&**name)).unwrap().1;
        let gap = place(&["S6A", "SENTINEL-6A"]).left() - place(&["Satrak"]).right();
        assert!(gap >= 6.0, "{size:?}: {gap}");
    }
}
