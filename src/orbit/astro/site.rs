//! A location on the ground.

use serde::{Deserialize, Serialize};

use super::{Angle, GroundPoint};

/// A location on or near the ground, geodetic on WGS84.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "SiteFields", into = "SiteFields")]
pub struct Site {
    latitude_deg: f64,
    longitude_deg: f64,
    altitude_m: f64,
}

/// The reason why coordinates do not make a site.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum SiteError {
    #[error("latitude {0} is not between -90 and 90 degrees")]
    Latitude(f64),
    #[error("longitude {0} is not between -180 and 360 degrees")]
    Longitude(f64),
    /// The range covers the Dead Sea and every mountain.
    #[error("altitude {0} is not between -1000 and 10000 m")]
    Altitude(f64),
}

/// Istanbul.
impl Default for Site {
    fn default() -> Self {
        Self { latitude_deg: 41.02, longitude_deg: 29.17, altitude_m: 100.0 }
    }
}

impl Site {
    /// A site at `latitude_deg` (-90 to 90, north positive), `longitude_deg`
    /// (-180 to 360, east positive) and `altitude_m` above the WGS84
    /// ellipsoid (-1000 to 10000).
    pub fn new(latitude_deg: f64, longitude_deg: f64, altitude_m: f64) -> Result<Self, SiteError> {
        // Written so that NaN is refused too.
        if !(-90.0..=90.0).contains(&latitude_deg) {
            return Err(SiteError::Latitude(latitude_deg));
        }
        if !(-180.0..=360.0).contains(&longitude_deg) {
            return Err(SiteError::Longitude(longitude_deg));
        }
        if !(-1000.0..=10_000.0).contains(&altitude_m) {
            return Err(SiteError::Altitude(altitude_m));
        }
        let longitude_deg =
            if longitude_deg > 180.0 { longitude_deg - 360.0 } else { longitude_deg };
        Ok(Self { latitude_deg, longitude_deg, altitude_m })
    }

    /// Geodetic latitude, north positive.
    pub fn latitude(self) -> Angle {
        Angle::from_degrees(self.latitude_deg)
    }

    /// Longitude, east positive, -180 to 180 degrees.
    pub fn longitude(self) -> Angle {
        Angle::from_degrees(self.longitude_deg)
    }

    /// The site without its altitude.
    pub fn point(self) -> GroundPoint {
        GroundPoint::new(self.latitude(), self.longitude())
    }

    /// Height above the ellipsoid in metres.
    pub fn altitude_m(self) -> f64 {
        self.altitude_m
    }
}

/// The form of a site in files.
#[derive(Serialize, Deserialize)]
struct SiteFields {
    latitude_deg: f64,
    longitude_deg: f64,
    altitude_m: f64,
}

impl TryFrom<SiteFields> for Site {
    type Error = SiteError;
    fn try_from(fields: SiteFields) -> Result<Self, SiteError> {
        Self::new(fields.latitude_deg, fields.longitude_deg, fields.altitude_m)
    }
}

impl From<Site> for SiteFields {
    fn from(site: Site) -> Self {
        let Site { latitude_deg, longitude_deg, altitude_m } = site;
        Self { latitude_deg, longitude_deg, altitude_m }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_on_the_ground_is_refused() {
        assert_eq!(Site::new(90.5, 0.0, 0.0), Err(SiteError::Latitude(90.5)));
        assert!(Site::new(f64::NAN, 0.0, 0.0).is_err());
        assert!(Site::new(0.0, 0.0, f64::INFINITY).is_err());
        let west = Site::new(0.0, 359.0, 0.0).unwrap();
        assert!((west.longitude().degrees() + 1.0).abs() < 1e-12);
    }
}
