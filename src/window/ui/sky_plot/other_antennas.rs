//! The marks of unselected antennas, and the ends of azimuth axes.

use egui::{Id, Painter, Pos2, Rect, Role, Sense, Stroke, Ui, Vec2, WidgetInfo};

use super::{
    bearing,
    geometry::{Dome, outward},
    labels::{Key, Label, Labels},
    marks,
    nodes::{name_mark, spoken, tip},
    placement::Side,
    scene::{AzimuthStop, OtherAntenna, SkyScene},
};
use crate::ui::{format, text, tokens::Tokens, widgets::paint};

/// Size of the mark of an unselected antenna, as a share of the selected one.
const SCALE: f32 = 0.5;
/// Half the side of the box of an unselected cross-hair, points.
const HALF: f32 = 14.0;
/// Diameter of the commanded ring of an unselected antenna, points.
const RING: f32 = 13.0;
/// Length of an azimuth stop inside of the rim, points. The stop ends on the rim, clear of the
/// names outside.
const STOP: f32 = 22.0;
/// Distance between the rim and the name of a stop, points.
const BESIDE_RIM: f32 = 6.0;
/// Half the length of the bar at the outer end of a stop, points.
const BAR: f32 = 7.0;

impl OtherAntenna<'_> {
    /// Returns the place of the mark of the antenna.
    fn mark(&self, dome: Dome) -> Option<Pos2> {
        let measured = self.measured.and_then(|measured| dome.visible(measured.direction));
        measured.or_else(|| bearing::mark(dome, self.bearing.as_ref()?))
    }

    fn lost(&self) -> Option<&str> {
        self.measured.and_then(|measured| measured.lost).or(self.bearing?.lost)
    }
}

/// Keeps labels away from the marks of the antennas.
pub(super) fn reserve(labels: &mut Labels<'_>, dome: Dome, scene: &SkyScene<'_>) {
    for mark in scene.antennas.iter().filter_map(|antenna| antenna.mark(dome)) {
        labels.reserve(paint::square(mark, 2.0 * HALF));
    }
}

/// Adds the names of the antennas.
pub(super) fn label(labels: &mut Labels<'_>, dome: Dome, scene: &SkyScene<'_>, t: &Tokens) {
    for antenna in scene.antennas {
        let Some(mark) = antenna.mark(dome) else { continue };
        let lost = antenna.lost().map_or_else(String::new, |age| format!(" ? {age}"));
        let place = antenna.bearing.as_ref().and_then(bearing::place).unwrap_or_default();
        let now = if scene.later.is_some() { " now" } else { "" };
        let name = format!("{}{now} {place}{lost}", antenna.name);
        let colour = if lost.is_empty() { t.t1 } else { t.t3 };
        labels.add(&Label {
            key: Key::Antenna(antenna.index),
            lines: &[(name.trim_end(), text::small(), colour)],
            mark,
            clearance: HALF,
            order: &Side::ORDER,
            tolerance: 0.6,
        });
    }
}

/// Labels the ends of azimuth axes outside of the rim.
pub(super) fn label_stops(labels: &mut Labels<'_>, dome: Dome, scene: &SkyScene<'_>, t: &Tokens) {
    for (index, stop) in scene.stops.iter().enumerate() {
        let Some([inner, end]) = ends(dome, stop) else { continue };
        labels.reserve(Rect::from_two_pos(inner, end).expand(BAR));
        let name = format!("{} stop", stop.names);
        let angle = format::azimuth(stop.azimuth.degrees());
        let words = format!("{name} {angle}");
        // Two lines do not fit above and below the disc.
        let is_beside = (end - dome.centre).x.abs() >= (end - dome.centre).y.abs();
        let two = [(&*name, text::small_strong(), t.bad), (&*angle, text::small(), t.bad)];
        let one = [(&*words, text::small_strong(), t.bad)];
        labels.add(&Label {
            key: Key::Stop(index),
            lines: if is_beside { &two } else { &one },
            mark: end + (end - inner).normalized() * BESIDE_RIM,
            clearance: 2.0 + BAR,
            order: &Side::by_nearness(end - dome.centre),
            tolerance: 0.6,
        });
    }
}

/// Returns both ends of the mark across the rim, the outer end last.
fn ends(dome: Dome, stop: &AzimuthStop<'_>) -> Option<[Pos2; 2]> {
    let direction = outward(stop.azimuth.radians() as f32);
    let rim = dome.centre + direction * dome.radius;
    stop.azimuth.is_finite().then(|| [rim - direction * STOP, rim])
}

/// Paints the ends of azimuth axes.
pub(super) fn paint_stops(painter: &Painter, dome: Dome, scene: &SkyScene<'_>, t: &Tokens) {
    for stop in scene.stops {
        let Some([inner, end]) = ends(dome, stop) else { continue };
        let stroke = Stroke::new(3.0, t.bad);
        let sideways = (end - inner).normalized().rot90() * BAR;
        painter.line_segment([inner, end], stroke);
        painter.line_segment([end - sideways, end + sideways], stroke);
    }
}

/// Paints the marks of the antennas.
pub(super) fn paint(painter: &Painter, dome: Dome, scene: &SkyScene<'_>, t: &Tokens) {
    for antenna in scene.antennas {
        if let Some(bearing) = &antenna.bearing {
            bearing::paint_one(painter, dome, bearing, 1.0, t);
        }
        if let Some(position) = antenna.commanded.and_then(|commanded| dome.visible(commanded)) {
            painter.circle_stroke(position, RING / 2.0, Stroke::new(1.25, t.cmd));
        }
        let Some(measured) = antenna.measured else { continue };
        let Some(position) = dome.visible(measured.direction) else { continue };
        match measured.lost {
            None => marks::measured(painter, position, SCALE, t),
            Some(_) => marks::lost(painter, position, SCALE, t),
        }
    }
}

/// Adds the nodes of the antennas. Returns the index of a clicked antenna.
pub(super) fn nodes(
    ui: &Ui,
    canvas: Id,
    rect: Rect,
    dome: Dome,
    scene: &SkyScene<'_>,
    t: &Tokens,
) -> Option<usize> {
    let mut clicked = None;
    let mut points: Vec<Pos2> = Vec::new();
    for antenna in scene.antennas {
        let Some(position) = antenna.mark(dome).filter(|position| rect.contains(*position)) else {
            continue;
        };
        let lost = antenna.lost().map(|age| format!(", no reply for {age}")).unwrap_or_default();
        let name = format!("Antenna {}{lost}", antenna.name);
        let (text, tip) = match (antenna.measured, &antenna.bearing) {
            (Some(measured), _) => {
                (spoken(&name, measured.direction), tip(&name, measured.direction))
            }
            (None, Some(bearing)) => {
                let Some(place) = bearing::place(bearing) else { continue };
                let azimuth = if bearing.limit.is_none() { "azimuth " } else { "" };
                let text = format!("{name}, {azimuth}{place}");
                (text.clone(), text)
            }
            (None, None) => continue,
        };
        let id = canvas.with(("antenna", antenna.index));
        // Two antennas that track the same pass overlap; a click selects the first.
        if points.iter().any(|other| other.distance(position) < 2.0 * HALF) {
            name_mark(ui, id, position, &text);
            continue;
        }
        points.push(position);
        let place = Rect::from_center_size(position, Vec2::splat(HALF));
        let response = ui.interact(place, id, Sense::click());
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &text));
        if response.has_focus() {
            ui.painter().circle_stroke(position, HALF, Stroke::new(2.0, t.sat));
        }
        if response.clicked() {
            clicked = Some(antenna.index);
        }
        response.on_hover_text(tip);
    }
    clicked
}
