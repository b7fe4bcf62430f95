//! Theme and scale of the window.

use std::fs;

use azel::{
    controller::SPECS,
    model::{Appearance, DistanceUnit, ThemeName, UiCommand, View},
    station,
    ui::theme,
};
use egui::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use jiff::Timestamp;

use crate::window_stories::{
    every_view::words,
    rig::{self, LARGE, SMALL, Window, asked, says, settle},
    states,
    unit::{Unit, clock_from, open, step_until},
};

fn page(size: [f32; 2]) -> Window {
    let mut model = rig::model(states::holding());
    model.view = View::Preferences;
    let mut window = rig::window(size, model);
    window.get_by_role_and_label(Role::RadioButton, "Appearance").click();
    settle(&mut window);
    asked(&mut window);
    window
}

fn chosen(window: &mut Window, word: &str) -> Appearance {
    window.get_by_role_and_label(Role::RadioButton, word).click();
    match <[UiCommand; 1]>::try_from(asked(window)) {
        Ok([UiCommand::SetAppearance(appearance)]) => appearance,
        other => panic!("{other:?}"),
    }
}

#[test]
fn theme_and_sun_are_chosen_and_the_scale_that_fits() {
    let usual = Appearance::default();
    let mut window = page(LARGE);
    let night = Appearance { theme: ThemeName::Night, ..usual };
    assert_eq!(chosen(&mut window, "Night"), night);
    let by_day = Appearance { light_by_day: true, ..usual };
    assert_eq!(chosen(&mut window, "Light by day"), by_day);
    let larger = Appearance { scale_percent: 150, ..usual };
    assert_eq!(chosen(&mut window, "150 %"), larger);
    assert!(window.query_by_label("175 %").is_none(), "the views would be cut off");
    assert!(says(&window, "A larger scale needs a larger window"));

    let mut window = page(SMALL);
    assert!(window.query_by_label("125 %").is_none());
    assert_eq!(chosen(&mut window, "Light").theme, ThemeName::Light);
}

#[test]
fn angles_have_the_decimals_that_are_chosen_and_no_more_than_the_unit_gives() {
    let mut window = page(LARGE);
    let exact = Appearance { angle_decimals: 3, ..Appearance::default() };
    assert_eq!(chosen(&mut window, "0.001°"), exact);
    let axes = |angle_decimals| {
        let mut model = rig::model(states::holding());
        model.appearance.angle_decimals = angle_decimals;
        let window = rig::window(LARGE, model);
        let labels = window.query_all_by_role(Role::Label);
        let mut words = labels.filter_map(|node| node.accesskit_node().value());
        let words = words.find(|words| words.contains(", actual ")).unwrap();
        let actual = words.split("actual ").nth(1).unwrap_or_default();
        let decimals = actual.split(',').next().unwrap_or_default().split('.').nth(1);
        decimals.unwrap_or_default().len()
    };
    assert_eq!([1, 2, 3].map(axes), [1, 2, 3]);
}

#[test]
fn distances_are_shown_in_the_unit_that_is_chosen() {
    let mut window = page(LARGE);
    let miles = Appearance { distances: DistanceUnit::Miles, ..Appearance::default() };
    assert_eq!(chosen(&mut window, "Miles"), miles);
    let heard = |view, appearance| {
        let mut model = rig::model(states::holding());
        (model.view, model.appearance) = (view, appearance);
        model.refresh_sky();
        words(&rig::window(LARGE, model))
    };
    for (view, before) in [(View::Operate, "Range"), (View::Map, "From the station: ")] {
        let figure = |appearance| {
            let words = heard(view, appearance);
            let at = words.iter().position(|of| of.starts_with(before)).expect("a range");
            // The rate of the range stands in a line below the range.
            let mut lines = words[at..].iter().filter_map(|of| of.lines().next());
            let words = lines.find(|of| of.ends_with("km") || of.ends_with("mi"));
            let words: Vec<_> = words.expect("a distance").rsplit([' ', ',']).collect();
            let number: String = words[1].chars().filter(char::is_ascii_digit).collect();
            (number.parse::<f64>().unwrap(), words[0].to_owned())
        };
        let [(km, of_km), (in_miles, of_miles)] = [Appearance::default(), miles].map(figure);
        assert_eq!((&*of_km, &*of_miles), ("km", "mi"), "{view:?}");
        assert!((km / in_miles - 1.609_344).abs() < 0.01, "{view:?}: {km} km, {in_miles} mi");
    }
    let model = Appearance { distances: DistanceUnit::NauticalMiles, ..Appearance::default() };
    assert!(heard(View::Elements, model).contains(&"Apo × per nmi".to_owned()));
}

#[test]
fn the_window_turns_light_while_the_sun_is_up_and_keeps_its_scale() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("station.toml");
    let unit = Unit::start(rig::now());
    station::save(&unit.station(), &path, SPECS).unwrap();
    let kept = "theme = 'night'\nlight_by_day = true\nscale_percent = 125\n";
    fs::write(folder.path().join("window.toml"), kept).unwrap();
    for (utc, wanted) in
        [("2026-08-12T10:15:00Z", ThemeName::Light), ("2026-08-12T22:15:00Z", ThemeName::Night)]
    {
        let mut window = open(&path, clock_from(utc.parse::<Timestamp>().unwrap()));
        step_until(&mut window, "the Sun", |model| model.sky.sun.is_some());
        window.run_steps(2);
        assert_eq!(theme::name(&window.ctx), wanted, "{utc}");
        assert!((window.ctx.zoom_factor() - 1.25).abs() < 1e-6);
    }
    assert!(fs::read_to_string(folder.path().join("window.toml")).unwrap().contains("'night'"));
}
