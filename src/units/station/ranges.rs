//! Ranges of the numbers in a station, for its file and its forms.

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
/// Rate of questions to a controller, per second.
pub const POLL_HZ: RangeInclusive<f64> = 2.0..=10.0;

/// Time between two checks of the position in a program track, seconds.
pub const FOLLOW_PERIOD_S: RangeInclusive<f64> = 0.05..=600.0;
/// Error below which no new position is sent, degrees.
pub const DEAD_BAND_DEG: RangeInclusive<f64> = 0.0..=90.0;
/// Time from a command until the antenna moves, seconds.
pub const LATENCY_S: RangeInclusive<f64> = 0.0..=60.0;

/// Margin that the operator adds to a keep-out, degrees.
pub const MARGIN_DEG: RangeInclusive<f64> = 0.0..=30.0;
/// Elevation of a corner of a keep-out, degrees.
pub const CORNER_ELEVATION_DEG: RangeInclusive<f64> = -90.0..=90.0;
/// Time from a reminder to AOS, minutes.
pub const REMINDER_MIN: RangeInclusive<f64> = 1.0..=60.0;
/// Frequency of a carrier, MHz.
pub const FREQUENCY_MHZ: RangeInclusive<f64> = 0.1..=300_000.0;
/// Smallest angle between the Sun and the direction of an antenna, degrees.
pub const SUN_RADIUS_DEG: RangeInclusive<f64> = 0.1..=60.0;
/// Time ahead for which the Sun's way is kept free, minutes.
pub const SUN_AHEAD_MIN: RangeInclusive<f64> = 0.0..=120.0;
/// Sway of a standing antenna between two positions, degrees.
pub const SWAY_DEG: RangeInclusive<f64> = 0.0..=2.0;
/// Longest outage after which an antenna goes on without a question, seconds.
pub const RESUME_AFTER_S: RangeInclusive<f64> = 0.0..=600.0;

/// Azimuth of the lower of two crossed axes, degrees.
pub const LOWER_AXIS_AZIMUTH_DEG: RangeInclusive<f64> = 0.0..=180.0;
/// Lower end of the travel of crossed axes, degrees.
pub const TRAVEL_FROM_DEG: RangeInclusive<f64> = -180.0..=90.0;
/// Upper end of the travel of crossed axes, degrees.
pub const TRAVEL_TO_DEG: RangeInclusive<f64> = 90.0..=360.0;

/// Counter-clockwise end of an azimuth axis, degrees.
pub const AZIMUTH_FROM_DEG: RangeInclusive<f64> = -360.0..=360.0;
/// Travel from the counter-clockwise to the clockwise end, degrees.
pub const AZIMUTH_SPAN_DEG: RangeInclusive<f64> = 1.0..=1080.0;
/// Clockwise end of an azimuth axis, degrees.
pub const AZIMUTH_TO_DEG: RangeInclusive<f64> = -359.0..=1440.0;
/// Lower end of an elevation axis, degrees.
pub const ELEVATION_FROM_DEG: RangeInclusive<f64> = -90.0..=89.0;
/// Upper end of an elevation axis, degrees.
pub const ELEVATION_TO_DEG: RangeInclusive<f64> = 0.0..=180.0;
/// Travel from the lower to the upper end, degrees.
pub const ELEVATION_SPAN_DEG: RangeInclusive<f64> = 1.0..=270.0;

/// Shortest pass, or part of one, that is taken, seconds.
pub const MIN_DURATION_S: RangeInclusive<f64> = 0.0..=86_400.0;
/// Most passes of a satellite a day.
pub const PASSES_PER_DAY: RangeInclusive<f64> = 1.0..=100.0;
/// Time ahead that is planned, hours.
pub const SCHEDULE_SPAN_H: RangeInclusive<f64> = 12.0..=168.0;
/// Smallest part of a pass that is taken, per cent of the seconds that count.
pub const MIN_PERCENT: RangeInclusive<f64> = 1.0..=100.0;
/// Age of elements by which passes are still taken, days.
pub const ELEMENT_AGE_D: RangeInclusive<f64> = 0.1..=1000.0;
/// Error of a unit's clock from which it is set, seconds: a clock that was set is proved within 2.
pub const CLOCK_LIMIT_S: RangeInclusive<f64> = 0.2..=60.0;
/// Rest after which a motion of automatic operation is announced, minutes.
pub const REST_MIN: RangeInclusive<f64> = 0.0..=1440.0;
/// How long such a motion is announced, seconds.
pub const WARNING_S: RangeInclusive<f64> = 30.0..=600.0;
/// Time from the end of one pass until an antenna can go to the next, seconds.
pub const SET_UP_S: RangeInclusive<f64> = 0.0..=600.0;

/// How long measured positions and lines on the links are kept, days.
pub const RAW_DAYS: RangeInclusive<f64> = 0.04..=3650.0;
/// How long everything else is kept, years.
pub const RECORD_YEARS: RangeInclusive<f64> = 0.1..=100.0;

/// A term of a pointing model, degrees.
pub const POINTING_TERM_DEG: RangeInclusive<f64> = -10.0..=10.0;
/// Its scale of the elevation, degrees a degree.
pub const POINTING_SCALE: RangeInclusive<f64> = -0.05..=0.05;
