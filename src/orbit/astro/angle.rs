//! An angle type that hides its unit.

use std::ops::{Add, Mul, Neg, Sub};

use serde::{Deserialize, Serialize};

/// A plane angle, stored and serialised in radians. Operations never wrap it implicitly.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Default, Serialize, Deserialize)]
pub struct Angle(f64);

impl Angle {
    pub const ZERO: Self = Self(0.0);

    pub const fn from_radians(radians: f64) -> Self {
        Self(radians)
    }

    pub const fn from_degrees(degrees: f64) -> Self {
        Self(degrees.to_radians())
    }

    pub const fn radians(self) -> f64 {
        self.0
    }

    pub const fn degrees(self) -> f64 {
        self.0.to_degrees()
    }

    /// Returns the same direction in the range from 0 up to, not including, 360 degrees.
    #[must_use]
    pub fn wrapped_360(self) -> Self {
        // Most angles are in that range, and a division is slow.
        if (0.0..std::f64::consts::TAU).contains(&self.0) {
            return self;
        }
        let turned = self.0.rem_euclid(std::f64::consts::TAU);
        // A tiny negative angle rounds up to the full turn.
        Self(if turned >= std::f64::consts::TAU { 0.0 } else { turned })
    }

    /// Returns the same direction in the range from -180 up to, not including, 180 degrees.
    #[must_use]
    pub fn wrapped_180(self) -> Self {
        let half = std::f64::consts::PI;
        Self(Self(self.0 + half).wrapped_360().0 - half)
    }

    #[must_use]
    pub fn abs(self) -> Self {
        Self(self.0.abs())
    }

    pub fn is_finite(self) -> bool {
        self.0.is_finite()
    }
}

impl Add for Angle {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Sub for Angle {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl Neg for Angle {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Mul<f64> for Angle {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self(self.0 * factor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrapping_keeps_the_direction_and_the_half_open_range() {
        for (degrees, full, half) in [
            (0.0, 0.0, 0.0),
            (360.0, 0.0, 0.0),
            (-10.0, 350.0, -10.0),
            (180.0, 180.0, -180.0),
            (725.0, 5.0, 5.0),
        ] {
            let angle = Angle::from_degrees(degrees);
            assert!((angle.wrapped_360().degrees() - full).abs() < 1e-9, "{degrees}");
            assert!((angle.wrapped_180().degrees() - half).abs() < 1e-9, "{degrees}");
        }
        assert!(Angle::from_radians(-1e-20).wrapped_360().radians() < 1.0);
    }
}
