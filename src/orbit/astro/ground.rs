//! Points of the ground and circles around them, by geodetic latitude and longitude.
//!
//! Each point represents its vertical, a unit vector. Distances are therefore angles between
//! verticals. All quantities that depend on the horizon, such as day and night, are exact.

use glam::DVec3;

use super::{Angle, frames::MEAN_RADIUS_KM};

/// Number of steps from the northernmost to the southernmost point of the edge of a cap.
const STEPS: u16 = 90;
/// Max latitude of a cap's centre, degrees. Nearer to a pole, its longitude is undefined.
const POLE_DEG: f64 = 90.0 - 1e-6;

const HALF_TURN: Angle = Angle::from_degrees(180.0);

/// A point of the ground, geodetic on WGS84.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundPoint {
    /// Geodetic latitude, north positive.
    pub latitude: Angle,
    /// Longitude, east positive, from -180 to below 180 degrees.
    pub longitude: Angle,
}

impl GroundPoint {
    pub fn new(latitude: Angle, longitude: Angle) -> Self {
        Self { latitude, longitude: longitude.wrapped_180() }
    }

    pub fn from_degrees(latitude_deg: f64, longitude_deg: f64) -> Self {
        Self::new(Angle::from_degrees(latitude_deg), Angle::from_degrees(longitude_deg))
    }

    /// Returns the point whose vertical is `direction`, an Earth-fixed vector of any length but
    /// zero.
    pub fn below(direction: DVec3) -> Self {
        let from_axis = direction.x.hypot(direction.y);
        Self::new(
            Angle::from_radians(direction.z.atan2(from_axis)),
            Angle::from_radians(direction.y.atan2(direction.x)),
        )
    }

    /// Returns the Earth-fixed unit vector straight up.
    pub fn vertical(self) -> DVec3 {
        let (sin_lat, cos_lat) = self.latitude.radians().sin_cos();
        let (sin_lon, cos_lon) = self.longitude.radians().sin_cos();
        DVec3::new(cos_lat * cos_lon, cos_lat * sin_lon, sin_lat)
    }

    #[must_use]
    pub fn antipode(self) -> Self {
        Self::new(-self.latitude, self.longitude + HALF_TURN)
    }

    /// Returns the angle between the verticals of two points, 0 to 180 degrees.
    pub fn distance(self, other: Self) -> Angle {
        let (a, b) = (self.vertical(), other.vertical());
        Angle::from_radians(a.cross(b).length().atan2(a.dot(b)))
    }

    /// Returns the initial direction of the great circle to `other`, from north through east, 0 to
    /// 360 degrees.
    pub fn bearing(self, other: Self) -> Angle {
        let (sin_from, cos_from) = self.latitude.radians().sin_cos();
        let (sin_to, cos_to) = other.latitude.radians().sin_cos();
        let (sin_east, cos_east) = (other.longitude - self.longitude).radians().sin_cos();
        let north = cos_from * sin_to - sin_from * cos_to * cos_east;
        Angle::from_radians((sin_east * cos_to).atan2(north)).wrapped_360()
    }
}

/// The ground within a given distance of a point. The distance is less than a quarter of the
/// Earth's circumference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cap {
    pub centre: GroundPoint,
    /// Angle from the centre to the edge, above 0 and below 90 degrees.
    pub radius: Angle,
}

/// The part of one parallel in a cap. It extends equally far to both sides of the centre's
/// meridian.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CapRow {
    pub latitude: Angle,
    /// Difference in longitude between the centre and either end; 180 degrees for a whole parallel.
    pub half_width: Angle,
}

impl Cap {
    /// Returns the distance over the ground from the centre to the edge, km.
    pub fn radius_km(&self) -> f64 {
        self.radius.radians() * MEAN_RADIUS_KM
    }

    pub fn contains(&self, point: GroundPoint) -> bool {
        self.centre.distance(point) <= self.radius
    }

    /// Returns the edge from its northernmost to its southernmost point. Each row spans from one
    /// side to the other. If the cap contains a pole, the edge begins or ends where its two sides
    /// meet beyond the pole, with a half width of 180 degrees.
    pub fn edge(&self) -> Vec<CapRow> {
        let centre_deg = self.centre.latitude.degrees().clamp(-POLE_DEG, POLE_DEG);
        let (sin_centre, cos_centre) = centre_deg.to_radians().sin_cos();
        let (sin_radius, cos_radius) = self.radius.radians().sin_cos();
        let row = |step: u16| {
            let bearing = HALF_TURN * (f64::from(step) / f64::from(STEPS));
            let (sin_bearing, cos_bearing) = bearing.radians().sin_cos();
            let sin_latitude = sin_centre * cos_radius + cos_centre * sin_radius * cos_bearing;
            let sin_latitude = sin_latitude.clamp(-1.0, 1.0);
            let across = sin_bearing * sin_radius * cos_centre;
            let along = cos_radius - sin_centre * sin_latitude;
            CapRow {
                latitude: Angle::from_radians(sin_latitude.asin()),
                half_width: Angle::from_radians(across.max(0.0).atan2(along)),
            }
        };
        (0..=STEPS).map(row).collect()
    }

    /// Returns the whole cap from north to south: its edge, and the pole if the cap contains one.
    pub fn rows(&self) -> Vec<CapRow> {
        let mut rows = self.edge();
        let pole = |latitude_deg: f64| CapRow {
            latitude: Angle::from_degrees(latitude_deg),
            half_width: HALF_TURN,
        };
        let quarter = Angle::from_degrees(90.0);
        if self.centre.latitude + self.radius > quarter {
            rows.insert(0, pole(90.0));
        }
        if self.radius - self.centre.latitude > quarter {
            rows.push(pole(-90.0));
        }
        rows
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cap(latitude_deg: f64, longitude_deg: f64, radius_deg: f64) -> Cap {
        let centre = GroundPoint::from_degrees(latitude_deg, longitude_deg);
        Cap { centre, radius: Angle::from_degrees(radius_deg) }
    }

    fn ends(cap: &Cap, row: &CapRow) -> [GroundPoint; 2] {
        [row.half_width, -row.half_width]
            .map(|offset| GroundPoint::new(row.latitude, cap.centre.longitude + offset))
    }

    #[test]
    fn a_point_survives_the_way_over_its_vertical() {
        for latitude in (-90..=90).step_by(15) {
            for longitude in (-180..180).step_by(15) {
                let ground_point =
                    GroundPoint::from_degrees(f64::from(latitude), f64::from(longitude));
                assert!(
                    ground_point.distance(GroundPoint::below(ground_point.vertical())).degrees()
                        < 1e-9
                );
                let far = ground_point.distance(ground_point.antipode()).degrees();
                assert!((far - 180.0).abs() < 1e-6, "{far}");
            }
        }
        assert!((GroundPoint::from_degrees(0.0, 190.0).longitude.degrees() + 170.0).abs() < 1e-9);
    }

    #[test]
    fn a_bearing_leads_along_the_great_circle() {
        let istanbul = GroundPoint::from_degrees(41.0, 29.0);
        for (latitude, longitude, wanted_deg) in
            [(60.0, 29.0, 0.0), (-10.0, 29.0, 180.0), (89.999, -151.0, 0.0), (41.0, 29.001, 90.0)]
        {
            let target = GroundPoint::from_degrees(latitude, longitude);
            let deviation = istanbul.bearing(target) - Angle::from_degrees(wanted_deg);
            assert!(deviation.wrapped_180().degrees().abs() < 0.01, "{latitude} {longitude}");
        }
        // Across the date line, the shorter way is east.
        let fiji = GroundPoint::from_degrees(0.0, 179.0);
        let samoa = GroundPoint::from_degrees(0.0, -172.0);
        assert!((fiji.bearing(samoa).degrees() - 90.0).abs() < 1e-9);
    }

    #[test]
    fn every_point_of_an_edge_is_a_radius_away() {
        for latitude in [-89.0, -60.0, -12.3, 0.0, 41.0, 66.0, 88.0] {
            for radius in [0.5, 23.1, 60.0, 89.17] {
                let cap = cap(latitude, 175.0, radius);
                for row in cap.edge() {
                    for end in ends(&cap, &row) {
                        let deviation = cap.centre.distance(end) - cap.radius;
                        assert!(deviation.degrees().abs() < 1e-6, "{latitude} {radius} {row:?}");
                    }
                }
                let rows = cap.rows();
                let falls = |pair: &[CapRow]| pair[0].latitude >= pair[1].latitude;
                assert!(rows.windows(2).all(falls), "{latitude} {radius}");
            }
        }
    }

    #[test]
    fn a_cap_across_the_date_line_has_points_on_both_sides() {
        let fiji = cap(-17.0, 178.0, 20.0);
        assert!(fiji.contains(GroundPoint::from_degrees(-17.0, -170.0)));
        assert!(fiji.contains(GroundPoint::from_degrees(-17.0, 170.0)));
        assert!(!fiji.contains(GroundPoint::from_degrees(-17.0, -150.0)));
        let rows = fiji.rows();
        assert_eq!(rows.len(), fiji.edge().len(), "no pole");
        // The middle of the cap, at about its own latitude, is some 21 degrees of longitude wide.
        let widest = rows.iter().map(|row| row.half_width.degrees()).fold(0.0, f64::max);
        assert!((widest - 20.95).abs() < 0.1, "{widest}");
        assert!((rows[0].latitude.degrees() - 3.0).abs() < 1e-9);
        assert!((rows.last().unwrap().latitude.degrees() + 37.0).abs() < 1e-9);
        assert!(rows[0].half_width.degrees() < 1e-5);
    }

    #[test]
    fn a_cap_over_a_pole_goes_round_it() {
        for (latitude, pole) in [(80.0, 90.0), (-80.0, -90.0)] {
            let cap = cap(latitude, 30.0, 23.0);
            assert!(cap.contains(GroundPoint::from_degrees(pole, 0.0)));
            assert!(cap.contains(GroundPoint::from_degrees(pole * 77.5 / 90.0, -150.0)));
            assert!(!cap.contains(GroundPoint::from_degrees(pole * 76.5 / 90.0, -150.0)));
            let rows = cap.rows();
            assert_eq!(rows.len(), cap.edge().len() + 1);
            let at_pole = if pole > 0.0 { rows[0] } else { rows[rows.len() - 1] };
            let next_row = if pole > 0.0 { rows[1] } else { rows[rows.len() - 2] };
            assert!((at_pole.latitude.degrees() - pole).abs() < 1e-9);
            assert!((at_pole.half_width.degrees() - 180.0).abs() < 1e-9);
            // The edge beyond the pole lies 13 degrees from it, all the way round.
            assert!((next_row.latitude.degrees().abs() - 77.0).abs() < 1e-9, "{next_row:?}");
            assert!((next_row.half_width.degrees() - 180.0).abs() < 1e-9, "{next_row:?}");
        }
    }

    #[test]
    fn a_cap_around_a_pole_itself_is_round() {
        for row in cap(90.0, 0.0, 20.0).edge() {
            assert!((row.latitude.degrees() - 70.0).abs() < 1e-5, "{row:?}");
        }
    }
}
