//! What a mount can follow, and lists of passes for others to read. Pure
//! functions over passes.

mod azimuth_route;
pub mod pass_export;
mod trackability;

pub use azimuth_route::{AzimuthRange, AzimuthRoute, RangeTooSmall};
pub use trackability::{Sample, Trackability, trackability};
