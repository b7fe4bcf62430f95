//! Parallels and meridians.

use egui::{Align2, Color32, Mesh, Painter, Pos2, Rect, Vec2, pos2, vec2};

use super::projection::Projection;
use crate::ui::{format, text, tokens::Tokens};

/// Distance between two dots, points.
const DOTS: f32 = 6.0;
/// Section width below which the grid has twice as many lines, degrees.
const CLOSE_DEG: f32 = 200.0;

/// Returns the distance between two lines, degrees.
fn step(projection: &Projection) -> i32 {
    let [west, east] = projection.longitudes();
    if east - west > CLOSE_DEG { 30 } else { 15 }
}

/// Returns the parallels of the map, degrees, with their y.
fn parallels(projection: Projection) -> impl Iterator<Item = (i32, f32)> {
    let (step, latitudes) = (step(&projection), projection.latitudes());
    let count = 90 / step;
    (1 - count..count)
        .map(move |index| index * step)
        .filter(move |latitude| latitudes.contains(&(*latitude as f32)))
        .map(move |latitude| (latitude, projection.point_at(0.0, latitude as f32).y))
}

/// Returns the meridians of the map, degrees of any turn, with their x.
fn meridians(projection: Projection) -> impl Iterator<Item = (i32, f32)> {
    let step = step(&projection);
    let [west, east] = projection.longitudes().map(|longitude| longitude / step as f32);
    (west.ceil() as i32..=east.floor() as i32)
        .map(move |index| index * step)
        .map(move |longitude| (longitude, projection.point_at(longitude as f32, 0.0).x))
}

/// Returns a mesh of the lines as dots, with the equator as a whole line. The caller caches the
/// mesh.
pub(super) fn lines(projection: Projection, colour: Color32) -> Mesh {
    let world = projection.world;
    let mut mesh = Mesh::default();
    let dot = |mesh: &mut Mesh, position: Pos2| {
        let position = pos2(position.x.floor() + 0.5, position.y.floor() + 0.5);
        mesh.add_colored_rect(Rect::from_center_size(position, Vec2::splat(1.0)), colour);
    };
    for (latitude, y) in parallels(projection) {
        if latitude == 0 {
            let top = y.floor();
            let line = Rect::from_x_y_ranges(world.x_range(), top..=top + 1.0);
            mesh.add_colored_rect(line, colour);
            continue;
        }
        for index in 0..(world.width() / DOTS) as u16 {
            dot(&mut mesh, pos2(world.left() + f32::from(index) * DOTS, y));
        }
    }
    for (_, x) in meridians(projection) {
        for index in 0..(world.height() / DOTS) as u16 {
            dot(&mut mesh, pos2(x, world.top() + f32::from(index) * DOTS));
        }
    }
    mesh
}

/// Paints the numbers at the left and the lower edge, except those below a mark. Returns their
/// boxes.
pub(super) fn numbers(
    painter: &Painter,
    projection: Projection,
    marks: &[Rect],
    t: &Tokens,
) -> Vec<Rect> {
    let world = projection.world;
    let mut boxes = Vec::new();
    let mut number = |position: Pos2, anchor: Align2, words: String| {
        let galley = painter.layout_no_wrap(words, text::caption(), t.t3);
        let place = anchor.anchor_size(position, galley.size());
        let ground = place.expand2(vec2(3.0, 0.0));
        if world.contains_rect(ground) && !marks.iter().any(|mark| mark.intersects(ground)) {
            painter.rect_filled(ground, 0.0, t.sky);
            painter.galley(place.min, galley, t.t3);
            boxes.push(ground);
        }
    };
    for (latitude, y) in parallels(projection).filter(|(latitude, _)| *latitude != 0) {
        let words = format::latitude(f64::from(latitude), 0);
        number(pos2(world.left() + 8.0, y), Align2::LEFT_CENTER, words);
    }
    let step = step(&projection);
    for (longitude, x) in meridians(projection).filter(|(longitude, _)| longitude / step % 2 == 0) {
        let words = match (longitude + 180).rem_euclid(360) - 180 {
            0 => "0°".to_owned(),
            -180 => "180°".to_owned(),
            longitude => format::longitude(f64::from(longitude), 0),
        };
        number(pos2(x, world.bottom() - 2.0), Align2::CENTER_BOTTOM, words);
    }
    boxes
}
