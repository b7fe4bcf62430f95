//! Clock, tracking window and time-tagged position (sections 8 to 11 and 17).

use jiff::Timestamp;
use jiff::tz::TimeZone;

use super::ValueError;
use super::fields::{FieldError, FrameFields, time_values};

/// First year of a clock that was set: an unset unit starts in 2000.
const FIRST_PLAUSIBLE_YEAR: i16 = 2010;

/// Reply to `TIME?`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct UnitTime {
    /// Time of the unit's clock, UTC.
    pub time: Timestamp,
    /// `true` if the reply had milliseconds. The document lists them but omits them in its example.
    pub has_milliseconds: bool,
}

impl UnitTime {
    pub(super) fn read(fields: FrameFields<'_>) -> Result<Self, FieldError> {
        let has_milliseconds = fields.count() > 6;
        let time = if has_milliseconds { fields.time_with_ms(1) } else { fields.time(1, 0) }?;
        Ok(Self { time, has_milliseconds })
    }

    /// Returns `true` if the clock was ever set: the year is 2010 or later.
    pub fn is_set(self) -> bool {
        TimeZone::UTC.to_datetime(self.time).year() >= FIRST_PLAUSIBLE_YEAR
    }
}

/// Values of `TIME=`: a whole second.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ClockTime(Timestamp);

impl ClockTime {
    /// Rounds `time` down to its second. Returns an error for a year outside 2000 to 2099.
    pub fn new(time: Timestamp) -> Result<Self, ValueError> {
        whole_second(time).map(Self)
    }

    /// Returns UTC, a whole second.
    pub fn time(self) -> Timestamp {
        self.0
    }

    pub(super) fn values(self) -> Vec<String> {
        time_values(self.0).to_vec()
    }
}

fn whole_second(time: Timestamp) -> Result<Timestamp, ValueError> {
    let year = TimeZone::UTC.to_datetime(time).year();
    let out_of_range =
        ValueError::Range { name: "year", value: f64::from(year), min: 2000.0, max: 2099.0 };
    if !(2000..=2099).contains(&year) {
        return Err(out_of_range);
    }
    // `TIME=` and `START_STOP_TIME=` take no milliseconds (sections 9 and 11).
    Timestamp::from_second(time.as_second()).map_err(|_| out_of_range)
}

/// Reply to `START_STOP_TIME?`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StartStopTime {
    /// Start of tracking, UTC.
    pub start: Timestamp,
    /// End of tracking, UTC; may be before the start in a unit that was never set.
    pub stop: Timestamp,
}

impl StartStopTime {
    pub(super) fn read(fields: FrameFields<'_>) -> Result<Self, FieldError> {
        Ok(Self { start: fields.time(1, 0)?, stop: fields.time(7, 0)? })
    }

    pub fn is_ordered(self) -> bool {
        self.start < self.stop
    }
}

/// Values of `START_STOP_TIME=`, with the stop time after the start time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TrackWindow {
    start: Timestamp,
    stop: Timestamp,
}

impl TrackWindow {
    /// Rounds both times down to their second. Returns an error for a year outside 2000 to 2099.
    pub fn new(start: Timestamp, stop: Timestamp) -> Result<Self, ValueError> {
        // Rounding comes first: two times within one second would make a window without a length.
        let (start, stop) = (whole_second(start)?, whole_second(stop)?);
        if stop <= start {
            return Err(ValueError::StopBeforeStart);
        }
        Ok(Self { start, stop })
    }

    /// Returns the start of tracking, UTC, a whole second.
    pub fn start(self) -> Timestamp {
        self.start
    }

    /// Returns the end of tracking, UTC, a whole second.
    pub fn stop(self) -> Timestamp {
        self.stop
    }

    pub(super) fn values(self) -> Vec<String> {
        time_values(self.start).into_iter().chain(time_values(self.stop)).collect()
    }
}

/// Reply to `TPOS?`: a position and its time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimedPosition {
    /// First angle as reported, degrees. The document calls it X, but its
    /// example of 306 only fits an azimuth.
    pub x_deg: f64,
    /// Second angle as reported, degrees: Y, or elevation.
    pub y_deg: f64,
    /// Time of the measurement, UTC by the unit's clock.
    pub time: Timestamp,
}

impl TimedPosition {
    pub(super) fn read(fields: FrameFields<'_>) -> Result<Self, FieldError> {
        Ok(Self {
            x_deg: fields.decimal(1)?,
            y_deg: fields.decimal(2)?,
            // Section 17 has milliseconds in its example too, unlike section 8.
            time: fields.time_with_ms(3)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_must_have_a_length() {
        let time = |second: i64| Timestamp::from_second(1_500_000_000 + second).unwrap();
        assert_eq!(TrackWindow::new(time(5), time(5)), Err(ValueError::StopBeforeStart));
        assert!(TrackWindow::new(time(5), time(6)).is_ok());
        assert!(ClockTime::new(Timestamp::from_second(0).unwrap()).is_err());
        assert!(ClockTime::new(Timestamp::MAX).is_err());
    }
}
