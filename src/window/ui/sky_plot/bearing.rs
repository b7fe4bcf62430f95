//! The mark of an antenna with unknown elevation, or at a limit of its azimuth. It is a line from
//! the zenith to the rim in place of a point.

use egui::{Align2, Painter, Pos2, Rect, Shape, Stroke, Vec2};

use super::{
    geometry::{Dome, dashed, outward},
    labels::{Key, Label, Labels},
    placement::Side,
    scene::{Bearing, SkyScene},
};
use crate::{
    astro::Angle,
    ui::{format, text, tokens::Tokens},
};

/// Side of the triangle at the rim, points.
const SIDE: f32 = 12.0;
/// Dash and gap of the line, points.
const DOTS: (f32, f32) = (2.0, 6.0);
const DASHES: (f32, f32) = (4.0, 3.0);

/// Returns the ends of the line, from the zenith to the rim; `None` if the azimuth is not finite.
fn ends(dome: Dome, azimuth: Angle) -> Option<[Pos2; 2]> {
    let direction = outward(azimuth.radians() as f32);
    azimuth.is_finite().then(|| [dome.centre, dome.centre + direction * dome.radius])
}

/// Returns the centre and the corners of the triangle at the rim, with its tip outwards.
fn triangle(dome: Dome, azimuth: Angle) -> Option<(Pos2, Vec<Pos2>)> {
    let [_, rim] = ends(dome, azimuth)?;
    let direction = outward(azimuth.radians() as f32);
    let sideways = direction.rot90() * (SIDE / 2.0);
    let base = rim - direction * SIDE;
    Some((rim - direction * (SIDE / 2.0), vec![rim, base + sideways, base - sideways]))
}

/// Returns the measured azimuth or the limit, such as "043°" or "at CCW limit".
pub(super) fn place(bearing: &Bearing<'_>) -> Option<String> {
    let azimuth = || bearing.measured.map(|azimuth| format::azimuth(azimuth.degrees()));
    bearing.limit.map(|limit| format!("at {limit}")).or_else(azimuth)
}

/// Returns the label, such as "Genius 043°" or "RC2000C at CCW limit".
pub(super) fn words(bearing: &Bearing<'_>) -> String {
    let lost = bearing.lost.map_or_else(String::new, |age| format!(" ? {age}"));
    format!("{} {}{lost}", bearing.name, place(bearing).unwrap_or_default())
}

/// Returns the centre of the mark of the measured azimuth.
pub(super) fn mark(dome: Dome, bearing: &Bearing<'_>) -> Option<Pos2> {
    triangle(dome, bearing.measured?).map(|(middle, _)| middle)
}

/// Keeps labels away from the mark and places its name.
pub(super) fn label(labels: &mut Labels<'_>, dome: Dome, scene: &SkyScene<'_>, t: &Tokens) {
    let Some(bearing) = &scene.bearing else { return };
    let (Some(azimuth), Some(mark)) = (bearing.measured, mark(dome, bearing)) else { return };
    labels.reserve(Rect::from_center_size(mark, Vec2::splat(SIDE + 4.0)));
    if let Some(ends) = ends(dome, azimuth) {
        labels.reserve_path(&ends, 4.0);
    }
    let now = if scene.later.is_some() { " now" } else { "" };
    let name = format!("{}{now}", words(bearing));
    let colour = if bearing.lost.is_some() { t.t3 } else { t.ant };
    labels.add(&Label {
        key: Key::Bearing,
        lines: &[(&name, text::small_strong(), colour)],
        mark,
        clearance: SIDE,
        order: &Side::ORDER,
        tolerance: 1.0,
    });
}

/// Paints the previewed, the commanded and the measured azimuth, in this order.
pub(super) fn paint(painter: &Painter, dome: Dome, scene: &SkyScene<'_>, t: &Tokens) {
    if let Some(bearing) = &scene.bearing {
        paint_one(painter, dome, bearing, 2.0, t);
    }
}

/// Paints the lines of one antenna; the line of the measured azimuth is `width` points wide.
pub(super) fn paint_one(
    painter: &Painter,
    dome: Dome,
    bearing: &Bearing<'_>,
    width: f32,
    t: &Tokens,
) {
    let line = |azimuth: Option<Angle>, dash: (f32, f32), stroke: Stroke| {
        if let Some(ends) = azimuth.and_then(|azimuth| ends(dome, azimuth)) {
            painter.extend(dashed(&ends, dash.0, dash.1, stroke));
        }
    };
    line(bearing.ghost, DASHES, Stroke::new(1.0, t.cmd));
    line(bearing.commanded, DASHES, Stroke::new(1.125 * width, t.cmd));
    let colour = if bearing.lost.is_some() { t.t3 } else { t.ant };
    line(bearing.measured, DOTS, Stroke::new(width, colour));
    let Some((middle, corners)) = bearing.measured.and_then(|azimuth| triangle(dome, azimuth))
    else {
        return;
    };
    painter.add(Shape::convex_polygon(corners, t.sky, Stroke::new(2.0, colour)));
    if bearing.lost.is_some() {
        painter.text(middle, Align2::CENTER_CENTER, "?", text::caption(), colour);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::pos2;

    #[test]
    fn the_line_leads_to_the_rim_and_the_triangle_ends_there() {
        let dome = Dome { centre: pos2(300.0, 300.0), radius: 200.0 };
        let east = Angle::from_degrees(90.0);
        let [start, end] = ends(dome, east).unwrap();
        assert_eq!(start, dome.centre);
        assert!(end.distance(pos2(500.0, 300.0)) < 1e-3, "{end}");
        let (middle, corners) = triangle(dome, east).unwrap();
        assert!(middle.distance(pos2(494.0, 300.0)) < 1e-3, "{middle}");
        assert!(corners.iter().all(|corner| corner.distance(dome.centre) < 200.1), "{corners:?}");
        assert!(ends(dome, Angle::from_degrees(f64::NAN)).is_none());
    }

    #[test]
    fn it_is_named_with_its_azimuth_and_its_silence() {
        let measured = Some(Angle::from_degrees(402.6));
        let bearing = Bearing { name: "Genius", measured, ..Bearing::default() };
        assert_eq!(words(&bearing), "Genius 043°");
        let lost = Bearing { lost: Some("14 s"), ..bearing };
        assert_eq!(words(&lost), "Genius 043° ? 14 s");
        let at_limit = Bearing { limit: Some("CW limit"), ..bearing };
        assert_eq!(words(&at_limit), "Genius at CW limit");
    }
}
