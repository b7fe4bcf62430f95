//! Tree for screen readers: names, groups and order.

use std::collections::BTreeMap;

use azel::ui::{rail, top_bar};
use egui::{Role, accesskit::Action};
use egui_kittest::kittest::{AccessKitNode, NodeT as _, Queryable as _};

use crate::window_stories::{every_view::Findings, rig::Window};

/// Returns all nodes in reading order.
fn in_order(window: &Window) -> Vec<AccessKitNode<'_>> {
    window.root().children_recursive().map(|node| node.accesskit_node()).collect()
}

fn is_control(node: &AccessKitNode<'_>) -> bool {
    let data = node.data();
    let acts = data.supports_action(Action::Focus) || data.supports_action(Action::Click);
    // A label is no control, although the pointer can select its text.
    acts && node.role() != Role::Label
}

fn name(node: &AccessKitNode<'_>) -> String {
    node.label().unwrap_or_default().trim().to_owned()
}

/// Returns the names of the groups around a node, starting with the outermost.
fn groups(node: &AccessKitNode<'_>) -> Vec<String> {
    let ancestors = std::iter::successors(node.parent(), AccessKitNode::parent);
    let mut names: Vec<String> =
        ancestors.map(|of| name(&of)).filter(|of| !of.is_empty()).collect();
    names.reverse();
    names
}

fn is_hidden(node: &AccessKitNode<'_>) -> bool {
    node.is_hidden() || node.role() == Role::ScrollBar
}

/// Returns faults: controls without a name, and controls of one role and name in one group.
fn names(window: &Window) -> Vec<String> {
    let mut faults = Vec::new();
    let mut seen: BTreeMap<(Vec<String>, String, String), usize> = BTreeMap::new();
    for node in in_order(window).into_iter().filter(|of| is_control(of) && !is_hidden(of)) {
        let (role, name) = (format!("{:?}", node.role()), name(&node));
        if name.is_empty() {
            let place = node.raw_bounds();
            faults.push(format!("{role} without a name in {:?} at {place:?}", groups(&node)));
        }
        *seen.entry((groups(&node), role, name)).or_default() += 1;
    }
    let twice = seen.into_iter().filter(|((_, _, name), count)| *count > 1 && !name.is_empty());
    faults.extend(twice.map(|((groups, role, name), count)| {
        format!("{role} {name:?} in {groups:?}, {count} times")
    }));
    faults
}

/// Returns a fault if the first control is not STOP.
fn first(window: &Window) -> Option<String> {
    let nodes = in_order(window);
    let first = nodes.iter().find(|of| is_control(of)).map(name).unwrap_or_default();
    (!first.starts_with("STOP")).then(|| format!("the first control is {first:?}"))
}

/// Returns faults: controls of the top bar that come after a control of the rail.
fn out_of_order(window: &Window, [width, height]: [f32; 2]) -> Vec<String> {
    let (bar, rail) = (f64::from(top_bar::height(height)), f64::from(rail::width(width)));
    let nodes = in_order(window);
    let is_below = |node: &AccessKitNode<'_>| node.raw_bounds().is_some_and(|at| at.y0 >= bar);
    let of_rail =
        |of: &AccessKitNode<'_>| is_below(of) && of.raw_bounds().is_some_and(|at| at.x1 <= rail);
    let after = nodes.iter().filter(|of| is_control(of)).skip_while(|of| !of_rail(of));
    let late = after.filter(|of| !is_hidden(of) && of.raw_bounds().is_some_and(|at| at.y1 <= bar));
    late.map(|of| format!("{:?} comes after the rail", name(of))).collect()
}

/// Returns faults: marks in a drawing that are no children of its node.
fn strays(window: &Window) -> Vec<String> {
    let mut faults = Vec::new();
    for canvas in window.query_all_by_role(Role::Canvas) {
        let inside: Vec<_> =
            canvas.children_recursive().map(|node| node.accesskit_node().id()).collect();
        let area = canvas.rect().expand(1.0);
        for node in window.query_all_by_role(Role::ListBoxOption) {
            let is_mark = node.rect().width() <= 20.0 && area.contains(node.rect().center());
            let node = node.accesskit_node();
            if is_mark && !inside.contains(&node.id()) {
                faults.push(format!("{:?} does not belong to its drawing", name(&node)));
            }
        }
    }
    faults
}

/// Finds controls without a distinct name in their group, a first control that is not STOP, and
/// marks outside of their drawing. Counts the drawings.
pub(super) fn check(window: &Window, size: [f32; 2], findings: &mut Findings) {
    let mut faults = names(window);
    faults.extend(first(window));
    faults.extend(strays(window));
    faults.extend(out_of_order(window, size));
    findings.count(window.query_all_by_role(Role::Canvas).count());
    for fault in faults {
        findings.add(&fault);
    }
}
