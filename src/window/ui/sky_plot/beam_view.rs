//! A magnified view of the sky around the satellite, for judging the beam.

use egui::{Align2, Painter, Pos2, Rect, Stroke, Vec2, pos2, vec2};

use super::{geometry::sharp, marks, scene::SkyScene};
use crate::{
    astro::AzEl,
    ui::{format, text, tokens::Tokens},
};

/// Diameter of the view, points.
const DIAMETER: f32 = 104.0;
/// Distance from the edges of the plot, points.
const EDGE: f32 = 14.0;
/// Height of the caption, points.
const CAPTION: f32 = 20.0;
/// Room that the caption needs next to the view, points.
const CAPTION_BESIDE: f32 = 24.0;

/// Returns the square of the view in the lower right corner of the plot.
pub(super) fn place(rect: Rect) -> Rect {
    let corner = rect.right_bottom() - vec2(EDGE, EDGE + CAPTION);
    Rect::from_min_size(corner - Vec2::splat(DIAMETER), Vec2::splat(DIAMETER))
}

/// Returns the view with its caption, which labels avoid.
pub(super) fn reserved(rect: Rect) -> Rect {
    let view = place(rect).expand(4.0);
    // The caption is wider than the view.
    Rect::from_min_max(view.min - vec2(CAPTION_BESIDE, 0.0), rect.right_bottom())
}

/// Returns half the width of the view, degrees: 1, or one and a half beam widths for a beam wider
/// than 1°.
pub(super) fn half_view_deg(beam_width_deg: f64) -> f64 {
    if beam_width_deg.is_finite() && beam_width_deg > 1.0 { 1.5 * beam_width_deg } else { 1.0 }
}

/// Returns measured minus predicted in degrees: across (azimuth times the cosine of the elevation)
/// and in elevation.
pub(super) fn error_deg(measured: AzEl, predicted: AzEl) -> (f64, f64) {
    let across = (measured.azimuth - predicted.azimuth).wrapped_180().degrees()
        * predicted.elevation.radians().cos();
    (across, measured.elevation_deg() - predicted.elevation_deg())
}

/// Paints the view around the predicted direction, if there is one.
pub(super) fn paint(painter: &Painter, rect: Rect, scene: &SkyScene<'_>, t: &Tokens) {
    let Some(predicted) = scene.predicted.filter(is_finite) else { return };
    let view = place(rect);
    let radius = view.width() / 2.0;
    let centre = sharp(view.center());
    let beam_deg = scene.beam_width.degrees();
    let half = half_view_deg(beam_deg);
    let scale = radius / half as f32;
    painter.circle(centre, radius, t.sky, Stroke::new(1.5, t.edge));
    for arm in [vec2(radius, 0.0), vec2(0.0, radius)] {
        painter.line_segment([centre - arm, centre + arm], Stroke::new(1.0, t.grid));
    }

    // Elevation increases upwards. Points outside the view move to its edge.
    let point = |across: f32, up: f32| -> Option<Pos2> {
        let offset = vec2(across, -up) * scale;
        let shown = if offset.length() > radius { offset.normalized() * radius } else { offset };
        (!shown.any_nan()).then(|| centre + shown)
    };
    for (across, up) in scene.recent_errors {
        if let Some(position) = point(*across, *up) {
            painter.circle_filled(position, 1.0, t.t3);
        }
    }
    if beam_deg.is_finite() && beam_deg > 0.0 {
        let ring = beam_deg as f32 / 2.0 * scale;
        let colour = if scene.commanded.is_some() { t.cmd } else { t.edge };
        painter.circle_stroke(centre, ring, Stroke::new(2.25, colour));
    }
    marks::selected(painter, centre, t);
    if let Some(measured) = scene.measured.filter(|m| m.lost.is_none() && is_finite(&m.direction)) {
        let (across, up) = error_deg(measured.direction, predicted);
        if let Some(position) = point(across as f32, up as f32) {
            marks::measured(&painter.with_clip_rect(view.expand(EDGE)), position, 0.75, t);
        }
    }
    let caption = format!(
        "Beam {}, view ±{}°",
        format::degrees(beam_deg, 2),
        format::number(half, decimals(half))
    );
    let position = pos2(rect.right() - EDGE, rect.bottom() - EDGE);
    painter.text(position, Align2::RIGHT_BOTTOM, caption, text::caption(), t.t2);
}

fn is_finite(direction: &AzEl) -> bool {
    direction.azimuth.is_finite() && direction.elevation.is_finite()
}

fn decimals(value: f64) -> usize {
    usize::from((value - value.round()).abs() > 0.05)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_is_measured_across_the_sky() {
        let (across, up) =
            error_deg(AzEl::from_degrees(0.2, 60.1), AzEl::from_degrees(359.8, 60.0));
        assert!((across - 0.2).abs() < 1e-9 && (up - 0.1).abs() < 1e-9);
        let (across, _) = error_deg(AzEl::from_degrees(359.8, 60.0), AzEl::from_degrees(0.2, 60.0));
        assert!((across + 0.2).abs() < 1e-9);
    }

    #[test]
    fn a_wide_beam_fits_into_the_view() {
        for beam in [0.2, 0.88, 3.0, 21.0] {
            assert!(half_view_deg(beam) > beam / 2.0);
        }
        assert!((half_view_deg(0.5) - 1.0).abs() < 1e-9);
        assert!((half_view_deg(f64::NAN) - 1.0).abs() < 1e-9);
    }
}
