//! Drawing directly on the sky: points of the skyline and new zones.

use egui::{Pos2, Response, Stroke, StrokeKind, Ui};

use super::{
    super::{
        Chosen, HorizonState, Tool,
        draft::{Skies, ZoneDraft},
        edit::{self, place},
    },
    HANDLE,
    scene::holds_for,
};
use crate::{
    astro::AzEl,
    station::Antenna,
    ui::{
        sky_plot::geometry::{Dome, dashed},
        tokens::Tokens,
        widgets::paint,
    },
};

/// Handles a click or a drag on the sky.
pub(super) fn draw_on_canvas(
    ui: &Ui,
    canvas: &Response,
    dome: Dome,
    skies: &mut Skies,
    state: &mut HorizonState,
    antenna: Option<&Antenna>,
) {
    let Some(position) = canvas.interact_pointer_pos() else { return };
    let is_alt = ui.input(|input| input.modifiers.alt);
    let coarse = state.snaps;
    let direction = edit::snapped(edit::position_under(dome, position, 180.0), coarse);
    match state.tool {
        Tool::Select if canvas.clicked() => {
            if let (Chosen::Zone(index), true) = (state.chosen, is_alt)
                && let Some(zone) = skies.zones.get_mut(index)
                && let Some(edge) = zone.nearest_edge(dome, position)
                && let Some(added) = zone.split(edge)
            {
                let near = zone.corners.get(edge).map_or(180.0, |corner| corner.azimuth.saved());
                zone.put(added, edit::snapped(edit::position_under(dome, position, near), coarse));
                state.corner = Some(added);
                return;
            }
            let (azimuth_deg, elevation_deg) = edit::position_under(dome, position, 180.0);
            let direction = AzEl::from_degrees(azimuth_deg, elevation_deg);
            if let Some(found) = skies.zone_at(direction, |zone| holds_for(zone, antenna)) {
                state.choose(Chosen::Zone(found));
            }
        }
        Tool::Point if canvas.clicked() => {
            let mut points = skies.skyline();
            points.push(direction);
            if skies.set_skyline(points) {
                state.choose(Chosen::Skyline);
            }
        }
        Tool::Polygon => {
            let is_round = state.drawing.len() >= edit::MIN_CORNERS
                && state
                    .drawing
                    .first()
                    .is_some_and(|corner| place(dome, *corner).distance(position) < HANDLE);
            if canvas.double_clicked() || (canvas.clicked() && is_round) {
                let corners = std::mem::take(&mut state.drawing);
                add_zone(skies, state, &corners);
            } else if canvas.clicked() {
                let near = state.drawing.last().map_or(180.0, |last| last.0);
                state
                    .drawing
                    .push(edit::snapped(edit::position_under(dome, position, near), coarse));
                // A double click adds the same point twice.
                state.drawing.dedup();
            }
        }
        Tool::Rectangle => {
            if canvas.drag_started() {
                let press = ui.input(|input| input.pointer.press_origin()).unwrap_or(position);
                let start = edit::snapped(edit::position_under(dome, press, 180.0), coarse);
                state.drawing = vec![start, start];
            }
            if let Some(start) = state.drawing.first().copied() {
                let end = edit::snapped(edit::position_under(dome, position, start.0), coarse);
                state.drawing = vec![start, end];
                if canvas.drag_stopped() {
                    state.drawing.clear();
                    if let Some(corners) = edit::rectangle(start, end) {
                        add_zone(skies, state, &corners);
                    }
                }
            }
        }
        Tool::Select | Tool::Point => {}
    }
}

/// Adds a keep-out of at least three corners and selects it.
fn add_zone(skies: &mut Skies, state: &mut HorizonState, corners: &[(f64, f64)]) {
    if corners.len() < edit::MIN_CORNERS {
        return;
    }
    let name = skies.free_name("Keep-out");
    skies.zones.push(ZoneDraft::added(name, corners));
    state.choose(Chosen::Zone(skies.zones.len().saturating_sub(1)));
    state.tool = Tool::Select;
}

pub(super) fn paint_drawing(ui: &Ui, dome: Dome, state: &HorizonState, t: &Tokens) {
    let corners = match (state.tool, &state.drawing[..]) {
        (Tool::Rectangle, [start, end]) => edit::rectangle(*start, *end).map(Vec::from),
        (Tool::Polygon, corners) => Some(corners.to_vec()),
        _ => None,
    };
    let mut path: Vec<Pos2> = corners.iter().flatten().map(|corner| place(dome, *corner)).collect();
    if state.tool == Tool::Rectangle {
        path.extend(path.first().copied());
    }
    for position in &path {
        let stroke = Stroke::new(1.5, t.sat);
        ui.painter().rect(paint::square(*position, HANDLE), 0.0, t.bg0, stroke, StrokeKind::Inside);
    }
    ui.painter().extend(dashed(&path, 4.0, 3.0, Stroke::new(1.5, t.sat)));
}
