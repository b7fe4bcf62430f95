//! Interval of possible angles of each axis, because a unit may not report an angle.

use std::time::Duration;

use super::Gate;
use crate::{
    clock::Instant,
    device::{Axis, Measured},
    plan::Sweep,
};

/// Max age of an angle that replaces a missing one: the max age of a position for a jog.
const MAX_ANGLE_GAP: Duration = Duration::from_secs(1);
/// Max distance of a limit switch from the end of the travel in the settings, degrees.
const AT_LIMIT_DEG: f64 = 5.0;
/// Range of all elevations at one azimuth, for an antenna that does not turn in elevation, degrees.
const ALL_ELEVATIONS_DEG: (f64, f64) = (0.0, 90.0);

/// Interval of possible angles of one axis, degrees as the mount counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::driver) struct Interval {
    pub(in crate::driver) from_deg: f64,
    pub(in crate::driver) to_deg: f64,
    /// `true` if the unit reports the angle or the limit switch of the axis.
    pub(in crate::driver) is_known: bool,
}

impl Interval {
    fn from_angle(deg: f64) -> Self {
        Self { from_deg: deg, to_deg: deg, is_known: true }
    }

    /// Restricts a range to the angles that this axis can reach.
    fn restrict(self, (from_deg, to_deg): (f64, f64), travel_deg: (f64, f64)) -> (f64, f64) {
        if self.is_known {
            return (from_deg, to_deg);
        }
        let lowest_deg = travel_deg.0.min(self.from_deg);
        let highest_deg = travel_deg.1.max(self.to_deg);
        (from_deg.max(lowest_deg), to_deg.min(highest_deg))
    }

    /// Returns the range of an axis that may have turned at up to its maximum rate since `last`.
    fn from_last(
        last: LastAngle,
        elapsed: Duration,
        rate_deg_s: f64,
        travel_deg: (f64, f64),
    ) -> Self {
        let turned_deg = rate_deg_s * elapsed.as_secs_f64();
        // An axis that was beyond its travel may still be beyond it.
        let (lowest_deg, highest_deg) = (travel_deg.0.min(last.deg), travel_deg.1.max(last.deg));
        Self {
            from_deg: (last.deg - turned_deg).max(lowest_deg),
            to_deg: (last.deg + turned_deg).min(highest_deg),
            is_known: false,
        }
    }
}

/// Possible angles of both axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::driver) struct Intervals(pub(in crate::driver) [Interval; 2]);

impl Intervals {
    pub(in crate::driver) fn sweep(self) -> Sweep {
        Sweep(self.0.map(|axis| (axis.from_deg, axis.to_deg)))
    }

    /// Returns the possible angles of the axes after turning by `ahead_deg`. An axis without a
    /// known angle stays within its travel.
    pub(super) fn turn(self, ahead_deg: [f64; 2], travel_deg: [(f64, f64); 2]) -> Sweep {
        let Sweep(ahead) = self.sweep().turned(ahead_deg);
        let [first, second] = self.0;
        let [first_ahead, second_ahead] = ahead;
        let [first_travel, second_travel] = travel_deg;
        Sweep([
            first.restrict(first_ahead, first_travel),
            second.restrict(second_ahead, second_travel),
        ])
    }

    /// Returns the first axis without a known angle.
    pub(in crate::driver) fn unknown(self) -> Option<usize> {
        self.0.iter().position(|axis| !axis.is_known)
    }

    /// Returns the angles of both axes; `None` if either angle is unknown.
    pub(in crate::driver) fn angles_deg(self) -> Option<[f64; 2]> {
        self.unknown().is_none().then(|| self.0.map(|axis| axis.from_deg))
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct LastAngle {
    deg: f64,
    requested: Instant,
    /// Time of the first limit switch report after the angle.
    at_limit: Option<Instant>,
}

/// Last reported angle of each axis.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct LastAngles([Option<LastAngle>; 2]);

impl LastAngles {
    fn take(&mut self, measured: &Measured) {
        for (last, axis) in self.0.iter_mut().zip(measured.axes) {
            let requested = measured.requested;
            if let Some(deg) = angle_deg(axis) {
                *last = Some(LastAngle { deg, requested, at_limit: None });
            } else if let Some(last) = last.as_mut().filter(|_| axis.plus_limit != axis.minus_limit)
            {
                // The axis had already reached the switch: later readings do not extend its travel
                // time.
                last.at_limit.get_or_insert(requested);
            }
        }
    }
}

impl Gate {
    /// Stores the angles of the current position.
    pub(in crate::driver) fn remember_angles(&mut self) {
        if let Some(measured) = self.controller.state().measured {
            self.last_angles.take(&measured);
        }
    }

    /// Forgets the angles: without a link, anybody may turn the axes, and the steady clock pauses
    /// while the computer sleeps.
    pub(in crate::driver) fn forget_angles(&mut self) {
        self.last_angles = LastAngles::default();
    }

    /// Returns the intervals of the axes at the last position; `None` before the first position.
    pub(in crate::driver) fn intervals(&self) -> Option<Intervals> {
        let measured = self.state().measured?;
        let [first, second] = measured.axes;
        let [first_travel_deg, second_travel_deg] = self.mount.travel_deg();
        let [first_last, second_last] = self.last_angles.0;
        let rate_deg_s = self.limits.maximum_rate_deg_s;
        let interval = |axis, travel_deg, last| {
            interval(axis, travel_deg, last, measured.requested, rate_deg_s)
        };
        let (from_deg, to_deg) = ALL_ELEVATIONS_DEG;
        Some(Intervals([
            interval(first, first_travel_deg, first_last),
            if self.variant.capabilities.has_elevation() {
                interval(second, second_travel_deg, second_last)
            } else {
                // A keep-out with an azimuth range applies at any elevation.
                Interval { from_deg, to_deg, is_known: true }
            },
        ]))
    }

    /// Returns the request time of the oldest angle in use.
    pub(super) fn oldest_request(&self) -> Option<Instant> {
        let measured = self.state().measured?;
        let count = self.variant.capabilities.axis_count();
        let axes = measured.axes.into_iter().zip(self.last_angles.0).take(count);
        // A substitute angle is older than its position. Azel must judge a motion from the older
        // time.
        let bridged =
            axes.filter(|(axis, _)| angle_deg(*axis).is_none()).filter_map(|(_, last)| {
                last.map(|last| last.requested)
                    .filter(|requested| is_bridged(*requested, measured.requested))
            });
        bridged.chain([measured.requested]).min()
    }
}

/// Returns the interval of an axis. `requested` is the request time of its reading.
fn interval(
    axis: Axis,
    travel_deg: (f64, f64),
    last: Option<LastAngle>,
    requested: Instant,
    rate_deg_s: f64,
) -> Interval {
    if let Some(deg) = angle_deg(axis) {
        return Interval::from_angle(deg);
    }
    match (axis.minus_limit, axis.plus_limit, last) {
        // An RC2000C reports no angle of an axis at its limit switch.
        (true, false, last) => at_limit(travel_deg.0, last, requested, rate_deg_s),
        (false, true, last) => at_limit(travel_deg.1, last, requested, rate_deg_s),
        // Two active switches contradict each other, so neither locates the axis.
        (_, _, Some(last)) if is_bridged(last.requested, requested) => {
            Interval::from_angle(last.deg)
        }
        (_, _, Some(last)) => {
            let elapsed = requested.saturating_duration_since(last.requested);
            Interval::from_last(last, elapsed, rate_deg_s, travel_deg)
        }
        (_, _, None) => {
            let (from_deg, to_deg) = travel_deg;
            Interval { from_deg, to_deg, is_known: false }
        }
    }
}

/// Returns the interval of an axis at the limit switch at an end of its travel. If the axis cannot
/// have reached that end since its last angle, the interval covers all angles between the two.
fn at_limit(
    end_deg: f64,
    last: Option<LastAngle>,
    requested: Instant,
    rate_deg_s: f64,
) -> Interval {
    let Some(last) = last else { return Interval::from_angle(end_deg) };
    let elapsed = last.at_limit.unwrap_or(requested).saturating_duration_since(last.requested);
    let reached_deg = rate_deg_s * elapsed.as_secs_f64() + AT_LIMIT_DEG;
    if (end_deg - last.deg).abs() <= reached_deg {
        return Interval::from_angle(end_deg);
    }
    Interval { from_deg: end_deg.min(last.deg), to_deg: end_deg.max(last.deg), is_known: false }
}

fn is_bridged(last: Instant, requested: Instant) -> bool {
    requested.saturating_duration_since(last) < MAX_ANGLE_GAP
}

fn angle_deg(axis: Axis) -> Option<f64> {
    axis.angle_deg.filter(|deg| deg.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::{AxisMotion, Drive};

    fn axis(angle_deg: Option<f64>, [minus_limit, plus_limit]: [bool; 2]) -> Axis {
        Axis { angle_deg, motion: AxisMotion::Still, drive: Drive::Off, plus_limit, minus_limit }
    }

    /// Returns the interval, in degrees, of an axis with a travel from -5 to 100 degrees and a rate
    /// up to 2 degrees a second. The axis stood at 10 degrees `seconds` ago.
    fn interval_after(seconds: u64, axis: Axis) -> (f64, f64, bool) {
        let requested = Instant::now();
        let now = requested + Duration::from_secs(seconds);
        let last = Some(LastAngle { deg: 10.0, requested, at_limit: None });
        let Interval { from_deg, to_deg, is_known } = interval(axis, (-5.0, 100.0), last, now, 2.0);
        (from_deg, to_deg, is_known)
    }

    #[test]
    fn without_an_angle_it_widens_from_the_last_one_up_to_the_travel() {
        let blank = axis(None, [false; 2]);
        assert_eq!(interval_after(3, axis(Some(30.0), [false; 2])), (30.0, 30.0, true));
        assert_eq!(interval_after(0, blank), (10.0, 10.0, true), "one blank reading is no news");
        assert_eq!(interval_after(1, blank), (8.0, 12.0, false));
        assert_eq!(interval_after(2, blank), (6.0, 14.0, false));
        assert_eq!(interval_after(10, blank), (-5.0, 30.0, false));
        assert_eq!(interval_after(1000, blank), (-5.0, 100.0, false));
        assert_eq!(interval_after(2, axis(Some(f64::NAN), [false; 2])), (6.0, 14.0, false));
    }

    #[test]
    fn a_limit_switch_means_that_end_of_the_travel() {
        assert_eq!(interval_after(5, axis(None, [true, false])), (-5.0, -5.0, true));
        assert_eq!(interval_after(50, axis(None, [false, true])), (100.0, 100.0, true));
        assert_eq!(
            interval_after(1, axis(None, [false, true])),
            (10.0, 100.0, false),
            "it is elsewhere"
        );
        assert_eq!(
            interval_after(2, axis(None, [true, true])),
            (6.0, 14.0, false),
            "they contradict"
        );
    }
}
