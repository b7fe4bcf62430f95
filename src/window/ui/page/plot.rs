//! Shapes of a plot in SVG. The style sheet sets their appearance by class.

use maud::{Markup, html};

use crate::astro::AzEl;

/// Returns a line through these points, or nothing for fewer than two points.
pub(in crate::ui) fn line(class: &str, points: &[[f64; 2]]) -> Markup {
    let texts: Vec<String> =
        points.iter().map(|[x, y]| format!("{},{}", number(*x), number(*y))).collect();
    html! {
        @if points.len() > 1 { polyline class=(class) points=(texts.join(" ")) {} }
    }
}

/// Returns a box with its upper left corner at `place`.
pub(in crate::ui) fn filled(class: &str, place: [f64; 2], size: [f64; 2]) -> Markup {
    let ([x, y], [width, height]) = (place.map(number), size.map(number));
    html! { rect class=(class) x=(x) y=(y) width=(width) height=(height) {} }
}

pub(in crate::ui) fn ring(class: &str, centre: [f64; 2], radius: f64) -> Markup {
    let ([x, y], radius) = (centre.map(number), number(radius));
    html! { circle class=(class) cx=(x) cy=(y) r=(radius) {} }
}

/// Returns words on the base line `y`.
pub(in crate::ui) fn text(class: &str, place: [f64; 2], words: &str) -> Markup {
    let [x, y] = place.map(number);
    html! { text class=(class) x=(x) y=(y) { (words) } }
}

/// Formats a number with at most two decimals.
pub(in crate::ui) fn number(value: f64) -> String {
    let rounded = (value * 100.0).round() / 100.0;
    // Adding zero makes a negative zero positive.
    (rounded + 0.0).to_string()
}

/// The sky in a circle: north up, east right, rings at 0, 30 and 60 degrees.
#[derive(Debug, Clone, Copy)]
pub(in crate::ui) struct Sky {
    pub(in crate::ui) centre: [f64; 2],
    pub(in crate::ui) radius: f64,
}

impl Sky {
    /// Returns the position of a direction; directions below the horizon lie on the horizon.
    pub(in crate::ui) fn point(self, direction: AzEl) -> [f64; 2] {
        let [x, y] = self.centre;
        let from_zenith = (90.0 - direction.elevation_deg()).clamp(0.0, 90.0) / 90.0 * self.radius;
        let (sin, cos) = direction.azimuth.radians().sin_cos();
        [x + from_zenith * sin, y - from_zenith * cos]
    }

    /// Returns the rings and the mark of north.
    pub(in crate::ui) fn rings(self) -> Markup {
        let Self { centre, radius } = self;
        let [x, y] = centre;
        html! {
            (ring("quiet thin", centre, radius))
            (ring("quiet hair", centre, radius * 2.0 / 3.0))
            (ring("quiet hair", centre, radius / 3.0))
            (line("thin", &[[x, y - radius], [x, y - radius * 0.78]]))
        }
    }
}

/// Returns a small sky with the track of a pass, and the part that the antenna takes.
pub(in crate::ui) fn thumbnail(whole: &[AzEl], part: &[AzEl]) -> Markup {
    const RADIUS: f64 = 10.0;
    let sky = Sky { centre: [0.0, 0.0], radius: RADIUS };
    let points =
        |track: &[AzEl]| track.iter().map(|direction| sky.point(*direction)).collect::<Vec<_>>();
    let (whole, part) = (points(whole), points(part));
    html! {
        svg.sky viewBox="-11 -11 22 22" {
            (sky.rings())
            (line("thin", &whole))
            (line("thick", &part))
            @if let Some(start) = whole.first().or(part.first()) {
                (ring("filled", *start, 1.6))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_no_noise() {
        assert_eq!([-0.001, 12.345, 3.0].map(number), ["0", "12.35", "3"]);
    }

    #[test]
    fn one_point_makes_no_line() {
        assert_eq!(line("thin", &[[1.0, 2.0]]).into_string(), "");
        let two = line("thin", &[[1.0, 2.0], [3.0, 4.5]]).into_string();
        assert_eq!(two, r#"<polyline class="thin" points="1,2 3,4.5"></polyline>"#);
    }
}
