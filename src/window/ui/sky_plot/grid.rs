//! The disc with its rings, spokes and rim, and the keyholes of the mount.

use egui::{Align2, Painter, Pos2, Rect, Shape, Stroke, Vec2, vec2};

use super::{
    geometry::{Dome, dashed, hatch, outward},
    labels::Labels,
    scene::Keyholes,
};
use crate::{
    astro::{Angle, AzEl},
    ui::{
        text::{self, Weight},
        tokens::Tokens,
    },
};

/// Elevations of the rings, degrees.
const RINGS: [f32; 2] = [30.0, 60.0];
/// Elevation at which the spokes begin, degrees.
const SPOKE_TOP_DEG: f32 = 87.0;
/// Distance of the azimuth names from the rim, points.
const NAMES: f32 = 15.0;
/// Size of a name of three digits, points.
const NAME_SIZE: Vec2 = vec2(22.0, 14.0);
/// Spacing of the hatch of a keyhole, points.
const HATCH: f32 = 5.0;

/// Paints the background of the disc.
pub(in crate::ui) fn disc(painter: &Painter, dome: Dome, t: &Tokens) {
    painter.circle_filled(dome.centre, dome.radius, t.sky);
}

/// Paints the rings and the spokes, without the numbers of the rings.
pub(in crate::ui) fn rings(painter: &Painter, dome: Dome, t: &Tokens) {
    let thin = Stroke::new(1.0, t.grid);
    for elevation in RINGS {
        painter.circle_stroke(dome.centre, dome.ring(elevation), thin);
    }
    for (index, azimuth_deg) in (0..360_u16).step_by(30).enumerate() {
        let azimuth = f32::from(azimuth_deg).to_radians();
        let spoke = [dome.point_at(azimuth, SPOKE_TOP_DEG), dome.point_at(azimuth, 0.0)];
        if index.is_multiple_of(3) {
            painter.line_segment(spoke, thin);
        } else {
            painter.extend(dashed(&spoke, 1.0, 5.0, thin));
        }
    }
    let cross = Stroke::new(1.0, t.t3);
    for arm in [vec2(5.0, 0.0), vec2(0.0, 5.0)] {
        painter.line_segment([dome.centre - arm, dome.centre + arm], cross);
    }
}

/// Paints the numbers of the rings at fixed places.
pub(in crate::ui) fn ring_numbers(painter: &Painter, dome: Dome, t: &Tokens) {
    for elevation in RINGS {
        let position = dome.point_at(std::f32::consts::FRAC_PI_2, elevation);
        let galley = painter.layout_no_wrap(format!("{elevation}°"), text::caption(), t.t3);
        let place = Rect::from_center_size(position, galley.size());
        painter.rect_filled(place.expand2(vec2(3.0, 0.0)), 0.0, t.sky);
        painter.galley(place.min, galley, t.t3);
    }
}

/// Places the numbers of the rings among labels: at the east, or else on another spoke.
pub(in crate::ui) fn label_rings(labels: &mut Labels<'_>, dome: Dome) {
    const SPOKES_DEG: [f32; 10] =
        [90.0, 270.0, 60.0, 120.0, 240.0, 300.0, 30.0, 150.0, 210.0, 330.0];
    for elevation in RINGS {
        let places =
            SPOKES_DEG.map(|azimuth_deg| dome.point_at(azimuth_deg.to_radians(), elevation));
        labels.add_number(format!("{elevation}°"), &places);
    }
}

/// Paints the rim with its ticks and names, and the ring of the minimum elevation. Returns the
/// boxes of the names.
pub(in crate::ui) fn rim(painter: &Painter, dome: Dome, minimum: Angle, t: &Tokens) -> Vec<Rect> {
    let elevation = minimum.degrees() as f32;
    if elevation > 0.0 && elevation < 90.0 {
        let ring = dome.circle(dome.ring(elevation));
        painter.extend(dashed(&ring, 2.0, 4.0, Stroke::new(1.0, t.edge)));
    }
    painter.circle_stroke(dome.centre, dome.radius, Stroke::new(1.5, t.edge));
    let name_at = |azimuth_deg: u16| {
        let direction = outward(f32::from(azimuth_deg).to_radians());
        let foot = dome.centre + direction * dome.radius;
        painter.line_segment([foot, foot + direction * 5.0], Stroke::new(1.0, t.edge));
        let (name, font, colour) = match azimuth_deg {
            0 => ("N".to_owned(), text::sized(14.0, Weight::Bold), t.t1),
            90 => ("E".to_owned(), text::sized(14.0, Weight::Bold), t.t1),
            180 => ("S".to_owned(), text::sized(14.0, Weight::Bold), t.t1),
            270 => ("W".to_owned(), text::sized(14.0, Weight::Bold), t.t1),
            _ => (format!("{azimuth_deg:03}"), text::caption(), t.t3),
        };
        painter.text(foot + direction * NAMES, Align2::CENTER_CENTER, name, font, colour)
    };
    (0..360).step_by(30).map(name_at).collect()
}

/// Returns the estimated boxes of the azimuth names, without painting them.
pub(in crate::ui) fn name_boxes(dome: Dome) -> Vec<Rect> {
    let box_at = |azimuth_deg: u16| {
        let direction = outward(f32::from(azimuth_deg).to_radians());
        let centre = dome.centre + direction * (dome.radius + NAMES);
        Rect::from_center_size(centre, NAME_SIZE)
    };
    (0..360).step_by(30).map(box_at).collect()
}

/// Paints the caps at both ends of the lower axis. Returns their outlines.
pub(in crate::ui) fn keyholes(
    painter: &Painter,
    dome: Dome,
    holes: &Keyholes,
    t: &Tokens,
) -> Vec<Vec<Pos2>> {
    let caps: Vec<_> = [0.0, 180.0]
        .into_iter()
        .map(|turn| holes.lower_axis_azimuth + Angle::from_degrees(turn))
        .map(|azimuth| cap(dome, azimuth, holes.radius))
        .filter(|outline| !outline.is_empty())
        .collect();
    for outline in &caps {
        painter.add(Shape::convex_polygon(outline.clone(), t.warnbg, Stroke::NONE));
        let lines = hatch(outline, HATCH, false);
        let stroke = Stroke::new(1.6, t.warn);
        painter.extend(lines.into_iter().map(|line| Shape::line_segment(line, stroke)));
        painter.add(Shape::closed_line(outline.clone(), Stroke::new(1.25, t.warn)));
    }
    caps
}

/// Returns the upper half of a circle on the sphere around a point of the horizon. Empty if the
/// circle is not finite or has no size.
pub(in crate::ui) fn cap(dome: Dome, azimuth: Angle, radius: Angle) -> Vec<Pos2> {
    if !(azimuth.is_finite() && radius.degrees() > 0.0 && radius.degrees() < 90.0) {
        return Vec::new();
    }
    let middle = AzEl { azimuth, elevation: Angle::ZERO }.to_enu();
    let along =
        AzEl { azimuth: azimuth + Angle::from_degrees(90.0), elevation: Angle::ZERO }.to_enu();
    let (sin, cos) = radius.radians().sin_cos();
    // The arc omits its ends, which rounding could put below the rim.
    let arc = (1..30_u8).filter_map(|step| {
        let (up, side) = (f64::from(step) * 6.0).to_radians().sin_cos();
        let direction = along * side + glam::DVec3::Z * up;
        dome.point(AzEl::from_enu(middle * cos + direction * sin))
    });
    let rim = (0..=10_u8).map(|step| {
        let part = f64::from(step) / 5.0 - 1.0;
        dome.point_at((azimuth + radius * part).radians() as f32, 0.0)
    });
    arc.chain(rim).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::pos2;

    #[test]
    fn a_cap_reaches_its_radius_and_ends_at_the_rim() {
        let dome = Dome { centre: pos2(0.0, 0.0), radius: 270.0 };
        let outline = cap(dome, Angle::from_degrees(180.0), Angle::from_degrees(6.0));
        // 6 degrees are 18 points; south is at the bottom.
        let top = outline.iter().map(|point| point.y).fold(f32::MAX, f32::min);
        assert!((top - (270.0 - 18.0)).abs() < 0.1, "{top}");
        for point in &outline {
            assert!(point.to_vec2().length() < 270.1);
            assert!(point.x.abs() < 28.5);
        }
    }

    #[test]
    fn a_cap_without_size_or_place_is_empty() {
        let dome = Dome { centre: pos2(0.0, 0.0), radius: 270.0 };
        assert!(cap(dome, Angle::from_degrees(f64::NAN), Angle::from_degrees(6.0)).is_empty());
        assert!(cap(dome, Angle::ZERO, Angle::ZERO).is_empty());
        assert!(cap(dome, Angle::ZERO, Angle::from_degrees(f64::NAN)).is_empty());
    }
}
