//! Legend in the bar of the table.

use egui::{Align2, Painter, Pos2, Rect, Stroke, Ui, pos2, vec2};

use super::{MapLayers, ground, words};
use crate::{
    model::{
        Model,
        globe::{AHEAD_MIN, GlobeSatellite},
    },
    ui::{
        format,
        sky_plot::geometry::{circle, dashed},
        text, theme,
        tokens::Tokens,
        widgets::paint,
    },
};

/// Width of a sample, points.
const SAMPLE: f32 = 16.0;
const GAP: f32 = 6.0;
/// Distance between two entries, points.
const STEP: f32 = 16.0;

type Sample = fn(&Painter, Pos2, &Tokens);

/// Draws the entries of the shown layers from the right end of `rect`, as many as have room.
pub(super) fn show(ui: &Ui, rect: Rect, model: &Model, layers: MapLayers) {
    let t = theme::tokens(ui);
    let selected = model.globe.selected();
    let entries = entries(model, selected, layers);
    let widths: Vec<f32> = entries
        .iter()
        .map(|(_, words)| SAMPLE + GAP + paint::text_width(ui, words, text::small()))
        .collect();
    let all: f32 = widths.iter().map(|width| width + STEP).sum();
    let mut left = (rect.right() - all).max(rect.left()).min(rect.left() + 220.0);
    for ((sample, words), width) in entries.iter().zip(widths) {
        if left + width > rect.right() {
            return;
        }
        let position = pos2(left + SAMPLE / 2.0, rect.center().y);
        sample(ui.painter(), position, t);
        let position = pos2(left + SAMPLE + GAP, rect.center().y);
        paint::text(ui, position, Align2::LEFT_CENTER, words, text::small(), t.t2);
        left += width + STEP;
    }
}

fn entries(
    model: &Model,
    selected: Option<&GlobeSatellite>,
    layers: MapLayers,
) -> Vec<(Sample, String)> {
    let mut entries: Vec<(Sample, String)> = Vec::new();
    if selected.is_some() && layers.tracks {
        entries.push((flown, "flown".to_owned()));
        entries.push((ahead, format!("next {AHEAD_MIN} min")));
    }
    if layers.footprints {
        let elevation = words::elevation(model.globe.aos_elevation);
        entries.push((footprint, format!("footprint at {elevation}")));
        if let Some(satellite) = selected {
            let unit = model.appearance.distances;
            let height = format::distance(satellite.below.height_km, 0, unit);
            let name = &model.station.name;
            entries.push((rises, format!("{name} sees a satellite at {height} height")));
        }
    }
    if layers.terminator {
        entries.push((terminator, "sunset and sunrise".to_owned()));
    }
    entries
}

fn line(position: Pos2) -> [Pos2; 2] {
    [position - vec2(SAMPLE / 2.0, 0.0), position + vec2(SAMPLE / 2.0, 0.0)]
}

fn flown(painter: &Painter, position: Pos2, t: &Tokens) {
    painter.line_segment(line(position), Stroke::new(2.0, t.sat));
}

fn ahead(painter: &Painter, position: Pos2, t: &Tokens) {
    painter.extend(dashed(&line(position), 6.5, 3.0, Stroke::new(2.0, t.sat)));
}

fn footprint(painter: &Painter, position: Pos2, t: &Tokens) {
    painter.circle_stroke(position, 6.0, Stroke::new(1.0, t.t2));
}

fn rises(painter: &Painter, position: Pos2, t: &Tokens) {
    painter.extend(dashed(&circle(position, 6.0), 3.0, 3.0, Stroke::new(1.25, t.ok)));
}

fn terminator(painter: &Painter, position: Pos2, t: &Tokens) {
    ground::terminator(painter, &line(position), t);
}
