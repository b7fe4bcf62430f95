//! Pointing model of a mount, computed from many passes. This module neither reads nor commands an
//! antenna.

#[cfg(test)]
mod coverage;
mod fit;
mod least_squares;
mod run;
#[cfg(test)]
mod tests;

pub use fit::{Alike, CannotFit, Fit, Interval, Kind, KindNoise, Point, fit};
