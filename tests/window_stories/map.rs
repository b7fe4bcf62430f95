//! Map view: the satellites over the globe.

use std::sync::Arc;

use azel::{
    astro::{GroundPoint, time::add_seconds},
    contract::passes::{ListedSatellite, PassLists, PredictedPass},
    model::{Model, UiCommand, View, globe::MapDirection},
    orbit::{Propagator, bundled},
};
use egui::{Event, Key, Modifiers, PointerButton, Role, pos2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    every_view::painted,
    extremes::{nothing_is_cut, nothing_overlaps},
    rig::{self, LARGE, NOAA_20, SIZES, SMALL, Window, asked, says, settle},
    states,
};

/// Catalog number of a favourite with a pass after the current one.
const METEOR: u32 = 59_051;
/// Largest common window size, points, besides the default one and the smallest.
const FULL: [f32; 2] = [1920.0, 1080.0];

fn model() -> Model {
    let mut model = rig::model(states::holding());
    model.view = View::Map;
    model.refresh_sky();
    model
}

fn view(size: [f32; 2]) -> Window {
    rig::window(size, model())
}

/// Selects the pass of a favourite as the window does.
fn select(model: &mut Model, number: u32) {
    model.selected = model.pass_of(number).map(PredictedPass::key);
    model.refresh_sky();
}

/// Returns the names of the nodes of this role that contain `contains`.
fn named(window: &Window, role: Role, contains: &str) -> Vec<String> {
    let labels = window.query_all_by_role(role).filter_map(|node| node.accesskit_node().label());
    labels.filter(|label| label.contains(contains)).collect()
}

#[test]
fn the_view_opens_from_rail_and_key() {
    for size in SIZES {
        let mut window = rig::window(size, rig::model(states::holding()));
        window.get_by_role_and_label(Role::Tab, "Map").click();
        assert_eq!(asked(&mut window), [UiCommand::Show(View::Map)]);
        window.key_press_modifiers(Modifiers::COMMAND, Key::Num8);
        assert_eq!(asked(&mut window), [UiCommand::Show(View::Map)]);
        let foot = window.get_by_role_and_label(Role::Tab, "Preferences").rect();
        let keys = window.get_by_role_and_label(Role::Button, "Keys").rect();
        assert!(foot.bottom() <= keys.top(), "{foot:?} {keys:?}");
    }
}

#[test]
fn every_window_shows_the_whole_map() {
    for size in [LARGE, SMALL, FULL, [1440.0, 640.0], [1200.0, 760.0]] {
        for is_demo in [false, true] {
            let mut model = model();
            model.shown_mut().demo = is_demo;
            "Şile northern field unit"
                .clone_into(&mut Arc::make_mut(&mut model.shown_mut().station).name);
            let window = rig::window(size, model);
            nothing_is_cut(&window, size);
            nothing_overlaps(&window);
            let map = window.get_by_role(Role::Canvas).rect();
            assert!((map.width() - 2.0 * map.height()).abs() < 1.0, "{size:?} {map:?}");
            assert!(map.width() > 0.6 * size[0] - 72.0, "{size:?} {map:?}");
            assert!(map.bottom() <= size[1], "{size:?} {map:?}");
        }
    }
}

#[test]
fn the_map_and_the_table_name_every_satellite_and_the_station() {
    let window = view(LARGE);
    assert!(says(&window, "5 favourites, 3 above 5° at Şile 1"));
    let on_map = named(&window, Role::ListBoxOption, "on the map");
    assert_eq!(on_map.len(), 5, "{on_map:?}");
    assert_eq!(named(&window, Role::Canvas, "Map. 5 favourites").len(), 1);
    assert!(says(&window, "Station Şile 1, 41.0° N, 29.2° E"));
    let rows = named(&window, Role::ListBoxOption, "azimuth");
    assert_eq!(rows.len(), 5, "{rows:?}");
    // The highest satellite comes first.
    assert!(rows[0].starts_with("NOAA 20, "), "{rows:?}");
    assert!(rows[0].contains("next until"), "{rows:?}");
    for of in &window.state().model.globe.satellites {
        let place = format!("{:.1}° ", of.below.point.latitude.degrees().abs());
        let row = rows.iter().find(|row| row.starts_with(of.satellite.short_name()));
        assert!(row.is_some_and(|row| row.contains(&place)), "{place} {rows:?}");
    }
}

#[test]
fn a_name_keeps_off_the_numbers_of_the_grid() {
    let is_number = |words: &str| words.ends_with("°W") || words.ends_with("°S");
    for size in [SMALL, LARGE, FULL, [2560.0, 1440.0]] {
        let mut window = view(size);
        let globe = &window.state().model.globe;
        let place = globe.satellites.iter().position(|of| of.is_selected).expect("one is selected");
        let name = globe.satellites[place].satellite.short_name().replace(' ', "");
        let mut seen = 0;
        for longitude_deg in (-84..=-36).step_by(3) {
            for latitude_deg in [-86.0, -80.0, -74.0] {
                let point = GroundPoint::from_degrees(latitude_deg, f64::from(longitude_deg));
                window.state_mut().model.globe.satellites[place].below.point = point;
                settle(&mut window);
                let texts = painted::placed(&window);
                let map = window.get_by_role(Role::Canvas).rect();
                let on_map = || texts.iter().filter(|(_, at)| map.contains_rect(*at));
                let named = on_map().filter(|(words, _)| *words == name);
                for (_, at) in named {
                    seen += 1;
                    let touches =
                        |of: &egui::Rect| of.expand2(egui::vec2(4.0, 0.0)).intersects(*at);
                    let number =
                        on_map().find(|(words, number)| is_number(words) && touches(number));
                    assert_eq!(number, None, "{size:?} {longitude_deg} {latitude_deg}: {at:?}");
                }
            }
        }
        assert!(seen > 20, "{size:?}: {seen} names");
    }
}

#[test]
fn the_globe_agrees_with_the_sky() {
    let model = model();
    let globe = &model.globe;
    let elevations: Vec<f64> =
        globe.satellites.iter().map(|of| of.look.direction.elevation_deg()).collect();
    assert!(elevations.is_sorted_by(|a, b| a >= b), "{elevations:?}");
    let here = model.station.site.point();
    for of in &globe.satellites {
        let sees = of.footprint.contains(here);
        let off_deg = of.look.direction.elevation_deg() - globe.aos_elevation.degrees();
        assert!(sees == (off_deg > 0.0) || off_deg.abs() < 0.4, "{} {off_deg}", of.number());
        let first = of.track.first().unwrap();
        assert!(first.time <= model.now, "{}", of.number());
        let near = of
            .track
            .iter()
            .min_by_key(|point| (point.time.as_second() - model.now.as_second()).abs());
        let off_deg = near.unwrap().point.distance(of.below.point).degrees();
        assert!(off_deg < 5.0, "{} {off_deg}", of.number());
    }
    let selected = globe.selected().unwrap();
    assert_eq!(selected.number(), NOAA_20);
    let (first, last) = (selected.track[0], selected.track[selected.track.len() - 1]);
    let minutes = |from: jiff::Timestamp, to: jiff::Timestamp| {
        (to.as_second() - from.as_second()) as f64 / 60.0
    };
    assert!((50.0..51.0).contains(&minutes(first.time, model.now)));
    assert!((149.0..151.0).contains(&minutes(model.now, last.time)));
    // The time is noon in summer in Istanbul, so the globe shows day there.
    assert!(!globe.night.unwrap().contains(here));
    assert!(globe.subsolar.unwrap().latitude.degrees() > 10.0);
}

#[test]
fn the_tracks_of_a_long_list_come_little_by_little() {
    let mut model = model();
    let catalog = bundled().unwrap();
    let near_earth = catalog.iter().filter(|of| of.period_s() < 7200.0).take(20);
    let satellites = near_earth.map(|elements| {
        let propagator = Propagator::new(elements).unwrap();
        Arc::new(ListedSatellite { elements: elements.clone(), propagator })
    });
    let chosen = model.pass_lists.satellite(NOAA_20).cloned();
    model.shown_mut().pass_lists.favourites.satellites =
        Arc::new(chosen.into_iter().chain(satellites).collect());
    model.shown_mut().pass_lists.favourites.revision += 1;
    for wanted in [9, 17, 21, 21] {
        model.now = add_seconds(model.now, 1.0);
        model.refresh_sky();
        let globe = &model.globe;
        assert_eq!(globe.satellites.len(), 21);
        let drawn = globe.satellites.iter().filter(|of| !of.track.is_empty()).count();
        assert_eq!(drawn, wanted);
        assert!(!globe.selected().unwrap().track.is_empty(), "the selected one comes first");
    }
}

#[test]
fn only_where_passes_were_searched_for_is_it_said_that_there_is_none() {
    let said = |change: fn(&mut Model)| {
        let mut model = model();
        model.shown_mut().pass_lists.favourites.passes = Arc::default();
        model.shown_mut().pass_lists.favourites.revision += 1;
        model.shown_mut().pass_lists.favourites.made_at = Some(model.now);
        change(&mut model);
        model.refresh_sky();
        let window = rig::window(FULL, model);
        let texts = painted::texts(&window);
        let is_painted = |words: &str| texts.iter().any(|text| text == words);
        ["none in 48 h", "not computed", "…", "No later pass in the next 48 h."].map(is_painted)
    };
    assert_eq!(said(|_| {}), [true, false, false, true]);
    assert_eq!(
        said(|model| model.shown_mut().pass_lists.favourites.made_at = None),
        [false, false, true, false]
    );
    let not_followed = |model: &mut Model| {
        Arc::make_mut(&mut model.shown_mut().station).favourites = std::iter::empty().collect();
    };
    assert_eq!(said(not_followed), [false, true, false, false]);
}

#[test]
fn a_mask_decides_what_is_up() {
    let mut model = model();
    let mask = azel::astro::HorizonMask::from_degrees([(0.0, 89.0)]).unwrap();
    Arc::make_mut(&mut model.shown_mut().station).horizon_mask = Some(mask);
    model.refresh_sky();
    assert!(model.globe.satellites.iter().all(|of| !of.is_up));
    assert!(says(&rig::window(LARGE, model), "5 favourites, 0 above the mask at Şile 1"));
}

#[test]
fn a_click_on_the_map_or_in_the_table_selects() {
    let mut window = view(LARGE);
    let name = named(&window, Role::ListBoxOption, "SWOT").first().cloned();
    assert!(name.is_none(), "not a favourite");
    for kind in ["on the map", "azimuth"] {
        for of in model().globe.satellites.iter().filter(|of| of.next.is_some()) {
            let number = of.number();
            let start = of.satellite.short_name();
            let labels = named(&window, Role::ListBoxOption, kind);
            let label = labels.iter().find(|label| label.starts_with(start)).unwrap();
            window.get_by_role_and_label(Role::ListBoxOption, label).click();
            let wanted = [UiCommand::SelectSatellite(number)];
            assert_eq!(asked(&mut window), wanted, "{label}");
        }
    }
}

#[test]
fn a_double_click_opens_the_sky_plot() {
    let mut window = view(LARGE);
    let label = named(&window, Role::ListBoxOption, "azimuth").remove(1);
    let at = window.get_by_role_and_label(Role::ListBoxOption, &label).rect().center();
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
    assert!(asked(&mut window).contains(&UiCommand::Show(View::Operate)));
}

#[test]
fn the_selected_satellite_stands_in_the_inspector() {
    for size in SIZES {
        let mut model = model();
        select(&mut model, METEOR);
        let mut window = rig::window(size, model);
        if size == SMALL {
            assert!(window.query_by_label_contains("Sub-satellite point").is_none());
            window.get_by_role_and_label(Role::Button, "Details").click();
            settle(&mut window);
            nothing_overlaps(&window);
        }
        for words in
            ["METEOR-M2 4, 59051, elements", "LOS T", "Sub-satellite point: ", "Height, speed: 8"]
        {
            assert!(says(&window, words), "{words}");
        }
        assert!(says(&window, "Footprint radius: 2"));
        assert!(says(&window, "Heading: "));
        assert!(says(&window, "Next at Şile 1"));
        let passes = named(&window, Role::ListBoxOption, "Pass at ");
        assert!(!passes.is_empty());
        // A small window needs scrolling to show the passes.
        rig::scroll(&mut window, pos2(size[0] - 100.0, 400.0), -2000.0);
        window.get_by_role_and_label(Role::ListBoxOption, &passes[0]).click();
        let asked_for = asked(&mut window);
        assert!(
            matches!(asked_for[..], [UiCommand::SelectPass((METEOR, aos))] if aos > rig::now()),
            "{asked_for:?}"
        );
        window.get_by_role_and_label(Role::Button, "Open on sky plot").click();
        assert_eq!(asked(&mut window), [UiCommand::Show(View::Operate)]);
        window.get_by_role_and_label(Role::Button, "Elements").click();
        assert_eq!(asked(&mut window), [UiCommand::Show(View::Elements)]);
    }
}

#[test]
fn a_satellite_stays_selected_when_its_pass_is_over() {
    for (number, countdown) in [(METEOR, "AOS T"), (NOAA_20, "no pass")] {
        let mut model = model();
        select(&mut model, number);
        model.now = model.selected_pass().unwrap().pass.los.time;
        model.refresh_sky();
        assert!(model.selected_pass().is_none());
        assert_eq!(model.globe.selected().unwrap().number(), number);
        assert!(says(&rig::window(LARGE, model), countdown), "{number}");
    }
}

#[test]
fn the_table_of_a_small_window_is_a_drawer() {
    let mut window = view(SMALL);
    assert_eq!(named(&window, Role::ListBoxOption, "azimuth").len(), 0);
    for rows in [5, 0] {
        window.get_by_role_and_label(Role::Button, "Where they are").click();
        settle(&mut window);
        assert_eq!(named(&window, Role::ListBoxOption, "azimuth").len(), rows);
        nothing_is_cut(&window, SMALL);
        nothing_overlaps(&window);
    }
}

#[test]
fn a_note_leaves_the_bar_of_the_table() {
    let mut window = view(SMALL);
    window.state_mut().views.file_saved(Err("the disk is full".to_owned()));
    settle(&mut window);
    let note = window.get_by_role_and_label(Role::Button, "Close the note of the file").rect();
    let bar = window.get_by_role_and_label(Role::Button, "Where they are").rect();
    assert!(note.bottom() < bar.top(), "{note:?} {bar:?}");
}

#[test]
fn the_arrows_lead_from_satellite_to_satellite() {
    for (key, towards) in [
        (Key::ArrowUp, MapDirection::North),
        (Key::ArrowRight, MapDirection::East),
        (Key::ArrowDown, MapDirection::South),
        (Key::ArrowLeft, MapDirection::West),
    ] {
        let mut window = view(LARGE);
        let globe = &window.state().model.globe;
        let from = globe.selected().unwrap().below.point;
        let next = globe.nearest(towards, |_| true);
        if let Some(next) = next {
            let to = globe.satellites.iter().find(|of| of.number() == next).unwrap();
            let north = (to.below.point.latitude - from.latitude).degrees();
            let east = (to.below.point.longitude - from.longitude).wrapped_180().degrees();
            let along = match towards {
                MapDirection::North => north,
                MapDirection::South => -north,
                MapDirection::East => east,
                MapDirection::West => -east,
            };
            assert!(along > 0.0, "{towards:?} {north} {east}");
        }
        window.key_press(key);
        let wanted: Vec<_> = next.map(UiCommand::SelectSatellite).into_iter().collect();
        assert_eq!(asked(&mut window), wanted, "{key:?}");
    }
    // Without a selected satellite, the keys begin with the highest selectable one.
    let mut model = model();
    model.selected = None;
    model.refresh_sky();
    assert!(model.globe.selected().is_none());
    let highest = model.globe.satellites.iter().find(|of| of.next.is_some()).unwrap().number();
    let mut window = rig::window(LARGE, model);
    assert!(says(&window, "No satellite selected"));
    window.key_press(Key::ArrowUp);
    assert_eq!(asked(&mut window), [UiCommand::SelectSatellite(highest)]);
}

/// Returns the places of the marks on the map, in the order of the globe.
fn marks(window: &Window) -> Vec<egui::Rect> {
    let name = |of: &azel::model::globe::GlobeSatellite| {
        format!("{} on the map", of.satellite.short_name())
    };
    let names = window.state().model.globe.satellites.iter().map(name);
    let find = |name: String| window.query_by_label_contains(&name).map(|node| node.rect());
    names.filter_map(find).collect()
}

#[test]
fn keys_wheel_and_drag_move_the_map() {
    for size in SIZES {
        let mut window = view(size);
        let whole = marks(&window);
        assert_eq!(whole.len(), 5);
        window.key_press(Key::Plus);
        settle(&mut window);
        assert_ne!(marks(&window), whole);
        window.key_press(Key::Minus);
        settle(&mut window);
        assert_eq!(marks(&window), whole);
        let sea = window.get_by_role(Role::Canvas).rect().left_top() + egui::vec2(60.0, 40.0);
        rig::scroll(&mut window, sea, 120.0);
        assert_ne!(marks(&window), whole);
        window.key_press(Key::Num0);
        settle(&mut window);
        assert_eq!(marks(&window), whole);
        window.drag_at(sea);
        window.step();
        window.hover_at(sea + egui::vec2(100.0, 0.0));
        window.step();
        window.drop_at(sea + egui::vec2(100.0, 0.0));
        settle(&mut window);
        assert_ne!(marks(&window), whole);
        assert_eq!(asked(&mut window), [], "nothing but the map moves");
    }
}

#[test]
fn the_place_under_the_pointer_is_told() {
    let mut window = view(LARGE);
    let map = window.get_by_role(Role::Canvas).rect();
    // Point 60 degrees west and 30 degrees north of the middle, in the sea.
    window.hover_at(pos2(map.center().x - map.width() / 6.0, map.center().y - map.width() / 12.0));
    settle(&mut window);
    assert!(says(&window, "Pointer at 30.0° N, 60.0° W"));
    window.hover_at(pos2(400.0, 20.0));
    settle(&mut window);
    assert!(!says(&window, "Pointer at"));
}

#[test]
fn layers_are_shown_and_hidden_and_kept() {
    for size in rig::sizes() {
        let mut window = view(size);
        assert!(window.query_by_label("Grid").is_none());
        window.key_press(Key::L);
        settle(&mut window);
        for name in ["Grid", "Tracks of the others"] {
            window.get_by_label(name).click();
            settle(&mut window);
        }
        let layers = window.state().views.stored().map_layers;
        assert!(!layers.grid && layers.other_tracks && layers.terminator);
        window.key_press(Key::L);
        settle(&mut window);
        assert!(window.query_by_label("Grid").is_none());
    }
    // A wide window has the first four in the bar as well.
    let mut window = view(LARGE);
    for name in ["Tracks", "Footprints", "Terminator", "Names"] {
        window.get_by_role_and_label(Role::CheckBox, name).click();
        settle(&mut window);
    }
    let layers = window.state().views.stored().map_layers;
    assert!(!(layers.tracks || layers.footprints || layers.terminator || layers.names));
}

#[test]
fn only_what_antennas_track_is_shown_where_that_is_wanted() {
    let mut model = rig::model(states::tracking(0.04));
    model.view = View::Map;
    select(&mut model, 25_544);
    let mut window = rig::window(LARGE, model);
    assert_eq!(named(&window, Role::ListBoxOption, "on the map").len(), 5);
    window.get_by_role_and_label(Role::RadioButton, "Tracked").click();
    settle(&mut window);
    let left = named(&window, Role::ListBoxOption, "on the map");
    // The tracked satellite and the selected one stay.
    assert_eq!(left.len(), 2, "{left:?}");
    assert!(left.iter().any(|name| name.starts_with("NOAA 20")), "{left:?}");
    assert!(left.iter().any(|name| name.starts_with("ISS")), "{left:?}");
}

#[test]
fn a_map_without_satellites_says_why() {
    for size in SIZES {
        let mut model = model();
        model.shown_mut().pass_lists = PassLists::default();
        model.selected = None;
        Arc::make_mut(&mut model.shown_mut().station).favourites = [].into();
        model.refresh_sky();
        let mut window = rig::window(size, model);
        if size == SMALL {
            window.get_by_role_and_label(Role::Button, "Where they are").click();
            settle(&mut window);
        }
        assert!(says(&window, "No satellite is shown. Choose favourites in Elements."));
        assert!(says(&window, "0 favourites, 0 above 5°"));
        nothing_is_cut(&window, size);
        window.key_press(Key::ArrowUp);
        assert_eq!(asked(&mut window), []);
        window.get_by_role_and_label(Role::RadioButton, "Tracked").click();
        settle(&mut window);
        assert!(says(&window, "No antenna tracks a satellite."));
    }
}

#[test]
fn stop_is_where_it_always_is() {
    for size in rig::sizes() {
        let mut window = view(size);
        window.get_by_role_and_label(Role::Button, "STOP").click();
        assert_eq!(asked(&mut window), [UiCommand::Stop]);
    }
}
