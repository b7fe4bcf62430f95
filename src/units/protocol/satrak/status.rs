//! Reply to `STATUS?` (section 6).

use super::coded::coded;
use super::fields::{FieldError, FrameFields};

coded! {
    /// Phase of the unit in its tracking window (field 9).
    TrackState {
        NotInTrackTime = 0,
        InTrackTime = 1,
        /// A window that is over.
        Completed = 2,
        /// Move to the start point before the window begins.
        BeforeStart = 3,
    }
}

coded! {
    /// Motion of one axis (fields 12 and 13).
    AxisMotion {
        /// Motion toward smaller angles.
        Negative = -1,
        Still = 0,
        /// Motion toward larger angles.
        Positive = 1,
    }
}

impl AxisMotion {
    /// Returns `true` if the axis moves; an unexplained number counts as moving.
    pub fn is_moving(self) -> bool {
        self != Self::Still
    }
}

/// End switches of both axes; an unexplained number counts as set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Limits {
    /// `true` if the X axis is at its upper end.
    pub x_plus: bool,
    /// `true` if the X axis is at its lower end.
    pub x_minus: bool,
    /// `true` if the Y axis is at its upper end.
    pub y_plus: bool,
    /// `true` if the Y axis is at its lower end.
    pub y_minus: bool,
}

impl Limits {
    /// Returns `true` if any axis is at an end.
    pub fn any(self) -> bool {
        self.x_plus || self.x_minus || self.y_plus || self.y_minus
    }
}

/// Measurements and activity of the unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Status {
    /// `true` if a fault or warning exists; `ERRSTATUS?` names it.
    pub fault: bool,
    /// Azimuth, degrees.
    pub az_deg: f64,
    /// Elevation, degrees.
    pub el_deg: f64,
    pub limits: Limits,
    pub tracking_enabled: bool,
    pub track_state: TrackState,
    /// `true` if the clock was set from GPS.
    pub rtc_from_gps: bool,
    /// GPS lock delay, seconds; the document gives no explanation.
    pub gps_lock_delay_s: f64,
    pub x_motion: AxisMotion,
    pub y_motion: AxisMotion,
    /// X angle, degrees.
    pub x_deg: f64,
    /// Y angle, degrees.
    pub y_deg: f64,
    /// `true` if auto-track is on; `None` if the unit does not report it.
    pub auto_track: Option<bool>,
}

impl Status {
    /// Number of fields that an older unit sends.
    pub(super) const MIN_FIELDS: usize = 15;
    /// Number of fields that the document lists.
    pub(super) const FIELDS: usize = 16;
    /// Max number of fields, with room for additions of a newer unit. Decimal commas turn 15 fields
    /// into 19 with wrong angles, so 19 fields must not count as additions.
    pub(super) const MAX_FIELDS: usize = 18;

    pub(super) fn read(fields: FrameFields<'_>) -> Result<Self, FieldError> {
        Ok(Self {
            fault: fields.flag(1)?,
            az_deg: fields.decimal(2)?,
            el_deg: fields.decimal(3)?,
            limits: Limits {
                x_plus: fields.flag(4)?,
                x_minus: fields.flag(5)?,
                y_plus: fields.flag(6)?,
                y_minus: fields.flag(7)?,
            },
            tracking_enabled: fields.flag(8)?,
            track_state: TrackState::from_code(fields.integer(9)?),
            // The value is not read as a flag: an unexplained number must not confirm the clock.
            rtc_from_gps: fields.integer::<i64>(10)? == 1,
            // Section 6 gives seconds, but does not say that they are whole.
            gps_lock_delay_s: fields.decimal(11)?,
            x_motion: AxisMotion::from_code(fields.integer(12)?),
            y_motion: AxisMotion::from_code(fields.integer(13)?),
            x_deg: fields.decimal(14)?,
            y_deg: fields.decimal(15)?,
            auto_track: (fields.count() >= Self::FIELDS).then(|| fields.flag(16)).transpose()?,
        })
    }

    pub fn is_moving(&self) -> bool {
        self.x_motion.is_moving() || self.y_motion.is_moving()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::satrak::Frame;

    #[test]
    fn unexplained_numbers_lean_to_the_safe_side() {
        let frame = Frame::from_payload("STATUS?,7,1.5,2,2,0,0,-1,0,9,5,12,4,-1,80,90,3");
        let status = Status::read(FrameFields::new(&frame)).unwrap();
        assert!(status.fault);
        let limits = Limits { x_plus: true, x_minus: false, y_plus: false, y_minus: true };
        assert_eq!(status.limits, limits);
        assert!(status.limits.any());
        assert_eq!(status.track_state, TrackState::Unknown(9));
        assert!(!status.rtc_from_gps);
        assert_eq!(status.x_motion, AxisMotion::Unknown(4));
        assert!(status.x_motion.is_moving() && status.is_moving());
        assert_eq!(status.y_motion, AxisMotion::Negative);
        assert_eq!(status.auto_track, Some(true));
    }
}
