//! Texts that Azel must not cut.

use azel::model::View;
use egui::accesskit::Role;
use egui_kittest::{
    Node,
    kittest::{NodeT as _, Queryable as _},
};

use crate::window_stories::{
    every_view::{Findings, in_view, painted, scene},
    rig::{self, LARGE, SIZES, SMALL, Window},
    settings_rig, states,
};

/// Returns `true` if the node is a line of the list of keys.
fn is_key(node: &Node<'_>) -> bool {
    let words = node.accesskit_node().label().or(node.accesskit_node().value());
    let words = words.unwrap_or_default();
    azel::ui::keys::ALL.iter().any(|of| words.ends_with(&format!(": {}", of.does)))
}

#[test]
fn the_list_of_keys_and_the_head_of_a_card_are_whole() {
    for size in SIZES {
        let list = scene("List of keys", size);
        let before = painted::cut(&scene("Operate, jog", size));
        let cut: Vec<_> =
            painted::cut(&list).into_iter().filter(|words| !before.contains(words)).collect();
        assert!(cut.is_empty(), "{size:?}: {cut:?}");
        let rows: Vec<_> = list.query_all_by_role(Role::Label).filter(is_key).collect();
        assert_eq!(rows.len(), azel::ui::keys::ALL.len());
        for row in rows.iter().map(Node::rect) {
            let is_clear = row.top() > 56.0 && row.bottom() < size[1];
            assert!(is_clear && row.height() >= 22.0, "{size:?}: {row:?}");
        }
    }
    for name in ["Operate, tracking", "Operate, three antennas of the demo"] {
        let cut = painted::cut(&scene(name, LARGE));
        assert!(!cut.iter().any(|words| words.contains("mount at")), "{name}: {cut:?}");
    }
}

#[test]
fn the_satellite_of_the_track_button_is_whole_in_the_smallest_window() {
    let mut model = rig::model(states::holding());
    let meteor = model.pass_lists.favourites.passes.iter().find(|of| of.number() == 59_051);
    model.selected = meteor.map(azel::contract::passes::PredictedPass::key);
    let window = rig::window(SMALL, model);
    assert!(painted::texts(&window).contains(&"Track METEOR-M2 4".to_owned()));
    let cut = painted::cut(&window);
    assert!(!cut.iter().any(|words| words.starts_with("Track ")), "{cut:?}");
}

#[test]
fn where_an_antenna_comes_from_is_whole_in_a_wide_plan() {
    let cut = painted::cut(&scene("Plan", LARGE));
    assert!(!cut.iter().any(|words| words.contains(" from ")), "{cut:?}");
}

#[test]
fn the_seconds_of_a_unit_are_whole_on_any_day() {
    for size in SIZES {
        let mut window = settings_rig::opened(size, settings_rig::read());
        let model = &mut window.state_mut().model;
        model.now = azel::astro::time::add_seconds(model.now, -36.0 * 3600.0);
        rig::settle(&mut window);
        let cut = painted::cut(&window);
        assert!(!cut.iter().any(|words| words.contains(" Aug ")), "{size:?}: {cut:?}");
    }
}

#[test]
fn the_seconds_of_a_new_start_and_stop_are_within_their_fields_at_any_width() {
    for width in [1024.0, 1360.0, 1419.0, 1436.0, 1440.0, 1480.0, 1530.0, 1920.0, 2200.0] {
        let mut window = settings_rig::opened([width, 900.0], settings_rig::read());
        // Azel writes a changed value in a bold font.
        for field in ["Start", "Stop"] {
            settings_rig::write(&mut window, field, "2026-08-28 20:58:58");
        }
        let typed = |run: &painted::Run| run.text == "2026-08-2820:58:58";
        let places: Vec<_> = painted::runs(&window).into_iter().filter(typed).collect();
        assert_eq!(places.len(), 2, "{width}");
        for run in places {
            let room = run.clip.x_range();
            let is_whole = room.contains(run.rect.left()) && room.contains(run.rect.right());
            assert!(is_whole, "{width}: {:?} in {room:?}", run.rect.x_range());
        }
    }
}

#[test]
fn raw_bytes_that_have_no_room_end_with_an_ellipsis() {
    let window = in_view(SMALL, View::Console, {
        let model = rig::model(states::holding());
        let long = format!("SATELLITE?,{}.txt,NOAA 20,1,43013,78.4", "a".repeat(200));
        let line =
            crate::window_stories::console::wire(1.0, azel::device::Direction::Received, &long);
        model.wires[0].push(line);
        model
    });
    let cut = painted::cut(&window);
    assert!(cut.iter().any(|words| words.starts_with("$SATELLITE?,aaa")), "{cut:?}");
}

/// Starts of texts that may end with an ellipsis, because the pointer shows them whole.
const MAY_BE_CUT: [&str; 6] = [
    // State of another antenna, below the card.
    "Holding at ",
    // Content of a fold.
    "Go to a stored satellite",
    "Send the other rotator",
    // Place of a source, and its name.
    "celestrak.org/",
    "bundled, ",
    // Values that Azel has not read from a unit.
    "192.168.10.21:4001, not read: ",
];

/// Finds cut texts that must be whole.
pub(super) fn check(window: &Window, findings: &mut Findings) {
    let cut = painted::cut(window);
    findings.count(painted::texts(window).len());
    let may_be_cut = |words: &&String| MAY_BE_CUT.iter().any(|start| words.starts_with(start));
    for words in cut.iter().filter(|words| !may_be_cut(words)) {
        findings.add(&format!("{words:?} is cut"));
    }
}
