//! Marks of the commanded and the measured direction.

use egui::{Align2, Painter, Pos2, Rect, Shape, Stroke, Vec2, vec2};

use super::{
    geometry::{Dome, sharp},
    labels::Labels,
    marks,
    placement::Side,
    scene::SkyScene,
};
use crate::ui::{text, tokens::Tokens, widgets::paint};

/// Min diameter of the ring around a satellite, points.
const SMALLEST_RING: f32 = 22.0;
/// Side of the box of the cross-hair that labels keep clear, points.
const CROSS_HAIR: f32 = 56.0;
/// Distance of the notes on a lost link from the centre, points.
const NOTE: f32 = 14.0;

/// Returns the diameter of the commanded ring, points: the beam width, but always large enough to
/// see.
fn ring(dome: Dome, scene: &SkyScene<'_>) -> f32 {
    // A NaN beam width gives the smallest ring.
    dome.length(scene.beam_width).max(SMALLEST_RING)
}

/// Returns the circles that the marks of the antenna occupy: centre and radius.
fn circles(dome: Dome, scene: &SkyScene<'_>) -> impl Iterator<Item = (Pos2, f32)> {
    let ring = ring(dome, scene) / 2.0;
    let measured = scene.measured.map(|measured| (measured.direction, CROSS_HAIR / 2.0));
    let commanded = scene.commanded.map(|commanded| (commanded, ring));
    let ghost = scene.ghost.map(|ghost| (ghost.end, ring));
    let all = [measured, commanded, ghost].into_iter().flatten();
    all.filter_map(move |(direction, radius)| Some((dome.point(direction)?, radius)))
}

/// Keeps labels away from the cross-hair and the rings.
pub(super) fn reserve(dome: Dome, scene: &SkyScene<'_>, labels: &mut Labels<'_>) {
    for (position, radius) in circles(dome, scene) {
        labels.reserve(paint::square(position, 2.0 * radius));
    }
    if let Some(measured) = scene.measured.filter(|measured| measured.lost.is_some())
        && let Some(position) = dome.point(measured.direction)
    {
        labels.reserve(Rect::from_min_size(
            position + vec2(NOTE, -2.0 * NOTE),
            vec2(44.0, 4.0 * NOTE),
        ));
    }
}

/// Returns the distance of a label from its mark, points. The label clears a circle of the antenna
/// that contains `mark`; otherwise the distance is `default`.
pub(super) fn clearance(dome: Dome, scene: &SkyScene<'_>, mark: Pos2, default: f32) -> f32 {
    circles(dome, scene)
        .map(|(position, radius)| (position.distance(mark), radius))
        .filter(|(distance, radius)| distance < radius)
        .map(|(distance, radius)| distance + radius + 1.0)
        .fold(default, f32::max)
}

/// Returns the sides of a label at `mark`, and its distance. The label clears the circles of the
/// antenna on the side away from the antenna, close to its mark.
pub(super) fn beam_label_place(
    dome: Dome,
    scene: &SkyScene<'_>,
    mark: Pos2,
    default: f32,
) -> ([Side; 8], f32) {
    let (outward, clearance) = circles(dome, scene)
        .map(|(position, radius)| (mark - position, radius + 1.0 - position.distance(mark)))
        .fold((Vec2::ZERO, default), |max, next| if next.1 > max.1 { next } else { max });
    (Side::by_nearness(outward), clearance)
}

/// Paints the preview, the commanded ring and the cross-hair, in this order.
pub(super) fn paint(painter: &Painter, dome: Dome, scene: &SkyScene<'_>, t: &Tokens) {
    let ring = ring(dome, scene);
    if let Some(ghost) = scene.ghost
        && let Some(end) = dome.point(ghost.end)
    {
        let way = ghost.way.iter().filter_map(|direction| dome.point(*direction)).collect();
        painter.add(Shape::line(way, Stroke::new(1.0, t.cmd)));
        marks::ghost(painter, end, ring, ghost.is_refused, t);
    }
    if let Some(position) = scene.commanded.and_then(|commanded| dome.point(commanded)) {
        marks::commanded(painter, position, ring, t);
    }
    let Some(measured) = scene.measured else { return };
    let Some(position) = dome.point(measured.direction) else { return };
    match measured.lost {
        None => marks::measured(painter, sharp(position), 1.0, t),
        Some(age) => {
            marks::lost(painter, position, 1.0, t);
            let note = |start: Vec2, anchor: Align2, words: &str| {
                let galley = painter.layout_no_wrap(words.to_owned(), text::small_strong(), t.t3);
                let place = anchor.anchor_size(position + start, galley.size());
                painter.rect_filled(place.expand(1.0), 0.0, t.sky);
                painter.galley(place.min, galley, t.t3);
            };
            note(vec2(NOTE, -NOTE), Align2::LEFT_BOTTOM, "?");
            note(vec2(NOTE, NOTE), Align2::LEFT_TOP, age);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        astro::{Angle, AzEl},
        ui::sky_plot::testing,
    };

    #[test]
    fn a_label_clears_a_ring_around_its_mark() {
        let dome = Dome { centre: Pos2::ZERO, radius: 270.0 };
        let target = AzEl::from_degrees(120.0, 40.0);
        let mark = dome.point(target).unwrap();
        let far = mark + vec2(60.0, 0.0);
        let scene = |beam_deg| SkyScene {
            commanded: Some(target),
            beam_width: Angle::from_degrees(beam_deg),
            ..testing::empty()
        };
        assert!((clearance(dome, &scene(0.88), mark, 8.0) - 12.0).abs() < 1e-3);
        // A beam of 20 degrees has 60 points.
        assert!((clearance(dome, &scene(20.0), mark, 8.0) - 31.0).abs() < 1e-3);
        assert!((clearance(dome, &scene(20.0), far, 8.0) - 8.0).abs() < 1e-3);
        assert!((clearance(dome, &scene(f64::NAN), mark, 8.0) - 12.0).abs() < 1e-3);
    }
}
