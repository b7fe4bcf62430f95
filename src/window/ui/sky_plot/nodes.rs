//! Interactive nodes of the plot, for the pointer, Tab and screen readers.

use egui::{Id, Pos2, Rect, Response, Role, Sense, Stroke, Ui, Vec2, WidgetInfo};

use super::{
    MenuOf, ShowMenu, bearing, bodies::Dot, geometry::Dome, scene::SkyScene, track::Event,
    zoom::Zoom,
};
use crate::{
    astro::AzEl,
    ui::{format, tokens::Tokens, widgets::context_menu},
};

/// Side of the square around a mark that reacts to the pointer, points.
const TARGET: f32 = 20.0;

/// Adds the plot as one focusable node. The wheel zooms the plot; the operator can drag a zoomed
/// plot. Returns the node; the ids of all other nodes derive from its id.
pub(super) fn canvas(
    ui: &Ui,
    rect: Rect,
    scene: &SkyScene<'_>,
    whole: Dome,
    zoom: &mut Zoom,
) -> Response {
    let id = ui.make_persistent_id("sky plot");
    let sense = if zoom.is_whole() { Sense::click() } else { Sense::click_and_drag() };
    let response = ui.interact(rect, id, sense);
    response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, scene.description));
    if response.dragged() {
        zoom.drag(response.drag_delta(), whole);
    }
    if let Some(position) = response.hover_pos() {
        let (points, pinched) =
            ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
        if points != 0.0 {
            zoom.turn(points, position, whole);
        }
        if (pinched - 1.0).abs() > f32::EPSILON {
            zoom.magnify(pinched, position, whole);
        }
    }
    response
}

/// Adds the nodes of the satellites. Returns the chosen satellite.
// The parameters are the plot, its content and the function for its menus.
#[allow(clippy::too_many_arguments)]
pub(super) fn satellites(
    ui: &Ui,
    canvas: Id,
    rect: Rect,
    dome: Dome,
    scene: &SkyScene<'_>,
    others: &[Dot<'_>],
    t: &Tokens,
    menu: &mut ShowMenu<'_>,
) -> Option<u32> {
    let selected = scene.track.and_then(|track| {
        let (number, direction) = (track.catalog_number, track.position?);
        Some((number, track.name, direction, dome.visible(direction)?, true))
    });
    let others =
        others.iter().map(|Dot { satellite: other_satellite, position: point, .. }| {
            (
                other_satellite.catalog_number,
                other_satellite.name,
                other_satellite.direction,
                *point,
                false,
            )
        });
    let mut chosen = None;
    // The selected satellite comes last, so that it takes the pointer where two nodes overlap.
    let visible = others.chain(selected).filter(|(_, _, _, position, _)| rect.contains(*position));
    for (number, name, direction, position, is_selected) in visible {
        let place = Rect::from_center_size(position, Vec2::splat(TARGET));
        let response = ui.interact(place, canvas.with(("satellite", number)), Sense::click());
        response.widget_info(|| {
            let name = spoken(name, direction);
            WidgetInfo::selected(Role::ListBoxOption, true, is_selected, name)
        });
        ui.accesskit_node_builder(response.id, |node| node.set_selected(is_selected));
        if response.has_focus() {
            let radius = TARGET / 2.0 + 2.0;
            ui.painter().circle_stroke(position, radius, Stroke::new(2.0, t.sat));
        }
        if response.clicked() {
            chosen = Some(number);
        }
        let menu_of = MenuOf::Satellite(number, direction);
        context_menu::show(ui, &response, |ui| menu(ui, response.id, menu_of));
        if response.hovered() {
            response.on_hover_text(tip(name, direction));
        }
    }
    chosen
}

/// Adds the nodes of the events and of the antenna.
pub(super) fn events_and_antenna(
    ui: &Ui,
    canvas: Id,
    dome: Dome,
    events: &[Event],
    scene: &SkyScene<'_>,
) {
    let note = |salt: &str, direction: AzEl, name: &str| {
        if let Some(position) = dome.point(direction) {
            name_mark(ui, canvas.with(salt), position, &spoken(name, direction));
        }
    };
    for event in events {
        let time = format::moment(event.sample.time, scene.now);
        note(event.word, event.sample.direction, &format!("{} {time}", event.word));
    }
    if let Some(commanded) = scene.commanded {
        note("commanded", commanded, "Commanded");
    }
    if let Some(measured) = scene.measured {
        let name = match measured.lost {
            Some(age) => format!("Antenna, no reply for {age}"),
            None => "Antenna".to_owned(),
        };
        note("antenna", measured.direction, &name);
    }
    if let Some(bearing) = &scene.bearing
        && let Some(position) = bearing::mark(dome, bearing)
    {
        let no_elevation = if bearing.limit.is_none() { ", no elevation" } else { "" };
        let text = format!("Antenna {}{no_elevation}", bearing::words(bearing));
        name_mark(ui, canvas.with("bearing"), position, &text);
    }
}

pub(super) fn name_mark(ui: &Ui, id: Id, position: Pos2, name: &str) {
    // The node is small, so that satellites around it keep the pointer.
    let place = Rect::from_center_size(position, Vec2::splat(2.0));
    let response = ui.interact(place, id, Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, name));
}

pub(super) fn spoken(name: &str, direction: AzEl) -> String {
    let (azimuth, elevation) = numbers(direction);
    format!("{name}, azimuth {azimuth}, elevation {elevation}")
}

pub(super) fn tip(name: &str, direction: AzEl) -> String {
    let (azimuth, elevation) = numbers(direction);
    format!("{name}\nAz {azimuth}  El {elevation}")
}

fn numbers(direction: AzEl) -> (String, String) {
    (format::degrees(direction.azimuth_deg(), 1), format::degrees(direction.elevation_deg(), 1))
}
