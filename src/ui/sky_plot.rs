//! The sky plot: a disc from zenith to horizon with the selected pass, other
//! satellites, and the commanded and measured directions of the antenna.

mod antenna;
mod beam_view;
mod bearing;
mod bodies;
pub(super) mod corners;
pub(super) mod geometry;
pub(super) mod grid;
pub(super) mod keep_outs;
pub(super) mod labels;
pub(super) mod legend;
pub(super) mod marks;
pub(super) mod mask;
mod nodes;
pub(super) mod placement;
mod readout;
mod scene;
mod small;
#[cfg(test)]
mod stories;
#[cfg(test)]
mod testing;
mod track;

use std::collections::HashMap;

use egui::{Rect, Ui};

use self::{
    geometry::Dome,
    labels::{Key, Label, Labels},
    placement::{Memory, Side},
};
use super::{text, theme, tokens::Tokens};

pub use scene::{Bearing, KeepOutMark, Keyholes, Measured, OtherSatellite, SkyScene, Track};
pub use small::paint_small;

/// State of the plot, kept from frame to frame.
#[derive(Debug, Clone, Default)]
pub struct SkyPlotState {
    pub layers: Layers,
    labels: HashMap<Key, Memory>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
// Independent check boxes.
#[allow(clippy::struct_excessive_bools)]
pub struct Layers {
    /// Satellites that are not selected.
    pub others: bool,
    /// Names of the satellites that are not selected.
    pub names: bool,
    /// The Sun and the Moon.
    pub sun_and_moon: bool,
    /// Directions that the mount cannot reach.
    pub keyholes: bool,
    /// The sky blocked by the horizon mask.
    pub mask: bool,
    /// Zones into which antennas must not point.
    pub keep_outs: bool,
}

impl Default for Layers {
    fn default() -> Self {
        Self {
            others: true,
            names: true,
            sun_and_moon: true,
            keyholes: true,
            mask: true,
            keep_outs: true,
        }
    }
}

/// Shows the plot in `rect`. Returns the catalog number of a satellite chosen with a click
/// or with Enter.
pub fn show(
    ui: &mut Ui,
    rect: Rect,
    scene: &SkyScene<'_>,
    state: &mut SkyPlotState,
) -> Option<u32> {
    if !geometry::usable(rect) {
        return None;
    }
    let ui = &mut ui.new_child(egui::UiBuilder::new().id_salt("sky plot").max_rect(rect));
    ui.shrink_clip_rect(rect);
    let t = theme::tokens(ui.ctx());
    let dome = Dome::fitted(rect);
    ui.painter().rect_filled(rect, 0.0, t.bg0);

    // Added before the buttons in the corners, which lie above the canvas.
    let canvas = nodes::canvas(ui, rect, scene);
    paint_sky(ui, rect, dome, scene, state, t);
    beam_view::paint(ui.painter(), rect, scene, t);
    let chosen = nodes::satellites(ui, canvas.id, dome, scene, state.layers.others, t);
    let events = scene.track.map(|track| track::events(&track)).unwrap_or_default();
    nodes::events_and_antenna(ui, canvas.id, dome, &events, scene);
    readout::paint(ui.painter(), rect, dome, scene, t);
    corners::upper_right(ui, rect, &mut state.layers, t);
    corners::lower_left(ui, rect, dome, scene, t);
    if canvas.has_focus() {
        let stroke = egui::Stroke::new(2.0, t.sat);
        ui.painter().rect_stroke(rect.shrink(2.0), 0.0, stroke, egui::StrokeKind::Inside);
    }
    chosen
}

/// Paints the layers from the disc up to the selected satellite, then the
/// labels between them, so that no line crosses a text.
fn paint_sky(
    ui: &Ui,
    rect: Rect,
    dome: Dome,
    scene: &SkyScene<'_>,
    state: &mut SkyPlotState,
    t: &Tokens,
) {
    let painter = ui.painter();
    let layers = state.layers;
    let before = std::mem::take(&mut state.labels);
    let mut labels = Labels::new(painter, t, Some(dome), rect.shrink(4.0), before);

    grid::disc(painter, dome, t);
    if let Some(mask) = scene.mask.filter(|_| layers.mask) {
        mask::paint(painter, dome, mask, t);
    }
    grid::rings(painter, dome, t);
    for name in grid::rim(painter, dome, scene.minimum_elevation, t) {
        labels.reserve(name);
    }
    labels.reserve_path(&dome.circle(dome.radius), 4.0);
    if layers.keep_outs {
        keep_outs::paint(painter, dome, scene.keep_outs, t);
        for words in keep_outs::words(painter, dome, scene.keep_outs, t) {
            labels.reserve(words);
        }
    }
    if let Some(holes) = scene.keyholes.filter(|_| layers.keyholes) {
        for outline in grid::keyholes(painter, dome, &holes, t) {
            labels.reserve(Rect::from_points(&outline));
        }
    }
    let numbers = readout::reserved(painter, rect, dome, scene, t);
    for corner in corners::reserved(rect, dome, scene).into_iter().chain(numbers) {
        labels.reserve(corner);
    }
    if layers.sun_and_moon {
        bodies::sun_and_moon(painter, dome, scene, &mut labels, t);
    }
    if layers.others {
        bodies::others(painter, dome, scene.others, &mut labels, t);
    }
    antenna::reserve(dome, scene, &mut labels);
    bearing::label(&mut labels, dome, scene, t);

    let mut events = Vec::new();
    if let Some(track) = &scene.track {
        let parts = track::parts(dome, track, scene.now);
        let ticks = track::ticks(dome, track);
        events = track::events(track);
        labels.reserve_path(&parts.flown, 6.0);
        labels.reserve_path(&parts.planned, 6.0);
        track::paint(painter, &parts, &ticks, t);
        label_selected(&mut labels, dome, scene, t);
        track::label_events(&mut labels, dome, &events, t);
        track::label_minutes(&mut labels, &ticks, &events, scene.now, t);
    }
    if layers.sun_and_moon {
        bodies::label_sun_and_moon(&mut labels, dome, scene, t);
    }
    if layers.others && layers.names {
        bodies::label_others(&mut labels, dome, scene, t);
    }
    state.labels = labels.into_memory();

    track::paint_events(painter, dome, &events, t);
    bearing::paint(painter, dome, scene, t);
    antenna::paint(painter, dome, scene, t);
    let position = scene.track.and_then(|track| track.position);
    if let Some(at) = position.and_then(|position| dome.visible(position)) {
        marks::selected(painter, at, t);
    }
}

fn label_selected(labels: &mut Labels<'_>, dome: Dome, scene: &SkyScene<'_>, t: &Tokens) {
    let Some(track) = scene.track else { return };
    let Some(mark) = track.position.and_then(|position| dome.visible(position)) else { return };
    labels.add(&Label {
        key: Key::Selected(track.catalog_number),
        lines: &[(track.name, text::sized(13.0, text::Weight::SemiBold), t.sat)],
        mark,
        clearance: antenna::clearance(dome, scene, mark, 12.0),
        order: &Side::ORDER,
        tolerance: 1.0,
    });
}
