//! The azimuths and elevations of a zone, for a cheap test whether a whole box of directions is
//! outside it.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;

use super::edge::{Edge, Shape};

/// Ranges of azimuth and elevation that contain a zone, radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extent {
    azimuths: (f64, f64),
    elevations: (f64, f64),
}

impl Extent {
    /// Returns the extent of a zone; `None` for a zone that contains the zenith or is wider than
    /// half a turn.
    pub(super) fn enclosing(edges: &[Edge]) -> Option<Self> {
        let start = edges.first()?.from_azimuth;
        let mut azimuth = start;
        let (mut azimuths, mut elevations) = ((start, start), (FRAC_PI_2, -FRAC_PI_2));
        for edge in edges {
            azimuth += edge.turn;
            azimuths = (azimuths.0.min(azimuth), azimuths.1.max(azimuth));
            for elevation in [edge.start, edge.end].into_iter().chain(furthest(edge)).map(elevation)
            {
                elevations = (elevations.0.min(elevation), elevations.1.max(elevation));
            }
        }
        let is_closed = (azimuth - start).abs() < 1.0;
        let is_narrow = azimuths.1 - azimuths.0 < PI;
        (is_closed && is_narrow).then_some(Self { azimuths, elevations })
    }

    /// Returns a lower bound of the distance between the zone and any direction in a box, radians.
    /// The bound is zero or negative if the box may reach into the zone.
    pub(super) fn clearance(self, azimuths: (f64, f64), elevations: (f64, f64)) -> f64 {
        let (lowest, highest) = self.elevations;
        let level = (elevations.0 - highest).max(lowest - elevations.1);
        // The meridians of the sides come closest at the smallest cosine of the elevation.
        let cos = elevations.0.cos().min(elevations.1.cos()).max(0.0);
        let side_clearance = |nearest: f64| {
            let nearest = nearest.rem_euclid(TAU);
            let furthest = nearest + (azimuths.1 - azimuths.0);
            if furthest > PI {
                return f64::NEG_INFINITY;
            }
            (cos * nearest.sin().min(furthest.sin())).asin()
        };
        let (first, last) = self.azimuths;
        level.max(side_clearance(first - azimuths.1)).max(side_clearance(azimuths.0 - last))
    }
}

fn elevation(point: DVec3) -> f64 {
    point.z.atan2(point.x.hypot(point.y))
}

/// Returns the highest and the lowest point of a great circle, if they lie on the edge.
fn furthest(edge: &Edge) -> impl Iterator<Item = DVec3> {
    let points = match edge.shape {
        Shape::GreatCircle { normal } => {
            let top = (DVec3::Z - normal * normal.z).try_normalize();
            let points = [top, top.map(|top| -top)].into_iter().flatten();
            Some(points.filter(move |point| edge.spans(*point, normal)))
        }
        Shape::Arc { .. } => None,
    };
    points.into_iter().flatten()
}
