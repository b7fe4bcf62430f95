//! Motion of a rotator, from the device's drive state and from its readings.

use std::time::Duration;

use crate::{
    clock::Instant,
    device::AxisMotion,
    protocol::rotator_genius::{Moving, Rotator},
};

/// Time without progress of the reading after which a rotator without drive counts as standing.
const SETTLED: Duration = Duration::from_millis(500);
/// Min change of a reading that shows a turn, degrees: readings are whole degrees.
const TURN_DEG: i32 = 2;

/// Known motion of one rotator.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Turning {
    /// Last position at which the rotator stood, degrees.
    rest_deg: Option<i32>,
    coast: Option<Coast>,
}

/// A turn that the device drives, or has just stopped driving.
#[derive(Debug, Clone, Copy)]
struct Coast {
    is_clockwise: bool,
    furthest_deg: i32,
    /// Time of the last progress of the reading.
    advanced_at: Instant,
}

impl Turning {
    /// Takes the report of `now`, and returns the motion of the rotator.
    pub(super) fn look(&mut self, rotator: &Rotator, now: Instant) -> AxisMotion {
        let angle_deg = rotator.position.ok().map(|angle| i32::from(angle.degrees()));
        let driven = match rotator.moving {
            Moving::Stopped => None,
            Moving::Clockwise => Some(true),
            Moving::CounterClockwise => Some(false),
        };
        if let Some(is_clockwise) = driven {
            self.coast = angle_deg.map(|furthest_deg| Coast {
                is_clockwise,
                furthest_deg,
                advanced_at: now,
            });
            return motion(is_clockwise);
        }
        let Some(angle_deg) = angle_deg else {
            *self = Self::default();
            return AxisMotion::Still;
        };
        if let Some(coast) = &mut self.coast {
            // A reading that flickers between two degrees makes no progress.
            let onward = turned_deg(coast.furthest_deg, angle_deg);
            if (onward > 0) == coast.is_clockwise && onward != 0 {
                (coast.furthest_deg, coast.advanced_at) = (angle_deg, now);
            }
            if now.saturating_duration_since(coast.advanced_at) < SETTLED {
                return motion(coast.is_clockwise);
            }
            *self = Self { rest_deg: Some(angle_deg), coast: None };
            return AxisMotion::Still;
        }
        let rest_deg = *self.rest_deg.get_or_insert(angle_deg);
        let turned = turned_deg(rest_deg, angle_deg);
        if turned.abs() < TURN_DEG {
            return AxisMotion::Still;
        }
        let is_clockwise = turned > 0;
        self.coast = Some(Coast { is_clockwise, furthest_deg: angle_deg, advanced_at: now });
        motion(is_clockwise)
    }
}

fn motion(is_clockwise: bool) -> AxisMotion {
    if is_clockwise { AxisMotion::Plus } else { AxisMotion::Minus }
}

/// Returns the shorter way from one reading to another, degrees, clockwise positive.
fn turned_deg(from_deg: i32, to_deg: i32) -> i32 {
    (to_deg - from_deg + 180).rem_euclid(360) - 180
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::rotator_genius::{NoPosition, RotatorKind, WholeDegrees};

    fn rotator(angle_deg: u16, moving: Moving) -> Rotator {
        Rotator {
            position: WholeDegrees::new(angle_deg).map_err(|_| NoPosition::NoSensor),
            limit_cw: None,
            limit_ccw: None,
            kind: RotatorKind::Azimuth,
            moving,
            offset_deg: None,
            target: None,
            start: None,
            is_outside_limits: Some(false),
            name: String::new(),
        }
    }

    /// Returns the motions for readings that come every 250 ms.
    fn motions_after(
        turning: &mut Turning,
        start: Instant,
        readings: &[(u16, Moving)],
    ) -> Vec<AxisMotion> {
        let times = (0_u32..).map(|tick| start + tick * Duration::from_millis(250));
        let look =
            |((angle_deg, moving), instant)| turning.look(&rotator(angle_deg, moving), instant);
        readings.iter().copied().zip(times).map(look).collect()
    }

    #[test]
    fn a_rotator_coasts_until_its_reading_stays() {
        use AxisMotion::{Plus, Still};
        use Moving::{Clockwise, Stopped};
        let readings = [
            (358, Stopped),
            (358, Clockwise),
            (359, Stopped),
            (1, Stopped),
            (1, Stopped),
            (1, Stopped),
            (2, Stopped),
        ];
        let motions = motions_after(&mut Turning::default(), Instant::now(), &readings);
        assert_eq!(motions, [Still, Plus, Plus, Plus, Plus, Still, Still]);
    }

    #[test]
    fn a_reading_that_flickers_is_no_turn() {
        use AxisMotion::{Minus, Still};
        use Moving::{CounterClockwise, Stopped};
        let readings = [
            (43, CounterClockwise),
            (42, Stopped),
            (43, Stopped),
            (42, Stopped),
            (43, Stopped),
            (42, Stopped),
        ];
        let motions = motions_after(&mut Turning::default(), Instant::now(), &readings);
        assert_eq!(motions, [Minus, Minus, Minus, Still, Still, Still]);
    }

    #[test]
    fn one_that_nobody_drives_is_seen_to_turn_all_the_same() {
        use AxisMotion::{Minus, Still};
        use Moving::Stopped;
        let readings = [100, 99, 98, 97, 97, 97].map(|angle_deg| (angle_deg, Stopped));
        let motions = motions_after(&mut Turning::default(), Instant::now(), &readings);
        assert_eq!(motions, [Still, Still, Minus, Minus, Minus, Still]);
    }

    #[test]
    fn without_a_reading_the_drive_alone_tells() {
        let mut turning = Turning::default();
        let now = Instant::now();
        assert_eq!(turning.look(&rotator(999, Moving::Clockwise), now), AxisMotion::Plus);
        assert_eq!(turning.look(&rotator(999, Moving::Stopped), now), AxisMotion::Still);
    }
}
