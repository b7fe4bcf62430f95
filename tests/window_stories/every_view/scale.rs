//! At 200 % nothing that must stay is lost, in any view.

use egui::{Rect, Role, ViewportId, accesskit::Live, pos2, vec2};
use egui_kittest::kittest::{AccessKitNode, By, NodeT as _, Queryable as _};

use crate::window_stories::{
    every_view::{SCENES, painted},
    rig::{Window, settle},
};

/// Points of a window at 200 %: of 2048 x 1280, the smallest at that scale, and of 2560 x 1440.
const SIZES: [[f32; 2]; 2] = [[1024.0, 640.0], [1280.0, 720.0]];

/// A part by its name, and how its node is recognised.
type Part = (&'static str, fn(&AccessKitNode<'_>) -> bool);

/// What every view keeps, and what Operate keeps of an antenna. Never folded, hidden or scrolled
/// away.
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

/// Whether there is such a node, and all of them are whole in the window.
fn is_there(window: &Window, whole: Rect, is_it: fn(&AccessKitNode<'_>) -> bool) -> bool {
    let all = window.query_all(By::new()).filter(|node| is_it(&node.accesskit_node()));
    let places: Vec<Rect> = all.map(|node| node.rect()).collect();
    !places.is_empty() && places.iter().all(|place| whole.contains_rect(*place))
}

#[test]
fn at_200_percent_no_view_loses_what_must_stay() {
    let mut faults = Vec::new();
    for scene in &SCENES {
        for size in SIZES {
            let mut window = scene.open(size);
            let root = window.input_mut().viewports.entry(ViewportId::ROOT).or_default();
            root.native_pixels_per_point = Some(2.0);
            settle(&mut window);
            assert!((window.ctx.pixels_per_point() - 2.0).abs() < 1e-6);
            let whole = Rect::from_min_size(pos2(0.0, 0.0), vec2(size[0], size[1]));
            let has_antenna = !window.state().model.antennas.is_empty();
            let of_antenna = if has_antenna { &OF_AN_ANTENNA[..1] } else { &[] };
            let is_operate = has_antenna && scene.name.starts_with("Operate");
            let of_antenna = if is_operate { &OF_AN_ANTENNA[..] } else { of_antenna };
            for (what, is_it) in ALWAYS.iter().chain(of_antenna) {
                if !is_there(&window, whole, *is_it) {
                    faults.push(format!("{} {size:?}: {what} is not there", scene.name));
                }
            }
            for run in painted::runs(&window) {
                let seen = run.clip.intersect(whole).expand(1.0);
                let is_cut = run.rect.left() < seen.left() || run.rect.right() > seen.right();
                if is_cut {
                    faults.push(format!(
                        "{} {size:?}: {:?} is cut at {:?}",
                        scene.name, run.text, run.rect
                    ));
                }
            }
        }
    }
    assert!(faults.is_empty(), "{} faults\n{}", faults.len(), faults.join("\n"));
}
