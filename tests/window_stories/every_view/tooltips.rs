//! Place of a tooltip beside its subject.

use azel::model::View;
use egui::{Rect, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::window_stories::{
    every_view::{demo, in_view, painted, scene},
    rig::{self, LARGE, SIZES, SMALL, Window, settle},
    states,
};

/// Min distance of the text of a tooltip from its border, points.
const MARGIN: f32 = 4.0;

/// Returns the names and places of all controls.
fn controls(window: &Window) -> Vec<(String, Rect)> {
    let roles = [Role::Button, Role::ListBoxOption, Role::RadioButton, Role::Slider, Role::Tab];
    let of = |role| {
        window
            .query_all_by_role(role)
            .map(|node| (node.accesskit_node().label().unwrap_or_default(), node.rect()))
    };
    roles.into_iter().flat_map(of).collect()
}

/// Points at every control in turn and returns the number of tooltips.
fn point_at_all(window: &mut Window) -> usize {
    let whole = window.ctx.content_rect();
    let mut told = 0;
    let shown = controls(window).into_iter().filter(|(_, of)| whole.contains(of.center()));
    for (name, subject) in shown {
        window.hover_at(subject.center());
        settle(window);
        for tip in window.query_all_by_role(Role::Tooltip) {
            // The node itself has no place.
            let texts = tip.children_recursive();
            let labels = texts.filter(|of| of.accesskit_node().role() == Role::Label);
            let Some(tip) = labels.map(|of| of.rect()).reduce(Rect::union) else { continue };
            told += 1;
            let tip = tip.expand(MARGIN);
            let both = tip.intersect(subject);
            assert!(!both.is_positive(), "{name:?} at {subject:?}: {tip:?}");
            assert!(whole.contains_rect(tip), "{name:?}: {tip:?}");
        }
    }
    told
}

#[test]
fn a_tooltip_covers_no_part_of_its_subject() {
    let mut operate = rig::window(SMALL, demo());
    let mut map = in_view(SMALL, View::Map, rig::model(states::holding()));
    let told = point_at_all(&mut operate) + point_at_all(&mut map);
    assert!(told > 20, "{told} tooltips");
}

/// Returns the number of controls in view that paint no text, and the names of those without a
/// tooltip.
fn unexplained(window: &mut Window) -> (usize, Vec<String>) {
    let whole = window.ctx.content_rect();
    let texts: Vec<Rect> = painted::runs(window).into_iter().map(|run| run.rect).collect();
    let roles = [Role::Button, Role::CheckBox, Role::ComboBox];
    let nodes = roles.into_iter().flat_map(|role| window.query_all_by_role(role));
    let marks: Vec<(String, Rect)> = nodes
        .filter(|node| !node.accesskit_node().is_disabled())
        .map(|node| (node.accesskit_node().label().unwrap_or_default(), node.rect()))
        .filter(|(_, of)| {
            whole.contains_rect(*of) && !texts.iter().any(|text| text.intersects(*of))
        })
        .collect();
    let mut found = Vec::new();
    let count = marks.len();
    for (name, mark) in marks {
        window.hover_at(mark.center());
        settle(window);
        if window.query_all_by_role(Role::Tooltip).next().is_none() {
            found.push(name);
        }
    }
    (count, found)
}

#[test]
fn a_control_without_text_has_its_name_under_the_pointer() {
    let (mut all, mut found) = (0, Vec::new());
    let scenes = [
        "Operate, three antennas of the demo",
        "Operate, tracking",
        "Map",
        "Plan",
        "Elements",
        "Console",
        "Record",
        "Antennas",
        "Preferences",
    ];
    for size in SIZES {
        for name in scenes {
            let (count, controls) = unexplained(&mut scene(name, size));
            all += count;
            found.extend(controls.into_iter().map(|control| format!("{name}: {control}")));
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
    assert!(all > 80, "{all} controls without text");
}

#[test]
fn short_words_are_explained_under_the_pointer() {
    let mut window = rig::window(LARGE, rig::model(states::holding()));
    for about in ["Keyhole: ", "Elevation floor: ", "Pointing error: "] {
        let mut found = window.query_all_by_label_contains(about);
        let place = found.next().unwrap_or_else(|| panic!("nothing about {about:?}")).rect();
        drop(found);
        window.hover_at(place.center());
        settle(&mut window);
        let tips = window.query_all_by_role(Role::Tooltip);
        let mut texts = tips.flat_map(|tip| tip.children_recursive().collect::<Vec<_>>());
        let is_told = texts.any(|of| {
            of.accesskit_node().value().is_some_and(|words| words.len() > about.len() + 20)
        });
        assert!(is_told, "{about:?}");
    }
}
