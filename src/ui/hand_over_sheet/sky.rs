//! A track over the sky in a thumbnail: north up, east right, rings at 0, 30 and 60 degrees.

use super::svg::Svg;
use crate::astro::AzEl;

/// What a thumbnail shows.
pub(super) struct Track {
    pub(super) whole: Vec<AzEl>,
    /// The part that the antenna takes.
    pub(super) taken: Vec<AzEl>,
}

/// Draws a track in a circle.
pub(super) fn draw(svg: &mut Svg, [x, y]: [f64; 2], radius: f64, track: &Track) {
    svg.ring([x, y], radius, 0.5);
    svg.ring([x, y], radius * 2.0 / 3.0, 0.25);
    svg.ring([x, y], radius / 3.0, 0.25);
    svg.line([x, y - radius], [x, y - radius * 0.78], 0.8);
    let on_paper = |at: &AzEl| {
        let from_zenith = (90.0 - at.elevation_deg()).clamp(0.0, 90.0) / 90.0 * radius;
        let (sin, cos) = at.azimuth.radians().sin_cos();
        [x + from_zenith * sin, y - from_zenith * cos]
    };
    let points = |track: &[AzEl]| track.iter().map(on_paper).collect::<Vec<_>>();
    let (whole, taken) = (points(&track.whole), points(&track.taken));
    svg.path(&whole, 0.4);
    svg.path(&taken, 1.1);
    if let Some(start) = whole.first().or(taken.first()) {
        svg.dot(*start, 1.4);
    }
}
