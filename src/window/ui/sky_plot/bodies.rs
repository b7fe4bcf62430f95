//! The Sun, the Moon and the satellites that are not selected.

use egui::{Painter, Pos2, Stroke};

use super::{
    antenna,
    geometry::{Dome, dashed},
    labels::{Key, Label, Labels},
    marks,
    placement::Side,
    scene::{OtherSatellite, SkyScene},
};
use crate::{
    astro::AzEl,
    ui::{format, text, tokens::Tokens, widgets::paint},
};

/// Elevation below which unselected satellites have no name, degrees.
const LOWEST_NAME_DEG: f64 = 5.0;
/// Distance from the beam below which the label of the Sun shows the distance, degrees.
const NEAR_BEAM_DEG: f64 = 5.0;

/// Paints the Sun and the Moon and keeps labels away from them.
pub(super) fn sun_and_moon(
    painter: &Painter,
    dome: Dome,
    scene: &SkyScene<'_>,
    labels: &mut Labels<'_>,
    t: &Tokens,
) {
    let mark = |body: Option<AzEl>| body.and_then(|direction| dome.visible(direction));
    if let Some(position) = mark(scene.sun) {
        marks::sun(painter, position, t);
        labels.reserve(paint::square(position, 22.0));
    }
    if let Some(position) = mark(scene.moon) {
        marks::moon(painter, position, t);
        labels.reserve(paint::square(position, 16.0));
    }
}

/// Labels the Sun and the Moon, near the beam with their distance from it.
pub(super) fn label_sun_and_moon(
    labels: &mut Labels<'_>,
    dome: Dome,
    scene: &SkyScene<'_>,
    t: &Tokens,
) {
    let live = scene.measured.filter(|measured| measured.lost.is_none());
    let beam = live.map(|measured| measured.direction).or(scene.commanded);
    // The current beam has no relation to the Sun of another time.
    let beam = beam.filter(|_| scene.later.is_none());
    let bodies =
        [(Key::Sun, "Sun", scene.sun, 13.0, t.sun), (Key::Moon, "Moon", scene.moon, 9.0, t.moon)];
    for (key, word, direction, clearance, colour) in bodies {
        let Some((direction, mark)) = direction.and_then(|d| Some((d, dome.visible(d)?))) else {
            continue;
        };
        let distance = beam.map(|beam| beam.separation(direction).degrees());
        let name = match distance.filter(|distance| *distance < NEAR_BEAM_DEG) {
            Some(distance) => format!("{word} {}", format::degrees(distance, 1)),
            None => word.to_owned(),
        };
        let (order, clearance) = antenna::beam_label_place(dome, scene, mark, clearance);
        labels.add(&Label {
            key,
            lines: &[(&name, text::small(), colour)],
            mark,
            clearance,
            order: &order,
            tolerance: 1.0,
        });
    }
}

/// An unselected satellite above the horizon, as the plot draws it.
pub(super) struct Dot<'a> {
    pub(super) satellite: &'a OtherSatellite<'a>,
    pub(super) position: Pos2,
    /// Path over the next minutes.
    ahead: Vec<Pos2>,
}

/// Returns the satellites that are not selected.
pub(super) fn dots<'a>(dome: Dome, others: &'a [OtherSatellite<'a>]) -> Vec<Dot<'a>> {
    let dots = others.iter().filter_map(|satellite| {
        let position = dome.visible(satellite.direction)?;
        Some(Dot { satellite, position, ahead: dome.path(satellite.ahead.iter().copied()) })
    });
    dots.collect()
}

/// Paints the paths of the other satellites.
pub(super) fn paths(painter: &Painter, dots: &[Dot<'_>], t: &Tokens) {
    for Dot { ahead, .. } in dots.iter().filter(|dot| !dot.ahead.is_empty()) {
        painter.extend(dashed(ahead, 1.5, 4.0, Stroke::new(1.25, t.other)));
    }
}

/// Paints the other satellites, and keeps labels away from them and their paths.
pub(super) fn others(painter: &Painter, dots: &[Dot<'_>], labels: &mut Labels<'_>, t: &Tokens) {
    for Dot { satellite, position, ahead } in dots {
        labels.reserve_path(ahead, 3.0);
        marks::other(painter, *position, satellite.geostationary, t);
        labels.reserve(paint::square(*position, 8.0));
    }
}

/// Labels the other satellites as far as there is room.
pub(super) fn label_others(
    labels: &mut Labels<'_>,
    dome: Dome,
    scene: &SkyScene<'_>,
    dots: &[Dot<'_>],
    t: &Tokens,
) {
    for Dot { satellite, position, .. } in dots {
        if satellite.direction.elevation_deg() < LOWEST_NAME_DEG {
            continue;
        }
        labels.add(&Label {
            key: Key::Other(satellite.catalog_number),
            lines: &[(satellite.name, text::small(), t.t2)],
            mark: *position,
            clearance: antenna::clearance(dome, scene, *position, 6.0),
            order: &Side::ORDER,
            tolerance: 0.4,
        });
    }
}
