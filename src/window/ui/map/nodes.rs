//! Nodes of the map for the pointer, Tab and screen readers.

use egui::{Id, Pos2, Rect, Response, Role, Sense, Stroke, Ui, Vec2, WidgetInfo, pos2};

use super::{MapState, projection::Projection, words};
use crate::{
    model::{Model, UiCommand, View, globe::GlobeSatellite},
    ui::tokens::Tokens,
};

/// Side length of the square around a mark that reacts to the pointer, points.
const TARGET: f32 = 20.0;

/// Adds the map as one node, which reacts to drags and to the wheel.
pub(super) fn canvas(ui: &Ui, world: Rect, model: &Model, state: &mut MapState) -> Response {
    let id = ui.make_persistent_id("map");
    let sense = Sense::drag() | Sense::focusable_noninteractive();
    let response = ui.interact(world, id, sense);
    let words = format!("Map. {}", words::summary(model, state.shown));
    response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, &words));
    if response.dragged() {
        state.zoom.drag(response.drag_delta(), world);
    }
    if let Some(position) = response.hover_pos() {
        let points = ui.input(|input| input.smooth_scroll_delta().y);
        if points != 0.0 {
            state.zoom.turn(points, position, world);
        }
    }
    response
}

/// Adds the nodes of the satellites and of the station.
pub(super) fn marks(
    ui: &Ui,
    canvas: Id,
    projection: &Projection,
    model: &Model,
    shown: &[&GlobeSatellite],
    commands: &mut Vec<UiCommand>,
    t: &Tokens,
) {
    let station = model.station.site.point();
    let position = projection.point(station);
    if projection.world.contains(position) {
        // Keep the node small: satellites around it need the pointer.
        let place = Rect::from_center_size(position, Vec2::splat(2.0));
        let response = ui.interact(place, canvas.with("station"), Sense::hover());
        let name = format!("Station {}, {}", model.station.name, words::place(station));
        response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &name));
    }
    // Add the selected satellite last: it takes the pointer where two overlap.
    let (selected, others): (Vec<&GlobeSatellite>, Vec<_>) =
        shown.iter().copied().partition(|object| object.is_selected);
    for object in others.into_iter().chain(selected) {
        let position = projection.point(object.below.point);
        if !projection.world.contains(position) {
            continue;
        }
        satellite(ui, canvas, position, object, model, commands, t);
    }
}

fn satellite(
    ui: &Ui,
    canvas: Id,
    position: Pos2,
    object: &GlobeSatellite,
    model: &Model,
    commands: &mut Vec<UiCommand>,
    t: &Tokens,
) {
    let place = Rect::from_center_size(position, Vec2::splat(TARGET));
    let response = ui.interact(place, canvas.with(("satellite", object.number())), Sense::click());
    let name = format!(
        "{} on the map, {}",
        object.satellite.short_name(),
        words::place(object.below.point)
    );
    response
        .widget_info(|| WidgetInfo::selected(Role::ListBoxOption, true, object.is_selected, &name));
    ui.accesskit_node_builder(response.id, |node| node.set_selected(object.is_selected));
    if response.has_focus() {
        ui.painter().circle_stroke(position, TARGET / 2.0 + 2.0, Stroke::new(2.0, t.sat));
    }
    chosen(&response, object, commands);
    // Drop the focus: the arrow keys then select satellites instead of moving between nodes.
    if response.clicked() && ui.input(|input| input.pointer.any_released()) {
        response.surrender_focus();
    }
    response.on_hover_text(words::tip(object, model));
}

/// Handles a click on a satellite, which selects it, and a double click, which opens the sky plot.
pub(super) fn chosen(
    response: &Response,
    satellite: &GlobeSatellite,
    commands: &mut Vec<UiCommand>,
) {
    if response.clicked() {
        commands.push(UiCommand::SelectSatellite(satellite.number()));
    }
    if response.double_clicked() {
        commands.push(UiCommand::Show(View::Operate));
    }
}

/// Returns the corner that shows the place under the pointer.
pub(super) fn corner(world: Rect) -> Pos2 {
    pos2(world.right() - 8.0, world.bottom() - 2.0)
}
