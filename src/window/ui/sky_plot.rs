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
mod other_antennas;
pub(super) mod placement;
mod planned;
mod pointer;
mod readout;
mod scene;
mod small;
#[cfg(test)]
mod stories;
#[cfg(test)]
mod testing;
mod track;
mod zoom;

use std::collections::HashMap;

use egui::{Id, PointerButton, Popup, Pos2, Rect, Response, Ui};
use jiff::Timestamp;

use self::{
    bodies::Dot,
    geometry::Dome,
    labels::{Key, Label, Labels},
    placement::{Memory, Side},
};
use super::{
    along, text, theme,
    tokens::Tokens,
    widgets::{context_menu, paint},
};
use crate::{astro::AzEl, model::CROWD};

pub(in crate::ui) use corners::LEGEND_FOOT;
pub use scene::{
    AzimuthStop, Bearing, Ghost, KeepOutMark, Keyholes, LaterScene, Measured, OtherAntenna,
    OtherSatellite, PlannedAntenna, SkyScene, Track,
};
pub use small::paint_small;
pub use zoom::Zoom;

/// State of the plot, kept from frame to frame.
#[derive(Debug, Clone, Default)]
pub struct SkyPlotState {
    pub layers: Layers,
    pub zoom: Zoom,
    /// `true` if a drawer covers the place of the legend, so that only its button is shown.
    pub folds_legend: bool,
    /// `true` if the plot had the keyboard focus in the last frame.
    pub has_focus: bool,
    labels: HashMap<Key, Memory>,
    /// `true` if a menu was open in the last frame. A click outside then only closes the menu.
    menu_open: bool,
    /// Direction of the sky at which the operator opened the menu.
    menu_at: Option<AzEl>,
}

/// Actions of the operator in the plot.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SkyAnswer {
    /// Catalog number of a satellite chosen with a click or with Enter.
    pub chosen: Option<u32>,
    /// Index in the station of an antenna chosen with a click or with Enter.
    pub antenna: Option<usize>,
    /// Time of the path under the pointer.
    pub pointed: Option<Timestamp>,
    /// Direction of a click in the sky.
    pub clicked: Option<AzEl>,
    /// `true` if the previous click was the first half of a double click, which shows the whole
    /// sky.
    pub takes_click_back: bool,
    /// Position of the ghost in the plot.
    pub ghost_at: Option<Pos2>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
// The fields are independent check boxes.
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
    /// Antennas that are not selected, with the ends of their azimuth axes.
    pub antennas: bool,
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
            antennas: true,
        }
    }
}

/// Subject of a menu in the plot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MenuOf {
    /// A satellite with its catalog number and direction.
    Satellite(u32, AzEl),
    /// A direction of the sky.
    Sky(AzEl),
}

/// Function that shows the entries of a menu.
pub type ShowMenu<'a> = dyn FnMut(&mut Ui, Id, MenuOf) + 'a;

/// Shows the plot in `rect`, and its menus with `menu`.
pub fn show(
    ui: &mut Ui,
    rect: Rect,
    scene: &SkyScene<'_>,
    state: &mut SkyPlotState,
    menu: &mut ShowMenu<'_>,
) -> SkyAnswer {
    if !geometry::usable(rect) {
        return SkyAnswer::default();
    }
    let ui = &mut ui.new_child(egui::UiBuilder::new().id_salt("sky plot").max_rect(rect));
    ui.shrink_clip_rect(rect);
    let t = theme::tokens(ui.ctx());
    let whole = Dome::fitted(rect);
    ui.painter().rect_filled(rect, 0.0, t.bg0);

    // The canvas comes first, because the buttons in the corners lie above it.
    let canvas = nodes::canvas(ui, rect, scene, whole, &mut state.zoom);
    let takes_click_back = canvas.double_clicked() && !state.zoom.is_whole();
    if takes_click_back {
        state.zoom.reset();
    }
    let dome = state.zoom.disc(whole);
    let others: &[_] = if state.layers.others { scene.others } else { &[] };
    let others = bodies::dots(dome, others);
    paint_sky(ui, rect, dome, scene, &others, state, t);
    beam_view::paint(ui.painter(), rect, scene, t);
    let marks = &paint::marks_of(ui, &canvas);
    let chosen = nodes::satellites(marks, canvas.id, rect, dome, scene, &others, t, menu);
    let antenna = other_antennas::nodes(marks, canvas.id, rect, dome, scene, t);
    let events = scene.track.map(|track| track::events(&track)).unwrap_or_default();
    planned::nodes(marks, canvas.id, dome, scene);
    nodes::events_and_antenna(marks, canvas.id, dome, &events, scene);
    // The corners keep their places in a magnified sky.
    readout::paint(ui.painter(), rect, whole, scene, !state.zoom.is_whole(), t);
    corners::upper_right(ui, rect, &mut state.layers, t);
    corners::lower_left(ui, rect, whole, scene, state, t);
    let pointed = point_out(ui, rect, dome, &canvas, scene, t);
    state.has_focus = canvas.has_focus();
    if state.has_focus {
        let stroke = egui::Stroke::new(2.0, t.sat);
        ui.painter().rect_stroke(rect.shrink(2.0), 0.0, stroke, egui::StrokeKind::Inside);
    }
    let is_menu_open = Popup::is_any_open(ui);
    let closes_menu = std::mem::replace(&mut state.menu_open, is_menu_open) || is_menu_open;
    if canvas.secondary_clicked() {
        state.menu_at = canvas.interact_pointer_pos().and_then(|position| dome.direction(position));
    }
    let menu_at = state.menu_at.or(scene.measured.map(|measured| measured.direction));
    if let Some(direction) = menu_at {
        context_menu::show(ui, &canvas, |ui| menu(ui, canvas.id, MenuOf::Sky(direction)));
    }
    let is_click = canvas.clicked_by(PointerButton::Primary) && !takes_click_back && !closes_menu;
    let clicked = canvas.interact_pointer_pos().filter(|_| is_click);
    SkyAnswer {
        chosen,
        antenna,
        pointed,
        clicked: clicked.and_then(|position| dome.direction(position)),
        takes_click_back,
        ghost_at: ghost_at(dome, scene).filter(|position| rect.contains(*position)),
    }
}

/// Returns the position of the ghost; for an antenna without elevation half-way to the rim.
fn ghost_at(dome: Dome, scene: &SkyScene<'_>) -> Option<Pos2> {
    let on_line = || {
        let azimuth = scene.bearing?.ghost.filter(|azimuth| azimuth.is_finite())?;
        Some(dome.point_at(azimuth.radians() as f32, 45.0))
    };
    scene.ghost.and_then(|ghost| dome.point(ghost.end)).or_else(on_line)
}

/// Shows the direction under the pointer, or the time at a marked point of the path. Returns the
/// time under the pointer.
fn point_out(
    ui: &Ui,
    rect: Rect,
    dome: Dome,
    canvas: &Response,
    scene: &SkyScene<'_>,
    t: &Tokens,
) -> Option<Timestamp> {
    let pointer = canvas.hover_pos().filter(|_| canvas.hovered() && !canvas.dragged());
    let on_path =
        pointer.and_then(|position| pointer::on_path(dome, scene.track.as_ref()?, position));
    let elsewhere = || along::sample_at(scene.track?.samples, scene.marked?);
    if let Some(sample) = on_path.or_else(elsewhere) {
        pointer::marked(ui, rect, dome, sample, scene.now, t);
    } else if let Some((position, pointed)) =
        pointer.and_then(|position| Some((position, dome.direction(position)?)))
    {
        pointer::pointed_at(ui, rect, position, pointed, t);
    }
    on_path.map(|sample| sample.time)
}

/// Paints the layers from the disc up to the selected satellite, and the labels between them. The
/// labels lie above the lines, and their backgrounds lie below the marks.
fn paint_sky(
    ui: &Ui,
    rect: Rect,
    dome: Dome,
    scene: &SkyScene<'_>,
    others: &[Dot<'_>],
    state: &mut SkyPlotState,
    t: &Tokens,
) {
    let painter = ui.painter();
    let layers = state.layers;
    grid::disc(painter, dome, t);
    if let Some(mask) = scene.mask.filter(|_| layers.mask) {
        mask::paint(painter, dome, mask, t);
    }
    grid::rings(painter, dome, t);
    let mut reserved = grid::rim(painter, dome, scene.minimum_elevation, t);
    if layers.keep_outs {
        keep_outs::paint(painter, dome, scene.keep_outs, t);
        reserved.extend(keep_outs::words(painter, dome, scene.keep_outs, t));
    }
    if let Some(holes) = scene.keyholes.filter(|_| layers.keyholes) {
        let outlines = grid::keyholes(painter, dome, &holes, t);
        reserved.extend(outlines.iter().map(|outline| Rect::from_points(outline)));
    }
    let whole = Dome::fitted(rect);
    reserved.extend(corners::reserved(rect, whole, scene, state));
    reserved.extend(readout::reserved(painter, rect, whole, scene, t));
    bodies::paths(painter, others, t);
    let drawn = scene.track.map(|track| {
        let parts = track::parts(dome, &track, scene.now);
        let ticks = track::ticks(dome, &track);
        track::paint(painter, &parts, &ticks, t);
        (parts, ticks, track::events(&track))
    });

    let before = std::mem::take(&mut state.labels);
    let mut labels = Labels::new(painter, t, Some(dome), rect.shrink(4.0), before);
    labels.reserve_path(&dome.circle(dome.radius), 4.0);
    // The name of a stop has few places outside of the disc, so it takes the least covered one.
    for rect in &reserved {
        labels.avoid(*rect, labels::LINE);
    }
    other_antennas::label_stops(&mut labels, dome, scene, t);
    for rect in reserved {
        labels.avoid(rect, labels::MARK - labels::LINE);
    }
    if layers.sun_and_moon {
        bodies::sun_and_moon(painter, dome, scene, &mut labels, t);
    }
    bodies::others(painter, others, &mut labels, t);
    antenna::reserve(dome, scene, &mut labels);
    other_antennas::reserve(&mut labels, dome, scene);
    bearing::label(&mut labels, dome, scene, t);
    let (ticks, events) = drawn.map_or_else(Default::default, |(parts, ticks, events)| {
        labels.reserve_path(&parts.flown, 6.0);
        labels.reserve_path(&parts.planned, 6.0);
        (ticks, events)
    });
    planned::reserve(&mut labels, dome, scene);
    label_selected(&mut labels, dome, scene, t);
    planned::label(&mut labels, dome, scene, t);
    track::label_events(&mut labels, dome, &events, scene.now, t);
    if layers.sun_and_moon {
        bodies::label_sun_and_moon(&mut labels, dome, scene, t);
    }
    grid::label_rings(&mut labels, dome);
    track::label_minutes(&mut labels, &ticks, &events, scene.now, t);
    other_antennas::label(&mut labels, dome, scene, t);
    if layers.names && scene.others.len() <= CROWD {
        bodies::label_others(&mut labels, dome, scene, others, t);
    }
    state.labels = labels.finish();

    track::paint_events(painter, dome, &events, t);
    other_antennas::paint_stops(painter, dome, scene, t);
    planned::paint(painter, dome, scene, t);
    other_antennas::paint(painter, dome, scene, t);
    bearing::paint(painter, dome, scene, t);
    antenna::paint(painter, dome, scene, t);
    let position = scene.track.and_then(|track| track.position);
    if let Some(point) = position.and_then(|position| dome.visible(position)) {
        marks::selected(painter, point, t);
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
