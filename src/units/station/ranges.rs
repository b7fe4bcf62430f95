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
/// Max jog rate of an axis, degrees a second.
pub const MAXIMUM_RATE_DEG_S: RangeInclusive<f64> = 0.01..=30.0;
/// Max single step of an axis, degrees.
pub const MAXIMUM_STEP_DEG: RangeInclusive<f64> = 0.01..=90.0;
/// Rate of questions to a controller, per second.
pub const POLL_HZ: RangeInclusive<f64> = 2.0..=10.0;

/// Time between two checks of the position in a program track, seconds.
pub const FOLLOW_PERIOD_S: RangeInclusive<f64> = 0.05..=600.0;
/// Position error below which Azel sends no new position, degrees.
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
/// Min angle between the Sun and the direction of an antenna, degrees.
pub const SUN_RADIUS_DEG: RangeInclusive<f64> = 0.1..=60.0;
/// Time ahead for which antennas avoid the Sun's path, minutes.
pub const SUN_AHEAD_MIN: RangeInclusive<f64> = 0.0..=120.0;
/// Sway of a standing antenna between two positions, degrees.
pub const SWAY_DEG: RangeInclusive<f64> = 0.0..=2.0;
/// Max outage after which an antenna continues without a question, seconds.
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

/// Min duration of a pass, or of a part of a pass, that the schedule takes, seconds.
pub const MIN_DURATION_S: RangeInclusive<f64> = 0.0..=86_400.0;
/// Max number of passes of a satellite a day.
pub const PASSES_PER_DAY: RangeInclusive<f64> = 1.0..=100.0;
/// Time ahead that the schedule covers, hours.
pub const SCHEDULE_SPAN_H: RangeInclusive<f64> = 12.0..=168.0;
/// Min part of a pass that the schedule takes, per cent of the seconds that count.
pub const MIN_PERCENT: RangeInclusive<f64> = 1.0..=100.0;
/// Max age of elements for passes that the schedule takes, days.
pub const ELEMENT_AGE_D: RangeInclusive<f64> = 0.1..=1000.0;
/// Clock error above which Azel sets a unit's clock, seconds. Azel proves a set clock within 2 s.
pub const CLOCK_LIMIT_S: RangeInclusive<f64> = 0.2..=60.0;
/// Rest after which Azel announces a motion of automatic operation, minutes.
pub const REST_MIN: RangeInclusive<f64> = 0.0..=1440.0;
/// Duration of such an announcement, seconds.
pub const WARNING_S: RangeInclusive<f64> = 30.0..=600.0;
/// Time from the end of one pass until an antenna can go to the next, seconds.
pub const SET_UP_S: RangeInclusive<f64> = 0.0..=600.0;

/// Retention of measured positions and lines on the links, days.
pub const RAW_DAYS: RangeInclusive<f64> = 0.04..=3650.0;
/// Retention of all other data, years.
pub const RECORD_YEARS: RangeInclusive<f64> = 0.1..=100.0;

/// A term of a pointing model, degrees.
pub const POINTING_TERM_DEG: RangeInclusive<f64> = -10.0..=10.0;
/// Elevation scale of a pointing model, degrees a degree.
pub const POINTING_SCALE: RangeInclusive<f64> = -0.05..=0.05;
