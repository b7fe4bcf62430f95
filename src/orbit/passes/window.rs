//! Values that all satellites of one search share: the site, the span of time and the elevations.
//!
//! Inside the search, a time is a number of seconds from the start of the span. The search does
//! calendar arithmetic only at the start and when it reports a pass.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;
use jiff::Timestamp;

use super::PassSearch;
use crate::{
    astro::{Angle, AzEl, Site, frames, time},
    simd::{Number, Vector},
};

/// A site and a span of time, prepared for computation.
#[derive(Debug, Clone)]
pub(super) struct Window {
    pub(super) start: Timestamp,
    /// Start in nanoseconds since 1970.
    from_ns: i64,
    pub(super) length_s: f64,
    /// Greenwich sidereal time at the start, radians.
    sidereal: f64,
    /// Geocentric site: longitude, sine and cosine of the latitude, and the distance from the
    /// centre of the Earth.
    pub(super) longitude: f64,
    pub(super) sin_latitude: f64,
    pub(super) cos_latitude: f64,
    pub(super) radius_km: f64,
    site: Site,
    /// Site in Earth-fixed axes, km.
    pub(super) site_ecef_km: DVec3,
    /// Directions east, north and up, and the position of the site along them from the centre of
    /// the Earth.
    axes: [DVec3; 3],
    site_enu_km: DVec3,
    /// Geometric elevation of AOS and LOS, radians, and its sine.
    pub(super) aos_elevation: f64,
    pub(super) sin_aos_elevation: f64,
    /// Min geometric elevation that a pass has to reach, radians; never below the elevation of the
    /// horizon.
    pub(super) floor: f64,
    pub(super) sin_floor: f64,
}

impl Window {
    /// Creates the window; `None` if the span is empty or no elevation can be reached.
    pub(super) fn new(search: &PassSearch) -> Option<Self> {
        let length_s = time::seconds_between(search.start, search.end);
        let geometric = |elevation: Angle| search.site.geometric_of_pass(elevation).radians();
        let aos_elevation = geometric(search.aos_elevation);
        let floor = geometric(search.floor).max(aos_elevation);
        // The negated test also refuses NaN.
        if !(length_s > 0.0 && aos_elevation >= -FRAC_PI_2 && floor <= FRAC_PI_2) {
            return None;
        }
        let site_ecef_km = frames::site_ecef_km(search.site);
        let to_enu = frames::ecef_to_enu(search.site);
        let radius_km = site_ecef_km.length();
        Some(Self {
            start: search.start,
            from_ns: time::nanoseconds(search.start),
            length_s,
            sidereal: time::gmst(search.start).radians(),
            longitude: site_ecef_km.y.atan2(site_ecef_km.x),
            sin_latitude: site_ecef_km.z / radius_km,
            cos_latitude: site_ecef_km.x.hypot(site_ecef_km.y) / radius_km,
            radius_km,
            site: search.site,
            site_ecef_km,
            axes: [0, 1, 2].map(|axis| to_enu.row(axis)),
            site_enu_km: to_enu * site_ecef_km,
            aos_elevation,
            sin_aos_elevation: aos_elevation.sin(),
            floor,
            sin_floor: floor.sin(),
        })
    }

    /// Returns a geometric direction in the form that the passes of the site use.
    pub(super) fn pass_direction(&self, geometric: AzEl) -> AzEl {
        self.site.pass_direction(geometric)
    }

    /// Returns the nanoseconds since 1970 of a time that is not before the start.
    pub(super) fn at_ns(&self, at_s: f64) -> i64 {
        let whole = at_s as i64;
        let rest = (at_s - whole as f64) * time::SECOND_NS as f64 + 0.5;
        self.from_ns + whole * time::SECOND_NS + rest as i64
    }

    /// Returns the Greenwich sidereal time in radians, not wrapped.
    #[inline(always)]
    pub(super) fn sidereal_at<N: Number>(&self, at_s: N) -> N {
        at_s * frames::EARTH_RATE_RAD_S + self.sidereal
    }

    /// Turns a vector from Earth-fixed axes to east, north, up.
    #[inline(always)]
    pub(super) fn to_enu<N: Number>(&self, ecef: Vector<N>) -> Vector<N> {
        let [east, north, up] = self.axes;
        Vector::new(ecef.dot(east.into()), ecef.dot(north.into()), ecef.dot(up.into()))
    }

    /// Returns the distance from the centre of the Earth, km, of a place east, north, up from the
    /// site.
    pub(super) fn radius_of_place_km(&self, enu_km: Vector<f64>) -> f64 {
        (enu_km + self.site_enu_km.into()).length()
    }

    /// Returns the vector from the site to an Earth-fixed position, east, north, up, km.
    #[inline(always)]
    pub(super) fn seen_from_site<N: Number>(&self, ecef_km: Vector<N>) -> Vector<N> {
        self.to_enu(ecef_km) - self.site_enu_km.into()
    }
}
