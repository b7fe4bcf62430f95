//! A location on the ground.

use serde::{Deserialize, Serialize, Serializer};

use super::{Angle, AzEl, GroundPoint, Refraction, RefractionError};

/// A location on or near the ground, geodetic on WGS84, and the refraction of the air over it.
///
/// A look from a site is the apparent direction, in which an antenna there has to point. Only
/// [`Site::airless`] gives geometric directions. The search for passes is geometric. The site alone
/// decides whether AOS, TCA and LOS have geometric or apparent elevations.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "SiteFields", into = "SiteFields")]
pub struct Site {
    latitude_deg: f64,
    longitude_deg: f64,
    altitude_m: f64,
    refraction: Refraction,
}

/// Reason why coordinates do not make a site.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum SiteError {
    #[error("latitude {0} is not between -90 and 90 degrees")]
    Latitude(f64),
    #[error("longitude {0} is not between -180 and 360 degrees")]
    Longitude(f64),
    /// Altitude out of the range, which covers the Dead Sea and every mountain.
    #[error("altitude {0} is not between -1000 and 10000 m")]
    Altitude(f64),
    #[error(transparent)]
    Refraction(#[from] RefractionError),
}

/// Default site, in Istanbul.
impl Default for Site {
    fn default() -> Self {
        Self {
            latitude_deg: 41.02,
            longitude_deg: 29.17,
            altitude_m: 100.0,
            refraction: Refraction::default(),
        }
    }
}

impl Site {
    /// Creates a site at `latitude_deg` (-90 to 90, north positive), `longitude_deg` (-180 to 360,
    /// east positive) and `altitude_m` above the WGS84 ellipsoid (-1000 to 10000), with the default
    /// refraction.
    pub fn new(latitude_deg: f64, longitude_deg: f64, altitude_m: f64) -> Result<Self, SiteError> {
        // The negated test also refuses NaN.
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
        let refraction = Refraction::default();
        Ok(Self { latitude_deg, longitude_deg, altitude_m, refraction })
    }

    /// Returns the same place with these settings of refraction, which must describe air.
    pub fn with_refraction(self, refraction: Refraction) -> Result<Self, SiteError> {
        refraction.check()?;
        Ok(Self { refraction, ..self })
    }

    /// Returns the same place without refraction: directions from it are geometric.
    #[must_use]
    pub fn airless(self) -> Self {
        Self { refraction: Refraction::none(), ..self }
    }

    pub fn refraction(self) -> Refraction {
        self.refraction
    }

    /// Returns the apparent direction of an object far above the air in the direction `geometric`.
    #[must_use]
    pub fn apparent(self, geometric: AzEl) -> AzEl {
        let air = self.refraction.atmosphere(self.altitude_m);
        air.map_or(geometric, |air| air.apparent_direction(geometric))
    }

    /// Returns the geometric elevation of an object far above the air that appears at `apparent`.
    pub fn geometric_elevation(self, apparent: Angle) -> Angle {
        let air = self.refraction.atmosphere(self.altitude_m);
        air.map_or(apparent, |air| air.geometric(apparent))
    }

    /// Returns the direction `geometric` in the form that passes of this site use: apparent only if
    /// the settings of refraction say so.
    #[must_use]
    pub fn pass_direction(self, geometric: AzEl) -> AzEl {
        if self.refraction.in_passes { self.apparent(geometric) } else { geometric }
    }

    /// Returns the geometric elevation for an elevation that a pass of this site has to reach.
    pub fn geometric_of_pass(self, elevation: Angle) -> Angle {
        if self.refraction.in_passes { self.geometric_elevation(elevation) } else { elevation }
    }

    /// Returns the elevation in passes of this site that corresponds to the antenna elevation
    /// `pointed`: the inverse of [`Self::pointing_of_pass`].
    pub fn pass_elevation(self, pointed: Angle) -> Angle {
        if self.refraction.in_passes { pointed } else { self.geometric_elevation(pointed) }
    }

    /// Returns the direction in which an antenna points for the direction `listed` of a pass.
    #[must_use]
    pub fn pointing_of_pass(self, listed: AzEl) -> AzEl {
        if self.refraction.in_passes { listed } else { self.apparent(listed) }
    }

    /// Returns the geodetic latitude, north positive.
    pub fn latitude(self) -> Angle {
        Angle::from_degrees(self.latitude_deg)
    }

    /// Returns the longitude, east positive, -180 to 180 degrees.
    pub fn longitude(self) -> Angle {
        Angle::from_degrees(self.longitude_deg)
    }

    /// Returns the site without its altitude.
    pub fn point(self) -> GroundPoint {
        GroundPoint::new(self.latitude(), self.longitude())
    }

    /// Returns the height above the ellipsoid, metres.
    pub fn altitude_m(self) -> f64 {
        self.altitude_m
    }
}

impl Site {
    /// Writes a site in the form of a station file. Default settings of refraction are left out, as
    /// in files that are older than these settings.
    pub fn serialize_in_file<S: Serializer>(&self, out: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct InFile {
            latitude_deg: f64,
            longitude_deg: f64,
            altitude_m: f64,
            #[serde(skip_serializing_if = "Option::is_none")]
            refraction: Option<Refraction>,
        }
        let Self { latitude_deg, longitude_deg, altitude_m, refraction } = *self;
        let refraction = Some(refraction).filter(|own| *own != Refraction::default());
        InFile { latitude_deg, longitude_deg, altitude_m, refraction }.serialize(out)
    }
}

/// Form of a site in snapshots and records.
#[derive(Serialize, Deserialize)]
struct SiteFields {
    latitude_deg: f64,
    longitude_deg: f64,
    altitude_m: f64,
    /// Settings of refraction; none in a station file that is older than these settings.
    #[serde(default = "Refraction::none")]
    refraction: Refraction,
}

impl TryFrom<SiteFields> for Site {
    type Error = SiteError;
    fn try_from(fields: SiteFields) -> Result<Self, SiteError> {
        Self::new(fields.latitude_deg, fields.longitude_deg, fields.altitude_m)?
            .with_refraction(fields.refraction)
    }
}

impl From<Site> for SiteFields {
    fn from(site: Site) -> Self {
        let Site { latitude_deg, longitude_deg, altitude_m, refraction } = site;
        Self { latitude_deg, longitude_deg, altitude_m, refraction }
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
