//! Reading order of the tree, which follows the window: down each column, along each row.

use std::collections::BTreeMap;

use azel::ui::theme;
use egui::{
    Color32, Event, Key, LayerId, Modifiers, Rect, Role,
    accesskit::{Action, NodeId},
    emath::Rangef,
};
use egui_kittest::{
    Node,
    kittest::{AccessKitNode, NodeT as _},
};

use crate::window_stories::{
    every_view::{Findings, painted, scene},
    rig::{LARGE, SMALL, Window, settle},
};

/// Node that a screen reader reads, with its visible place.
struct Read {
    name: String,
    place: Rect,
    layer: LayerId,
}

/// Returns the visible part of each widget, by its node.
fn places(window: &Window) -> BTreeMap<NodeId, (LayerId, Rect)> {
    window.ctx.viewport(|viewport| {
        let layers = viewport.this_pass.widgets.layers();
        let widgets =
            layers.flat_map(|(layer, widgets)| widgets.iter().map(move |of| (*layer, of)));
        widgets.map(|(layer, of)| (of.id.accesskit_id(), (layer, of.interact_rect))).collect()
    })
}

/// Returns `true` if the node is a mark of a drawing, whose order follows from its meaning.
fn is_drawn(node: &AccessKitNode<'_>) -> bool {
    std::iter::successors(node.parent(), AccessKitNode::parent).any(|of| of.role() == Role::Canvas)
}

/// Returns the controls and texts in the order of the tree, without STOP, which is the first by
/// intent.
fn read(window: &Window) -> Vec<Read> {
    let places = places(window);
    let nodes = window.root().children_recursive().map(|node| node.accesskit_node());
    let told = nodes.filter(|node| {
        !node.is_hidden()
            && !matches!(
                node.role(),
                Role::GenericContainer | Role::Group | Role::ScrollBar | Role::TextRun
            )
            && !is_drawn(node)
    });
    told.filter_map(|node| {
        let (layer, place) = *places.get(&node.locate().0)?;
        let name = node.label().or(node.value()).unwrap_or_default().trim().to_owned();
        let is_read = place.is_positive() && !name.is_empty() && !name.starts_with("STOP");
        is_read.then_some(Read { name, place, layer })
    })
    .collect()
}

/// Returns the share of the shorter of two ranges that the other covers.
fn common(a: Rangef, b: Rangef) -> f32 {
    a.intersection(b).span().max(0.0) / a.span().min(b.span())
}

/// Returns `true` if `later` stands before `earlier`: above in the same column, or left in the same
/// row.
fn goes_back(earlier: &Read, later: &Read) -> bool {
    let (a, b) = (earlier.place, later.place);
    let is_above = b.bottom() < a.top() + 0.5 && common(a.x_range(), b.x_range()) > 0.5;
    let is_before = b.right() < a.left() + 0.5 && common(a.y_range(), b.y_range()) > 0.5;
    earlier.layer == later.layer && (is_above || is_before)
}

/// Finds nodes that the tree has after nodes behind them. Counts all nodes.
pub(super) fn check(window: &Window, findings: &mut Findings) {
    let read = read(window);
    findings.count(read.len());
    for (index, later) in read.iter().enumerate() {
        if let Some(earlier) = read[..index].iter().find(|earlier| goes_back(earlier, later)) {
            findings.add(&format!(
                "{:?} {:?} is read before {:?} {:?}",
                earlier.name, earlier.place, later.name, later.place
            ));
        }
    }
}

/// Stop of Tab, with its name.
type Stop = (NodeId, String);

/// Presses and releases Tab in one frame, and draws two frames with the new focus.
fn press_tab(window: &mut Window, modifiers: Modifiers) {
    let key = |pressed| Event::Key {
        key: Key::Tab,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers,
    };
    window.input_mut().events.extend([
        Event::ModifiersChanged(modifiers),
        key(true),
        key(false),
        Event::ModifiersChanged(Modifiers::NONE),
    ]);
    window.run_steps(2);
}

/// Returns `true` if a focus ring is painted around the focused control or its row, or inside its
/// drawing.
fn is_ringed(window: &Window, ring: Color32) -> bool {
    focused(window).is_some_and(|(place, _)| {
        (0..8).any(|off| {
            let place = place.expand(4.0 - off as f32);
            painted::around(window, place, 1.5).contains(&ring)
        })
    })
}

/// Returns the stops of one round with Tab, starting at STOP, and adds faults to `faults`.
fn stops(window: &mut Window, modifiers: Modifiers, faults: &mut Vec<String>) -> Vec<Stop> {
    let ring = theme::tokens(&window.ctx).sat;
    let mut stops: Vec<Stop> = Vec::new();
    while stops.len() < 400 {
        press_tab(window, modifiers);
        let Some((_, now)) = focused(window) else {
            faults.push(format!("nothing has the focus after {:?}", stops.last()));
            break;
        };
        if stops.contains(&now) {
            if stops.first() != Some(&now) {
                faults.push(format!("{:?} comes again after {:?}", now.1, stops.last()));
            }
            break;
        }
        if !is_ringed(window, ring) {
            // The window still scrolls the control into view.
            settle(window);
        }
        if !is_ringed(window, ring) {
            faults.push(format!("no ring around {:?}", now.1));
        }
        if modifiers == Modifiers::NONE {
            // The view may have scrolled, so take both places from the current frame.
            let places = places(window);
            let read = |(id, name): &Stop| {
                let (layer, place) = *places.get(id)?;
                Some(Read { name: name.clone(), place, layer })
            };
            let is_seen = |of: &Read| of.place.is_positive();
            let pair = stops.last().and_then(read).filter(is_seen).zip(read(&now).filter(is_seen));
            if let Some((before, now)) = pair
                && goes_back(&before, &now)
            {
                faults.push(format!("{:?} comes before {:?}", before.name, now.name));
            }
        }
        stops.push(now);
    }
    stops
}

#[test]
fn tab_goes_along_the_rows_to_every_control_and_back() {
    let mut all = Vec::new();
    for (name, size) in BY_TAB {
        let mut faults = Vec::new();
        let mut window = scene(name, size);
        let wanted = focusable(&window);
        let forward = stops(&mut window, Modifiers::NONE, &mut faults);
        let mut back = stops(&mut window, Modifiers::SHIFT, &mut Vec::new());
        back.reverse();
        for (id, name) in &wanted {
            if !forward.iter().any(|(of, _)| of == id) {
                faults.push(format!("Tab never comes to {name:?}"));
            }
        }
        for (id, name) in &forward {
            if !back.iter().any(|(of, _)| of == id) {
                faults.push(format!("Shift Tab never comes to {name:?}"));
            }
        }
        if forward.len() < 10 {
            faults.push(format!("only {} stops", forward.len()));
        }
        all.extend(faults.into_iter().map(|fault| format!("{name} {size:?}: {fault}")));
    }
    assert!(all.is_empty(), "{} times\n{}", all.len(), all.join("\n"));
}

/// Returns the controls that can have the focus.
fn focusable(window: &Window) -> Vec<Stop> {
    let nodes = window.root().children_recursive().map(|node| node.accesskit_node());
    let can = nodes.filter(|node| {
        node.data().supports_action(Action::Focus) && !node.is_disabled() && !node.is_hidden()
    });
    can.map(|node| (node.locate().0, node.label().or(node.value()).unwrap_or_default())).collect()
}

/// Returns the place of the node that has the focus, and the node with its name.
fn focused(window: &Window) -> Option<(Rect, Stop)> {
    // A list keeps the focus and leads screen readers on to its row.
    let has_focus = |node: &Node<'_>| node.accesskit_node().is_focused_in_tree();
    let node = window.root().children_recursive().find(has_focus)?;
    let place = node.rect();
    let node = node.accesskit_node();
    let name = node.label().or(node.value()).unwrap_or_default();
    Some((place, (node.locate().0, name)))
}

/// Main views and the popups in them, each in a window with the most or the least room for it.
const BY_TAB: [(&str, [f32; 2]); 22] = [
    ("Operate, tracking", LARGE),
    ("Operate, jog", LARGE),
    ("Operate, jog", SMALL),
    ("Operate, a pair of rotators", SMALL),
    ("Operate, drawer of passes", SMALL),
    ("Plan", LARGE),
    ("Plan, details", SMALL),
    ("Elements", LARGE),
    ("Elements, details", SMALL),
    ("Elements, selected rows", LARGE),
    ("Upload", SMALL),
    ("Antennas", LARGE),
    ("Console", SMALL),
    ("Record", LARGE),
    ("Record", SMALL),
    ("Map", LARGE),
    ("Preferences", SMALL),
    ("Preferences, an antenna", LARGE),
    ("Horizon and keep-outs", SMALL),
    ("Satellites and priorities", LARGE),
    ("Automation rules", LARGE),
    ("Set-up, satellites", LARGE),
];
