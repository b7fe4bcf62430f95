//! Directions and keep-outs by independent formulas: no code here comes from the program.

use azel::station::Mount;
use glam::DVec3;

/// Distance between two points of an outline, degrees.
const STEP_DEG: f64 = 0.5;

/// Returns the unit vector of a direction, with the components east, north and up.
fn vector(az_deg: f64, el_deg: f64) -> DVec3 {
    let ((sin_az, cos_az), (sin_el, cos_el)) =
        (az_deg.to_radians().sin_cos(), el_deg.to_radians().sin_cos());
    DVec3::new(cos_el * sin_az, cos_el * cos_az, sin_el)
}

/// Returns the direction in which the axes point at `axes_deg`, degrees as the mount counts.
pub(super) fn direction(mount: &Mount, [first_deg, second_deg]: [f64; 2]) -> DVec3 {
    match *mount {
        Mount::AzEl { .. } => vector(first_deg, second_deg),
        Mount::Xy { lower_axis_azimuth_deg, .. } => {
            let (sin_x, cos_x) = (first_deg - 90.0).to_radians().sin_cos();
            let (sin_y, cos_y) = (second_deg - 90.0).to_radians().sin_cos();
            let (across, along) = (sin_x * cos_y, sin_y);
            let (sin_base, cos_base) = lower_axis_azimuth_deg.to_radians().sin_cos();
            DVec3::new(
                along * sin_base + across * cos_base,
                along * cos_base - across * sin_base,
                cos_x * cos_y,
            )
        }
    }
}

/// A keep-out with horizontal lower and upper edges, and great circles at its sides.
pub(super) struct Outline {
    points: Vec<DVec3>,
    middle: DVec3,
    heights: [f64; 2],
    /// Normals of the planes of both sides, which point into the zone.
    sides: [DVec3; 2],
}

impl Outline {
    /// Creates an outline from its corners in azimuth and elevation, degrees: lower left, lower
    /// right, upper right, upper left.
    pub(super) fn new(corners_deg: [(f64, f64); 4]) -> Self {
        let [lower_left, lower_right, upper_right, upper_left] =
            corners_deg.map(|(az_deg, el_deg)| vector(az_deg, el_deg));
        let mut points = Vec::new();
        for side in [(corners_deg[0], corners_deg[1]), (corners_deg[3], corners_deg[2])] {
            let ((from_deg, el_deg), (to_deg, _)) = side;
            points.extend(
                shares(to_deg - from_deg)
                    .map(|share| vector(from_deg + (to_deg - from_deg) * share, el_deg)),
            );
        }
        for (from, to) in [(lower_left, upper_left), (lower_right, upper_right)] {
            let span = from.angle_between(to);
            let arc = |share: f64| from * ((1.0 - share) * span).sin() + to * (share * span).sin();
            points.extend(shares(span.to_degrees()).map(|share| arc(share).normalize()));
        }
        let sides = [lower_left.cross(upper_left), upper_right.cross(lower_right)];
        Self {
            points,
            middle: lower_left + lower_right + upper_right + upper_left,
            heights: [lower_left.z, upper_left.z],
            sides: sides.map(DVec3::normalize),
        }
    }

    /// Returns the distance of a direction from the edge, degrees; negative inside.
    pub(super) fn clearance_deg(&self, direction: DVec3) -> f64 {
        let nearest = self.points.iter().map(|point| point.dot(direction));
        let edge_deg = nearest.fold(-1.0, f64::max).clamp(-1.0, 1.0).acos().to_degrees();
        let [lowest, highest] = self.heights;
        // The planes of the sides also bound directions beyond the zenith.
        let is_inside = direction.truncate().dot(self.middle.truncate()) > 0.0
            && (lowest..=highest).contains(&direction.z)
            && self.sides.iter().all(|normal| normal.dot(direction) >= 0.0);
        if is_inside { -edge_deg } else { edge_deg }
    }
}

/// Returns parts of a span, from its beginning to its end, 0 to 1.
fn shares(span_deg: f64) -> impl Iterator<Item = f64> {
    let parts = (span_deg.abs() / STEP_DEG).ceil().max(1.0) as u32;
    (0..=parts).map(move |part| f64::from(part) / f64::from(parts))
}

#[test]
fn the_two_geometries_agree() {
    use super::world::{Wish, World};
    use crate::common::dice::Dice;

    for seed in 0..300 {
        let mut dice = Dice::new(seed);
        let world = World::random(&mut dice, &Wish { keep_outs: 2, ..Wish::default() });
        for _ in 0..20 {
            let axes_deg =
                world.antenna.mount.travel_deg().map(|(from, to)| dice.between(from, to));
            let by_program = world.bounds.direction(axes_deg);
            let by_test = direction(&world.antenna.mount, axes_deg);
            assert!(by_program.to_enu().angle_between(by_test) < 1e-6, "seed {seed} {axes_deg:?}");
            for (zone, (outline, _)) in world.station.keep_outs.iter().zip(&world.outlines) {
                let program_deg = zone.zone.clearance(by_program).degrees();
                let test_deg = outline.clearance_deg(by_test);
                assert!(
                    (program_deg - test_deg).abs() < 0.26,
                    "seed {seed}: {program_deg} {test_deg} at {axes_deg:?}"
                );
            }
        }
    }
}
