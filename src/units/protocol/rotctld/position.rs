//! Positions and limits, in degrees.

/// A finite position of both axes, degrees. The range depends on the rotator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Position {
    azimuth_deg: f64,
    elevation_deg: f64,
}

/// A number that is not finite.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{0} is no angle")]
pub struct PositionError(f64);

impl Position {
    /// Returns a position at these angles, degrees; an error for an angle that is not finite.
    pub fn new(azimuth_deg: f64, elevation_deg: f64) -> Result<Self, PositionError> {
        match [azimuth_deg, elevation_deg].into_iter().find(|angle| !angle.is_finite()) {
            Some(angle) => Err(PositionError(angle)),
            None => Ok(Self { azimuth_deg, elevation_deg }),
        }
    }

    pub const fn azimuth_deg(self) -> f64 {
        self.azimuth_deg
    }

    pub const fn elevation_deg(self) -> f64 {
        self.elevation_deg
    }
}

/// Returns the number of an argument or an answer; `None` unless the text is a finite number.
pub(super) fn number(text: &str) -> Option<f64> {
    // Gpredict writes numbers in the locale of its user, so the decimal sign may be a comma.
    let number: f64 = text.replace(',', ".").parse().ok()?;
    number.is_finite().then_some(number)
}

/// Angles that a rotator can reach, degrees; each end is finite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    pub min_azimuth_deg: f64,
    pub max_azimuth_deg: f64,
    pub min_elevation_deg: f64,
    pub max_elevation_deg: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_position_has_finite_angles() {
        let position = Position::new(10.5, -1.0).unwrap();
        assert_eq!((position.azimuth_deg(), position.elevation_deg()), (10.5, -1.0));
        assert!(Position::new(f64::NAN, 1.0).is_err());
        assert_eq!(Position::new(1.0, f64::INFINITY), Err(PositionError(f64::INFINITY)));
    }

    #[test]
    fn numbers_may_have_a_comma_or_an_exponent() {
        let read = ["10", "10.25", "10,25", "-1e1", "+3", ".5"].map(number);
        assert_eq!(read, [10.0, 10.25, 10.25, -10.0, 3.0, 0.5].map(Some));
        for bad in ["", "nan", "inf", "-inf", "1.2.3", "1,000.5", "ten", "0x10", "1e999"] {
            assert_eq!(number(bad), None, "{bad}");
        }
    }
}
