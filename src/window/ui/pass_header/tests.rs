use super::*;
use crate::ui::widgets::testing;
use egui::Role;
use egui_kittest::{
    Harness,
    kittest::{NodeT as _, Queryable as _},
};

const NOAA_20: PassHeaderModel<'_> = PassHeaderModel {
    name: "NOAA 20",
    detail: "JPSS-1  43013",
    second_line: "Elements 8 h 52 min old · same set on Satrak · sunlit",
    warning: "",
    tca_countdown: "T−02:06",
    event: "LOS",
    countdown: "T−08:33",
    drawer_button: false,
    empty: None,
};

fn window(width: f32, height: f32, model: PassHeaderModel<'_>) -> Harness<'_, u32> {
    testing::window([width, height], 0, move |ui, clicks| {
        let rect = Rect::from_min_size(pos2(0.0, 0.0), vec2(width, height));
        *clicks += u32::from(show(ui, rect, &model));
    })
}

fn bounds(window: &Harness<'_, u32>, label: &str) -> (f64, f64) {
    let node = window.get_by_label_contains(label);
    let bounds = node.accesskit_node().raw_bounds().unwrap();
    (bounds.x0, bounds.x1)
}

#[test]
fn the_pass_and_its_countdowns_are_told() {
    let window = window(704.0, HEIGHT, NOAA_20);
    window.get_by_label(
        "NOAA 20, JPSS-1  43013, Elements 8 h 52 min old · same set on Satrak · sunlit",
    );
    window.get_by_label("TCA T−02:06, LOS T−08:33");
    assert!(window.query_by_role_and_label(Role::Button, "Passes").is_none());
}

#[test]
fn the_button_opens_the_list_also_without_a_pass() {
    for empty in [None, Some("No pass selected.")] {
        let model = PassHeaderModel { drawer_button: true, empty, ..NOAA_20 };
        let mut window = window(672.0, 44.0, model);
        assert_eq!(*window.state(), 0);
        window.get_by_role_and_label(Role::Button, "Passes").click();
        window.run();
        assert_eq!(*window.state(), 1);
    }
}

#[test]
fn a_sentence_stands_instead_of_a_pass() {
    let model = PassHeaderModel { empty: Some("No pass selected."), ..NOAA_20 };
    let window = window(704.0, HEIGHT, model);
    window.get_by_label("No pass selected.");
    assert!(window.query_by_label_contains("NOAA 20").is_none());
    assert!(window.query_by_label_contains("TCA").is_none());
}

#[test]
fn a_maximum_that_is_over_is_not_told() {
    let window = window(704.0, HEIGHT, PassHeaderModel { tca_countdown: "", ..NOAA_20 });
    window.get_by_label("LOS T−08:33");
}

#[test]
fn long_texts_end_before_the_countdowns() {
    let long = "A satellite with a name that is far too long to be shown in one line of it";
    for (width, height, drawer_button) in
        [(704.0, HEIGHT, false), (420.0, 44.0, true), (320.0, HEIGHT, false)]
    {
        let model = PassHeaderModel {
            name: long,
            detail: long,
            second_line: long,
            countdown: "T−23:59:59",
            drawer_button,
            ..NOAA_20
        };
        let window = window(width, height, model);
        let (_, texts_end) = bounds(&window, long);
        let (countdowns_begin, countdowns_end) = bounds(&window, "LOS");
        assert!(texts_end + 15.0 <= countdowns_begin, "{width}");
        assert!(countdowns_end <= f64::from(width), "{width}");
    }
}

#[test]
fn the_words_stay_while_the_figures_count() {
    let reading = |countdown| {
        let window = window(704.0, HEIGHT, PassHeaderModel { countdown, ..NOAA_20 });
        bounds(&window, "LOS").0
    };
    assert!((reading("T−08:33") - reading("T−01:11")).abs() < 1e-6);
}
