//! The tree is read in the order in which the window is: down each column, along each row.

use std::collections::BTreeMap;

use egui::{Key, LayerId, Rect, Role, accesskit::NodeId, emath::Rangef};
use egui_kittest::{
    Node,
    kittest::{AccessKitNode, NodeT as _},
};

use crate::window_stories::{
    every_view::{SCENES, scene},
    rig::{SIZES, SMALL, Window, settle},
};

/// Something that is read, where it is seen.
struct Read {
    name: String,
    place: Rect,
    layer: LayerId,
}

/// What can be seen of each widget, by its node.
fn places(window: &Window) -> BTreeMap<NodeId, (LayerId, Rect)> {
    window.ctx.viewport(|viewport| {
        let layers = viewport.this_pass.widgets.layers();
        let widgets =
            layers.flat_map(|(layer, widgets)| widgets.iter().map(move |of| (*layer, of)));
        widgets.map(|(layer, of)| (of.id.accesskit_id(), (layer, of.interact_rect))).collect()
    })
}

/// Whether it is a mark of a drawing, whose order is that of its meaning.
fn is_drawn(node: &AccessKitNode<'_>) -> bool {
    std::iter::successors(node.parent(), AccessKitNode::parent).any(|of| of.role() == Role::Canvas)
}

/// Controls and texts in the order of the tree, without STOP, which is the first by intent.
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

/// How much of the shorter of two ranges the other covers.
fn common(a: Rangef, b: Rangef) -> f32 {
    a.intersection(b).span().max(0.0) / a.span().min(b.span())
}

/// Whether `later` stands before `earlier`: above it in its column, or left of it in its row.
fn goes_back(earlier: &Read, later: &Read) -> bool {
    let (a, b) = (earlier.place, later.place);
    let is_above = b.bottom() < a.top() + 0.5 && common(a.x_range(), b.x_range()) > 0.5;
    let is_before = b.right() < a.left() + 0.5 && common(a.y_range(), b.y_range()) > 0.5;
    earlier.layer == later.layer && (is_above || is_before)
}

#[test]
fn nothing_is_read_after_what_stands_behind_it() {
    let (mut faults, mut count) = (Vec::new(), 0);
    for scene in &SCENES {
        // A drawer lies over the plot, and is read after it.
        let is_open = |size| size != SMALL || scene.name != "Operate, drawer of passes";
        for size in SIZES.into_iter().filter(|size| is_open(*size)) {
            let window = scene.open(size);
            let read = read(&window);
            count += read.len();
            for (index, later) in read.iter().enumerate() {
                let Some(earlier) = read[..index].iter().find(|of| goes_back(of, later)) else {
                    continue;
                };
                faults.push(format!(
                    "{} {size:?}: {:?} {:?} is read before {:?} {:?}",
                    scene.name, earlier.name, earlier.place, later.name, later.place
                ));
            }
        }
    }
    assert!(count > 3000, "{count} nodes");
    assert!(faults.is_empty(), "{} times\n{}", faults.len(), faults.join("\n"));
}

/// Scenes in which Tab is held to the rows.
const BY_TAB: [&str; 4] = ["Operate, tracking", "Antennas", "Console", "Preferences, an antenna"];

#[test]
fn tab_goes_along_the_rows() {
    for (name, size) in BY_TAB.into_iter().flat_map(|name| SIZES.map(|size| (name, size))) {
        let mut window = scene(name, size);
        let mut stops: Vec<(NodeId, String)> = Vec::new();
        loop {
            window.key_press(Key::Tab);
            settle(&mut window);
            // The view may have been scrolled: both places are of now.
            let places = places(&window);
            let read = |(id, name): &(NodeId, String)| {
                let (layer, place) = *places.get(id)?;
                Some(Read { name: name.clone(), place, layer })
            };
            let Some(now) = focused(&window).filter(|now| !stops.contains(now)) else { break };
            if let Some((before, now)) = stops.last().and_then(read).zip(read(&now)) {
                let (from, to) = (&before.name, &now.name);
                assert!(!goes_back(&before, &now), "{name} {size:?}: {from:?} before {to:?}");
            }
            stops.push(now);
        }
        assert!(stops.len() > 15, "{name} {size:?}: {} stops", stops.len());
    }
}

/// The node that has the focus, with its name.
fn focused(window: &Window) -> Option<(NodeId, String)> {
    let node = window.root().children_recursive().find(Node::is_focused)?.accesskit_node();
    Some((node.locate().0, node.label().or(node.value()).unwrap_or_default()))
}
