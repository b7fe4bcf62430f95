//! The shapes of the marks in the sky. Each meaning has its own shape.

use egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, Vec2, vec2};

use super::geometry::{circle, dashed};
use crate::ui::tokens::Tokens;

/// Width of the outline that separates a mark from lines below it, points.
const OUTLINE: f32 = 1.25;
/// Half the size of an event mark, points.
const EVENT: f32 = 6.5;
/// Distance from the centre of the cross-hair to the begin and end of its arms, points.
const ARM: (f32, f32) = (11.0, 26.0);

/// The shape of an event of a pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::ui) enum EventForm {
    /// A triangle that points up, for AOS.
    Up,
    /// A diamond, for TCA.
    Diamond,
    /// A triangle that points down, for LOS.
    Down,
}

/// Paints AOS, TCA or LOS.
pub(in crate::ui) fn event(
    painter: &Painter,
    position: Pos2,
    form: EventForm,
    colour: Color32,
    ground: Color32,
) {
    let corners = match form {
        EventForm::Up => vec![vec2(0.0, -EVENT), vec2(EVENT, EVENT), vec2(-EVENT, EVENT)],
        EventForm::Down => vec![vec2(0.0, EVENT), vec2(-EVENT, -EVENT), vec2(EVENT, -EVENT)],
        EventForm::Diamond => {
            vec![vec2(0.0, -EVENT), vec2(EVENT, 0.0), vec2(0.0, EVENT), vec2(-EVENT, 0.0)]
        }
    };
    let corners = corners.into_iter().map(|corner| position + corner).collect();
    painter.add(Shape::convex_polygon(corners, ground, Stroke::new(2.0, colour)));
}

/// Paints the Sun: a circle with eight rays.
pub(in crate::ui) fn sun(painter: &Painter, position: Pos2, t: &Tokens) {
    let stroke = Stroke::new(1.5, t.sun);
    painter.circle(position, 5.0, t.sky, stroke);
    for eighth in 0..8_u8 {
        let ray = Vec2::angled(f32::from(eighth) * std::f32::consts::FRAC_PI_4);
        painter.line_segment([position + ray * 7.5, position + ray * 10.5], stroke);
    }
}

/// Paints the Moon: a crescent, open to the right.
pub(in crate::ui) fn moon(painter: &Painter, position: Pos2, t: &Tokens) {
    const RADIUS: f32 = 7.0;
    // Both arcs meet in the two horns. The inner arc has its centre further to the side.
    let horn: f32 = 50.0_f32.to_radians();
    let inner_middle = position + vec2(RADIUS * 0.72, 0.0);
    let (up, side) = (RADIUS * horn.sin(), RADIUS * horn.cos() - RADIUS * 0.72);
    let inner_radius = up.hypot(side);
    let inner_from = up.atan2(side);
    let arc = |middle: Pos2, radius: f32, start: f32, end: f32| {
        (0..=16_u8).map(move |step| {
            let turn = start + (end - start) * f32::from(step) / 16.0;
            middle + Vec2::angled(turn) * radius
        })
    };
    let full = std::f32::consts::TAU;
    let mut outline: Vec<Pos2> = arc(position, RADIUS, horn, full - horn).collect();
    outline.extend(arc(inner_middle, inner_radius, full - inner_from, inner_from));
    painter.add(Shape::closed_line(outline, Stroke::new(1.5, t.moon)));
}

/// Paints an unselected satellite: a circle, or a square if it is geostationary.
pub(in crate::ui) fn other(painter: &Painter, position: Pos2, geostationary: bool, t: &Tokens) {
    if geostationary {
        painter.rect_filled(Rect::from_center_size(position, Vec2::splat(7.0)), 0.0, t.other);
    } else {
        painter.circle_filled(position, 4.0, t.other);
    }
}

/// Paints the selected satellite.
pub(in crate::ui) fn selected(painter: &Painter, position: Pos2, t: &Tokens) {
    painter.circle(position, 5.0, t.sat, Stroke::new(OUTLINE, t.sky));
}

/// Paints the commanded direction: a ring with the diameter of the beam.
pub(in crate::ui) fn commanded(painter: &Painter, position: Pos2, diameter: f32, t: &Tokens) {
    painter.circle_stroke(position, diameter / 2.0, Stroke::new(2.25 + 2.0 * OUTLINE, t.sky));
    painter.circle_stroke(position, diameter / 2.0, Stroke::new(2.25, t.cmd));
}

/// Paints the preview of a commanded direction, crossed out if Azel would refuse it.
pub(in crate::ui) fn ghost(
    painter: &Painter,
    position: Pos2,
    diameter: f32,
    is_refused: bool,
    t: &Tokens,
) {
    let ring = circle(position, diameter / 2.0);
    let colour = if is_refused { t.warn } else { t.cmd };
    painter.extend(dashed(&ring, 4.0, 3.0, Stroke::new(2.25, colour)));
    if is_refused {
        let arm = Vec2::splat(diameter / 2.0) * std::f32::consts::FRAC_1_SQRT_2;
        for arm in [arm, arm.rot90()] {
            painter.line_segment([position - arm, position + arm], Stroke::new(2.25, colour));
        }
    }
}

/// Paints the planned pointing of an antenna: the four corners of a square with sides of twice
/// `half`.
pub(in crate::ui) fn planned(painter: &Painter, position: Pos2, half: f32, t: &Tokens) {
    let leg = half * 0.6;
    for stroke in [Stroke::new(2.0 + 2.0 * OUTLINE, t.sky), Stroke::new(2.0, t.sat)] {
        for (x, y) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
            let corner = position + vec2(x, y) * half;
            let ends = [corner - vec2(x * leg, 0.0), corner, corner - vec2(0.0, y * leg)];
            painter.add(Shape::line(ends.into(), stroke));
        }
    }
}

/// Paints the measured direction as a cross-hair; a `scale` of 1 is its size in the plot.
pub(in crate::ui) fn measured(painter: &Painter, position: Pos2, scale: f32, t: &Tokens) {
    for stroke in [Stroke::new(2.0 + 2.0 * OUTLINE, t.sky), Stroke::new(2.0, t.ant)] {
        // The outline also surrounds the ends of the arms.
        let more = (stroke.width - 2.0) / 2.0;
        for arm in arms() {
            let ends =
                [position + arm * (ARM.0 * scale - more), position + arm * (ARM.1 * scale + more)];
            painter.line_segment(ends, stroke);
        }
    }
}

/// Paints the last known direction of an antenna with a lost link.
pub(in crate::ui) fn lost(painter: &Painter, position: Pos2, scale: f32, t: &Tokens) {
    for arm in arms() {
        let line = [position + arm * (ARM.0 * scale), position + arm * (ARM.1 * scale)];
        painter.line_segment(line, Stroke::new(2.0 + 2.0 * OUTLINE, t.sky));
        painter.extend(dashed(&line, 3.0, 3.0, Stroke::new(2.0, t.t3)));
    }
}

fn arms() -> [Vec2; 4] {
    [vec2(1.0, 0.0), vec2(-1.0, 0.0), vec2(0.0, 1.0), vec2(0.0, -1.0)]
}
