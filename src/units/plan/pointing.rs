//! The pointing model of a mount, as it follows from many passes. Nothing here reads or commands an
//! antenna.

mod fit;
mod least_squares;
#[cfg(test)]
mod tests;

pub use fit::{Alike, CannotFit, Fit, Found, Interval, Kind, Point, fit};
