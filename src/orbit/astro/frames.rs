//! Frames: TEME, Earth-fixed (ECEF) and the site's east, north, up (ENU).
//!
//! Greenwich mean sidereal time alone turns TEME into the Earth-fixed frame, with UT1 taken as UTC.
//! This neglects UT1-UTC, which stays below 0.9 s or 0.004 degrees of Earth rotation. It also
//! neglects polar motion, which stays below 0.6 arc seconds or 0.000 2 degrees.

use glam::{DMat3, DVec3};
use jiff::Timestamp;

use super::{Angle, AzEl, GroundPoint, Site, time};

/// Equatorial radius of the WGS84 ellipsoid, km.
pub const WGS84_RADIUS_KM: f64 = 6_378.137;
pub const WGS84_FLATTENING: f64 = 1.0 / 298.257_223_563;
/// Mean radius of the WGS84 ellipsoid, km.
pub const MEAN_RADIUS_KM: f64 = 6_371.009;
/// Rotation rate of the Earth relative to TEME, rad/s: the rate of mean sidereal time (IAU 1982).
pub const EARTH_RATE_RAD_S: f64 = 7.292_115_855_3e-5;

pub fn site_ecef_km(site: Site) -> DVec3 {
    let (sin_lat, cos_lat) = site.latitude().radians().sin_cos();
    let (sin_lon, cos_lon) = site.longitude().radians().sin_cos();
    let e2 = WGS84_FLATTENING * (2.0 - WGS84_FLATTENING);
    let prime_vertical_km = WGS84_RADIUS_KM / (1.0 - e2 * sin_lat * sin_lat).sqrt();
    let altitude_km = site.altitude_m() / 1000.0;
    let from_axis_km = (prime_vertical_km + altitude_km) * cos_lat;
    DVec3::new(
        from_axis_km * cos_lon,
        from_axis_km * sin_lon,
        (prime_vertical_km * (1.0 - e2) + altitude_km) * sin_lat,
    )
}

/// Returns the point of the ground below an Earth-fixed position outside the Earth's core, and the
/// height above the ellipsoid, km.
///
/// Source: Vallado, "Fundamentals of Astrodynamics", the iteration on the latitude; accurate to a
/// millimetre after five steps.
pub fn geodetic(position_ecef_km: DVec3) -> (GroundPoint, f64) {
    let e2 = WGS84_FLATTENING * (2.0 - WGS84_FLATTENING);
    let DVec3 { x, y, z } = position_ecef_km;
    let from_axis_km = x.hypot(y);
    let prime_vertical_km = |sin: f64| WGS84_RADIUS_KM / (1.0 - e2 * sin * sin).sqrt();
    let mut latitude = z.atan2(from_axis_km * (1.0 - e2));
    for _ in 0..5 {
        let sin = latitude.sin();
        latitude = (z + e2 * prime_vertical_km(sin) * sin).atan2(from_axis_km);
    }
    let (sin, cos) = latitude.sin_cos();
    let ellipsoid_km = WGS84_RADIUS_KM * WGS84_RADIUS_KM / prime_vertical_km(sin);
    let height_km = from_axis_km * cos + z * sin - ellipsoid_km;
    let longitude = Angle::from_radians(y.atan2(x));
    (GroundPoint::new(Angle::from_radians(latitude), longitude), height_km)
}

/// Returns the rotation from Earth-fixed vectors to east, north, up at `site`.
pub fn ecef_to_enu(site: Site) -> DMat3 {
    let (sin_lat, cos_lat) = site.latitude().radians().sin_cos();
    let (sin_lon, cos_lon) = site.longitude().radians().sin_cos();
    let east = DVec3::new(-sin_lon, cos_lon, 0.0);
    let north = DVec3::new(-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat);
    let up = DVec3::new(cos_lat * cos_lon, cos_lat * sin_lon, sin_lat);
    DMat3::from_cols(east, north, up).transpose()
}

/// Place and axes of a site, computed once for many looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SiteFrame {
    pub ecef_km: DVec3,
    /// Rotation from Earth-fixed vectors to east, north, up.
    pub to_enu: DMat3,
    site: Site,
}

impl SiteFrame {
    /// Returns the apparent direction of an object far above the air at this geometric place (east,
    /// north, up). An antenna has to point in this direction.
    pub fn direction(&self, enu_km: DVec3) -> AzEl {
        self.site.apparent(AzEl::from_enu(enu_km))
    }

    /// Returns an Earth-fixed position as seen from the site: east, north, up, km.
    pub fn enu_km(&self, ecef_km: DVec3) -> DVec3 {
        self.to_enu * (ecef_km - self.ecef_km)
    }
}

impl From<Site> for SiteFrame {
    fn from(site: Site) -> Self {
        Self { ecef_km: site_ecef_km(site), to_enu: ecef_to_enu(site), site }
    }
}

pub fn teme_to_ecef(time: Timestamp) -> DMat3 {
    DMat3::from_rotation_z(-time::gmst(time).radians())
}

/// Returns the Earth-fixed velocity, km/s, of a body at `position_ecef_km`. `velocity_km_s` is its
/// inertial velocity, turned into the Earth-fixed axes.
pub fn velocity_over_ground_km_s(position_ecef_km: DVec3, velocity_km_s: DVec3) -> DVec3 {
    velocity_km_s - DVec3::new(0.0, 0.0, EARTH_RATE_RAD_S).cross(position_ecef_km)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ellipsoid_has_its_radii_and_the_zenith_points_outwards() {
        let equator = site_ecef_km(Site::new(0.0, 90.0, 1000.0).unwrap());
        assert!((equator - DVec3::new(0.0, 6_379.137, 0.0)).length() < 1e-9);
        let pole = site_ecef_km(Site::new(-90.0, 0.0, 0.0).unwrap());
        assert!((pole.z + 6_356.752_314_245).abs() < 1e-6, "{pole}");
        let site = Site::new(41.02, 29.17, 100.0).unwrap();
        let higher = Site::new(41.02, 29.17, 1100.0).unwrap();
        let rise = ecef_to_enu(site) * (site_ecef_km(higher) - site_ecef_km(site));
        assert!((rise - DVec3::Z).length() < 1e-9, "{rise}");
    }

    #[test]
    fn sites_agree_with_astropy() {
        for (latitude, longitude, altitude_m, expected) in [
            (41.02, 29.17, 100.0, [4_208.024_395, 2_348.894_671, 4_164.164_850]),
            (-53.15, -70.9, 30.0, [1_254.341_663, -3_622.322_597, -5_080.596_237]),
            (78.23, 15.4, 450.0, [1_258.453_243, 346.635_775, 6_222.665_492]),
        ] {
            let found = site_ecef_km(Site::new(latitude, longitude, altitude_m).unwrap());
            assert!(found.distance(DVec3::from_array(expected)) < 2e-6, "{found}");
        }
    }

    #[test]
    fn the_point_below_agrees_with_the_published_example_and_with_sites() {
        // Vallado, example 3-3.
        let (point, height_km) = geodetic(DVec3::new(6_524.834, 6_862.875, 6_448.296));
        assert!((point.latitude.degrees() - 34.352_496).abs() < 1e-6, "{point:?}");
        assert!((point.longitude.degrees() - 46.446_4).abs() < 1e-4, "{point:?}");
        assert!((height_km - 5_085.22).abs() < 0.01, "{height_km}");
        for latitude in (-90..=90).step_by(10) {
            for (longitude, altitude_m) in [(-179.9, 0.0), (0.0, 10_000.0), (29.17, -1000.0)] {
                let site = Site::new(f64::from(latitude), longitude, altitude_m).unwrap();
                let (point, height_km) = geodetic(site_ecef_km(site));
                let deviation = (point.latitude - site.latitude()).degrees();
                assert!(deviation.abs() < 1e-8, "{latitude} {deviation}");
                let off_km = height_km - altitude_m / 1000.0;
                assert!(off_km.abs() < 1e-6, "{latitude} {off_km}");
            }
        }
    }

    #[test]
    fn what_stands_still_over_the_ground_has_no_velocity() {
        let time: Timestamp = "2026-08-12T00:00:00Z".parse().unwrap();
        let later = time::add_seconds(time, 1.0);
        let fixed = DVec3::new(42_164.0, 0.0, 0.0);
        let before = teme_to_ecef(time).transpose() * fixed;
        let after = teme_to_ecef(later).transpose() * fixed;
        let inertial_km_s = after - before;
        let relative = velocity_over_ground_km_s(fixed, teme_to_ecef(time) * inertial_km_s);
        assert!(relative.length() < 2e-4, "{relative}");
    }
}
