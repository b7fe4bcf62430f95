//! The scene of the plot: the sky with its obstructions, the passes, the Sun and the antenna.

use std::ops::Range;

use egui::{Align2, Pos2, Rect, Shape, Stroke, Ui, vec2};

use super::{
    super::{
        Chosen, HorizonState,
        draft::{Skies, ZoneDraft},
        edit::place,
    },
    label,
};
use crate::{
    astro::{Angle, Zone},
    contract::antenna::AntennaModel,
    model::{
        Model,
        effects::{
            Effect,
            obstacles::{Question, Toll},
        },
    },
    station::{Antenna, Mount},
    ui::{
        format,
        sky_plot::{
            KeepOutMark, Keyholes,
            geometry::{Dome, dashed, outward},
            grid, keep_outs, marks, mask,
        },
        theme,
        tokens::Tokens,
    },
};

pub(super) fn paint_sky(
    ui: &Ui,
    rect: Rect,
    dome: Dome,
    model: &Model,
    skies: &Skies,
    state: &mut HorizonState,
    antenna: Option<&AntennaModel>,
) {
    let t = theme::tokens(ui);
    let painter = ui.painter();
    grid::disc(painter, dome, t);
    let mask = skies.read_mask().ok().flatten();
    if let Some(mask) = &mask {
        mask::paint(painter, dome, mask, t);
    }
    grid::rings(painter, dome, t);
    grid::ring_numbers(painter, dome, t);
    let config = antenna.map(|antenna| &*antenna.config);
    let minimum_deg = config.map_or(0.0, |config| config.limits.minimum_elevation_deg);
    grid::rim(painter, dome, Angle::from_degrees(minimum_deg), t);
    let chosen = match state.chosen {
        Chosen::Zone(index) => skies.zones.get(index),
        Chosen::Skyline | Chosen::Sun => None,
    };
    let name = chosen.map(|zone| zone.name.trim());
    let shown_effect = model.obstacle_effects.effect.as_ref().filter(|_| state.shows_passes);
    if let Some(effect) = shown_effect {
        passes(ui, dome, effect, name, t);
    }
    if let Some(config) = config {
        travel(ui, dome, config, t);
    }
    let half_beam = config.map_or(Angle::ZERO, |config| config.beam_width() * 0.5);
    let shown: Vec<(&ZoneDraft, Zone)> = skies
        .zones
        .iter()
        .enumerate()
        .filter(|(index, zone)| state.chosen == Chosen::Zone(*index) || holds_for(zone, config))
        .filter_map(|(_, zone)| Some((zone, zone.zone().ok()?)))
        .collect();
    let marks: Vec<KeepOutMark<'_>> = shown
        .iter()
        .map(|(draft, zone)| KeepOutMark {
            name: draft.name.trim(),
            zone,
            margin: half_beam + Angle::from_degrees(draft.margin.saved()),
        })
        .collect();
    keep_outs::paint(painter, dome, &marks, t);
    if let Some(effect) = shown_effect {
        blocked(ui, dome, effect, name, t);
    }
    keep_outs::words(painter, dome, &marks, t);
    for zone in skies.zones.iter().filter(|zone| zone.zone().is_err()) {
        let corners = zone.corners_deg();
        let path: Vec<Pos2> =
            corners.iter().chain(corners.first()).map(|corner| place(dome, *corner)).collect();
        painter.extend(dashed(&path, 4.0, 3.0, Stroke::new(1.5, t.bad)));
    }
    sun(ui, rect, dome, model, skies, state, t);
    if let Some(antenna) = antenna
        && let Some(direction) =
            antenna.snapshot.state.measured.and_then(|measured| measured.direction())
        && let Some(position) = dome.visible(direction)
    {
        marks::measured(painter, position, 0.75, t);
        let words = format!(
            "{}\n{}, {}",
            antenna.config.name,
            format::degrees(direction.azimuth_deg(), 1),
            format::degrees(direction.elevation_deg(), 1)
        );
        label(ui, position + vec2(24.0, 8.0), Align2::LEFT_TOP, &words, t.t1, t);
    }
}

pub(super) fn holds_for(zone: &ZoneDraft, antenna: Option<&Antenna>) -> bool {
    match (&zone.antenna, antenna) {
        (Some(name), Some(antenna)) => Antenna::same_name(name, &antenna.name),
        _ => true,
    }
}

/// Returns the effect of the keep-out with this name on the passes.
fn toll_of<'a>(effect: &'a Effect<Question>, name: Option<&str>) -> Option<&'a Toll> {
    let keep_outs = &effect.question.after.keep_outs;
    let place = keep_outs.iter().position(|keep_out| Some(&*keep_out.name) == name)?;
    effect.after.of_each.get(place)
}

fn path(
    dome: Dome,
    effect: &Effect<Question>,
    way: usize,
    samples: Option<Range<usize>>,
) -> Vec<Pos2> {
    let Some(way) = effect.ways.get(way) else { return Vec::new() };
    let samples = samples.map_or(Some(way.samples.as_slice()), |range| way.samples.get(range));
    dome.path(samples.into_iter().flatten().map(|sample| sample.direction))
}

/// Draws all passes. The passes that the selected keep-out touches are on top.
fn passes(ui: &Ui, dome: Dome, effect: &Effect<Question>, chosen: Option<&str>, t: &Tokens) {
    let toll = toll_of(effect, chosen);
    let touched =
        |way: usize| toll.is_some_and(|toll| toll.blocked.iter().any(|(total, _)| *total == way));
    for is_touched in [false, true] {
        let colour = if is_touched { t.other } else { t.grid };
        for way in (0..effect.ways.len()).filter(|way| touched(*way) == is_touched) {
            let line = path(dome, effect, way, None);
            ui.painter().add(Shape::line(line, Stroke::new(1.0, colour)));
        }
    }
}

/// Draws the parts of passes that the selected keep-out blocks.
fn blocked(ui: &Ui, dome: Dome, effect: &Effect<Question>, chosen: Option<&str>, t: &Tokens) {
    let parts = toll_of(effect, chosen).map(|toll| toll.blocked.iter());
    for (way, samples) in parts.into_iter().flatten() {
        let line = path(dome, effect, *way, Some(samples.clone()));
        ui.painter().add(Shape::line(line, Stroke::new(1.5, t.warn)));
    }
}

/// Draws the ends of the travel.
fn travel(ui: &Ui, dome: Dome, config: &Antenna, t: &Tokens) {
    let painter = ui.painter();
    if let Some(holes) = Keyholes::new(&config.mount) {
        grid::keyholes(painter, dome, &holes, t);
    }
    let Mount::AzEl { azimuth_from_deg, azimuth_to_deg, elevation_from_deg, .. } = config.mount
    else {
        return;
    };
    if elevation_from_deg > 0.0 {
        let ring = dome.circle(dome.ring(elevation_from_deg as f32));
        painter.extend(dashed(&ring, 1.5, 4.0, Stroke::new(1.25, t.warn)));
    }
    if azimuth_to_deg - azimuth_from_deg < 360.0 {
        for end_deg in [azimuth_from_deg, azimuth_to_deg] {
            let azimuth = end_deg.to_radians() as f32;
            let spoke = [dome.point_at(azimuth, 87.0), dome.point_at(azimuth, 0.0)];
            painter.extend(dashed(&spoke, 1.5, 4.0, Stroke::new(1.25, t.warn)));
        }
    }
    for end_deg in [azimuth_from_deg, azimuth_to_deg] {
        let direction = outward(end_deg.to_radians() as f32);
        let foot = dome.centre + direction * dome.radius;
        let stroke = Stroke::new(3.0, t.bad);
        painter.line_segment([foot - direction * 12.0, foot + direction * 13.0], stroke);
        let across = direction.rot90() * 7.0;
        painter.line_segment([foot - across, foot + across], stroke);
    }
}

fn sun(
    ui: &Ui,
    rect: Rect,
    dome: Dome,
    model: &Model,
    skies: &Skies,
    state: &mut HorizonState,
    t: &Tokens,
) {
    let way = state.sun_way(model.station.site, model.now);
    let path = dome.path(way.iter().copied());
    // The path of the Sun sets and rises; no line joins these two points across the sky.
    for part in path.chunk_by(|a, b| a.distance(*b) < dome.radius / 4.0) {
        ui.painter().extend(dashed(part, 1.5, 4.0, Stroke::new(1.0, t.sun)));
    }
    let Some(direction) = model.sky.sun.filter(|sun| sun.elevation_deg() > 0.0) else { return };
    let Some(position) = dome.visible(direction) else { return };
    marks::sun(ui.painter(), position, t);
    let Some(avoidance) = skies.sun.saved() else { return };
    let radius = Angle::from_degrees(avoidance.radius_deg);
    let horizon =
        (0..=72_u8).map(|step| direction.displaced(f64::from(step) * 5.0, avoidance.radius_deg));
    let ring: Vec<Pos2> = horizon.filter_map(|ring_direction| dome.point(ring_direction)).collect();
    ui.painter().extend(dashed(&ring, 4.0, 3.0, Stroke::new(1.25, t.sun)));
    let words = format!("Sun {}", format::degrees(avoidance.radius_deg, 1));
    let point = position + vec2(dome.length(radius).max(10.0) + 6.0, 0.0);
    if rect.contains(point) {
        label(ui, point, Align2::LEFT_CENTER, &words, t.sun, t);
    }
}
