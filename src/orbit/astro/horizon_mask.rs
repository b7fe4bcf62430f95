//! The horizon mask of a site: the elevation, by azimuth, below which hills, walls and trees
//! block the sky.

mod import;

use std::fmt;

use serde::{Deserialize, Serialize};

pub use import::{MaskForm, MaskImportError};

use super::Angle;

/// Maximum number of points in a mask: one every twentieth of a degree.
pub const MAX_MASK_POINTS: usize = 7200;

const TURN_DEG: f64 = 360.0;

/// Elevation by azimuth, with straight lines between the points and, across north, from the last
/// point to the first. A single point makes a level horizon.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Vec<(f64, f64)>", into = "Vec<(f64, f64)>")]
pub struct HorizonMask {
    /// Azimuth from 0 to below 360, ascending, and elevation, in degrees.
    points: Vec<(f64, f64)>,
}

/// The reason why points do not make a mask.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum MaskError {
    #[error("the mask has no points")]
    Empty,
    #[error("the mask has more than {MAX_MASK_POINTS} points")]
    TooManyPoints,
    #[error("azimuth {0} is not between 0 and 360 degrees")]
    Azimuth(f64),
    #[error("elevation {0} is not between -90 and 90 degrees")]
    Elevation(f64),
    #[error("azimuth {0} is given twice")]
    Duplicate(f64),
}

/// The reason why a text does not hold a mask.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MaskTextError {
    #[error("line {line} does not hold an azimuth and an elevation")]
    Format {
        /// Counted from 1.
        line: usize,
    },
    /// A line holds a point that is refused.
    #[error("line {line}: {reason}")]
    Point {
        /// Counted from 1.
        line: usize,
        reason: MaskError,
    },
    /// Each line is valid, but together they do not make a mask.
    #[error(transparent)]
    Mask(#[from] MaskError),
}

impl HorizonMask {
    /// Builds a mask from points of azimuth (0 to 360) and elevation (-90 to 90) in degrees, in any
    /// order. No azimuth may occur twice; 0 and 360 are the same azimuth, but both may be given if
    /// their elevations are equal.
    pub fn from_degrees(points: impl IntoIterator<Item = (f64, f64)>) -> Result<Self, MaskError> {
        let mut builder = Builder::default();
        for (azimuth_deg, elevation_deg) in points {
            builder.add(0, azimuth_deg, elevation_deg).map_err(|(_, reason)| reason)?;
        }
        builder.finish().map_err(|(_, reason)| reason)
    }

    /// Reads a text with one point per line: azimuth and elevation in degrees, separated by
    /// spaces, tabs, a comma or a semicolon. A `#` starts a comment, empty lines are ignored, and
    /// the order is free.
    pub fn parse(text: &str) -> Result<Self, MaskTextError> {
        let at_line = |(line, reason)| match reason {
            MaskError::Empty => MaskTextError::Mask(reason),
            _ => MaskTextError::Point { line, reason },
        };
        let mut builder = Builder::default();
        for (index, content) in text.trim_start_matches('\u{feff}').lines().enumerate() {
            let line = index + 1;
            let content = content.split('#').next().unwrap_or_default().trim();
            if !content.is_empty() {
                let (azimuth_deg, elevation_deg) =
                    numbers(content).ok_or(MaskTextError::Format { line })?;
                builder.add(line, azimuth_deg, elevation_deg).map_err(at_line)?;
            }
        }
        builder.finish().map_err(at_line)
    }

    /// The elevation in the direction of `azimuth`, which may be any angle.
    pub fn elevation_at(&self, azimuth: Angle) -> Angle {
        let azimuth_deg = azimuth.wrapped_360().degrees();
        let above = self.points.partition_point(|(point_deg, _)| *point_deg <= azimuth_deg);
        let before = above.checked_sub(1).and_then(|index| self.points.get(index));
        let (Some(first), Some(last)) = (self.points.first(), self.points.last()) else {
            return Angle::ZERO;
        };
        let (from_deg, from_el) = before.copied().unwrap_or((last.0 - TURN_DEG, last.1));
        let next = self.points.get(above).copied();
        let (to_deg, to_el) = next.unwrap_or((first.0 + TURN_DEG, first.1));
        let share = (azimuth_deg - from_deg) / (to_deg - from_deg);
        Angle::from_degrees(from_el + share * (to_el - from_el))
    }

    /// Azimuth from 0 to below 360, ascending, and elevation, in degrees.
    pub fn points_deg(&self) -> &[(f64, f64)] {
        &self.points
    }

    pub fn lowest(&self) -> Angle {
        let lowest_deg = self.points.iter().map(|(_, el)| *el).fold(90.0, f64::min);
        Angle::from_degrees(lowest_deg)
    }

    pub fn highest(&self) -> Angle {
        let highest_deg = self.points.iter().map(|(_, el)| *el).fold(-90.0, f64::max);
        Angle::from_degrees(highest_deg)
    }
}

/// Reads the two numbers of a line whose comment is already removed.
fn numbers(content: &str) -> Option<(f64, f64)> {
    let separated = |c: char| c.is_whitespace() || c == ',' || c == ';';
    let (azimuth, rest) = content.split_once(separated)?;
    // Only one separator mark is allowed, with spaces around it: `1,,2` lacks a number
    // in the middle.
    let rest = rest.trim_start();
    let marked = content.get(azimuth.len()..)?.starts_with([',', ';']);
    let elevation = if marked { rest } else { rest.strip_prefix([',', ';']).unwrap_or(rest) };
    Some((azimuth.parse().ok()?, elevation.trim_start().parse().ok()?))
}

/// Collects points one by one, each with its line number.
#[derive(Default)]
struct Builder {
    points: Vec<(usize, f64, f64)>,
}

impl Builder {
    fn add(
        &mut self,
        line: usize,
        azimuth_deg: f64,
        elevation_deg: f64,
    ) -> Result<(), (usize, MaskError)> {
        // Written so that NaN is refused too.
        if !(0.0..=TURN_DEG).contains(&azimuth_deg) {
            return Err((line, MaskError::Azimuth(azimuth_deg)));
        }
        if !(-90.0..=90.0).contains(&elevation_deg) {
            return Err((line, MaskError::Elevation(elevation_deg)));
        }
        if self.points.len() == MAX_MASK_POINTS {
            return Err((line, MaskError::TooManyPoints));
        }
        self.points.push((line, azimuth_deg, elevation_deg));
        Ok(())
    }

    fn finish(mut self) -> Result<HorizonMask, (usize, MaskError)> {
        // The sort is stable: of two equal azimuths, the one from the later line comes second.
        self.points.sort_by(|a, b| a.1.total_cmp(&b.1));
        for (a, b) in self.points.iter().zip(self.points.iter().skip(1)) {
            // Compared by value: the sort puts -0 before 0, but they are the same azimuth.
            if a.1 - b.1 == 0.0 {
                return Err((b.0, MaskError::Duplicate(b.1)));
            }
        }
        let last = self.points.last().copied().ok_or((0, MaskError::Empty))?;
        if last.1 >= TURN_DEG {
            self.points.pop();
            match self.points.first().copied() {
                Some(first) if first.1 > 0.0 => self.points.insert(0, (last.0, 0.0, last.2)),
                None => self.points.push((last.0, 0.0, last.2)),
                Some(first) if first.2.total_cmp(&last.2).is_eq() => {}
                Some(_) => return Err((last.0, MaskError::Duplicate(last.1))),
            }
        }
        let points = self.points.into_iter().map(|(_, azimuth, elevation)| (azimuth, elevation));
        Ok(HorizonMask { points: points.collect() })
    }
}

impl TryFrom<Vec<(f64, f64)>> for HorizonMask {
    type Error = MaskError;
    fn try_from(points: Vec<(f64, f64)>) -> Result<Self, MaskError> {
        Self::from_degrees(points)
    }
}

impl From<HorizonMask> for Vec<(f64, f64)> {
    fn from(mask: HorizonMask) -> Self {
        mask.points
    }
}

/// Writes the text that [`HorizonMask::parse`] reads, without loss.
impl fmt::Display for HorizonMask {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(out, "# azimuth elevation, degrees")?;
        self.points
            .iter()
            .try_for_each(|(azimuth, elevation)| writeln!(out, "{azimuth} {elevation}"))
    }
}

#[cfg(test)]
mod tests;
