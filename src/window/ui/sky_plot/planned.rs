//! Planned pointing of the antennas in the sky of another time. Their live marks keep their place
//! and are labelled "now".

use egui::{Id, Painter, Pos2, Ui};

use super::{
    geometry::{Dome, outward},
    labels::{Key, Label, Labels},
    marks,
    nodes::{name_mark, spoken},
    placement::Side,
    scene::{PlannedAntenna, SkyScene},
};
use crate::{
    astro::Angle,
    ui::{format, text, tokens::Tokens, widgets::paint},
};

/// Half the box of a mark, points.
const HALF: f32 = 13.0;

impl PlannedAntenna<'_> {
    /// Returns the place of the planned mark; at the rim for an antenna without elevation.
    fn mark(&self, dome: Dome) -> Option<Pos2> {
        if let Some(direction) = self.pointing.direction() {
            return dome.visible(direction);
        }
        let azimuth = self.pointing.azimuth.filter(|azimuth| azimuth.is_finite())?;
        Some(dome.centre + outward(azimuth.radians() as f32) * (dome.radius - HALF))
    }
}

fn marks<'a>(
    dome: Dome,
    scene: &SkyScene<'a>,
) -> impl Iterator<Item = (&'a PlannedAntenna<'a>, Pos2)> {
    let antennas = scene.later.map(|later| later.antennas).unwrap_or_default();
    antennas.iter().filter_map(move |antenna| Some((antenna, antenna.mark(dome)?)))
}

/// Keeps labels away from the planned marks.
pub(super) fn reserve(labels: &mut Labels<'_>, dome: Dome, scene: &SkyScene<'_>) {
    for (_, mark) in marks(dome, scene) {
        labels.reserve(paint::square(mark, 2.0 * HALF));
    }
}

/// Labels the planned marks, and the live mark of the selected antenna.
pub(super) fn label(labels: &mut Labels<'_>, dome: Dome, scene: &SkyScene<'_>, t: &Tokens) {
    let Some(later) = scene.later else { return };
    let live = scene.measured.and_then(|measured| dome.visible(measured.direction));
    if let Some((name, mark)) = later.selected.zip(live) {
        let name = format!("{name} now");
        labels.add(&Label {
            key: Key::LiveAntenna,
            lines: &[(&name, text::small_strong(), t.ant)],
            mark,
            clearance: 28.0,
            order: &Side::ORDER,
            tolerance: 1.0,
        });
    }
    for (planned, mark) in marks(dome, scene) {
        let name = format!("{} planned", planned.name);
        labels.add(&Label {
            key: Key::Planned(planned.index),
            lines: &[(&name, text::small_strong(), t.sat), (&planned.doing, text::caption(), t.t2)],
            mark,
            clearance: HALF + 2.0,
            // A label has room inside of the disc.
            order: &Side::by_nearness(dome.centre - mark),
            tolerance: 1.0,
        });
    }
}

/// Paints the planned marks.
pub(super) fn paint(painter: &Painter, dome: Dome, scene: &SkyScene<'_>, t: &Tokens) {
    for (_, position) in marks(dome, scene) {
        marks::planned(painter, position, HALF - 2.0, t);
    }
}

/// Adds a node for each mark.
pub(super) fn nodes(ui: &Ui, canvas: Id, dome: Dome, scene: &SkyScene<'_>) {
    for (antenna, position) in marks(dome, scene) {
        let name = format!("{} planned, {}", antenna.name, antenna.doing);
        let text = if let Some(direction) = antenna.pointing.direction() {
            spoken(&name, direction)
        } else {
            let azimuth_deg = antenna.pointing.azimuth.map_or(f64::NAN, Angle::degrees);
            format!("{name}, azimuth {}", format::azimuth(azimuth_deg))
        };
        name_mark(ui, canvas.with(("planned", antenna.index)), position, &text);
    }
}
