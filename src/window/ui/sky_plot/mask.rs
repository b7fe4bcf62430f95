//! The horizon mask: the part of the sky blocked by hills and walls.

use egui::{Mesh, Painter, Pos2, Shape, Stroke};

use super::geometry::{Dome, hatch};
use crate::{
    astro::{Angle, HorizonMask},
    ui::tokens::Tokens,
};

/// Number of steps around the horizon. Each step is half a degree, about 2 points at the rim.
const STEPS: u16 = 720;
/// Spacing of the hatch, points.
const HATCH: f32 = 6.0;
/// Width of the lines of the hatch, points.
const HATCH_LINE: f32 = 1.3;
/// Width of the skyline, points.
const SKYLINE: f32 = 1.25;

/// Paints the area between the skyline and the rim.
pub(in crate::ui) fn paint(painter: &Painter, dome: Dome, mask: &HorizonMask, t: &Tokens) {
    let rim = dome_line(dome, |_| 0.0);
    // The plot shows nothing below the horizon, so a lower skyline counts as zero.
    let skyline = dome_line(dome, |azimuth| mask.elevation_at(azimuth).degrees().max(0.0) as f32);
    painter.add(ribbon(&rim, &skyline, t));
    let outline: Vec<Pos2> = rim.iter().chain(skyline.iter().rev()).copied().collect();
    let stroke = Stroke::new(HATCH_LINE, t.hatch);
    let lines = hatch(&outline, HATCH, true);
    painter.extend(lines.into_iter().map(|line| Shape::line_segment(line, stroke)));
    painter.add(Shape::line(skyline, Stroke::new(SKYLINE, t.hatch)));
}

/// Returns a line once around the dome, from north to north.
fn dome_line(dome: Dome, elevation_deg: impl Fn(Angle) -> f32) -> Vec<Pos2> {
    let azimuths = (0..=STEPS).map(|step| f64::from(step) * 360.0 / f64::from(STEPS));
    azimuths
        .map(Angle::from_degrees)
        .map(|azimuth| dome.point_at(azimuth.radians() as f32, elevation_deg(azimuth)))
        .collect()
}

/// Returns the fill of the mask as a mesh, because egui fills only convex shapes. The rim and the
/// skyline cover its edges.
fn ribbon(rim: &[Pos2], skyline: &[Pos2], t: &Tokens) -> Mesh {
    let mut mesh = Mesh::default();
    for (index, (outer, inner)) in (0_u32..).zip(rim.iter().zip(skyline)) {
        mesh.colored_vertex(*outer, t.mask);
        mesh.colored_vertex(*inner, t.mask);
        if let Some(first) = (2 * index).checked_sub(2) {
            mesh.add_triangle(first, first + 1, first + 2);
            mesh.add_triangle(first + 1, first + 2, first + 3);
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::pos2;

    const DOME: Dome = Dome { centre: pos2(0.0, 0.0), radius: 270.0 };

    fn outline(mask: &HorizonMask) -> Vec<Pos2> {
        let skyline = dome_line(DOME, |azimuth| mask.elevation_at(azimuth).degrees() as f32);
        dome_line(DOME, |_| 0.0).into_iter().chain(skyline.into_iter().rev()).collect()
    }

    #[test]
    fn the_skyline_stands_at_the_elevation_of_the_mask() {
        let mask = HorizonMask::from_degrees([(0.0, 0.0), (90.0, 30.0), (180.0, 0.0)]).unwrap();
        let skyline = dome_line(DOME, |azimuth| mask.elevation_at(azimuth).degrees() as f32);
        // East is at the right; 30 degrees are 90 points.
        assert!(skyline[180].distance(pos2(180.0, 0.0)) < 1e-3, "{}", skyline[180]);
        assert!(skyline[540].distance(pos2(-270.0, 0.0)) < 1e-3, "{}", skyline[540]);
    }

    #[test]
    fn the_hatch_stays_between_skyline_and_rim() {
        let mask = HorizonMask::from_degrees([(0.0, 10.0), (180.0, 20.0)]).unwrap();
        let lines = hatch(&outline(&mask), HATCH, true);
        assert!(lines.len() > 100, "{}", lines.len());
        for [start, end] in lines {
            for share in [0.05, 0.5, 0.95] {
                let offset = start.lerp(end, share).to_vec2();
                let azimuth = Angle::from_radians(f64::from(offset.x.atan2(-offset.y)));
                let elevation_deg = 90.0 - f64::from(offset.length()) / 3.0;
                let highest_deg = mask.elevation_at(azimuth).degrees();
                assert!(elevation_deg > -0.01 && elevation_deg < highest_deg + 0.01, "{offset}");
            }
        }
    }

    #[test]
    fn a_flat_horizon_has_no_hatch() {
        let mask = HorizonMask::from_degrees([(0.0, 0.0)]).unwrap();
        let lines = hatch(&outline(&mask), HATCH, true);
        assert!(lines.iter().all(|[start, end]| start.distance(*end) < 1e-3));
    }
}
