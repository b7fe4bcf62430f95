//! The point below a satellite, its footprint and its ground track.

use jiff::Timestamp;

use super::{Propagator, State};
use crate::astro::{Angle, Cap, GroundPoint, frames, frames::MEAN_RADIUS_KM, time::add_seconds};

/// The point below a satellite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SubPoint {
    pub point: GroundPoint,
    /// Height of the satellite above the ellipsoid, km.
    pub height_km: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackPoint {
    pub time: Timestamp,
    pub point: GroundPoint,
}

impl State {
    /// Returns the point below a satellite in this state at `time`.
    pub fn sub_point(&self, time: Timestamp) -> SubPoint {
        let (point, height_km) = frames::geodetic(frames::teme_to_ecef(time) * self.position_km);
        SubPoint { point, height_km }
    }
}

impl SubPoint {
    /// Returns the ground from which the satellite is seen at `elevation` (0 to 90 degrees) or
    /// higher, on a sphere. The flattening of the Earth moves the edge of this ground by up to a
    /// third of a degree.
    pub fn footprint(&self, elevation: Angle) -> Cap {
        let cos_nadir = MEAN_RADIUS_KM * elevation.radians().cos();
        let from_centre_km = MEAN_RADIUS_KM + self.height_km.max(0.0);
        let radius = (cos_nadir / from_centre_km).clamp(0.0, 1.0).acos() - elevation.radians();
        Cap { centre: self.point, radius: Angle::from_radians(radius.max(0.0)) }
    }
}

impl Propagator {
    /// Returns the ground track from `start` onwards: `count` points, `step_s` seconds apart. The
    /// track ends early if the orbit does.
    pub fn ground_track(&self, start: Timestamp, step_s: f64, count: u32) -> Vec<TrackPoint> {
        let times = (0..count).map(|step| add_seconds(start, f64::from(step) * step_s));
        let point = |time| {
            let state = self.state_at(time).ok()?;
            Some(TrackPoint { time, point: state.sub_point(time).point })
        };
        times.map_while(point).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{astro::Site, bundled};

    const TIME: &str = "2026-08-12T11:15:30Z";

    fn propagator(number: u32) -> Propagator {
        Propagator::new(bundled().unwrap().get(number).unwrap()).unwrap()
    }

    fn site(point: GroundPoint) -> Site {
        Site::new(point.latitude.degrees(), point.longitude.degrees(), 0.0).unwrap().airless()
    }

    #[test]
    fn a_satellite_is_in_the_zenith_of_the_point_below_it() {
        let time: Timestamp = TIME.parse().unwrap();
        // The orbits are low, of half a day and geosynchronous.
        for number in [25_544, 43_013, 24_876, 54_743] {
            let propagator = propagator(number);
            let below = propagator.state_at(time).unwrap().sub_point(time);
            let look = propagator.look_from(site(below.point), time).unwrap();
            assert!(look.direction.elevation_deg() > 89.999, "{number} {look:?}");
            assert!((look.range_km - below.height_km).abs() < 1e-3, "{number} {below:?}");
        }
    }

    #[test]
    fn a_footprint_ends_where_the_satellite_stands_at_its_elevation() {
        let time: Timestamp = TIME.parse().unwrap();
        for number in [25_544, 43_013, 54_743] {
            let propagator = propagator(number);
            let below = propagator.state_at(time).unwrap().sub_point(time);
            for elevation_deg in [0.0, 5.0, 20.0] {
                let footprint = below.footprint(Angle::from_degrees(elevation_deg));
                for row in footprint.edge() {
                    let longitude = footprint.centre.longitude + row.half_width;
                    let edge = GroundPoint::new(row.latitude, longitude);
                    let look = propagator.look_from(site(edge), time).unwrap();
                    let off_deg = look.direction.elevation_deg() - elevation_deg;
                    assert!(off_deg.abs() < 0.35, "{number} {elevation_deg} {off_deg}");
                }
            }
        }
        // A height of 826 km gives a radius of 2570 km at 5 degrees.
        let below = SubPoint { point: GroundPoint::from_degrees(0.0, 0.0), height_km: 826.0 };
        let wide_km = below.footprint(Angle::from_degrees(5.0)).radius_km();
        assert!((wide_km - 2_570.0).abs() < 30.0, "{wide_km}");
    }

    #[test]
    fn a_track_follows_the_satellite_and_ends_with_its_orbit() {
        let time: Timestamp = TIME.parse().unwrap();
        let noaa_20 = propagator(43_013);
        let track = noaa_20.ground_track(time, 20.0, 600);
        assert_eq!(track.len(), 600);
        for point in track.iter().step_by(50) {
            let below = noaa_20.state_at(point.time).unwrap().sub_point(point.time);
            assert_eq!(below.point, point.point);
        }
        // The inclination is 98.7 degrees.
        let north = track
            .iter()
            .map(|track_point| track_point.point.latitude.degrees())
            .fold(-90.0, f64::max);
        assert!((north - 81.4).abs() < 0.4, "{north}");
        let end: Timestamp = "2200-01-01T00:00:00Z".parse().unwrap();
        assert_eq!(noaa_20.ground_track(end, 20.0, 10), []);
    }

    #[test]
    fn a_geostationary_satellite_stays_over_its_place() {
        // Turksat 5A at 31 degrees east.
        let time: Timestamp = TIME.parse().unwrap();
        let catalog = bundled().unwrap();
        let turksat =
            catalog.iter().find(|elements| elements.name().starts_with("TURKSAT 5A")).unwrap();
        let track = Propagator::new(turksat).unwrap().ground_track(time, 3600.0, 24);
        for TrackPoint { point, .. } in track {
            assert!((point.longitude.degrees() - 31.0).abs() < 0.2, "{point:?}");
            assert!(point.latitude.degrees().abs() < 0.2, "{point:?}");
        }
    }
}
