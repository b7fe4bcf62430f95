//! Reading order of the window for screen readers.
//!
//! A view draws parts of a fixed size first, such as the buttons at the right of a bar, and then
//! the rest. The accessibility tree therefore starts with the parts drawn first. This module sorts
//! neighbouring parts into the order of the window: down each column, along each row.

use std::collections::HashMap;

use egui::{
    Context, FullOutput, LayerId, Plugin, Rect, Role,
    accesskit::{Node, NodeId},
};

/// Max overlap of two places that still count as side by side, points.
const NEAR: f32 = 0.5;

/// Plugin that sorts the accessibility tree of every frame.
#[derive(Debug, Default)]
pub(super) struct ReadingOrder;

impl Plugin for ReadingOrder {
    fn debug_name(&self) -> &'static str {
        "reading order"
    }

    fn output_hook(&mut self, ctx: &Context, output: &mut FullOutput) {
        let Some(update) = &mut output.platform_output.accesskit_update else { return };
        let spots = Spots::new(ctx, &update.nodes);
        for (_, node) in &mut update.nodes {
            // The marks of a drawing have their own order, such as order of time.
            if node.role() != Role::Canvas && node.children().len() > 1 {
                let children = spots.in_order(node.children());
                node.set_children(children);
            }
        }
    }
}

/// The visible part of a node.
#[derive(Debug, Clone, Copy)]
struct Spot {
    layer: LayerId,
    place: Rect,
}

impl Spot {
    /// Returns `true` if screen readers read it before `other`: it stands above `other` in the same
    /// column, or left of it in the same row.
    fn is_before(self, other: Self) -> bool {
        let (a, b) = (self.place, other.place);
        let columns = a.x_range().intersection(b.x_range()).span();
        let rows = a.y_range().intersection(b.y_range()).span();
        let is_above = a.bottom() < b.top() + NEAR && columns > NEAR;
        let is_left = a.right() < b.left() + NEAR && rows > 0.5 * a.height().min(b.height());
        self.layer == other.layer && (is_above || is_left)
    }
}

/// The visible parts of all nodes.
struct Spots(HashMap<NodeId, Spot>);

impl Spots {
    fn new(ctx: &Context, nodes: &[(NodeId, Node)]) -> Self {
        let of_widgets: HashMap<NodeId, Spot> = ctx.viewport(|viewport| {
            let layers = viewport.this_pass.widgets.layers();
            let widgets = layers.flat_map(|(_, widgets)| widgets);
            let spot = |widget: &egui::WidgetRect| Spot {
                layer: widget.layer_id,
                place: widget.interact_rect,
            };
            widgets.map(|widget| (widget.id.accesskit_id(), spot(widget))).collect()
        });
        let nodes: HashMap<NodeId, &Node> = nodes.iter().map(|(id, node)| (*id, node)).collect();
        let mut spots = Self(HashMap::new());
        for id in nodes.keys() {
            spots.add(*id, &nodes, &of_widgets);
        }
        spots
    }

    /// Adds a node and its content. The place of a container is the place of its content,
    /// regardless of the container's size.
    fn add(
        &mut self,
        id: NodeId,
        nodes: &HashMap<NodeId, &Node>,
        of_widgets: &HashMap<NodeId, Spot>,
    ) -> Option<Spot> {
        if let Some(spot) = self.0.get(&id) {
            return Some(*spot);
        }
        let (node, mut spot) = (nodes.get(&id)?, *of_widgets.get(&id)?);
        if matches!(node.role(), Role::GenericContainer | Role::Group) {
            spot.place = Rect::NOTHING;
        }
        for child in node.children() {
            let child = self.add(*child, nodes, of_widgets);
            if let Some(child) = child.filter(|recorded_spot| {
                recorded_spot.layer == spot.layer && recorded_spot.place.is_positive()
            }) {
                spot.place = spot.place.union(child.place);
            }
        }
        self.0.insert(id, spot);
        Some(spot)
    }

    /// Returns the nodes in reading order. Nodes without a defined order keep theirs, and
    /// overlapping neighbours stay together.
    fn in_order(&self, nodes: &[NodeId]) -> Vec<NodeId> {
        struct Left {
            id: NodeId,
            spot: Option<Spot>,
            /// Number of remaining nodes that screen readers read before this node.
            before: usize,
        }
        let is_before =
            |a: Option<Spot>, b: Option<Spot>| a.zip(b).is_some_and(|(a, b)| a.is_before(b));
        // The map is read once per node, because the code compares each node with each.
        let spots: Vec<Option<Spot>> = nodes.iter().map(|id| self.0.get(id).copied()).collect();
        let before = |spot: Option<Spot>| {
            spots.iter().filter(|maybe_spot| is_before(**maybe_spot, spot)).count()
        };
        let with_spots = nodes.iter().zip(&spots);
        let mut left: Vec<Left> = with_spots
            .map(|(id, spot)| Left { id: *id, spot: *spot, before: before(*spot) })
            .collect();
        let (mut order, mut start) = (Vec::with_capacity(nodes.len()), 0);
        while !left.is_empty() {
            let is_free = |(index, one): (usize, &Left)| (one.before == 0).then_some(index);
            let later = left.iter().enumerate().skip(start).find_map(is_free);
            let next = later.or_else(|| left.iter().enumerate().find_map(is_free));
            start = next.unwrap_or_default();
            let following_left = left.remove(start);
            for other in left.iter_mut().filter(|one| is_before(following_left.spot, one.spot)) {
                other.before -= 1;
            }
            order.push(following_left.id);
        }
        order
    }
}

#[cfg(test)]
mod tests {
    use egui::{Align, Layout, UiBuilder, pos2, vec2};
    use egui_kittest::kittest::NodeT as _;

    use super::*;
    use crate::ui::widgets::testing;

    fn read(mut draw: impl FnMut(&mut egui::Ui)) -> Vec<String> {
        let window = testing::window([400.0, 300.0], (), move |ui, ()| draw(ui));
        let nodes = window.root().children_recursive();
        let buttons = nodes.filter(|node| node.accesskit_node().role() == Role::Button);
        buttons.filter_map(|node| node.accesskit_node().label()).collect()
    }

    #[test]
    fn buttons_from_the_right_are_read_from_the_left() {
        let words = read(|ui| {
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                for name in ["save", "copy", "open"] {
                    let _ = ui.button(name);
                }
            });
        });
        assert_eq!(words, ["open", "copy", "save"]);
    }

    #[test]
    fn a_column_is_read_to_its_end() {
        let words = read(|ui| {
            for (left, name) in [(200.0, "right"), (0.0, "left")] {
                for row in 0..3_u8 {
                    let min = pos2(left, f32::from(row) * 40.0);
                    let place = Rect::from_min_size(min, vec2(100.0, 30.0));
                    ui.scope_builder(UiBuilder::new().max_rect(place), |ui| {
                        let _ = ui.button(format!("{name} {row}"));
                    });
                }
            }
        });
        assert_eq!(words, ["left 0", "left 1", "left 2", "right 0", "right 1", "right 2"]);
    }
}
