//! Refraction of radio waves in the troposphere: the difference between the apparent and the
//! geometric elevation of a satellite.
//!
//! Source: Recommendation ITU-R P.834-9, annex 1, equation (1), for the bending of a ray through
//! spherical layers. This module integrates it over the exponential atmosphere of Recommendation
//! ITU-R P.453-14 (refractivity 315 at sea level, scale height 7.35 km). The closed formulas of
//! P.834 hold only for that refractivity, up to 3 km and up to 10 degrees; the integral needs no
//! such limits. Refractivity of measured air: P.453-14, equations (6) and (9).
//!
//! Neglected: ducts, rain, the ionosphere (below 0.01 degrees above 100 MHz at 10 degrees), and the
//! path within the atmosphere of a satellite that is below 60 km.

use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

use super::{Angle, AzEl};

/// Refractivity at sea level, and scale height (P.453-14). The refractivity falls to the part 1/e
/// within this height.
const SEA_LEVEL_N: f64 = 315.0;
const SCALE_HEIGHT_KM: f64 = 7.35;
/// Max refractivity. P.453-14 maps at most 400 on average near the ground. Twice this limit would
/// bend rays round the Earth, and one true direction would have several apparent directions.
const MAX_N: f64 = 500.0;
/// Radius of the Earth in P.834, km.
const EARTH_KM: f64 = 6_370.0;
/// Number of scale heights above which only a millionth of the air is left to bend a ray.
const TOP: f64 = 14.0;
/// Angle below the horizontal at which refraction has faded out, degrees. Rays below the horizontal
/// end at the ground, except at sites on mountains.
const FADE_DEG: f64 = 5.0;
/// Accuracy of an apparent elevation, radians, and max number of iterations.
const TOLERANCE: f64 = 1e-10;
const ROUNDS: usize = 20;

/// Nodes and weights of the Gauss-Legendre rule with 10 points, each for both signs. More points
/// change the bending by at most 6e-6 degrees.
const RULE: [(f64, f64); 5] = [
    (0.148_874_338_981_631_2, 0.295_524_224_714_752_9),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_3),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_1),
];

/// Air model for the refraction at a site.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Air {
    /// No refraction: directions are geometric.
    None,
    /// Mean air of the Earth at the height of the site.
    #[default]
    Standard,
    /// Pressure, temperature and humidity that the operator entered.
    Measured,
}

/// Settings of refraction at a site.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Refraction {
    pub air: Air,
    /// Pressure at the height of the site, not reduced to sea level; 300 to 1100 hPa.
    pub pressure_hpa: f64,
    /// Temperature, -90 to 60 degrees Celsius.
    pub temperature_c: f64,
    /// Relative humidity, 0 to 100 percent.
    pub humidity_percent: f64,
    /// AOS, TCA and LOS of passes use apparent instead of geometric elevations.
    pub in_passes: bool,
}

/// Reason why settings describe no air.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum RefractionError {
    #[error("refraction.pressure_hpa {0} is not between 300 and 1100")]
    Pressure(f64),
    #[error("refraction.temperature_c {0} is not between -90 and 60")]
    Temperature(f64),
    #[error("refraction.humidity_percent {0} is not between 0 and 100")]
    Humidity(f64),
    #[error(
        "the refractivity of such air would be {0:.0}, and is not above 500 anywhere; lower \
         refraction.humidity_percent or refraction.temperature_c"
    )]
    Refractivity(f64),
}

/// Standard air for pointing, and geometric passes. The weather values come from the International
/// Standard Atmosphere at sea level, with the humidity of refractivity 315.
impl Default for Refraction {
    fn default() -> Self {
        Self {
            air: Air::Standard,
            pressure_hpa: 1013.25,
            temperature_c: 15.0,
            humidity_percent: 55.0,
            in_passes: false,
        }
    }
}

impl Refraction {
    /// Range of the pressure at the height of the site, hPa.
    pub const PRESSURE_HPA: RangeInclusive<f64> = 300.0..=1100.0;
    pub const TEMPERATURE_C: RangeInclusive<f64> = -90.0..=60.0;
    pub const HUMIDITY_PERCENT: RangeInclusive<f64> = 0.0..=100.0;

    /// Returns settings without refraction in pointing and passes.
    pub fn none() -> Self {
        Self { air: Air::None, ..Self::default() }
    }

    /// Checks that each value is in its range and that the air can occur. The check includes values
    /// that the selected air model ignores.
    pub fn check(&self) -> Result<(), RefractionError> {
        // The negated test also refuses NaN.
        if !Self::PRESSURE_HPA.contains(&self.pressure_hpa) {
            return Err(RefractionError::Pressure(self.pressure_hpa));
        }
        if !Self::TEMPERATURE_C.contains(&self.temperature_c) {
            return Err(RefractionError::Temperature(self.temperature_c));
        }
        if !Self::HUMIDITY_PERCENT.contains(&self.humidity_percent) {
            return Err(RefractionError::Humidity(self.humidity_percent));
        }
        let measured = self.measured_n();
        if measured > MAX_N { Err(RefractionError::Refractivity(measured)) } else { Ok(()) }
    }

    /// Returns the atmosphere over a site at `altitude_m`; `None` without refraction.
    pub(super) fn atmosphere(&self, altitude_m: f64) -> Option<Atmosphere> {
        let altitude_km = altitude_m / 1000.0;
        let refractivity = match self.air {
            Air::None => return None,
            Air::Standard => SEA_LEVEL_N * (-altitude_km / SCALE_HEIGHT_KM).exp(),
            Air::Measured => self.measured_n(),
        };
        Some(Atmosphere { excess: 1e-6 * refractivity, radius_km: EARTH_KM + altitude_km })
    }

    fn measured_n(&self) -> f64 {
        let (p, t) = (self.pressure_hpa, self.temperature_c);
        let kelvin = t + 273.15;
        let enhancement = 1.0 + 1e-4 * (7.2 + p * (0.0320 + 5.9e-6 * t * t));
        let saturation_hpa = enhancement * 6.1121 * ((18.678 - t / 234.5) * t / (t + 257.14)).exp();
        let vapour_hpa = self.humidity_percent / 100.0 * saturation_hpa;
        77.6 * p / kelvin - 5.6 * vapour_hpa / kelvin + 3.75e5 * vapour_hpa / (kelvin * kelvin)
    }
}

/// Spherical layers over a site.
#[derive(Debug, Clone, Copy)]
pub(super) struct Atmosphere {
    /// Refractive index at the site minus one.
    excess: f64,
    /// Distance of the site from the centre of the Earth, km.
    radius_km: f64,
}

impl Atmosphere {
    /// Returns the geometric elevation of a satellite that appears at `apparent`. The result rises
    /// with `apparent`.
    pub(super) fn geometric(self, apparent: Angle) -> Angle {
        Angle::from_radians(apparent.radians() - self.bending(apparent.radians()))
    }

    /// Returns the apparent elevation of a satellite at the elevation `geometric`: the inverse of
    /// [`Self::geometric`].
    pub(super) fn apparent(self, geometric: Angle) -> Angle {
        let geometric = geometric.radians();
        let error = |apparent: f64| apparent - self.bending(apparent) - geometric;
        let (mut before, mut off_before) = (geometric, error(geometric));
        let mut here = geometric - off_before;
        for _ in 0..ROUNDS {
            let deviation = error(here);
            let change = deviation - off_before;
            if deviation.abs() < TOLERANCE || change.abs() < f64::EPSILON {
                break;
            }
            let next = here - deviation * (here - before) / change;
            (before, off_before, here) = (here, deviation, next);
        }
        Angle::from_radians(here)
    }

    /// Returns the apparent direction of a satellite in the direction `geometric`.
    pub(super) fn apparent_direction(self, geometric: AzEl) -> AzEl {
        AzEl { elevation: self.apparent(geometric.elevation), ..geometric }
    }

    /// Returns the whole bending of a ray that arrives at `elevation`, all in radians.
    fn bending(self, elevation: f64) -> f64 {
        let share = 1.0 + elevation / FADE_DEG.to_radians();
        if share <= 0.0 {
            0.0
        } else if elevation < 0.0 {
            share * self.bending_above(0.0)
        } else {
            self.bending_above(elevation)
        }
    }

    /// Returns the integral of P.834 over the height `h`. The square of the vertical part of the
    /// ray, `(n r)² - (n₀ r₀ cos θ)²`, is nearly `b (h + σ²)`. The substitution `h = s² + 2 s σ`
    /// therefore leaves a smooth function of `s`, even where the ray begins level.
    fn bending_above(self, elevation: f64) -> f64 {
        let Self { excess, radius_km } = self;
        let (sin, cos) = elevation.sin_cos();
        let at_site = (1.0 + excess) * radius_km;
        let b = 2.0 * at_site * (1.0 + excess - radius_km * excess / SCALE_HEIGHT_KM);
        let rise = at_site * sin;
        let sigma = rise / b.sqrt();
        let top_km = TOP * SCALE_HEIGHT_KM;
        let half = 0.5 * top_km / ((sigma * sigma + top_km).sqrt() + sigma);
        let part = |s: f64| {
            let height_km = s * (s + 2.0 * sigma);
            let thinner = (-height_km / SCALE_HEIGHT_KM).exp_m1();
            let here = (1.0 + excess * (1.0 + thinner)) * (radius_km + height_km);
            let farther =
                height_km * (1.0 + excess * (1.0 + thinner)) + radius_km * excess * thinner;
            let vertical = (farther * (here + at_site) + rise * rise).sqrt();
            let index = 1.0 + excess * (1.0 + thinner);
            (1.0 + thinner) / index * 2.0 * (s + sigma) / vertical
        };
        let sum: f64 = RULE
            .iter()
            .map(|(node, weight)| weight * (part(half * (1.0 + node)) + part(half * (1.0 - node))))
            .sum();
        excess / SCALE_HEIGHT_KM * at_site * cos * half * sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sea_level(refractivity: f64) -> Atmosphere {
        Atmosphere { excess: 1e-6 * refractivity, radius_km: 6370.0 }
    }

    fn deg(degrees: f64) -> Angle {
        Angle::from_degrees(degrees)
    }

    #[test]
    fn apparent_elevations_rise_with_geometric_ones_and_lead_back_to_them() {
        for refractivity in [60.0, 200.0, 315.0, 400.0, 500.0] {
            let air = sea_level(refractivity);
            let mut before = f64::NEG_INFINITY;
            for step in -18_000..=18_000 {
                let geometric_deg = f64::from(step) / 200.0;
                let apparent = air.apparent(deg(geometric_deg));
                let back_deg = air.geometric(apparent).degrees();
                assert!((back_deg - geometric_deg).abs() < 1e-8, "{geometric_deg}: {back_deg}");
                assert!(apparent.degrees() > before, "{refractivity} {geometric_deg}");
                assert!(apparent.degrees() >= geometric_deg - 1e-9);
                before = apparent.degrees();
            }
        }
    }

    #[test]
    fn the_integral_agrees_with_the_closed_formulas_of_the_recommendation() {
        // Source: P.834-9, equations (8) and (13), for 0 to 10 degrees and 0 to 3 km.
        for altitude_km in [0.0, 1.0, 2.0, 3.0] {
            let air = Refraction::default().atmosphere(1000.0 * altitude_km).unwrap();
            for step in 0..=100 {
                let (e, h) = (f64::from(step) / 10.0, altitude_km);
                let of_apparent_deg = 1.0
                    / (1.314
                        + 0.6437 * e
                        + 0.028_69 * e * e
                        + h * (0.2305 + 0.094_28 * e + 0.010_96 * e * e)
                        + 0.008_583 * h * h);
                let deviation = e - air.geometric(deg(e)).degrees() - of_apparent_deg;
                assert!(deviation.abs() < 0.03, "{h} km, apparent {e}: {deviation}");
                let of_geometric_deg = 1.0
                    / (1.728
                        + 0.5411 * e
                        + 0.037_23 * e * e
                        + h * (0.1815 + 0.062_72 * e + 0.013_80 * e * e)
                        + h * h * (0.017_27 + 0.008_288 * e));
                let difference = air.apparent(deg(e)).degrees() - e - of_geometric_deg;
                assert!(difference.abs() < 0.03, "{h} km, geometric {e}: {difference}");
            }
        }
    }

    #[test]
    fn air_has_the_refractivity_of_the_recommendation() {
        // P.453 gives dry and wet term of air at 1000 hPa, 300 K and 20 hPa of vapour.
        let humid = Refraction {
            pressure_hpa: 1000.0,
            temperature_c: 26.85,
            humidity_percent: 100.0 * 20.0 / 35.4,
            ..Refraction::default()
        };
        assert!((humid.measured_n() - 341.6).abs() < 1.0, "{}", humid.measured_n());
        let standard = Refraction::default().measured_n();
        assert!((standard - 315.0).abs() < 3.0, "{standard}");
    }

    #[test]
    fn air_that_does_not_occur_is_refused() {
        let refused = |change: fn(&mut Refraction)| {
            let mut refraction = Refraction::default();
            change(&mut refraction);
            refraction.check().unwrap_err().to_string()
        };
        assert!(refused(|air| air.pressure_hpa = 29.9).contains("pressure_hpa 29.9"));
        assert!(refused(|air| air.temperature_c = f64::NAN).contains("temperature_c NaN"));
        assert!(refused(|air| air.humidity_percent = 101.0).contains("humidity_percent 101"));
        let hot = refused(|air| (air.temperature_c, air.humidity_percent) = (60.0, 100.0));
        assert!(hot.contains("refractivity"), "{hot}");
        assert_eq!(Refraction::default().check(), Ok(()));
    }
}
