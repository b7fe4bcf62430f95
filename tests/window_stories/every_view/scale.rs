//! Content that every view must keep at 200 %.

use std::collections::BTreeMap;

use egui::{
    Rect, Role, ViewportId,
    accesskit::{Action, Live},
    pos2, vec2,
};
use egui_kittest::kittest::{AccessKitNode, By, NodeT as _, Queryable as _};

use crate::window_stories::{
    every_view::{Findings, SCENES, Scene, painted},
    rig::{Window, settle},
};

/// Name of a part, and the test that recognises its node.
type Part = (&'static str, fn(&AccessKitNode<'_>) -> bool);

/// Parts that every view keeps, and parts that Operate keeps of an antenna. Azel never folds, hides
/// or scrolls them away.
const ALWAYS: [Part; 3] = [
    ("STOP", |node| node.role() == Role::Button && starts(node, "STOP")),
    ("the clock", |node| name(node).ends_with(" UTC")),
    ("the alarms", |node| node.role() == Role::Button && name(node).contains("alarm")),
];
const OF_AN_ANTENNA: [Part; 4] = [
    ("the chip", |node| node.role() == Role::Button && name(node).contains(", link ")),
    ("the sentence", |node| node.role() == Role::Label && node.live() == Live::Polite),
    ("the table of the axes", |node| name(node).contains("actual")),
    ("the modes", |node| node.role() == Role::RadioButton && name(node) == "Standby"),
];

fn name(node: &AccessKitNode<'_>) -> String {
    node.label().or_else(|| node.value()).unwrap_or_default()
}

fn starts(node: &AccessKitNode<'_>, words: &str) -> bool {
    name(node).starts_with(words)
}

fn is_control(node: &AccessKitNode<'_>) -> bool {
    let data = node.data();
    let acts = data.supports_action(Action::Focus) || data.supports_action(Action::Click);
    // A label is no control, although the pointer can select its text.
    acts && node.role() != Role::Label
}

/// Returns `true` if such a node exists, and all such nodes are whole in the window.
fn is_there(window: &Window, whole: Rect, is_it: fn(&AccessKitNode<'_>) -> bool) -> bool {
    let all = window.query_all(By::new()).filter(|node| is_it(&node.accesskit_node()));
    let places: Vec<Rect> = all.map(|node| node.rect()).collect();
    !places.is_empty() && places.iter().all(|place| whole.contains_rect(*place))
}

/// Returns role, name and place of the controls that are not whole in the window.
fn outside(window: &Window, whole: Rect) -> Vec<(Role, String, Rect)> {
    let all = window.query_all(By::new()).filter(|node| is_control(&node.accesskit_node()));
    let found = all.map(|node| {
        let known = node.accesskit_node();
        (known.role(), name(&known), node.rect())
    });
    found.filter(|(_, name, place)| !name.is_empty() && !whole.contains_rect(*place)).collect()
}

/// Brings the lowest control outside the window into view, in each quarter of its width. Returns
/// the number of these controls, and those that stay outside.
fn unreachable(window: &mut Window, whole: Rect) -> (usize, Vec<String>) {
    let mut lowest: BTreeMap<u8, (Role, String, Rect)> = BTreeMap::new();
    for (role, name, place) in outside(window, whole) {
        let quarter = (4.0 * place.center().x / whole.width()).clamp(0.0, 3.0) as u8;
        let known = lowest.get(&quarter);
        if known.is_none_or(|(_, _, known)| known.bottom() < place.bottom()) {
            lowest.insert(quarter, (role, name, place));
        }
    }
    let (count, mut lost) = (lowest.len(), Vec::new());
    for (role, name, place) in lowest.into_values() {
        let is_it = |node: &AccessKitNode<'_>, name_of: &str| {
            node.role() == role && self::name(node) == name_of
        };
        let lowest_of = |window: &Window| {
            let all = window.query_all(By::new());
            let all = all.filter(|node| is_it(&node.accesskit_node(), &name));
            all.map(|node| node.rect()).max_by(|a, b| a.bottom().total_cmp(&b.bottom()))
        };
        let all = window.query_all(By::new());
        let own = all.filter(|node| is_it(&node.accesskit_node(), &name));
        let own = own.max_by(|a, b| a.rect().bottom().total_cmp(&b.rect().bottom()));
        if let Some(own) = own {
            own.scroll_to_me();
        }
        settle(window);
        let is_seen = lowest_of(window).is_some_and(|place| whole.expand(1.0).contains_rect(place));
        if !is_seen {
            lost.push(format!("{name:?} at {place:?} cannot be reached"));
        }
    }
    (count, lost)
}

/// Finds losses at 200 %: parts that must stay, the ends of texts, and controls that no scrolling
/// reaches. Counts the controls that needed scrolling. The window stays at 200 %.
pub(super) fn check(scene: &Scene, size: [f32; 2], window: &mut Window, findings: &mut Findings) {
    let root = window.input_mut().viewports.entry(ViewportId::ROOT).or_default();
    root.native_pixels_per_point = Some(2.0);
    settle(window);
    assert!((window.ctx.pixels_per_point() - 2.0).abs() < 1e-6);
    let whole = Rect::from_min_size(pos2(0.0, 0.0), vec2(size[0], size[1]));
    let has_antenna = !window.state().model.antennas.is_empty();
    let is_operate = has_antenna && scene.name.starts_with("Operate");
    let of_antenna = match (is_operate, has_antenna) {
        (true, _) => &OF_AN_ANTENNA[..],
        (false, true) => &OF_AN_ANTENNA[..1],
        (false, false) => &[],
    };
    for (part, is_it) in ALWAYS.iter().chain(of_antenna) {
        if !is_there(window, whole, *is_it) {
            findings.add(&format!("{part} is not there"));
        }
    }
    for run in painted::runs(window) {
        let seen = run.clip.intersect(whole).expand(1.0);
        if run.rect.left() < seen.left() || run.rect.right() > seen.right() {
            findings.add(&format!("{:?} is cut at {:?}", run.text, run.rect));
        }
    }
    let (count, lost) = unreachable(window, whole);
    findings.count(count);
    for fault in lost {
        findings.add(&fault);
    }
}

/// The size is a window of 2560 x 1440 at 200 %, in points. The smallest window is among the sizes
/// of [`every_view`](super).
#[test]
fn at_200_percent_a_usual_screen_loses_nothing() {
    const SIZE: [f32; 2] = [1280.0, 720.0];
    let mut findings = Findings::default();
    for scene in &SCENES {
        check(scene, SIZE, &mut scene.open(SIZE), findings.begin(scene, "200 %"));
    }
    findings.end(&[("200 %", 10)]);
}
