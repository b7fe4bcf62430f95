//! The cap around a zone, for a cheap test whether a direction is far from the zone.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;

use super::{AzEl, edge::Edge};

/// Distance between the points of the edges to which the cap is fitted, radians.
const STEP: f64 = 0.02;

/// A spherical cap that contains the zone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ZoneCap {
    centre: DVec3,
    /// Angle from the centre to the edge, radians.
    radius: f64,
}

impl ZoneCap {
    /// Returns a cap that contains all `edges` and their inside. The cap is the whole sphere if the
    /// edges span a hemisphere or the cap would contain the nadir. In these cases, the inside may
    /// be the side of the edges that a smaller cap leaves out.
    pub(super) fn enclosing(edges: &[Edge]) -> Self {
        let whole = Self { centre: DVec3::Z, radius: PI };
        let points = || edges.iter().flat_map(|edge| edge.points(STEP)).map(AzEl::to_enu);
        let Some(centre) = points().sum::<DVec3>().try_normalize() else { return whole };
        let distance = |point: DVec3| centre.cross(point).length().atan2(centre.dot(point));
        // Between two points, an edge is no further away than the nearer point plus half a step.
        let furthest = points().map(distance).fold(0.0, f64::max);
        let radius = furthest + STEP;
        let is_small = radius < FRAC_PI_2 && distance(DVec3::NEG_Z) > radius;
        if is_small { Self { centre, radius } } else { whole }
    }

    /// Returns the min angle between the unit vector `point` and the zone, radians; zero or
    /// negative within the cap.
    pub(super) fn clearance(self, point: DVec3) -> f64 {
        self.centre.dot(point).clamp(-1.0, 1.0).acos() - self.radius
    }
}
