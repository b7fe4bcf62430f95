//! Time and direction of a satellite as seen from the site.

use std::f64::consts::TAU;

use super::{compact::CompactPoint, local_series::LocalState, window::Window};
use crate::{
    astro::{Angle, AzEl},
    simd::{Lanes, Number, Vector},
};

#[derive(Debug, Clone, Copy)]
pub(super) struct Sighting<N = f64> {
    pub(super) at_s: N,
    /// Azimuth in radians, -pi to pi.
    azimuth: N,
    elevation: N,
}

impl<N: Number> Sighting<N> {
    #[inline(always)]
    pub(super) fn new(place: &LocalState<N>) -> Self {
        let Vector { x, y, z } = place.enu_km;
        let elevation = z.atan2((x * x + y * y).sqrt());
        Self { elevation, ..Self::at_elevation(place, 0.0) }
    }

    /// Returns the sighting of a place with a known elevation.
    #[inline(always)]
    pub(super) fn at_elevation(place: &LocalState<N>, elevation: f64) -> Self {
        let Vector { x, y, .. } = place.enu_km;
        Self { at_s: place.at_s, azimuth: x.atan2(y), elevation: N::splat(elevation) }
    }
}

impl Sighting {
    /// Returns the geometric direction.
    pub(super) fn direction(&self) -> AzEl {
        let Self { azimuth, elevation, .. } = *self;
        let azimuth = if azimuth < 0.0 { azimuth + TAU } else { azimuth };
        AzEl { azimuth: Angle::from_radians(azimuth), elevation: Angle::from_radians(elevation) }
    }
}

impl Sighting<Lanes> {
    pub(super) fn lane(&self, lane: usize) -> Sighting {
        let lane_value = |numbers: &Lanes| numbers.lane(lane);
        Sighting {
            at_s: lane_value(&self.at_s),
            azimuth: lane_value(&self.azimuth),
            elevation: lane_value(&self.elevation),
        }
    }
}

impl Window {
    /// Returns the point of a pass for a sighting, with the direction that passes use.
    pub(super) fn point(&self, sighting: &Sighting) -> CompactPoint {
        let direction = self.pass_direction(sighting.direction());
        CompactPoint { at_ns: self.at_ns(sighting.at_s), direction }
    }
}
