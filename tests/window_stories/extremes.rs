//! Rare cases: long names, no content, and unknown values.

use std::sync::Arc;

use azel::{
    contract::{
        self, CatalogState,
        driver::{LinkLoss, LinkState, Snapshot},
        passes::PassLists,
    },
    engine::antenna::{Recent, refresh},
    model::{Model, Sky, UiCommand, View},
};
use egui::{Rect, Role, pos2, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    maintenance, preferences,
    rig::{self, SIZES, SMALL, Window, asked, says, settle},
    states,
};

/// Longest name that the layout must fit.
const LONG: &str = "Şile northern field unit";

/// Checks that every control is inside the window, and STOP in its normal place. The last lines of
/// the card may need scrolling.
pub(crate) fn nothing_is_cut(window: &Window, size: [f32; 2]) {
    let whole = Rect::from_min_size(pos2(0.0, 0.0), vec2(size[0], size[1]));
    for role in [Role::Button, Role::RadioButton, Role::TextInput, Role::Slider, Role::Tab] {
        for node in window.query_all_by_role(role) {
            let name = node.accesskit_node().label().unwrap_or_default();
            let last = ["Travel: ", "Faults: ", "Show "];
            if last.iter().any(|line| name.starts_with(line)) {
                continue;
            }
            assert!(whole.contains_rect(node.rect()), "{name:?} at {:?}", node.rect());
        }
    }
    let mut stops = window.get_all_by_role(Role::Button);
    let is_stop = |name: Option<String>| name.is_some_and(|name| name.starts_with("STOP"));
    let stop = stops.find(|node| is_stop(node.accesskit_node().label())).unwrap().rect();
    assert!(stop.top() < 12.0 && stop.right() > size[0] - 20.0, "{stop:?}");
}

/// Checks that no control overlaps another.
pub(crate) fn nothing_overlaps(window: &Window) {
    let buttons: Vec<(Option<String>, Rect)> = window
        .get_all_by_role(Role::Button)
        .map(|node| (node.accesskit_node().label(), node.rect()))
        .collect();
    for (index, (name, rect)) in buttons.iter().enumerate() {
        for (other, place) in &buttons[index + 1..] {
            let common = rect.intersect(*place);
            let touch = common.width() <= 1.0 || common.height() <= 1.0;
            assert!(touch, "{name:?} and {other:?} at {common:?}");
        }
    }
}

#[test]
fn the_longest_names_cut_nothing() {
    assert_eq!(LONG.chars().count(), 24);
    for size in SIZES {
        for count in [1, 4] {
            let mut model = rig::model(states::tracking(0.04));
            LONG.clone_into(&mut Arc::make_mut(&mut model.shown_mut().station).name);
            let mut config = model.station.antennas[0].clone();
            model.shown_mut().antennas.clear();
            for index in 0..count {
                config.name = format!("{}{index}", &LONG[..LONG.len() - 1]);
                let mut antenna = rig::antenna(config.clone(), states::tracking(0.04));
                refresh(&mut antenna, &mut Recent::default(), model.station.site, |number| {
                    model.pass_lists.satellite(number)
                });
                model.shown_mut().antennas.push(antenna);
            }
            let window = rig::window(size, model);
            nothing_is_cut(&window, size);
            nothing_overlaps(&window);
        }
    }
}

#[test]
fn every_state_fits_both_windows() {
    for size in SIZES {
        let locked = maintenance::locked(states::holding());
        let plain = [rig::quiet(), states::holding(), states::moving(), states::manual()];
        for snapshot in plain.into_iter().chain([locked]) {
            let window = rig::window(size, rig::model(snapshot));
            nothing_is_cut(&window, size);
            nothing_overlaps(&window);
        }
    }
}

#[test]
fn a_station_without_antennas_offers_to_set_one_up() {
    for size in SIZES {
        let mut model = rig::model(states::holding());
        model.shown_mut().antennas.clear();
        Arc::make_mut(&mut model.shown_mut().station).antennas.clear();
        let mut window = rig::window(size, model);
        nothing_is_cut(&window, size);
        window.get_by_role_and_label(Role::Button, "Set up an antenna").click();
        assert_eq!(asked(&mut window), [UiCommand::Show(View::Preferences)]);
        window.key_press(egui::Key::T);
        assert_eq!(asked(&mut window), []);
    }
}

fn without_elements(mut model: Model) -> Model {
    model.shown_mut().catalog = CatalogState::Failed;
    model.shown_mut().pass_lists = PassLists::default();
    model.selected = None;
    model.sky = Sky::default();
    model.refresh_sky();
    model
}

#[test]
fn without_elements_it_says_so_and_the_antenna_can_still_be_driven() {
    for size in SIZES {
        let mut window = rig::window(size, without_elements(rig::model(states::manual())));
        nothing_is_cut(&window, size);
        if window.query_by_role_and_label(Role::Button, "Passes").is_some() {
            window.key_press(egui::Key::P);
            asked(&mut window);
        }
        assert!(says(&window, "No elements: they could not be read. See the alarms."));
        window.drag_at(window.get_by_label("Jog X+").rect().center());
        let commands = asked(&mut window);
        assert!(
            matches!(commands[..], [UiCommand::Station(contract::Command::Antenna(..)), ..]),
            "{commands:?}"
        );
    }
}

#[test]
fn the_demo_station_says_that_no_metal_moves() {
    for size in SIZES {
        let mut model = rig::model(states::holding());
        model.shown_mut().demo = true;
        let mut window = rig::window(size, model);
        assert!(says(&window, "Demo station: the antennas are simulated, no real antenna moves."));
        nothing_is_cut(&window, size);
        // The card is as high as without the banner.
        let faults =
            window.get_by_label_contains(if size == SMALL { "Faults: " } else { "Details" });
        assert!(faults.rect().bottom() <= size[1], "{:?}", faults.rect());
        window.get_by_label("Set up your station").click();
        assert_eq!(asked(&mut window), [UiCommand::Show(View::Setup)]);
    }
}

#[test]
fn what_saving_does_to_the_demonstration_is_said_before_and_while_one_types() {
    for size in SIZES {
        let mut model = rig::model(states::holding());
        (model.shown_mut().demo, model.view) = (true, View::Preferences);
        let mut window = rig::window(size, model);
        let ends = "Saving ends the demo and uses this station.";
        window.get_by_label(ends);
        preferences::write(&mut window, "Latitude", "41.5");
        window.get_by_label(&format!("1 change. {ends}"));
    }
}

/// Returns the places of all controls of the window.
fn places(window: &Window) -> Vec<(String, Rect)> {
    let roles = [Role::Button, Role::RadioButton, Role::TextInput, Role::ListBoxOption];
    let of =
        |role| window.query_all_by_role(role).map(|of| (of.accesskit_node().label(), of.rect()));
    let all = roles.into_iter().flat_map(of);
    // One button has another name in the demo, at the same place.
    let name = |name: String| name.replace("Save and end the demo", "Save and use");
    let named = all.filter_map(|(label, place)| Some((name(label?), place)));
    named.filter(|(name, _)| name != "Set up your station").collect()
}

#[test]
fn the_end_of_the_demonstration_moves_nothing_under_the_pointer() {
    for size in SIZES {
        for view in [View::Operate, View::Plan, View::Antennas, View::Preferences, View::Map] {
            let mut model = rig::model(states::holding());
            (model.shown_mut().demo, model.view) = (true, view);
            let mut window = rig::window(size, model);
            let before = places(&window);
            window.state_mut().model.shown_mut().demo = false;
            settle(&mut window);
            assert_eq!(places(&window), before, "{view:?} {size:?}");
            assert!(!says(&window, "Demo station"));
            // The next view uses the room of the banner.
            for view in [View::Console, view] {
                window.state_mut().model.view = view;
                settle(&mut window);
            }
            assert_ne!(places(&window), before, "{view:?} {size:?}");
        }
    }
}

#[test]
fn the_demo_station_without_elements_says_so() {
    for size in SIZES {
        let mut model = without_elements(rig::model(states::holding()));
        model.shown_mut().demo = true;
        Arc::make_mut(&mut model.shown_mut().station).antennas.clear();
        model.shown_mut().antennas.clear();
        let window = rig::window(size, model);
        assert!(says(&window, "Demo station: the elements could not be read."));
        nothing_is_cut(&window, size);
    }
}

#[test]
fn a_lost_link_locks_what_cannot_be_sent_and_says_why() {
    for size in SIZES {
        let mut model = rig::model(rig::quiet());
        let (since, retry_at) = (rig::ago(&model, 42), model.steady);
        let link = LinkState::Lost { start: since, reason: LinkLoss::Silent, retry_at };
        let config = model.station.antennas[0].clone();
        model.shown_mut().antennas =
            vec![rig::antenna(config, Snapshot { link, ..states::tracking(0.0) })];
        let mut window = rig::window(size, model);
        nothing_is_cut(&window, size);
        assert!(says(&window, "No reply from Satrak for 42 s"));
        assert!(says(&window, "Locked: the unit does not answer."));
        assert!(says(&window, "Antenna, no reply for 42 s"), "on the sky as well");
        window.drag_at(window.get_by_label("Jog X+").rect().center());
        assert_eq!(asked(&mut window), []);
    }
}
