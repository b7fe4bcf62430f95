//! Wide and high windows, which use their room: two cards, a lane for each antenna, more hours.

use std::{collections::BTreeSet, sync::Arc};

use azel::{
    contract,
    contract::driver::{Command, Intent},
    model::{Model, UiCommand},
    station::AntennaId,
};
use egui::{Key, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    makes,
    rig::{self, LARGE, NOAA_20, Window, asked, says, settle},
    settings_rig, states,
};

const WIDE: [[f32; 2]; 2] = [[1920.0, 1080.0], [2560.0, 1440.0]];

/// Returns a station with a Satrak, a Rotator Genius and an RC2000C.
pub(crate) fn three() -> Model {
    let mut model = rig::model(states::holding());
    let genius = makes::model(makes::pair(), makes::pair_at(Intent::Position));
    let rc2000c = makes::model(makes::rc2000c(), makes::rc2000c_at(Intent::Manual));
    model.shown_mut().antennas.extend(genius.antennas.clone());
    model.shown_mut().antennas.extend(rc2000c.antennas.clone());
    for (index, antenna) in model.shown_mut().antennas.iter_mut().enumerate() {
        Arc::make_mut(&mut antenna.config).id = AntennaId(1 + index as u32);
    }
    model
}

fn lanes(window: &Window) -> Vec<String> {
    let bars = window.get_all_by_role(Role::ListBoxOption);
    let names = bars.filter_map(|bar| bar.accesskit_node().label());
    let mut lanes: Vec<String> =
        names.filter_map(|name| Some(name.split_once(": METEOR")?.0.to_owned())).collect();
    lanes.dedup();
    lanes
}

#[test]
fn more_cards_and_all_lanes_stand_in_a_wide_window_and_in_no_other() {
    for (size, cards) in WIDE.into_iter().zip([2, 3]) {
        let window = rig::window(size, three());
        let modes = window.get_all_by_role_and_label(Role::RadioButton, "Standby").count();
        assert_eq!(modes, cards, "{size:?}");
        assert_eq!(lanes(&window), ["Satrak", "Genius", "RC2000C"], "{size:?}");
        let long =
            says(&window, "Next 24 hours") || window.query_by_label("Next 24 hours").is_some();
        assert_eq!(long, size[0] > 2000.0);
    }
    let window = rig::window(LARGE, three());
    assert_eq!(window.get_all_by_role_and_label(Role::RadioButton, "Standby").count(), 1);
    assert!(lanes(&window).is_empty());
}

#[test]
fn what_unfolds_is_open_where_it_has_room_unless_the_operator_closes_it() {
    // The controls of the RC2000C take 500 points.
    let mut window = rig::window([2560.0, 1600.0], three());
    let folds = |window: &Window| -> Vec<Option<bool>> {
        let lines = window.get_all_by_label_contains("More: ");
        lines.map(|line| line.accesskit_node().data().is_expanded()).collect()
    };
    assert_eq!(folds(&window), [Some(true), Some(true)]);
    assert!(window.query_by_label("Scroll for more").is_none());
    window.get_all_by_label_contains("More: ").next().unwrap().click();
    settle(&mut window);
    assert_eq!(folds(&window), [Some(false), Some(true)], "the operator's choice");
    window.set_size(egui::vec2(2560.0, 800.0));
    settle(&mut window);
    assert_eq!(folds(&window), [Some(false), Some(false)], "no room");
}

#[test]
fn each_card_drives_its_own_antenna() {
    let mut window = rig::window(WIDE[0], three());
    let cards = |window: &Window| {
        let mut at: Vec<_> = window
            .get_all_by_role_and_label(Role::RadioButton, "Standby")
            .map(|node| node.rect().center())
            .collect();
        at.sort_by(|a, b| a.x.total_cmp(&b.x));
        at
    };
    let at = cards(&window);
    for (place, id) in at.into_iter().zip([AntennaId(1), AntennaId(2)]) {
        window.drag_at(place);
        window.drop_at(place);
        assert_eq!(asked(&mut window), [UiCommand::antenna(id, Command::Standby)]);
    }
    let mut track: Vec<_> = window
        .get_all_by_role_and_label(Role::Button, "Track NOAA 20")
        .map(|node| node.rect().center())
        .collect();
    track.sort_by(|a, b| a.x.total_cmp(&b.x));
    window.drag_at(track[1]);
    window.drop_at(track[1]);
    let commands = asked(&mut window);
    let [UiCommand::Station(contract::Command::Track { antenna, pass, .. })] = &commands[..] else {
        panic!("{commands:?}")
    };
    assert_eq!((*antenna, pass.0), (AntennaId(2), NOAA_20));
    // The previously selected antenna keeps its card and its place beside the new one.
    for (selected, shown) in [(2, [1, 3]), (0, [1, 3]), (1, [1, 2]), (2, [2, 3])] {
        window.state_mut().model.selected_antenna = selected;
        settle(&mut window);
        let [first, second] = cards(&window)[..] else { panic!("two cards") };
        for (place, id) in [first, second].into_iter().zip(shown.map(AntennaId)) {
            window.drag_at(place);
            window.drop_at(place);
            assert_eq!(asked(&mut window), [UiCommand::antenna(id, Command::Standby)]);
        }
    }
}

#[test]
fn each_card_locks_out_its_own_antenna() {
    let mut window = rig::window(WIDE[0], three());
    for index in [0, 1] {
        let name = window.state().model.antennas[index].config.name.clone();
        for key in [format!("Link of {name}"), "Lock out…".to_owned()] {
            window.get_by_role_and_label(Role::Button, &key).click_accesskit();
            settle(&mut window);
        }
        window.get_by_label(&format!("Lock out {name}"));
        window.key_press(Key::Escape);
        assert_eq!(asked(&mut window), []);
    }
}

#[test]
fn a_jog_of_the_second_card_ends_with_its_view() {
    let mut model = three();
    model.shown_mut().antennas[1].snapshot = makes::pair_at(Intent::Manual).into();
    let mut window = rig::window(WIDE[0], model);
    let key = window
        .get_all_by_role_and_label(Role::Button, "Jog clockwise")
        .map(|node| node.rect().center())
        .next()
        .expect("the keys of the second card");
    window.drag_at(key);
    let held = asked(&mut window);
    let is_its = |command: &UiCommand| {
        matches!(
            command,
            UiCommand::Station(contract::Command::Antenna(AntennaId(2), Command::Jog { .. }))
        )
    };
    assert!(!held.is_empty() && held.iter().all(is_its), "{held:?}");
    window.state_mut().model.view = azel::model::View::Console;
    let commands = asked(&mut window);
    let ends = UiCommand::antenna(AntennaId(2), Command::EndJog);
    assert_eq!(commands.iter().filter(|command| **command == ends).count(), 1, "{commands:?}");
}

#[test]
fn the_settings_of_a_unit_stand_in_as_many_columns_as_have_room() {
    for (width, wanted) in [(1024.0, 1), (1440.0, 2), (1920.0, 2), (2560.0, 3)] {
        let window = settings_rig::opened([width, 1440.0], settings_rig::read());
        let lefts =
            ["General", "GPS", "Tracking window", "Satellite and TLE", "Clock"].map(|card| {
                let title = window.get_by(|node| {
                    node.role() == Role::Label && node.value().as_deref() == Some(card)
                });
                title.rect().left().round() as i32
            });
        let columns: BTreeSet<i32> = lefts.into_iter().collect();
        assert_eq!(columns.len(), wanted, "{width}");
    }
}
