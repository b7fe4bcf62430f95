//! The horizon mask of a site: the elevation, by azimuth, below which hills, walls and trees
//! block the sky.

mod import;

use std::fmt;

use serde::{Deserialize, Serialize};

pub use import::{MaskForm, MaskImportError};

use super::Angle;

/// Max number of points in a mask: one every twentieth of a degree.
pub const MAX_MASK_POINTS: usize = 7200;

const TURN_DEG: f64 = 360.0;
/// Width of a wall, degrees. It is smaller than any error of a measured skyline, and keeps the mask
/// a function of the azimuth.
const WALL_DEG: f64 = 1e-3;

/// Elevation by azimuth, with straight lines between the points. A line across north joins the last
/// point to the first. A single point makes a level horizon.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Vec<(f64, f64)>", into = "Vec<(f64, f64)>")]
pub struct HorizonMask {
    /// Azimuth from 0 to below 360, ascending, and elevation, degrees.
    points: Vec<(f64, f64)>,
}

/// Reason why points do not make a mask.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum MaskError {
    #[error("the mask has no points")]
    Empty,
    #[error("the mask has more than {MAX_MASK_POINTS} points")]
    TooManyPoints,
    #[error("azimuth {0} is not between -180 and 360 degrees")]
    Azimuth(f64),
    #[error("elevation {0} is not between -90 and 90 degrees")]
    Elevation(f64),
    /// Azimuth on two lines that are not neighbours, or on more than two lines.
    #[error("azimuth {0} is given twice")]
    Duplicate(f64),
}

impl HorizonMask {
    /// Builds a mask from points of azimuth (-180 to 360) and elevation (-90 to 90), degrees, in
    /// any order. An azimuth that occurs twice, one point after the other, makes a wall. At a wall,
    /// the mask changes from the first to the second elevation within `WALL_DEG`. The pairs 360 and
    /// 0, and 180 and -180, also make a wall.
    pub fn from_degrees(points: impl IntoIterator<Item = (f64, f64)>) -> Result<Self, MaskError> {
        let mut builder = Builder::default();
        for (azimuth_deg, elevation_deg) in points {
            builder.add(0, azimuth_deg, elevation_deg).map_err(|(_, reason)| reason)?;
        }
        builder.finish().map_err(|(_, reason)| reason)
    }

    /// Reads a text as [`HorizonMask::import`] does.
    pub fn parse(text: &str) -> Result<Self, MaskImportError> {
        Self::import(text).map(|(mask, _)| mask)
    }

    /// Returns the elevation of the mask at `azimuth`, which may be any angle.
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

    /// Returns the points: azimuth from 0 to below 360, ascending, and elevation, degrees.
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
    // Only one separator mark is allowed, with spaces around it, because `1,,2` lacks a number in
    // the middle.
    let rest = rest.trim_start();
    let marked = content.get(azimuth.len()..)?.starts_with([',', ';']);
    let elevation = if marked { rest } else { rest.strip_prefix([',', ';']).unwrap_or(rest) };
    Some((azimuth.parse().ok()?, elevation.trim_start().parse().ok()?))
}

/// Builder of a mask that takes one point at a time, with its line number.
#[derive(Default)]
struct Builder {
    points: Vec<ReadPoint>,
}

/// A point as given.
#[derive(Clone, Copy)]
struct ReadPoint {
    line: usize,
    /// Index among the points, from 0.
    place: usize,
    /// Azimuth from -180 to 360 degrees.
    azimuth_deg: f64,
    elevation_deg: f64,
}

impl ReadPoint {
    /// Returns the azimuth from 0 to below 360 degrees.
    fn around_deg(self) -> f64 {
        // Adding zero turns -0 into 0.
        self.azimuth_deg.rem_euclid(TURN_DEG) + 0.0
    }

    fn is_beside(self, other: Self) -> bool {
        self.azimuth_deg.total_cmp(&other.azimuth_deg).is_ne()
            || self.place.abs_diff(other.place) == 1
    }
}

impl Builder {
    fn add(
        &mut self,
        line: usize,
        azimuth_deg: f64,
        elevation_deg: f64,
    ) -> Result<(), (usize, MaskError)> {
        // The negated test also refuses NaN.
        if !(-TURN_DEG / 2.0..=TURN_DEG).contains(&azimuth_deg) {
            return Err((line, MaskError::Azimuth(azimuth_deg)));
        }
        if !(-90.0..=90.0).contains(&elevation_deg) {
            return Err((line, MaskError::Elevation(elevation_deg)));
        }
        if self.points.len() == MAX_MASK_POINTS {
            return Err((line, MaskError::TooManyPoints));
        }
        let (place, azimuth_deg) = (self.points.len(), azimuth_deg + 0.0);
        self.points.push(ReadPoint { line, place, azimuth_deg, elevation_deg });
        Ok(())
    }

    fn finish(self) -> Result<HorizonMask, (usize, MaskError)> {
        let sorted = self.sorted();
        let mut points: Vec<(f64, f64)> = Vec::with_capacity(sorted.len());
        let mut last: Option<(ReadPoint, bool)> = None;
        for point in sorted {
            let (mut azimuth_deg, mut is_wall) = (point.around_deg(), false);
            if let Some((other, other_is_wall)) = last
                && other.around_deg() >= azimuth_deg
            {
                if other.elevation_deg.total_cmp(&point.elevation_deg).is_eq() {
                    continue;
                }
                if other_is_wall || !point.is_beside(other) {
                    return Err((point.line, MaskError::Duplicate(point.azimuth_deg)));
                }
                is_wall = true;
                // Rounding makes the file show the width.
                azimuth_deg = ((azimuth_deg + WALL_DEG) * 1e6).round() / 1e6;
            }
            let is_ascending = points.last().is_none_or(|(before, _)| *before < azimuth_deg);
            if !is_ascending || azimuth_deg >= TURN_DEG {
                return Err((point.line, MaskError::Duplicate(point.azimuth_deg)));
            }
            points.push((azimuth_deg, point.elevation_deg));
            last = Some((point, is_wall));
        }
        if points.is_empty() { Err((0, MaskError::Empty)) } else { Ok(HorizonMask { points }) }
    }

    /// Returns the points clockwise from north. Of two points at one azimuth, the first ends the
    /// line before it.
    fn sorted(mut self) -> Vec<ReadPoint> {
        let steps = self.points.iter().zip(self.points.iter().skip(1));
        let turn: i64 = steps.map(|(a, b)| b.azimuth_deg.total_cmp(&a.azimuth_deg) as i64).sum();
        if turn < 0 {
            self.points.reverse();
        }
        let by_azimuth = |a: &ReadPoint, b: &ReadPoint| {
            let order = a.around_deg().total_cmp(&b.around_deg());
            order.then(b.azimuth_deg.total_cmp(&a.azimuth_deg))
        };
        // The sort is stable, so points at one azimuth keep their order.
        self.points.sort_by(by_azimuth);
        self.points
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

/// Text that [`HorizonMask::parse`] reads without loss.
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
