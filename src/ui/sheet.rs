//! Pages of A4 to print, in black on white: what all of them share.

pub(super) mod sky;
pub(super) mod svg;
#[cfg(test)]
pub(super) mod tests;

use super::format;
use crate::astro::Site;
use svg::{Anchor, Face, HEIGHT, Svg, WIDTH};

pub(super) const MARGIN: f64 = 28.0;
pub(super) const LEFT: f64 = MARGIN;
pub(super) const RIGHT: f64 = WIDTH - MARGIN;
pub(super) const BOTTOM: f64 = HEIGHT - MARGIN;
/// Height of the head of a section.
pub(super) const SECTION_HEAD: f64 = 14.0;

pub(super) const BODY: Face = Face::of(7.0);
/// The smallest text.
pub(super) const SMALL: Face = Face::of(6.5);
pub(super) const CAPTION: Face = SMALL.quiet();

/// Head of a section: its name over a line, and what is to be said of it. Returns where the
/// section goes on.
pub(super) fn section(svg: &mut Svg, y: f64, name: &str, said: &str) -> f64 {
    const NAME: f64 = 110.0;
    svg.text([LEFT, y + 8.0], NAME, Face::of(8.5).bold(), name);
    let right = CAPTION.anchored(Anchor::End);
    svg.text([RIGHT, y + 8.0], RIGHT - LEFT - NAME, right, said);
    svg.line([LEFT, y + 10.5], [RIGHT, y + 10.5], 0.8);
    y + SECTION_HEAD
}

/// Latitude, longitude and altitude of a site.
pub(super) fn place(site: Site) -> String {
    format!(
        "{}, {}, {} m",
        format::latitude(site.latitude().degrees(), 3),
        format::longitude(site.longitude().degrees(), 3),
        format::number(site.altitude_m(), 0)
    )
}
