//! Names and times on the map.

use egui::{Pos2, Rect};

use super::{projection::Projection, tracks::Tracks};
use crate::{
    model::{Model, globe::GlobeSatellite},
    ui::{
        format,
        sky_plot::{
            labels::{Key, Label, Labels},
            placement::Side,
        },
        text::{self, Weight},
        tokens::Tokens,
    },
};

/// Distance to the right edge below which names stand at the left of their marks, points.
const FLIP: f32 = 110.0;
/// Distance beyond the edge up to which a mark keeps its name, points.
const EDGE: f32 = 4.0;
/// Tolerated covered share of the selected name and the station's name: they always appear.
const ALWAYS: f32 = 1.0;
/// Max covered share of a visible name, 0 to 1.
const TOLERANCE: f32 = 0.4;

/// Keeps labels away from the part of a line that is on the map.
pub(super) fn reserve(labels: &mut Labels<'_>, world: Rect, lines: &[Vec<Pos2>], width: f32) {
    for pair in lines.iter().flat_map(|line| line.windows(2)) {
        let &[start, end] = pair else { continue };
        if world.intersects(Rect::from_two_pos(start, end).expand(width)) {
            labels.reserve_path(pair, width);
        }
    }
}

/// Labels the selected satellite, the station, the times of the track and the other satellites, in
/// this order.
pub(super) fn add(
    labels: &mut Labels<'_>,
    projection: &Projection,
    model: &Model,
    shown: &[&GlobeSatellite],
    tracks: Option<&Tracks>,
    has_names: bool,
    t: &Tokens,
) {
    let (selected, others): (Vec<&GlobeSatellite>, Vec<_>) =
        shown.iter().copied().partition(|satellite| satellite.is_selected);
    let home = projection.point(model.station.site.point());
    for satellite in selected {
        let name = satellite.satellite.short_name();
        let lines = [(name, text::sized(13.0, Weight::SemiBold), t.sat)];
        let mark = projection.point(satellite.below.point);
        add_one(labels, Key::Selected(satellite.number()), &lines, mark, 10.0, ALWAYS);
    }
    let lines = [(model.station.name.as_str(), text::small_strong(), t.t1)];
    if labels.bounds().expand(EDGE).contains(home) {
        labels.add(&Label {
            key: Key::Station,
            lines: &lines,
            mark: home,
            clearance: 10.0,
            order: &[
                Side::West,
                Side::East,
                Side::NorthWest,
                Side::NorthEast,
                Side::North,
                Side::South,
            ],
            tolerance: ALWAYS,
        });
    }
    for tick in tracks.into_iter().flat_map(|tracks| &tracks.ticks) {
        let time = format::minute_in_plot(tick.time, model.now);
        let lines = [(time.as_str(), text::caption(), t.sat)];
        let key = Key::Minute(tick.time.as_second() / 60);
        add_one(labels, key, &lines, tick.position, 7.0, TOLERANCE);
    }
    for satellite in others.iter().filter(|_| has_names) {
        let lines = [(satellite.satellite.short_name(), text::small(), t.t2)];
        let mark = projection.point(satellite.below.point);
        add_one(labels, Key::Other(satellite.number()), &lines, mark, 6.0, TOLERANCE);
    }
}

fn add_one(
    labels: &mut Labels<'_>,
    key: Key,
    lines: &[(&str, egui::FontId, egui::Color32)],
    mark: Pos2,
    clearance: f32,
    tolerance: f32,
) {
    let bounds = labels.bounds();
    if !bounds.expand(EDGE).contains(mark) {
        return;
    }
    let mut order = Side::ORDER;
    if mark.x > bounds.right() - FLIP {
        order.swap(0, 1);
    }
    labels.add(&Label { key, lines, mark, clearance, order: &order, tolerance });
}
