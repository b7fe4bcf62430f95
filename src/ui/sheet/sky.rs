//! A track over the sky: north up, east right, rings at 0, 30 and 60 degrees.

use super::svg::Svg;
use crate::astro::AzEl;

/// Content of a thumbnail.
pub(in crate::ui) struct Track {
    pub(in crate::ui) whole: Vec<AzEl>,
    /// The part that the antenna takes.
    pub(in crate::ui) taken: Vec<AzEl>,
}

/// The sky in a circle.
#[derive(Debug, Clone, Copy)]
pub(in crate::ui) struct Sky {
    pub(in crate::ui) centre: [f64; 2],
    pub(in crate::ui) radius: f64,
}

impl Sky {
    /// The place of a direction; what lies below the horizon is drawn at it.
    pub(in crate::ui) fn at(self, direction: AzEl) -> [f64; 2] {
        let [x, y] = self.centre;
        let from_zenith = (90.0 - direction.elevation_deg()).clamp(0.0, 90.0) / 90.0 * self.radius;
        let (sin, cos) = direction.azimuth.radians().sin_cos();
        [x + from_zenith * sin, y - from_zenith * cos]
    }

    /// Draws the rings, and the mark of north.
    pub(in crate::ui) fn rings(self, svg: &mut Svg) {
        let Self { centre, radius } = self;
        let [x, y] = centre;
        svg.ring(centre, radius, 0.5);
        svg.ring(centre, radius * 2.0 / 3.0, 0.25);
        svg.ring(centre, radius / 3.0, 0.25);
        svg.line([x, y - radius], [x, y - radius * 0.78], 0.8);
    }
}

/// Draws a track in a circle.
pub(in crate::ui) fn draw(svg: &mut Svg, centre: [f64; 2], radius: f64, track: &Track) {
    let sky = Sky { centre, radius };
    sky.rings(svg);
    let points = |track: &[AzEl]| track.iter().map(|at| sky.at(*at)).collect::<Vec<_>>();
    let (whole, taken) = (points(&track.whole), points(&track.taken));
    svg.path(&whole, 0.4);
    svg.path(&taken, 1.1);
    if let Some(start) = whole.first().or(taken.first()) {
        svg.dot(*start, 1.4);
    }
}
