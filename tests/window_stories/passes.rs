//! Choice of a pass: in the list, on the sky, on the strip, by keys.

use std::sync::Arc;

use azel::{
    astro::time::add_seconds,
    contract,
    contract::passes::{PredictedPass, Scope},
    model::{Model, UiCommand},
    station::AntennaId,
    ui::{
        StoredViews, Views,
        pass_list::{Arrangement, Light, Order},
        sky_plot::Layers,
        theme,
    },
};
use egui::{Event, Key, Modifiers, PointerButton, Rect, Role, Shape, epaint::Vertex};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    rig::{self, LARGE, NOAA_20, SMALL, Window, asked, says, settle},
    states,
};

const METEOR_M2_4: u32 = 59_051;
const EUTELSAT_7C: u32 = 44_334;

/// Returns the window of a quiet station with NOAA 20 selected.
fn window(size: [f32; 2]) -> Window {
    rig::window(size, rig::model(states::holding()))
}

/// Returns the first pass of this satellite that has not begun.
fn coming(model: &Model, number: u32) -> &PredictedPass {
    let of = |predicted: &&PredictedPass| predicted.satellite.elements.catalog_number() == number;
    model
        .pass_lists
        .favourites
        .passes
        .iter()
        .filter(of)
        .find(|pass| pass.pass.aos.time > model.now)
        .unwrap()
}

#[test]
fn a_click_on_a_row_of_the_list_selects_its_pass() {
    let mut window = window(LARGE);
    let wanted = coming(&window.state().model, METEOR_M2_4).key();
    let row = "METEOR-M2 4, AOS T−1:28:51, max 49°, Trackable";
    window.get_by_role_and_label(Role::ListBoxOption, row).click();
    assert_eq!(asked(&mut window), [UiCommand::SelectPass(wanted)]);
    window.state_mut().model.selected = Some(wanted);
    settle(&mut window);
    assert_eq!(window.get_by_label(row).accesskit_node().is_selected(), Some(true));
    window.get_by_label_contains("METEOR-M2 4, 59051, ");
}

fn add_vertices(shape: &Shape, vertices: &mut Vec<Vertex>) {
    match shape {
        Shape::Vec(shapes) => shapes.iter().for_each(|of| add_vertices(of, vertices)),
        Shape::Mesh(mesh) => vertices.extend(&mesh.vertices),
        _ => {}
    }
}

#[test]
fn a_pass_under_way_looks_selected_only_if_it_is() {
    let window = window(LARGE);
    let row = |name: &str| {
        let mut rows = window.query_all_by_role(Role::ListBoxOption);
        let is_row = |label: String| label.starts_with(name) && label.contains("LOS T−");
        rows.find(|of| of.accesskit_node().label().is_some_and(is_row)).expect(name).rect()
    };
    let (selected, other) = (row("NOAA 20, "), row("METEOR-M2 4, "));
    let ground = theme::tokens(&window.ctx).bgsel;
    let filled = |place: Rect| {
        let is_corner = |of: &Vertex| of.color == ground && of.pos.distance(place.min) < 0.5;
        let mut vertices = Vec::new();
        window.output().shapes.iter().for_each(|of| add_vertices(&of.shape, &mut vertices));
        vertices.iter().any(is_corner)
    };
    assert!(filled(selected));
    assert!(!filled(other), "under way, and another is selected");
}

#[test]
fn a_click_on_a_satellite_of_the_sky_selects_it() {
    for size in rig::sizes() {
        let mut window = window(size);
        window.get_by_label_contains("EUTELSAT 7C, azimuth 211.8°").click();
        assert_eq!(asked(&mut window), [UiCommand::SelectSatellite(EUTELSAT_7C)]);
    }
}

#[test]
fn a_click_on_a_bar_of_the_strip_selects_its_pass() {
    for size in rig::sizes() {
        let mut window = window(size);
        let wanted = coming(&window.state().model, METEOR_M2_4).key();
        window.get_by_label("METEOR-M2 4, 12:44Z to 12:56Z, max 49°").click();
        assert_eq!(asked(&mut window), [UiCommand::SelectPass(wanted)]);
    }
}

#[test]
fn the_drawer_of_the_small_window_opens_by_key_and_button() {
    let mut window = window(SMALL);
    let wanted = coming(&window.state().model, METEOR_M2_4).key();
    let is_open = |window: &Window| window.query_by_label_contains("Next passes, ").is_some();
    assert!(!is_open(&window));
    window.key_press(Key::P);
    settle(&mut window);
    assert!(is_open(&window));
    window.get_by_label_contains("METEOR-M2 4, AOS T−1:28:51").scroll_to_me();
    settle(&mut window);
    window.get_by_label_contains("METEOR-M2 4, AOS T−1:28:51").click();
    assert_eq!(asked(&mut window), [UiCommand::SelectPass(wanted)]);
    window.key_press(Key::P);
    settle(&mut window);
    assert!(!is_open(&window));
    for open in [true, false] {
        window.get_by_role_and_label(Role::Button, "Passes").click();
        settle(&mut window);
        assert_eq!(is_open(&window), open);
    }
}

#[test]
fn the_open_drawer_covers_neither_card_nor_stop() {
    let mut window = window(SMALL);
    window.key_press(Key::P);
    settle(&mut window);
    let list = window.get_by_label_contains("ISS, AOS").rect();
    for other in ["STOP", "Track NOAA 20", "Jog X−"] {
        assert!(!window.get_by_label(other).rect().intersects(list), "{other}");
        window.get_by_label(other).click();
        settle(&mut window);
    }
    assert_eq!(asked(&mut window), [UiCommand::Stop, rig::track_noaa_20()]);
}

#[test]
fn the_legend_opens_beside_the_open_drawer() {
    for size in [SMALL, [1100.0, 1000.0]] {
        let mut window = window(size);
        window.key_press(Key::P);
        settle(&mut window);
        let button = window.get_by_role_and_label(Role::Button, "Legend").rect();
        window.hover_at(button.center());
        window.drag_at(button.center());
        window.drop_at(button.center());
        settle(&mut window);
        assert!(window.query_by_label("Legend of the sky plot").is_some(), "{size:?}");
    }
}

#[test]
fn a_click_in_the_open_drawer_never_reaches_the_sky_below() {
    let mut window = window(SMALL);
    window.key_press(Key::P);
    settle(&mut window);
    let rows: Vec<egui::Pos2> = window
        .get_all_by_role(Role::ListBoxOption)
        .filter(|node| node.accesskit_node().label().is_some_and(|name| name.contains("OS T−")))
        .map(|node| node.rect())
        // Leave out half-hidden rows, because the window scrolls to them first.
        .filter(|row| row.bottom() < 504.0)
        .map(|row| row.center())
        .collect();
    assert!(rows.len() >= 3);
    for at in rows {
        window.hover_at(at);
        window.drag_at(at);
        window.drop_at(at);
        let commands = asked(&mut window);
        assert!(matches!(commands[..], [UiCommand::SelectPass(_)]), "{commands:?}");
    }
}

#[test]
fn n_jumps_to_the_pass_under_way_and_not_to_what_never_sets() {
    for size in rig::sizes() {
        let mut window = window(size);
        window.key_press(Key::N);
        let under_way = window.state().model.next_pass().unwrap().key();
        assert_ne!(under_way.0, EUTELSAT_7C);
        assert_eq!(asked(&mut window), [UiCommand::SelectPass(under_way)]);
    }
}

#[test]
fn the_lowest_elevation_is_chosen_above_the_list() {
    let mut window = window(LARGE);
    window.get_by_label("Elevation floor: 10°").click();
    settle(&mut window);
    let choices = window.get_all_by_label_contains("30°");
    let choice = choices.into_iter().find(|node| node.rect().left() < 392.0).unwrap();
    choice.click();
    assert_eq!(
        asked(&mut window),
        [UiCommand::Station(contract::Command::SetElevationFloor(30.0))]
    );
}

#[test]
fn satellites_and_span_are_chosen_in_list_and_drawer() {
    for size in rig::sizes() {
        let mut window = window(size);
        open_list(&mut window);
        window.get_by_role_and_label(Role::RadioButton, "All").click();
        assert_eq!(asked(&mut window), [UiCommand::SetScope(Scope::All)]);
        window.get_by_role_and_label(Role::ComboBox, "How far ahead: 48 h").click();
        settle(&mut window);
        window.get_by_label("12 h").click();
        assert_eq!(asked(&mut window), [UiCommand::SetSpan(12)]);
    }
}

#[test]
fn a_pass_of_any_satellite_is_listed_selected_drawn_and_tracked() {
    for size in rig::sizes() {
        let mut model = rig::model(states::holding());
        let favourites = std::mem::take(&mut model.shown_mut().pass_lists.favourites.passes);
        // Use the same passes, as if their satellites were not favourites.
        model.shown_mut().pass_lists.all.passes = favourites;
        model.shown_mut().pass_lists.all.satellites =
            model.pass_lists.favourites.satellites.clone();
        model.list.scope = Scope::All;
        let is_wanted =
            |pass: &&PredictedPass| pass.number() == METEOR_M2_4 && pass.pass.aos.time > model.now;
        let wanted = model.pass_lists.all.passes.iter().find(is_wanted).unwrap().key();
        let mut window = rig::window(size, model);
        open_list(&mut window);
        let row = "METEOR-M2 4, AOS T−1:28:51, max 49°, Trackable";
        rig::scroll(&mut window, egui::pos2(180.0, 400.0), -200.0);
        window.get_by_role_and_label(Role::ListBoxOption, row).scroll_to_me();
        settle(&mut window);
        window.get_by_role_and_label(Role::ListBoxOption, row).click();
        assert_eq!(asked(&mut window), [UiCommand::SelectPass(wanted)]);
        let model = &mut window.state_mut().model;
        model.selected = Some(wanted);
        model.refresh_sky();
        settle(&mut window);
        window.get_by_label_contains("METEOR-M2 4, 59051, ");
        window.get_by_role_and_label(Role::Button, "Track METEOR-M2 4").click();
        let track = UiCommand::Station(contract::Command::Track {
            antenna: AntennaId(1),
            pass: wanted,
            is_agreed: false,
        });
        assert_eq!(asked(&mut window), [track]);
        assert!(window.query_by_label_contains("12:44Z to 12:56Z").is_none(), "not in the strip");
        window.key_press(Key::N);
        assert_eq!(asked(&mut window), [], "no followed satellite comes");
        window.key_press(Key::ArrowUp);
        assert!(matches!(asked(&mut window)[..], [UiCommand::SelectPass(_)]));
    }
}

#[test]
fn the_span_cuts_the_list_and_leaves_strip_and_next_pass_alone() {
    let mut model = rig::model(states::holding());
    model.list.favourites_h = 6;
    let (all, listed) = (model.pass_lists.favourites.passes.len(), model.upcoming().len());
    assert!(0 < listed && listed < all);
    let mut window = rig::window(LARGE, model);
    window.get_by_label(&format!("Next passes, {listed} · AOS at 5°"));
    Arc::make_mut(&mut window.state_mut().model.shown_mut().pass_lists.favourites.passes).clear();
    settle(&mut window);
    assert!(says(&window, "No pass in the next 6 h. Choose a lower elevation."));
}

#[test]
fn the_list_is_filtered_by_name_and_number() {
    for size in rig::sizes() {
        let mut window = window(size);
        window.key_press_modifiers(Modifiers::COMMAND, Key::F);
        settle(&mut window);
        window.event(Event::Text("meteor".to_owned()));
        settle(&mut window);
        // The filter does not apply to the strip of passes, whose bars do not count as rows.
        let rows = window.get_all_by_role(Role::ListBoxOption);
        let rows = rows.filter_map(|row| row.accesskit_node().label());
        let rows: Vec<_> = rows.filter(|name| name.contains("OS T−")).collect();
        assert!(rows.len() > 1 && rows.iter().all(|row| row.starts_with("METEOR")), "{rows:?}");
        let wanted: Vec<_> = (window.state().model.upcoming().iter())
            .filter(|pass| pass.number() == METEOR_M2_4)
            .map(PredictedPass::key)
            .collect();
        window.state_mut().model.selected = Some(wanted[0]);
        window.get_by_role_and_label(Role::TextInput, "Filter of the list").click();
        settle(&mut window);
        window.event(Event::Text("x".to_owned()));
        settle(&mut window);
        assert!(says(&window, "No listed pass has this name or number."));
        window.get_by_role_and_label(Role::Button, "Close").click();
        assert_eq!(asked(&mut window), []);
        assert!(window.get_all_by_label_contains("NOAA 20, ").count() > 0);
    }
}

#[test]
fn up_and_down_stay_within_what_is_filtered() {
    let mut window = window(LARGE);
    window.key_press_modifiers(Modifiers::COMMAND, Key::F);
    settle(&mut window);
    window.event(Event::Text("59051".to_owned()));
    settle(&mut window);
    let of_meteor: Vec<_> = (window.state().model.upcoming().iter())
        .filter(|pass| pass.number() == METEOR_M2_4)
        .map(PredictedPass::key)
        .collect();
    window.state_mut().model.selected = Some(of_meteor[0]);
    // A click moves the focus out of the field.
    window.drag_at(egui::pos2(700.0, 300.0));
    window.drop_at(egui::pos2(700.0, 300.0));
    asked(&mut window);
    window.key_press(Key::ArrowDown);
    assert_eq!(asked(&mut window), [UiCommand::SelectPass(of_meteor[1])]);
}

/// Returns the names of the rows of the list.
fn rows(window: &Window) -> Vec<String> {
    let rows = window.get_all_by_role(Role::ListBoxOption);
    let names = rows.filter_map(|row| row.accesskit_node().label());
    names.filter(|name| name.contains("OS T−") || name.contains("OS in")).collect()
}

#[test]
fn chips_filter_and_sort_the_list_and_stay_when_it_is_closed() {
    for size in rig::sizes() {
        let mut window = window(size);
        open_list(&mut window);
        window.key_press_modifiers(Modifiers::COMMAND, Key::F);
        settle(&mut window);
        window.get_by_role_and_label(Role::ComboBox, "Order: By AOS").click();
        settle(&mut window);
        window.get_by_label("Highest first").click();
        settle(&mut window);
        window.get_by_role_and_label(Role::CheckBox, "Upcoming").click();
        settle(&mut window);
        let listed = rows(&window);
        let highest = |row: &String| -> f64 {
            let after = row.split("max ").nth(1).unwrap();
            after.split('°').next().unwrap().parse().unwrap()
        };
        assert!(listed.len() > 1, "{listed:?}");
        assert!(listed.iter().map(highest).is_sorted_by(|a, b| a >= b), "{listed:?}");
        assert!(listed.iter().all(|row| !row.contains("LOS")), "{listed:?}");
        let arrangement = window.state().views.stored().passes;
        assert_eq!((arrangement.order, arrangement.to_come), (Order::Maximum, true));

        window.get_by_role_and_label(Role::Button, "Close").click();
        settle(&mut window);
        assert!(says(&window, "Filtered: Highest first · Upcoming"));
        window.get_by_role_and_label(Role::Button, "Clear").click();
        settle(&mut window);
        assert_eq!(window.state().views.stored().passes, Arrangement::default());
        assert_eq!(asked(&mut window), []);
    }
}

#[test]
fn sunlit_trackable_and_time_of_day_leave_out_the_rest() {
    let of = |arrangement: Arrangement| {
        let mut window = window(LARGE);
        window.state_mut().views =
            Views::new(StoredViews { passes: arrangement, ..StoredViews::default() });
        settle(&mut window);
        window.run_steps(20);
        let title = window.get_by_label_contains("Next passes, ").accesskit_node().value();
        let title = title.unwrap().replace("Next passes, ", "");
        title.split([' ', '·']).next().unwrap().parse::<usize>().unwrap()
    };
    let all = of(Arrangement::default());
    let [day, night] =
        [Light::Day, Light::Night].map(|light| of(Arrangement { light, ..Arrangement::default() }));
    assert_eq!(day + night, all);
    assert!(day > 0 && night > 0, "{day} {night}");
    let sunlit = of(Arrangement { sunlit: true, ..Arrangement::default() });
    assert!((1..all).contains(&sunlit), "{sunlit} of {all}");
    let trackable = of(Arrangement { trackable: true, ..Arrangement::default() });
    assert!((1..=all).contains(&trackable), "{trackable} of {all}");
    let group = Some("no such group".to_owned());
    assert_eq!(of(Arrangement { group, ..Arrangement::default() }), all, "a group that is gone");
}

#[test]
fn arrows_follow_the_order_of_the_rows() {
    let mut window = window(LARGE);
    let passes = Arrangement { order: Order::Duration, to_come: true, ..Arrangement::default() };
    window.state_mut().views = Views::new(StoredViews { passes, ..StoredViews::default() });
    let model = &window.state().model;
    let mut wanted: Vec<&PredictedPass> =
        model.upcoming().iter().filter(|pass| pass.pass.aos.time > model.now).collect();
    wanted.sort_by(|a, b| b.pass.duration_s().total_cmp(&a.pass.duration_s()));
    let keys: Vec<_> = wanted.iter().map(|pass| pass.key()).collect();
    window.state_mut().model.selected = Some(keys[1]);
    asked(&mut window);
    window.key_press(Key::ArrowDown);
    assert_eq!(asked(&mut window), [UiCommand::SelectPass(keys[2])]);
}

/// Opens the list, which is a drawer in the small window.
fn open_list(window: &mut Window) {
    if window.query_by_label_contains("Next passes, ").is_none() {
        window.key_press(Key::P);
        settle(window);
    }
}

#[test]
fn the_header_counts_to_los_while_the_satellite_is_up_and_to_aos_before() {
    for size in rig::sizes() {
        let mut model = rig::model(states::holding());
        let window = rig::window(size, rig::model(states::holding()));
        assert!(says(&window, "LOS T−05:56"));
        assert_eq!(model.selected.map(|(number, _)| number), Some(NOAA_20));
        model.selected = Some(coming(&model, METEOR_M2_4).key());
        model.refresh_sky();
        let window = rig::window(size, model);
        assert!(says(&window, "AOS T−1:28:51"));
    }
}

#[test]
fn a_pass_that_is_over_leaves_nothing_selected() {
    for size in rig::sizes() {
        let mut model = rig::model(states::holding());
        model.now = add_seconds(states::los(), 1.0);
        let now = model.now;
        Arc::make_mut(&mut model.shown_mut().pass_lists.favourites.passes)
            .retain(|predicted| predicted.pass.los.time > now);
        model.refresh_sky();
        let window = rig::window(size, model);
        window.get_by_label("No pass is selected. Choose one from the list.");
        assert!(window.query_by_label_contains("Track NOAA 20").is_none());
    }
}

#[test]
fn the_list_is_drawn_wider_and_a_double_click_brings_it_back() {
    let mut window = window(LARGE);
    let edge = |window: &Window| window.get_by_label("Width of the pass list").rect().center();
    let usual = edge(&window);
    let target = usual + egui::vec2(70.0, 5.0);
    window.drag_at(usual);
    window.hover_at(target);
    settle(&mut window);
    window.drop_at(target);
    settle(&mut window);
    assert_eq!(window.state().views.stored().list_width, Some(390));
    assert!((edge(&window).x - usual.x - 70.0).abs() < 1.5, "{}", edge(&window));
    let at = edge(&window);
    window.hover_at(at);
    settle(&mut window);
    // Send both clicks in one frame, because the frames of a story are too slow for a double click.
    let press = |pressed| Event::PointerButton {
        pos: at,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    window.input_mut().events.extend([true, false, true, false].map(press));
    settle(&mut window);
    assert_eq!(window.state().views.stored().list_width, None);
    assert_eq!(edge(&window), usual);
    assert_eq!(asked(&mut window), []);
}

#[test]
fn layers_and_width_are_there_again_at_the_next_start() {
    let layers = Layers { names: false, ..Layers::default() };
    let kept = StoredViews { list_width: Some(300), layers, ..StoredViews::default() };
    let mut window = window(LARGE);
    window.state_mut().views = Views::new(kept.clone());
    settle(&mut window);
    assert_eq!(window.state().views.stored(), kept);
    let edge = window.get_by_label("Width of the pass list").rect().center();
    assert!((edge.x - (72.0 + 300.0)).abs() < 1.5, "{edge}");
}
