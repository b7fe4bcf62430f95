//! Requests that can move the antenna (sections 2 to 4, 18 and 19).

use super::number::{checked, plain};
use super::{ValueError, Word};

/// Azel's own plausibility limits; the document gives no range.
const MAX_RATE_DEG_S: f64 = 100.0;
const MAX_STEP_DEG: f64 = 180.0;
const MIN_ELEVATION_DEG: f64 = -10.0;

/// A request that can move the antenna. Only the driver's gate may encode it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Motion {
    /// Rotation of the axes until a stop. The document gives no timeout.
    Move(Move),
    /// Rotation of the axes by an angle.
    Step(Step),
    /// Move to a direction.
    Goto(Goto),
    /// Tracking on.
    TrackOn,
    /// Auto-track on: the unit starts to track unattended in its window.
    AutoTrackOn,
}

/// Rates of both axes, at least one of them not zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Move {
    x_deg_s: f64,
    y_deg_s: f64,
}

impl Move {
    /// Returns rates in degrees per second, -100 to 100, rounded to a thousandth.
    pub fn new(x_deg_s: f64, y_deg_s: f64) -> Result<Self, ValueError> {
        let rate = |value| checked("rate in deg/s", value, -MAX_RATE_DEG_S, MAX_RATE_DEG_S);
        let (x_deg_s, y_deg_s) = moving(rate(x_deg_s)?, rate(y_deg_s)?)?;
        Ok(Self { x_deg_s, y_deg_s })
    }

    /// Returns the rate of the X axis, degrees per second.
    pub fn x_deg_s(self) -> f64 {
        self.x_deg_s
    }

    /// Returns the rate of the Y axis, degrees per second.
    pub fn y_deg_s(self) -> f64 {
        self.y_deg_s
    }
}

/// Angles by which both axes turn, at least one of them not zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    x_deg: f64,
    y_deg: f64,
}

impl Step {
    /// Returns a step in degrees, -180 to 180, rounded to a thousandth. The document prints deg/s,
    /// but its text and examples are degrees.
    pub fn new(x_deg: f64, y_deg: f64) -> Result<Self, ValueError> {
        let step = |value| checked("step in degrees", value, -MAX_STEP_DEG, MAX_STEP_DEG);
        let (x_deg, y_deg) = moving(step(x_deg)?, step(y_deg)?)?;
        Ok(Self { x_deg, y_deg })
    }

    /// Returns the step of the X axis, degrees.
    pub fn x_deg(self) -> f64 {
        self.x_deg
    }

    /// Returns the step of the Y axis, degrees.
    pub fn y_deg(self) -> f64 {
        self.y_deg
    }
}

/// Returns the values unless both are zero.
#[allow(clippy::float_cmp, reason = "rounded values, and only the exact zero stands still")]
fn moving(x: f64, y: f64) -> Result<(f64, f64), ValueError> {
    // The document does not say that `MOVE=,0,0` stops an axis; `STOP=` does (section 5).
    if x == 0.0 && y == 0.0 { Err(ValueError::NoMotion) } else { Ok((x, y)) }
}

/// A direction with at least one of its angles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Goto {
    az_deg: Option<f64>,
    el_deg: Option<f64>,
}

impl Goto {
    /// Returns a direction with azimuth 0 to 360 and elevation -10 to 90 in degrees, rounded to a
    /// thousandth; `None` leaves an angle unchanged.
    pub fn new(az_deg: Option<f64>, el_deg: Option<f64>) -> Result<Self, ValueError> {
        // Section 4 gives no range, so a unit may refuse 360. Zero is the same direction.
        let azimuth = |value| checked("azimuth", value, 0.0, 360.0).map(|az| az % 360.0);
        let elevation = |value| checked("elevation", value, MIN_ELEVATION_DEG, 90.0);
        if az_deg.is_none() && el_deg.is_none() {
            return Err(ValueError::NoMotion);
        }
        Ok(Self {
            az_deg: az_deg.map(azimuth).transpose()?,
            el_deg: el_deg.map(elevation).transpose()?,
        })
    }

    /// Returns the azimuth in degrees, from 0 to less than 360.
    pub fn az_deg(self) -> Option<f64> {
        self.az_deg
    }

    /// Returns the elevation in degrees.
    pub fn el_deg(self) -> Option<f64> {
        self.el_deg
    }
}

impl Motion {
    pub const fn word(self) -> Word {
        match self {
            Self::Move(_) => Word::Move,
            Self::Step(_) => Word::Step,
            Self::Goto(_) => Word::Goto,
            Self::TrackOn => Word::Track,
            Self::AutoTrackOn => Word::TrackAutoEnable,
        }
    }

    pub(super) fn values(self) -> Vec<String> {
        let angle = |angle: Option<f64>| angle.map_or_else(|| "NONE".to_owned(), plain);
        match self {
            Self::Move(Move { x_deg_s, y_deg_s }) => vec![plain(x_deg_s), plain(y_deg_s)],
            // The values have no plus sign: only the examples of section 3 write `+2`.
            Self::Step(Step { x_deg, y_deg }) => vec![plain(x_deg), plain(y_deg)],
            Self::Goto(Goto { az_deg, el_deg }) => vec![angle(az_deg), angle(el_deg)],
            Self::TrackOn | Self::AutoTrackOn => vec!["1".to_owned()],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_would_not_move_is_refused() {
        assert_eq!(Move::new(0.0, -0.0), Err(ValueError::NoMotion));
        assert_eq!(Move::new(0.0004, 0.0), Err(ValueError::NoMotion));
        assert_eq!(Step::new(0.0, 0.0), Err(ValueError::NoMotion));
        assert_eq!(Goto::new(None, None), Err(ValueError::NoMotion));
    }

    #[test]
    fn what_is_no_number_or_out_of_range_is_refused() {
        for bad in [f64::NAN, f64::INFINITY, 1e9] {
            assert!(Move::new(bad, 0.0).is_err());
            assert!(Step::new(0.0, bad).is_err());
            assert!(Goto::new(Some(bad), None).is_err());
        }
        assert!(Goto::new(Some(-0.5), None).is_err());
        assert!(Goto::new(None, Some(90.5)).is_err());
    }

    #[test]
    fn a_full_turn_is_north() {
        let north = Motion::Goto(Goto::new(Some(359.9999), None).unwrap());
        assert_eq!(north.values(), ["0", "NONE"]);
    }
}
