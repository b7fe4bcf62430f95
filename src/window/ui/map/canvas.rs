//! Canvas of the map.

use egui::{Align2, Color32, Rect, Shape, Stroke, StrokeKind, Ui, UiBuilder, vec2};

use super::{
    MapState, caps, grid, ground, labels, nodes, projection::Projection, tracks, words, world_in,
};
use crate::{
    astro::{Cap, GroundPoint},
    model::{Model, UiCommand, globe::GlobeSatellite},
    ui::{
        sky_plot::{geometry::dashed, labels::Labels, marks},
        text, theme,
        tokens::Tokens,
        widgets::paint,
    },
};

/// Opacity of the fill of the selected footprint, 0 to 1.
const FILL: f32 = 0.6;
/// Distance of names from the numbers of the grid, points.
const MARGIN: f32 = 3.0;

/// Draws the map of the whole world into `rect`. `visible` is the part that nothing covers.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    visible: Rect,
    model: &Model,
    shown: &[&GlobeSatellite],
    state: &mut MapState,
    commands: &mut Vec<UiCommand>,
) {
    let t = theme::tokens(ui);
    let world = world_in(rect);
    if !(world.is_finite() && world.height() > 90.0) {
        return;
    }
    let ui = &mut ui.new_child(UiBuilder::new().id_salt("map").max_rect(rect));
    let visible = visible.intersect(world);
    ui.shrink_clip_rect(visible);
    let canvas = nodes::canvas(ui, world, model, state);
    let projection = Projection::new(world, state.zoom);
    paint_map(ui, &projection, visible, model, shown, state, t);
    nodes::marks(&paint::marks_of(ui, &canvas), canvas.id, &projection, model, shown, commands, t);
    if let Some(place) = canvas.hover_pos().and_then(|position| projection.place(position)) {
        pointed_at(ui, visible, place, t);
    }
    if canvas.has_focus() {
        let stroke = Stroke::new(2.0, t.sat);
        ui.painter().rect_stroke(world.shrink(2.0), 0.0, stroke, StrokeKind::Inside);
    }
}

fn paint_map(
    ui: &Ui,
    projection: &Projection,
    visible: Rect,
    model: &Model,
    shown: &[&GlobeSatellite],
    state: &mut MapState,
    t: &Tokens,
) {
    let painter = ui.painter();
    let (layers, world) = (state.layers, projection.world);
    ground::paint(painter, *projection, &model.globe, layers, &mut state.land, t);
    let selected = shown.iter().find(|satellite| satellite.is_selected);
    let others = || shown.iter().filter(|satellite| !satellite.is_selected);
    if layers.other_tracks {
        for satellite in others() {
            tracks::paint_other(painter, projection, satellite, model.now, t);
        }
    }
    let station = model.station.site.point();
    if layers.footprints {
        for satellite in others() {
            outline(ui, projection, &satellite.footprint, 1.0, ground::edge(satellite.is_up, t));
        }
        if let Some(satellite) = selected {
            let fill = caps::fill(projection, &satellite.footprint, t.bgsel.gamma_multiply(FILL));
            painter.add(Shape::mesh(fill));
            outline(ui, projection, &satellite.footprint, 1.5, t.sat);
            let rises = Cap { centre: station, radius: satellite.footprint.radius };
            for line in caps::outline(projection, &rises) {
                painter.extend(dashed(&line, 3.0, 3.0, Stroke::new(1.25, t.ok)));
            }
        }
    }
    let laid_out = selected.filter(|_| layers.tracks);
    let laid_out = laid_out.map(|satellite| tracks::tracks(projection, satellite, model.now));
    if let Some(tracks) = &laid_out {
        tracks::paint(painter, tracks, t);
    }
    let before = std::mem::take(&mut state.labels);
    let mut labels = Labels::new(painter, t, None, visible.shrink(4.0), before);
    if let Some(subsolar) = model.globe.subsolar.filter(|_| layers.terminator) {
        let position = projection.point(subsolar);
        marks::sun(painter, position, t);
        labels.reserve(paint::square(position, 22.0));
    }
    if let Some(tracks) = &laid_out {
        labels::reserve(&mut labels, world, &tracks.flown, 6.0);
        labels::reserve(&mut labels, world, &tracks.ahead, 6.0);
    }
    if layers.grid {
        let marks: Vec<Rect> = marks(projection, model, shown).collect();
        for number in grid::numbers(painter, *projection, &marks, t) {
            labels.keep_off(number.expand(MARGIN));
        }
    }
    marks(projection, model, shown).for_each(|mark| labels.reserve(mark));
    labels::add(&mut labels, projection, model, shown, laid_out.as_ref(), layers.names, t);
    state.labels = labels.finish();

    ground::station(painter, projection.point(station), t);
    for satellite in others() {
        let stands = satellite.satellite.elements.is_geosynchronous();
        marks::other(painter, projection.point(satellite.below.point), stands, t);
    }
    if let Some(satellite) = selected {
        marks::selected(painter, projection.point(satellite.below.point), t);
    }
}

/// Returns the boxes of the satellites and the station.
fn marks<'a>(
    projection: &'a Projection,
    model: &Model,
    shown: &'a [&GlobeSatellite],
) -> impl Iterator<Item = Rect> + 'a {
    let home = paint::square(projection.point(model.station.site.point()), 16.0);
    let satellites =
        shown.iter().map(|satellite| paint::square(projection.point(satellite.below.point), 8.0));
    satellites.chain([home])
}

fn outline(ui: &Ui, projection: &Projection, cap: &Cap, width: f32, colour: Color32) {
    for line in caps::outline(projection, cap) {
        ui.painter().add(Shape::line(line, Stroke::new(width, colour)));
    }
}

/// Shows the place under the pointer, in the lower right corner.
fn pointed_at(ui: &Ui, visible: Rect, place: GroundPoint, t: &Tokens) {
    let words = words::place(place);
    let galley = ui.painter().layout_no_wrap(words.clone(), text::small(), t.t1);
    let rect = Align2::RIGHT_BOTTOM.anchor_size(nodes::corner(visible), galley.size());
    ui.painter().rect_filled(rect.expand2(vec2(4.0, 1.0)), 0.0, t.sky);
    ui.painter().galley(rect.min, galley, t.t1);
    paint::name_text(ui, "pointed at", rect, &format!("Pointer at {words}"));
}
