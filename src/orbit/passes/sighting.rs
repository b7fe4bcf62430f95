//! Time and direction of a satellite as seen from the site.

use std::f64::consts::TAU;

use super::{PassPoint, local_series::LocalState, window::Window};
use crate::{
    astro::{Angle, AzEl, time},
    orbit::simd::{Lanes, Number, Vector, lane_of},
};

#[derive(Debug, Clone, Copy)]
pub(super) struct Sighting<N = f64> {
    pub(super) at_s: N,
    /// Radians, -pi to pi.
    azimuth: N,
    elevation: N,
}

impl<N: Number> Sighting<N> {
    pub(super) fn new(place: &LocalState<N>) -> Self {
        let Vector { x, y, z } = place.enu_km;
        let elevation = z.atan2((x * x + y * y).sqrt());
        Self { elevation, ..Self::at_elevation(place, 0.0) }
    }

    /// The sighting of a place whose elevation is known.
    pub(super) fn at_elevation(place: &LocalState<N>, elevation: f64) -> Self {
        let Vector { x, y, .. } = place.enu_km;
        Self { at_s: place.at_s, azimuth: x.atan2(y), elevation: N::of(elevation) }
    }
}

impl Sighting<Lanes> {
    pub(super) fn lane(&self, lane: usize) -> Sighting {
        let of = |numbers| lane_of(numbers, lane);
        Sighting {
            at_s: of(&self.at_s),
            azimuth: of(&self.azimuth),
            elevation: of(&self.elevation),
        }
    }
}

impl Window {
    /// Time and direction of a place.
    pub(super) fn point(&self, place: &LocalState) -> PassPoint {
        self.point_of(&Sighting::new(place))
    }

    /// The sighting in calendar time.
    pub(super) fn point_of(&self, sighting: &Sighting) -> PassPoint {
        let Sighting { at_s, azimuth, elevation } = *sighting;
        let azimuth = if azimuth < 0.0 { azimuth + TAU } else { azimuth };
        PassPoint {
            time: time::add_seconds(self.from, at_s),
            direction: AzEl {
                azimuth: Angle::from_radians(azimuth),
                elevation: Angle::from_radians(elevation),
            },
        }
    }
}
