//! What the figures of a station may be: the same in its file and in a form.

use std::ops::RangeInclusive;

/// Elevation floor of the pass list, degrees.
pub const ELEVATION_FLOOR_DEG: RangeInclusive<f64> = 0.0..=89.0;
/// Full width of a beam at half power, degrees.
pub const BEAM_WIDTH_DEG: RangeInclusive<f64> = 0.01..=180.0;
/// Azimuth of a direction, degrees.
pub const AZIMUTH_DEG: RangeInclusive<f64> = 0.0..=360.0;
/// Elevation of a direction, degrees.
pub const ELEVATION_DEG: RangeInclusive<f64> = 0.0..=90.0;
/// Fastest jog of an axis, degrees a second.
pub const MAXIMUM_RATE_DEG_S: RangeInclusive<f64> = 0.01..=30.0;
/// Largest single step of an axis, degrees.
pub const MAXIMUM_STEP_DEG: RangeInclusive<f64> = 0.01..=90.0;
/// How often a controller is asked, per second.
pub const POLL_HZ: RangeInclusive<f64> = 2.0..=10.0;

/// Between two looks at where an antenna should be, seconds.
pub const FOLLOW_PERIOD_S: RangeInclusive<f64> = 0.05..=600.0;
/// What is not worth a new position, degrees.
pub const DEAD_BAND_DEG: RangeInclusive<f64> = 0.0..=90.0;
/// From a command until the metal moves, seconds.
pub const LATENCY_S: RangeInclusive<f64> = 0.0..=60.0;

/// What the operator adds to a keep-out, degrees.
pub const MARGIN_DEG: RangeInclusive<f64> = 0.0..=30.0;
/// Elevation of a corner of a keep-out, degrees.
pub const CORNER_ELEVATION_DEG: RangeInclusive<f64> = -90.0..=90.0;
/// Between the Sun and the direction of an antenna, degrees.
pub const SUN_RADIUS_DEG: RangeInclusive<f64> = 0.1..=60.0;
/// For how long ahead the way of the Sun is kept free, minutes.
pub const SUN_AHEAD_MIN: RangeInclusive<f64> = 0.0..=120.0;
/// How far a standing antenna may sway between two looks, degrees.
pub const SWAY_DEG: RangeInclusive<f64> = 0.0..=2.0;
/// The longest outage after which an antenna goes on, seconds.
pub const RESUME_AFTER_S: RangeInclusive<f64> = 0.0..=600.0;

/// Azimuth of the lower of two crossed axes, degrees.
pub const LOWER_AXIS_AZIMUTH_DEG: RangeInclusive<f64> = 0.0..=180.0;
/// Lower end of the travel of crossed axes, degrees.
pub const TRAVEL_FROM_DEG: RangeInclusive<f64> = -180.0..=90.0;
/// Upper end of the travel of crossed axes, degrees.
pub const TRAVEL_TO_DEG: RangeInclusive<f64> = 90.0..=360.0;

/// Counter-clockwise end of an azimuth axis, degrees.
pub const AZIMUTH_FROM_DEG: RangeInclusive<f64> = -360.0..=360.0;
/// By how much the clockwise end is above the counter-clockwise one, degrees.
pub const AZIMUTH_SPAN_DEG: RangeInclusive<f64> = 1.0..=1080.0;
/// Clockwise end of an azimuth axis, degrees.
pub const AZIMUTH_TO_DEG: RangeInclusive<f64> = -359.0..=1440.0;
/// Lower end of an elevation axis, degrees.
pub const ELEVATION_FROM_DEG: RangeInclusive<f64> = -90.0..=89.0;
/// Upper end of an elevation axis, degrees.
pub const ELEVATION_TO_DEG: RangeInclusive<f64> = 0.0..=180.0;
/// By how much the upper end is above the lower one, degrees.
pub const ELEVATION_SPAN_DEG: RangeInclusive<f64> = 1.0..=270.0;

/// An angle that belongs to a count, degrees as the mount counts.
pub const CALIBRATED_DEG: RangeInclusive<f64> = -360.0..=1440.0;
