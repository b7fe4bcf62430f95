//! Conversion between the counts of a position sensor and degrees, from points that the operator
//! has measured.

use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

use super::settings::Unfit;

/// Valid angles of a measured point, degrees of the mount.
const RANGE_DEG: RangeInclusive<f64> = -360.0..=1440.0;

/// A sensor count and the angle at which it was read.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CountPoint {
    /// Counts as on the front panel, 0 to 65535.
    pub counts: u16,
    /// Angle in degrees of the mount.
    pub degrees: f64,
}

impl CountPoint {
    /// Checks that points in any order make a scale; returns the reason if they do not. An empty
    /// list is valid: the scale is not known yet.
    pub(crate) fn check(points: &[Self]) -> Result<(), Unfit> {
        if points.is_empty() {
            return Ok(());
        }
        if !points.iter().all(|point| RANGE_DEG.contains(&point.degrees)) {
            let words =
                format!("must hold angles from {} to {}°", RANGE_DEG.start(), RANGE_DEG.end());
            return Err(Unfit::Text(words.replace('-', "−")));
        }
        CountLine::from_points(points).map(|_| ()).map_err(|error| {
            Unfit::Text(match error {
                CalibrationError::TooFew => "must hold two points or more, or none".to_owned(),
                CalibrationError::SameCounts(counts) => {
                    format!("must not hold {counts} counts twice")
                }
                CalibrationError::Flat => "must hold angles that change with the counts".to_owned(),
            })
        })
    }
}

/// Min slope of a line, degrees a count: a smaller slope is only noise.
const FLAT_DEG: f64 = 1e-6;

/// The straight line that fits measured points best (least squares).
///
/// The degrees of the mount are not wrapped: 370 is another position than 10.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CountLine {
    centre_counts: f64,
    centre_deg: f64,
    deg_per_count: f64,
}

/// Reason why no line fits the points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum CalibrationError {
    /// Fewer than two points.
    #[error("two points are needed")]
    TooFew,
    /// Two points with the same counts.
    #[error("{0} counts appear twice")]
    SameCounts(u16),
    /// Degrees that do not change with the counts, or are not numbers.
    #[error("the degrees do not change with the counts")]
    Flat,
}

impl CountLine {
    /// Returns the line through two or more points, in any order.
    pub fn from_points(points: &[CountPoint]) -> Result<Self, CalibrationError> {
        let mut counts: Vec<u16> = points.iter().map(|point| point.counts).collect();
        counts.sort_unstable();
        let twice = counts.iter().zip(counts.iter().skip(1)).find(|(a, b)| a == b);
        if let Some((counts, _)) = twice {
            return Err(CalibrationError::SameCounts(*counts));
        }
        if points.len() < 2 {
            return Err(CalibrationError::TooFew);
        }
        let mean = |value: fn(&CountPoint) -> f64| {
            points.iter().map(value).sum::<f64>() / points.len() as f64
        };
        let centre_counts = mean(|point| point.counts.into());
        let centre_deg = mean(|point| point.degrees);
        // The sums count from the centre, because large counts would cost digits.
        let (across, along) = points.iter().fold((0.0, 0.0), |(across, along), point| {
            let deviation = f64::from(point.counts) - centre_counts;
            (across + deviation * (point.degrees - centre_deg), along + deviation * deviation)
        });
        let deg_per_count = across / along;
        // The condition also refuses NaN.
        if deg_per_count.abs() >= FLAT_DEG && deg_per_count.is_finite() {
            Ok(Self { centre_counts, centre_deg, deg_per_count })
        } else {
            Err(CalibrationError::Flat)
        }
    }

    /// Returns the angle at which the sensor has these counts, degrees of the mount.
    pub fn degrees(&self, counts: u16) -> f64 {
        self.centre_deg + (f64::from(counts) - self.centre_counts) * self.deg_per_count
    }

    /// Returns the counts nearest to an angle in degrees of the mount; `None` outside 0 to 65535.
    pub fn counts(&self, degrees: f64) -> Option<u16> {
        let counts = self.centre_counts + (degrees - self.centre_deg) / self.deg_per_count;
        let counts = counts.round();
        (0.0..=f64::from(u16::MAX)).contains(&counts).then_some(counts as u16)
    }

    /// Returns `true` if the angle grows while the counts fall.
    pub fn is_reversed(&self) -> bool {
        self.deg_per_count < 0.0
    }

    /// Returns how far each point lies above the line, degrees, in the order of `points`.
    pub fn residuals_deg(&self, points: &[CountPoint]) -> Vec<f64> {
        points.iter().map(|point| point.degrees - self.degrees(point.counts)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(pairs: &[(u16, f64)]) -> Vec<CountPoint> {
        pairs.iter().map(|&(counts, degrees)| CountPoint { counts, degrees }).collect()
    }

    #[test]
    fn two_points_make_a_line_that_goes_past_north() {
        let line = CountLine::from_points(&points(&[(30, 0.0), (9030, 450.0)])).unwrap();
        assert!((line.degrees(7430) - 370.0).abs() < 1e-9);
        assert_eq!((line.counts(370.0), line.counts(10.0)), (Some(7430), Some(230)));
        assert!(!line.is_reversed());
    }

    #[test]
    fn every_count_comes_back_also_where_the_angle_falls() {
        let line = CountLine::from_points(&points(&[(65_535, -12.5), (0, 181.25)])).unwrap();
        assert!(line.is_reversed());
        for counts in 0..=u16::MAX {
            assert_eq!(line.counts(line.degrees(counts)), Some(counts));
        }
        assert_eq!((line.counts(181.3), line.counts(-13.0)), (None, None));
    }

    #[test]
    fn more_points_are_fitted_and_each_tells_how_far_it_is_off() {
        let measured = points(&[(1000, 10.0), (2000, 20.3), (3000, 30.0)]);
        let line = CountLine::from_points(&measured).unwrap();
        let residuals = line.residuals_deg(&measured);
        for (residual, expected) in residuals.iter().zip([-0.1, 0.2, -0.1]) {
            assert!((residual - expected).abs() < 1e-9, "{residuals:?}");
        }
    }

    #[test]
    fn what_makes_no_line_is_refused_with_the_reason() {
        let refused = |pairs: &[(u16, f64)]| CountLine::from_points(&points(pairs)).unwrap_err();
        assert_eq!(refused(&[]), CalibrationError::TooFew);
        assert_eq!(refused(&[(30, 0.0)]), CalibrationError::TooFew);
        assert_eq!(refused(&[(30, 0.0), (40, 1.0), (30, 2.0)]), CalibrationError::SameCounts(30));
        assert_eq!(refused(&[(30, 7.0), (40, 7.0)]), CalibrationError::Flat);
        assert_eq!(refused(&[(30, f64::NAN), (40, 7.0)]), CalibrationError::Flat);
    }

    #[test]
    fn a_scale_has_two_points_and_a_slope() {
        let check = |points: &[(u16, f64)]| {
            let points = points.iter().map(|&(counts, degrees)| CountPoint { counts, degrees });
            CountPoint::check(&points.collect::<Vec<_>>())
        };
        assert_eq!(check(&[]), Ok(()));
        assert_eq!(check(&[(100, 90.0), (300, 270.0), (200, 181.0)]), Ok(()));
        assert_eq!(check(&[(100, 90.0), (300, -90.0)]), Ok(()));
        for bad in [
            &[(100, 90.0)][..],
            &[(100, 90.0), (100, 91.0)],
            &[(100, 90.0), (200, 90.0)],
            &[(100, 90.0), (200, 9000.0)],
            &[(100, f64::NAN), (200, 90.0)],
        ] {
            assert!(check(bad).is_err(), "{bad:?}");
        }
    }
}
