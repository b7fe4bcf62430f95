//! Directions to the Sun and the Moon, from short series.
//!
//! Sun: "Astronomical Almanac", section C, low precision formulas (0.01 degrees from 1950 to
//! 2050). Moon: Montenbruck and Gill, "Satellite Orbits", section 3.3.2 (some arc minutes). The
//! series refer to the mean equinox of date, which is within 0.005 degrees of TEME.

use glam::{DMat3, DVec3};
use jiff::Timestamp;

use super::{
    Angle, AzEl, Cap, GroundPoint, Site,
    frames::{self, SiteFrame},
    time,
};

/// Terrestrial Time minus UTC since 2017, seconds. The Moon moves 0.01 degrees in that time.
const TT_MINUS_UTC_S: f64 = 69.184;
/// Elevation of the Sun's centre at sunrise and sunset, degrees. The Sun's radius and the
/// refraction put it below the horizon.
pub const RISE_DEG: f64 = -0.833;
const ASTRONOMICAL_UNIT_KM: f64 = 149_597_870.7;

/// Returns the apparent direction of the Sun, seen from `site`, with the refraction of radio waves.
pub fn sun(site: Site, time: Timestamp) -> AzEl {
    let frame = SiteFrame::from(site);
    frame.direction(sun_enu_km(&frame, time))
}

/// Returns the geometric vector from the site to the Sun: east, north, up, km.
pub fn sun_enu_km(site: &SiteFrame, time: Timestamp) -> DVec3 {
    seen_from(site, time, sun_teme_km(time))
}

/// Returns the apparent direction of the Moon, seen from `site`, with parallax and the refraction
/// of radio waves.
pub fn moon(site: Site, time: Timestamp) -> AzEl {
    let frame = SiteFrame::from(site);
    frame.direction(seen_from(&frame, time, moon_teme_km(time)))
}

/// Returns the point of the ground at which the Sun is in the zenith.
pub fn subsolar_point(time: Timestamp) -> GroundPoint {
    GroundPoint::below(sun_ecef_km(time))
}

/// Returns the part of the ground where it is night: the Sun is below [`RISE_DEG`].
pub fn night(time: Timestamp) -> Cap {
    let radius = Angle::from_degrees(90.0 + RISE_DEG);
    Cap { centre: subsolar_point(time).antipode(), radius }
}

fn seen_from(site: &SiteFrame, time: Timestamp, teme_km: DVec3) -> DVec3 {
    site.enu_km(frames::teme_to_ecef(time) * teme_km)
}

/// Returns the vector from the centre of the Earth to the Sun, in Earth-fixed axes, km.
pub fn sun_ecef_km(time: Timestamp) -> DVec3 {
    frames::teme_to_ecef(time) * sun_teme_km(time)
}

/// Returns the vector from the centre of the Earth to the Sun, in TEME, km.
pub fn sun_teme_km(time: Timestamp) -> DVec3 {
    let days = days_tt(time);
    let mean_longitude_deg = 280.460 + 0.985_647_4 * days;
    let anomaly = (357.528 + 0.985_600_3 * days).to_radians();
    let (sin, cos) = anomaly.sin_cos();
    let (sin_double, cos_double) = (2.0 * sin * cos, 1.0 - 2.0 * sin * sin);
    let longitude_deg = mean_longitude_deg + 1.915 * sin + 0.020 * sin_double;
    let distance_au = 1.000_14 - 0.016_71 * cos - 0.000_14 * cos_double;
    equatorial(days, longitude_deg.to_radians(), 0.0) * (distance_au * ASTRONOMICAL_UNIT_KM)
}

fn moon_teme_km(time: Timestamp) -> DVec3 {
    let days = days_tt(time);
    let centuries = days / 36_525.0;
    // The book uses the same symbols: anomalies of Moon and Sun, distance from the node, elongation
    // from the Sun.
    let mean_longitude = (218.316_17 + 481_267.880_88 * centuries).to_radians();
    let l = (134.962_92 + 477_198.867_53 * centuries).to_radians();
    let ls = (357.525_43 + 35_999.049_44 * centuries).to_radians();
    let f = (93.272_83 + 483_202.018_73 * centuries).to_radians();
    let d2 = 2.0 * (297.850_27 + 445_267.111_35 * centuries).to_radians();
    let second = (1.0 / 3600.0_f64).to_radians();

    let in_longitude = second
        * (22_640.0 * l.sin() + 769.0 * (2.0 * l).sin() - 4_586.0 * (l - d2).sin()
            + 2_370.0 * d2.sin()
            - 668.0 * ls.sin()
            - 412.0 * (2.0 * f).sin()
            - 212.0 * (2.0 * l - d2).sin()
            - 206.0 * (l + ls - d2).sin()
            + 192.0 * (l + d2).sin()
            - 165.0 * (ls - d2).sin()
            + 148.0 * (l - ls).sin()
            - 125.0 * (0.5 * d2).sin()
            - 110.0 * (l + ls).sin()
            - 55.0 * (2.0 * f - d2).sin());
    let from_node = f + in_longitude + second * (412.0 * (2.0 * f).sin() + 541.0 * ls.sin());
    let latitude = second
        * (18_520.0 * from_node.sin() - 526.0 * (f - d2).sin() + 44.0 * (l + f - d2).sin()
            - 31.0 * (f - l - d2).sin()
            - 25.0 * (f - 2.0 * l).sin()
            - 23.0 * (ls + f - d2).sin()
            + 21.0 * (f - l).sin()
            + 11.0 * (f - ls - d2).sin());
    let distance_km = 385_000.0
        - 20_905.0 * l.cos()
        - 3_699.0 * (d2 - l).cos()
        - 2_956.0 * d2.cos()
        - 570.0 * (2.0 * l).cos()
        + 246.0 * (2.0 * l - d2).cos()
        - 205.0 * (ls - d2).cos()
        - 171.0 * (l + d2).cos()
        - 152.0 * (l + ls - d2).cos();
    equatorial(days, mean_longitude + in_longitude, latitude) * distance_km
}

/// Returns the days since 2000-01-01T12:00 in Terrestrial Time.
fn days_tt(time: Timestamp) -> f64 {
    time::days_since_j2000(time) + TT_MINUS_UTC_S / time::DAY_S
}

/// Returns the unit vector in the equatorial frame of date, from ecliptic longitude and latitude in
/// radians.
fn equatorial(days: f64, longitude: f64, latitude: f64) -> DVec3 {
    let obliquity = (23.439_291 - 3.563e-7 * days).to_radians();
    let (sin_lon, cos_lon) = longitude.sin_cos();
    let (sin_lat, cos_lat) = latitude.sin_cos();
    DMat3::from_rotation_x(obliquity) * DVec3::new(cos_lat * cos_lon, cos_lat * sin_lon, sin_lat)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Site (latitude, longitude, altitude), time, then azimuth and elevation of the Sun and of the
    /// Moon, from astropy 8.0.2 (`get_body` seen from the site, no pressure, built-in ephemeris).
    type Row = ((f64, f64, f64), &'static str, (f64, f64), (f64, f64));

    const ISTANBUL: (f64, f64, f64) = (41.02, 29.17, 100.0);
    const PUNTA_ARENAS: (f64, f64, f64) = (-53.15, -70.9, 30.0);
    const QUITO: (f64, f64, f64) = (-0.2, -78.5, 2800.0);
    const SVALBARD: (f64, f64, f64) = (78.23, 15.4, 450.0);

    #[rustfmt::skip]
    const TABLE: [Row; 12] = [
        (ISTANBUL, "2024-03-20T03:06:00Z", (79.2149, -12.1423), (312.1250, -8.9377)),
        (ISTANBUL, "2026-08-12T17:45:00Z", (297.1577, -7.5266), (297.4756, -7.6741)),
        (ISTANBUL, "2026-11-21T09:00:00Z", (166.9073, 27.9717), (37.7651, -32.2679)),
        (PUNTA_ARENAS, "2026-08-12T17:45:00Z", (345.3945, 20.9713), (345.9036, 19.2831)),
        (PUNTA_ARENAS, "2030-01-05T22:10:00Z", (263.4902, 23.6259), (288.9755, 30.4946)),
        (PUNTA_ARENAS, "2035-07-01T12:00:00Z", (62.0338, -8.1787), (16.0446, 23.0021)),
        (QUITO, "2024-03-20T03:06:00Z", (269.7019, -56.1461), (324.6064, 59.1506)),
        (QUITO, "2026-08-12T17:45:00Z", (337.0927, 73.6807), (339.3392, 72.7678)),
        (QUITO, "2030-01-05T22:10:00Z", (246.5669, 16.1142), (251.2897, 38.8214)),
        (SVALBARD, "2024-03-20T03:06:00Z", (60.5691, -5.8482), (296.8943, 18.3505)),
        (SVALBARD, "2026-11-21T09:00:00Z", (155.2641, -9.3090), (17.9719, -2.5819)),
        (SVALBARD, "2035-07-01T12:00:00Z", (196.1329, 34.4467), (254.0457, 14.2345)),
    ];

    #[test]
    fn sun_and_moon_stand_where_astropy_sees_them() {
        let (mut sun_off, mut moon_off) = (0.0_f64, 0.0_f64);
        for ((latitude, longitude, altitude), text, sun_seen, moon_seen) in TABLE {
            let site = Site::new(latitude, longitude, altitude).unwrap().airless();
            let time: Timestamp = text.parse().unwrap();
            let deviation = |found: AzEl, (az, el): (f64, f64)| {
                found.separation(AzEl::from_degrees(az, el)).degrees()
            };
            sun_off = sun_off.max(deviation(sun(site, time), sun_seen));
            moon_off = moon_off.max(deviation(moon(site, time), moon_seen));
        }
        println!("Sun {sun_off} degrees, Moon {moon_off} degrees");
        assert!(sun_off < 0.02, "{sun_off}");
        assert!(moon_off < 0.1, "{moon_off}");
    }

    #[test]
    fn sun_and_moon_appear_higher_by_the_refraction_at_their_elevation() {
        let mut compared = 0;
        for ((latitude, longitude, altitude), text, ..) in TABLE {
            let site = Site::new(latitude, longitude, altitude).unwrap();
            let time: Timestamp = text.parse().unwrap();
            for body in [sun, moon] {
                let (apparent, geometric) = (body(site, time), body(site.airless(), time));
                let lifted_deg = (apparent.elevation - geometric.elevation).degrees();
                assert!(apparent.azimuth == geometric.azimuth && lifted_deg >= 0.0, "{lifted_deg}");
                if geometric.elevation_deg() > 10.0 {
                    // Flat layers of refractivity 315 at sea level are accurate enough this high.
                    let scale = (-altitude / 7350.0).exp() / geometric.elevation.radians().tan();
                    let flat_deg = (315e-6 * scale).to_degrees();
                    assert!((lifted_deg - flat_deg).abs() < 0.05 * flat_deg, "{lifted_deg}");
                    compared += 1;
                }
            }
        }
        assert!(compared > 8, "{compared}");
    }

    #[test]
    fn the_sun_rises_and_sets_on_the_edge_of_the_night() {
        for text in ["2026-03-20T14:46:00Z", "2026-06-21T08:24:00Z", "2026-11-14T18:13:40Z"] {
            let time: Timestamp = text.parse().unwrap();
            let below = subsolar_point(time);
            let site = |point: GroundPoint| {
                let (latitude, longitude) = (point.latitude, point.longitude);
                Site::new(latitude.degrees(), longitude.degrees(), 0.0).unwrap().airless()
            };
            assert!(sun(site(below), time).elevation_deg() > 89.98);
            let night = night(time);
            for row in night.edge() {
                let end = GroundPoint::new(row.latitude, night.centre.longitude + row.half_width);
                let elevation_deg = sun(site(end), time).elevation_deg();
                assert!((elevation_deg - RISE_DEG).abs() < 0.01, "{elevation_deg} at {end:?}");
            }
        }
    }

    #[test]
    fn at_the_equinox_the_night_is_bounded_by_two_meridians() {
        // The equinox of March 2026 is at 14:46 UTC; apparent noon in Greenwich is at
        // 12:07 on that day.
        let time: Timestamp = "2026-03-20T14:46:00Z".parse().unwrap();
        let below = subsolar_point(time);
        assert!(below.latitude.degrees().abs() < 0.01, "{below:?}");
        assert!((below.longitude.degrees() + 39.7).abs() < 0.2, "{below:?}");
        for row in night(time).edge() {
            if row.latitude.degrees().abs() < 60.0 {
                // The night loses 0.833 degrees, and more on a parallel farther north.
                let lost_deg = 90.0 - row.half_width.degrees();
                assert!((0.8..1.8).contains(&lost_deg), "{row:?}");
            }
        }
        let noon: Timestamp = "2026-06-21T12:00:00Z".parse().unwrap();
        let solstice = subsolar_point(noon);
        assert!((solstice.latitude.degrees() - 23.44).abs() < 0.01, "{solstice:?}");
        let north = GroundPoint::from_degrees(80.0, 0.0);
        assert!(!night(noon).contains(north) && night(noon).contains(north.antipode()));
    }
}
