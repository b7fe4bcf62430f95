//! How far the air lifts what is seen through it.
//!
//! Source: Sæmundsson, "Atmospheric refraction", Sky and Telescope 72 (1986),
//! for visible light. Radio waves are bent up to a fifth more, by the water in
//! the air.

use super::Angle;

/// The air at the site.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Air {
    /// Pressure at the site, not reduced to sea level, in hPa.
    pub pressure_hpa: f64,
    /// Temperature in degrees Celsius.
    pub temperature_c: f64,
}

/// The air the formula was made for: 1010 hPa and 10 degrees.
impl Default for Air {
    fn default() -> Self {
        Self { pressure_hpa: 1010.0, temperature_c: 10.0 }
    }
}

/// Elevations further below the horizon than this see no sky.
const LOWEST_DEG: f64 = -1.0;

impl Air {
    /// What to add to a geometric elevation to get the apparent one: 0.48 degrees
    /// at the horizon, 0.09 at 10 degrees, nothing at the zenith, in air of
    /// 1010 hPa and 10 degrees. Fades out between 1 and 2 degrees below the horizon.
    pub fn refraction(self, elevation: Angle) -> Angle {
        let elevation_deg = elevation.degrees();
        let seen_deg = elevation_deg.clamp(LOWEST_DEG, 90.0);
        let argument = Angle::from_degrees(seen_deg + 10.3 / (seen_deg + 5.11));
        let minutes = 1.02 / argument.radians().tan();
        let density = self.pressure_hpa / 1010.0 * 283.0 / (273.0 + self.temperature_c);
        let fading = (1.0 + elevation_deg - LOWEST_DEG).clamp(0.0, 1.0);
        // The formula passes through nothing a little short of the zenith.
        Angle::from_degrees(fading * density * minutes.max(0.0) / 60.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lifted_deg(elevation_deg: f64) -> f64 {
        Air::default().refraction(Angle::from_degrees(elevation_deg)).degrees()
    }

    #[test]
    fn the_air_lifts_most_at_the_horizon() {
        // Meeus, "Astronomical Algorithms", example 16.a: the Sun's lower limb,
        // apparent 0.5 degrees, is lifted by 28.75 arc minutes (by another
        // formula, which agrees within 0.1).
        let apparent_deg = 0.5;
        let true_deg = apparent_deg - 28.754 / 60.0;
        assert!((lifted_deg(true_deg) - 28.754 / 60.0).abs() < 0.1 / 60.0);
        assert!((lifted_deg(10.0) - 0.09).abs() < 0.003, "{}", lifted_deg(10.0));
        assert!(lifted_deg(90.0).abs() < 1e-3);
        assert!(lifted_deg(-2.0).abs() < 1e-12);
    }

    #[test]
    fn what_stands_higher_is_seen_higher() {
        let mut last_deg = -91.0;
        for tenth in -900..=900 {
            let elevation_deg = f64::from(tenth) / 10.0;
            let seen_deg = elevation_deg + lifted_deg(elevation_deg);
            assert!(seen_deg > last_deg, "{elevation_deg}");
            last_deg = seen_deg;
        }
    }

    #[test]
    fn thin_and_warm_air_bends_less() {
        let air = Air { pressure_hpa: 505.0, temperature_c: 10.0 };
        let half = air.refraction(Angle::ZERO).degrees() / lifted_deg(0.0);
        assert!((half - 0.5).abs() < 1e-12);
        let warm = Air { temperature_c: 40.0, ..Air::default() };
        assert!(warm.refraction(Angle::ZERO).degrees() < lifted_deg(0.0));
    }
}
