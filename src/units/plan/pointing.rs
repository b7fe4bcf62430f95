//! The pointing model of a mount, as it follows from many passes. Nothing here reads or commands an
//! antenna.

#[cfg(test)]
mod coverage;
mod fit;
mod least_squares;
mod run;
#[cfg(test)]
mod tests;

pub use fit::{Alike, CannotFit, Fit, Interval, Kind, KindNoise, Point, fit};
