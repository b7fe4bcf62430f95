//! Keep-outs that the operator adds, draws, types, undoes, compares with the passes and saves.

use std::{fs, sync::Arc};

use azel::{
    astro::{Angle, HorizonMask},
    contract::driver::{Intent, Snapshot, StoppingWay},
    controller::SPECS,
    device::AxisMotion,
    engine::antenna::{Recent, refresh},
    model::{
        Model, UiCommand, View,
        effects::{self, Effect, obstacles},
    },
    station::{self, Antenna, Entered, KeepOut, Station, SunAvoidance},
};
use egui::{Event, Key, Modifiers, PointerButton, Pos2, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    preferences::saved,
    rig::{self, LARGE, SMALL, Window, settle},
    states,
};

/// Opens the page in the window of the preferences.
pub(crate) fn open(window: &mut Window) {
    window.get_by_role_and_label(Role::RadioButton, "Horizon and keep-outs").click();
    settle(window);
}

/// Shows the form if the plot hides it.
pub(crate) fn show_table(window: &mut Window) {
    if let Some(tab) = window.query_by_role_and_label(Role::RadioButton, "Table") {
        tab.click();
    }
    settle(window);
}

/// Returns the commands other than requests for the effect of the draft.
pub(crate) fn asked(window: &mut Window) -> Vec<UiCommand> {
    let mut commands = rig::asked(window);
    commands.retain(|command| !matches!(command, UiCommand::ShowEffects(_)));
    commands
}

fn mast() -> KeepOut {
    crate::common::mast(&[(80.0, 0.0), (80.0, 30.0), (100.0, 30.0), (100.0, 0.0)])
}

fn page_of(size: [f32; 2], mut model: Model) -> Window {
    model.view = View::Preferences;
    let mut window = rig::window(size, model);
    open(&mut window);
    window
}

/// Returns the page of a station with a mast in the east.
pub(crate) fn page(size: [f32; 2]) -> Window {
    let mut model = rig::model(states::holding());
    Arc::make_mut(&mut model.shown_mut().station).keep_outs = vec![mast()];
    page_of(size, model)
}

fn choose(window: &mut Window, zone: &str) {
    show_table(window);
    let row = format!("{zone}, ");
    window
        .get_by(|node| {
            node.role() == Role::ListBoxOption
                && node.label().is_some_and(|of| of.starts_with(&row))
        })
        .click();
    settle(window);
}

fn show_plot(window: &mut Window) {
    if let Some(tab) = window.query_by_role_and_label(Role::RadioButton, "Plot") {
        tab.click();
    }
    settle(window);
}

fn place(window: &Window, mark: &str) -> Pos2 {
    window.get_by_label_contains(mark).rect().center()
}

fn drag(window: &mut Window, from: Pos2, to: Pos2, modifiers: Modifiers) {
    let button = |pos, pressed| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers,
    };
    window.event(Event::ModifiersChanged(modifiers));
    window.event(Event::PointerMoved(from));
    window.event(button(from, true));
    settle(window);
    for share in [0.3, 0.7, 1.0] {
        window.event(Event::PointerMoved(from.lerp(to, share)));
        settle(window);
    }
    window.event(button(to, false));
    window.event(Event::ModifiersChanged(Modifiers::NONE));
    settle(window);
}

fn corners(station: &Station, place: usize) -> Vec<(f64, f64)> {
    KeepOut::corners_deg(&station.keep_outs[place].zone)
}

fn save(window: &mut Window) -> Station {
    window.get_by_role_and_label(Role::Button, "Save and use").click();
    saved(asked(window))
}

fn is_locked(window: &Window) -> bool {
    window.get_by_role_and_label(Role::Button, "Save and use").accesskit_node().is_disabled()
}

fn field(window: &mut Window, name: &str, words: &str) {
    window.get_by_role_and_label(Role::TextInput, name).focus();
    settle(window);
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.event(Event::Text(words.to_owned()));
    settle(window);
}

#[test]
fn a_zone_is_added_named_and_saved_to_the_file() {
    for size in rig::sizes() {
        let mut window = page_of(size, rig::model(states::holding()));
        show_table(&mut window);
        window.get_by_role_and_label(Role::Button, "Add zone").click();
        settle(&mut window);
        field(&mut window, "Name of the keep-out", "roof");
        field(&mut window, "Reason of the keep-out", "New air conditioning");
        field(&mut window, "Safety margin", "2,5");
        window.get_by_role_and_label(Role::RadioButton, "Go round").click();
        settle(&mut window);
        let station = save(&mut window);
        let [roof] = &station.keep_outs[..] else { panic!("{:?}", station.keep_outs) };
        assert_eq!((&*roof.name, roof.entered, &roof.antenna), ("roof", Entered::GoRound, &None));
        assert!((roof.margin_deg - 2.5).abs() < 1e-12);
        assert_eq!(roof.reason, "New air conditioning");
        assert_eq!(corners(&station, 0).len(), 4);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("station.toml");
        station::save(&station, &path, SPECS).unwrap();
        let loaded = station::load(&path, SPECS).unwrap();
        assert_eq!((loaded.station, loaded.notes), (station, Vec::new()));
        assert!(fs::read_to_string(&path).unwrap().contains("[[keep_out]]"));
    }
}

#[test]
fn a_corner_is_dragged_and_the_drag_is_undone_and_done_again() {
    for size in rig::sizes() {
        let mut window = page(size);
        choose(&mut window, "mast");
        show_plot(&mut window);
        let from = place(&window, "Corner 2 of mast");
        // Move to the north-east, where the plot is free.
        let to = from + egui::vec2(0.0, -40.0);
        drag(&mut window, from, to, Modifiers::NONE);
        assert!(place(&window, "Corner 2 of mast").distance(to) < 4.0);
        let moved = place(&window, "Corner 2 of mast");
        for (modifiers, at) in [
            (Modifiers::COMMAND, from),
            (Modifiers::COMMAND | Modifiers::SHIFT, moved),
            (Modifiers::COMMAND, from),
        ] {
            window.key_press_modifiers(modifiers, Key::Z);
            settle(&mut window);
            assert!(place(&window, "Corner 2 of mast").distance(at) < 0.5);
        }
        assert!(is_locked(&window), "as it was");
    }
}

#[test]
fn shift_keeps_the_axis_that_moved_less() {
    let mut window = page(LARGE);
    choose(&mut window, "mast");
    let from = place(&window, "Corner 2 of mast");
    drag(&mut window, from, from + egui::vec2(2.0, -30.0), Modifiers::SHIFT);
    let station = save(&mut window);
    let (azimuth, elevation) = corners(&station, 0)[1];
    assert!((elevation - 30.0).abs() < 1e-9 && azimuth < 75.0, "{azimuth}, {elevation}");
}

#[test]
fn keys_move_add_and_remove_a_corner() {
    let mut window = page(LARGE);
    choose(&mut window, "mast");
    window.get_by_label_contains("Corner 2 of mast").click();
    settle(&mut window);
    window.key_press(Key::ArrowUp);
    settle(&mut window);
    window.key_press_modifiers(Modifiers::SHIFT, Key::ArrowLeft);
    settle(&mut window);
    window.key_press_modifiers(Modifiers::COMMAND, Key::ArrowRight);
    settle(&mut window);
    window.get_by_label("Corner 2 of mast, 75.1°, 30.5°");
    window.key_press(Key::Insert);
    settle(&mut window);
    window.get_by_label_contains("Corner 5 of mast");
    for _ in 0..4 {
        let corner = window.query_all_by_label_contains("Corner 2 of mast").next().unwrap();
        corner.focus();
        settle(&mut window);
        window.key_press(Key::Delete);
        settle(&mut window);
    }
    assert!(window.query_by_label_contains("Corner 3 of mast").is_some(), "three remain");
    assert!(window.query_by_label_contains("Corner 4 of mast").is_none());
}

#[test]
fn the_middle_of_an_edge_becomes_a_corner() {
    let mut window = page(LARGE);
    choose(&mut window, "mast");
    let from = place(&window, "Middle of edge 2 of mast");
    drag(&mut window, from, from + egui::vec2(-30.0, 0.0), Modifiers::NONE);
    let station = save(&mut window);
    let corners = corners(&station, 0);
    assert_eq!(corners.len(), 5);
    assert!((corners[2].0 - 90.0).abs() < 1.0 && corners[2].1 > 35.0, "{corners:?}");
}

#[test]
fn a_rectangle_and_a_polygon_are_drawn() {
    let mut window = page_of(LARGE, rig::model(states::holding()));
    let centre = window.get_by_role_and_label(Role::Canvas, "Horizon and keep-outs of the site");
    let centre = centre.rect().center() + egui::vec2(0.0, 8.0);
    window.get_by_role_and_label(Role::RadioButton, "Rectangle").click();
    settle(&mut window);
    let off = |x: f32, y: f32| centre + egui::vec2(x, y);
    drag(&mut window, off(100.0, 20.0), off(160.0, -40.0), Modifiers::NONE);
    window.get_by_role_and_label(Role::RadioButton, "Polygon").click();
    settle(&mut window);
    let click = |window: &mut Window, at: Pos2| {
        for pressed in [true, false] {
            window.event(Event::PointerMoved(at));
            window.event(Event::PointerButton {
                pos: at,
                button: PointerButton::Primary,
                pressed,
                modifiers: Modifiers::NONE,
            });
        }
        window.run_steps(1);
    };
    for at in [off(-100.0, 0.0), off(-150.0, 0.0), off(-150.0, 60.0)] {
        click(&mut window, at);
        window.run_steps(3);
    }
    click(&mut window, off(-100.0, 60.0));
    click(&mut window, off(-99.0, 1.0));
    settle(&mut window);
    let station = save(&mut window);
    assert_eq!(station.keep_outs.len(), 2, "{:?}", station.keep_outs);
    assert_eq!((corners(&station, 0).len(), corners(&station, 1).len()), (4, 4));
    assert_eq!(station.keep_outs[1].name, "Keep-out 2");
}

#[test]
fn a_wrong_cell_says_its_range_and_locks_saving() {
    for size in rig::sizes() {
        let mut window = page(size);
        choose(&mut window, "mast");
        field(&mut window, "Elevation of corner 3", "97");
        window.get_by_label("−90 to 90. The plot keeps 30.0°.");
        window.get_by_label_contains("1 field is not valid: mast, corner 3 in Horizon");
        assert!(is_locked(&window));
        field(&mut window, "Elevation of corner 3", "22,5");
        window.get_by_label("Edited, was 30.0");
        window.get_by_label("1 change");
        let station = save(&mut window);
        assert_eq!(corners(&station, 0)[2], (100.0, 22.5));
    }
}

#[test]
fn edges_that_cross_are_named_and_not_saved() {
    let mut window = page(LARGE);
    choose(&mut window, "mast");
    field(&mut window, "Azimuth of corner 3", "70");
    field(&mut window, "Azimuth of corner 4", "70");
    field(&mut window, "Elevation of corner 4", "40");
    window.get_by_label_contains("cross or touch each other.");
    assert!(is_locked(&window));
    window.get_by_role_and_label(Role::Button, "Revert").click();
    settle(&mut window);
    assert!(window.query_by_label_contains("cross or touch").is_none());
}

#[test]
fn the_sun_is_kept_away_from_once_that_is_set() {
    for size in rig::sizes() {
        let mut window = page(size);
        choose(&mut window, "Sun");
        window.get_by_label("Keep antennas away from the Sun").click();
        settle(&mut window);
        field(&mut window, "Radius of the Sun avoidance", "0");
        assert!(is_locked(&window));
        field(&mut window, "Radius of the Sun avoidance", "2");
        let sun = SunAvoidance { radius_deg: 2.0, ahead_min: 10.0 };
        assert_eq!(save(&mut window).sun_avoidance, Some(sun));
    }
}

#[test]
fn a_keep_out_is_tightened_while_the_antenna_moves_and_loosened_only_when_it_stands() {
    let moving = |margin: &str| {
        let mut model = rig::model(states::moving());
        Arc::make_mut(&mut model.shown_mut().station).keep_outs = vec![mast()];
        let mut window = page_of(LARGE, model);
        choose(&mut window, "mast");
        field(&mut window, "Safety margin", margin);
        window
    };
    assert!(!is_locked(&moving("2")));
    let window = moving("0.5");
    assert!(is_locked(&window));
    window.get_by_label("Satrak moves or tracks. To loosen mast, stop it, then save.");
}

#[test]
fn a_keep_out_around_an_antenna_is_saved_by_a_hold() {
    let mut model = rig::model(states::holding());
    let measured = model.antennas[0].snapshot.state.measured.unwrap();
    let at = measured.direction().unwrap();
    let (az, el) = (at.azimuth_deg(), at.elevation_deg());
    Arc::make_mut(&mut model.shown_mut().station).keep_outs = vec![mast()];
    let mut window = page_of(LARGE, model);
    choose(&mut window, "mast");
    for (corner, (azimuth, elevation)) in
        [(az - 9.0, el - 4.0), (az - 9.0, el + 4.0), (az + 9.0, el + 4.0), (az + 9.0, el - 4.0)]
            .into_iter()
            .enumerate()
    {
        field(&mut window, &format!("Azimuth of corner {}", corner + 1), &azimuth.to_string());
        field(&mut window, &format!("Elevation of corner {}", corner + 1), &elevation.to_string());
    }
    let words = "Satrak is inside “mast” now. It can be moved out by hand once you allow it.";
    window.get_by_label(words);
    let button = window.get_by_role_and_label(Role::Button, "Hold 1 s to save").rect().center();
    window.drag_at(button);
    window.run_steps(6);
    assert_eq!(asked(&mut window).len(), 1, "held to the end");
}

#[test]
fn the_effect_on_the_passes_stands_below_the_plot() {
    for size in rig::sizes() {
        let mut window = page(size);
        let commands = rig::asked(&mut window);
        let question = commands.into_iter().find_map(|command| match command {
            UiCommand::ShowEffects(question) => Some(*question),
            _ => None,
        });
        let question = question.expect("the page asks");
        assert_eq!(question.antenna.as_deref(), Some("Satrak"));
        assert_eq!((&question.before, question.after.keep_outs.len()), (&question.after, 1));
        window.get_by_label_contains("Being worked out.");
        let passes = window.state().model.pass_lists.favourites.passes.clone();
        let ways = effects::ways::<obstacles::Question>(&passes, &|| false);
        let effect = Effect::new(question.clone(), &ways, 0);
        assert!(effect.after.touched > 0);
        let touched =
            format!("block part of {} of the {} passes", effect.after.touched, effect.ways.len());
        let model = &mut window.state_mut().model;
        model.obstacle_effects.ask(question, model.steady);
        model.obstacle_effects.effect = Some(effect);
        settle(&mut window);
        window.get_by_label_contains(&touched);
        assert_eq!(rig::asked(&mut window), [], "asked once");
    }
}

fn manual(azimuth: f64, elevation: f64, motion: AxisMotion) -> Snapshot {
    let mut snapshot = Snapshot { intent: Intent::Manual, ..states::holding() };
    snapshot.state.measured = Some(states::measured(azimuth, elevation, motion));
    snapshot
}

#[test]
fn the_skyline_is_recorded_by_pointing() {
    for size in [LARGE, SMALL] {
        let mut window = page_of(size, rig::model(manual(10.0, 5.4, AxisMotion::Still)));
        let record = if size == LARGE { "Record the skyline" } else { "Record" };
        window.get_by_role_and_label(Role::Button, record).click();
        settle(&mut window);
        window.get_by_label_contains("0 marked").scroll_to_me();
    }
}

#[test]
fn each_mark_takes_what_was_measured_of_an_antenna_that_stands_in_manual() {
    let mut model = rig::model(manual(10.0, 5.4, AxisMotion::Still));
    Arc::make_mut(&mut model.shown_mut().station).horizon_mask = HorizonMask::parse("0 3").ok();
    let mut window = page_of(LARGE, model);
    let click = |window: &mut Window, button: &str| {
        window.get_by_role_and_label(Role::Button, button).scroll_to_me();
        settle(window);
        window.get_by_role_and_label(Role::Button, button).click();
        settle(window);
    };
    click(&mut window, "Record the skyline");
    click(&mut window, "Mark 10.0°, 5.4°");
    let point = |window: &mut Window, snapshot: Snapshot| {
        let config = Antenna::clone(&window.state().model.antennas[0].config);
        window.state_mut().model.shown_mut().antennas = vec![rig::antenna(config, snapshot)];
        let model = &mut window.state_mut().model;
        let site = model.station.site;
        for antenna in &mut model.shown_mut().antennas {
            refresh(antenna, &mut Recent::default(), site, |_| None);
        }
        settle(window);
    };
    point(&mut window, manual(200.0, 8.25, AxisMotion::Still));
    window.key_press(Key::Enter);
    settle(&mut window);
    window.get_by_label_contains("Nothing is marked from");
    point(&mut window, states::moving());
    window.get_by_label_contains("Satrak must be in Manual");
    assert!(window.get_by_role_and_label(Role::Button, "Mark").accesskit_node().is_disabled());
    click(&mut window, "End");
    click(&mut window, "Keep the new one");
    let station = save(&mut window);
    assert_eq!(station.horizon_mask, HorizonMask::parse("10 5.4\n200 8.25").ok());
    assert!(asked(&mut window).is_empty(), "nothing was sent to the antenna");
}

#[test]
fn a_mask_is_read_from_a_file_and_written_to_one() {
    let mut model = rig::model(states::holding());
    Arc::make_mut(&mut model.shown_mut().station).horizon_mask = HorizonMask::parse("0 3").ok();
    let mut window = page_of(LARGE, model);
    window.get_by_role_and_label(Role::Button, "Export").click();
    let mask = HorizonMask::parse("0 3").unwrap();
    assert_eq!(asked(&mut window), [UiCommand::ExportMask(Box::new(mask))]);
    window.get_by_role_and_label(Role::Button, "Import").click();
    settle(&mut window);
    field(&mut window, "Path of a horizon mask", "/tmp/hills.csv");
    window.get_by_role_and_label(Role::Button, "Read file").click();
    assert_eq!(asked(&mut window), [UiCommand::ImportMask("/tmp/hills.csv".into())]);
    let (mask, form) = HorizonMask::import("az,el\n0,2\n90,14").unwrap();
    let news = azel::model::MaskNews::Read(mask.clone(), form);
    window.state_mut().views.mask_news(news);
    settle(&mut window);
    window.get_by_label_contains("2 points read from a table.");
    assert_eq!(save(&mut window).horizon_mask, Some(mask));
}

#[test]
fn what_holds_is_drawn_in_the_sky_plot() {
    // The plot draws keep-outs without a missing glyph or a panic, also around the zenith.
    let cap = KeepOut::zone_of(&[(0.0, 80.0), (180.0, 80.0), (360.0, 80.0)]).unwrap();
    for size in rig::sizes() {
        let mut model = rig::model(states::holding());
        let overhead = KeepOut { name: "overhead".to_owned(), zone: cap.clone(), ..mast() };
        assert!(overhead.zone.clearance(azel::astro::AzEl::from_degrees(0.0, 90.0)) < Angle::ZERO);
        Arc::make_mut(&mut model.shown_mut().station).keep_outs = vec![mast(), overhead];
        rig::window(size, model);
    }
}

#[test]
fn the_margin_is_the_beam_the_overshoot_and_what_is_added() {
    let stopping_way = StoppingWay { overrun_s: 0.4, stops: 0, is_learned: false };
    let mut model = rig::model(Snapshot { stopping_way, ..states::holding() });
    Arc::make_mut(&mut model.shown_mut().station).keep_outs = vec![mast()];
    let mut window = page_of(LARGE, model);
    choose(&mut window, "mast");
    // The antenna is a Satrak of 3 degrees per second.
    window.get_by_label("°   beam 0.44° + overshoot 1.2° + 1.0°");
}

#[test]
fn the_reason_of_a_keep_out_is_shown_where_the_pointer_rests() {
    let mut model = rig::model(states::holding());
    Arc::make_mut(&mut model.shown_mut().station).keep_outs =
        vec![KeepOut { reason: "Steel mast".to_owned(), ..mast() }];
    let mut window = page_of(LARGE, model);
    window.get_by_label_contains("mast, Keep-out, hard").hover();
    window.run_steps(8);
    window.get_by_label("Steel mast");
}
