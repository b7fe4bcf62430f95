//! Ground of the map: sea, land, grid, day and night; and the station.

use egui::{Color32, Painter, Pos2, Shape, Stroke, vec2};

use super::{
    MapLayers, caps,
    land::{self, Land},
    projection::Projection,
};
use crate::{
    model::globe::Globe,
    ui::{sky_plot::geometry::dashed, tokens::Tokens},
};

/// Share of the daylight that the night takes, 0 to 1.
const NIGHT: f32 = 0.45;

/// Paints sea, land and grid; also the night if its layer is on.
pub(super) fn paint(
    painter: &Painter,
    projection: Projection,
    globe: &Globe,
    layers: MapLayers,
    land: &mut Option<Land>,
    t: &Tokens,
) {
    painter.rect_filled(projection.world, 0.0, t.sky);
    land::paint(painter, projection, layers.grid, land, t);
    if layers.terminator
        && let Some(night) = &globe.night
    {
        let shade = caps::fill(&projection, night, t.bg0.gamma_multiply(NIGHT));
        painter.add(Shape::mesh(shade));
        for line in caps::outline(&projection, night) {
            terminator(painter, &line, t);
        }
    }
}

/// Paints the edge of the night. Its dots differ from the dashes of a track even without colour.
pub(super) fn terminator(painter: &Painter, line: &[Pos2], t: &Tokens) {
    painter.extend(dashed(line, 1.5, 3.0, Stroke::new(1.5, t.sun)));
}

/// Paints the station as an open triangle.
pub(super) fn station(painter: &Painter, position: Pos2, t: &Tokens) {
    let corners =
        vec![position + vec2(0.0, -7.0), position + vec2(6.5, 5.0), position + vec2(-6.5, 5.0)];
    for stroke in [Stroke::new(4.0, t.sky), Stroke::new(1.75, t.t1)] {
        painter.add(Shape::closed_line(corners.clone(), stroke));
    }
    painter.add(Shape::convex_polygon(corners.clone(), t.sky, Stroke::NONE));
    painter.add(Shape::closed_line(corners, Stroke::new(1.75, t.t1)));
}

/// Returns the colour of the footprint of a satellite that is not selected.
pub(super) fn edge(is_up: bool, t: &Tokens) -> Color32 {
    if is_up { t.t3 } else { t.hatch }
}
