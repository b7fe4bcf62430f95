//! Rates of an antenna from its measured positions, and the reported barriers.

use std::time::Duration;

use crate::{
    astro::Angle,
    clock::Instant,
    device::{Axis, AxisMotion, Drive, Measured},
    driver::gate::Intervals,
    plan::Barrier,
};

/// Max time between two positions for a rate.
const SPAN: Duration = Duration::from_secs(5);
/// Min time between two positions for a rate. A unit with whole degrees would otherwise show a high
/// rate from a single step.
const APART: Duration = Duration::from_millis(150);
/// Max difference between equal angles, degrees.
const ROUNDING_DEG: f64 = 1e-6;
/// Last measured and reported values.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct BoundsMonitor {
    /// Receive time of the last judged position.
    looked: Option<Instant>,
    /// Later one of the two positions for the rates.
    last: Option<Measured>,
    /// Last angle of each axis, degrees, and its request time.
    angles: [Option<(f64, Instant)>; 2],
    /// Range of the readings of each axis without a motion.
    rests: [RestRange; 2],
    /// Rates of the axes between the last two positions, degrees a second.
    rates_deg_s: [f64; 2],
    /// Reported barriers that the antenna has not left since.
    reported: Vec<Barrier>,
}

/// Range of the readings of an axis that may stand.
///
/// A reading within this range is rounding, noise or sway. A reading beyond an end shifts the
/// range, so that a moving axis leaves the range with each reading.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct RestRange {
    /// Distance from the last reading to the lower and to the upper end, degrees.
    below_deg: f64,
    above_deg: f64,
}

impl RestRange {
    /// Takes a reading that differs by `turned_deg` from the last one. Returns `true` if the
    /// reading and the previous ones exceed a range of `width_deg`.
    fn leave(&mut self, turned_deg: f64, width_deg: f64) -> bool {
        let below_deg = (self.below_deg + turned_deg).max(0.0);
        let above_deg = (self.above_deg - turned_deg).max(0.0);
        self.below_deg = below_deg.min(width_deg);
        self.above_deg = above_deg.min(width_deg);
        below_deg + above_deg > width_deg + ROUNDING_DEG
    }
}

/// Returns `true` if the drive is on in the direction of this rate.
fn is_driven(axis: Axis, rate_deg_s: f64) -> bool {
    match axis.drive {
        Drive::Off => false,
        Drive::On | Drive::Jogged | Drive::Runaway => match axis.motion {
            AxisMotion::Plus => rate_deg_s > 0.0,
            AxisMotion::Minus => rate_deg_s < 0.0,
            AxisMotion::Still | AxisMotion::Unknown(_) => true,
        },
    }
}

/// Returns the rate since the last angle before a gap in the angles, degrees a second.
fn bridged_rate_deg_s(turned_deg: f64, now: Instant, last_time: Instant) -> f64 {
    let span = now.saturating_duration_since(last_time);
    if span.is_zero() || span > SPAN {
        return 0.0;
    }
    Angle::from_degrees(turned_deg).wrapped_180().degrees() / span.as_secs_f64()
}

fn is_at_limit(axis: Axis) -> bool {
    axis.plus_limit != axis.minus_limit
}

impl BoundsMonitor {
    /// Returns `true` once for each position.
    pub(super) fn is_new(&mut self, look: &Measured) -> bool {
        self.looked.replace(look.received) != Some(look.received)
    }

    /// Returns the rates of the axes between the last two positions, degrees a second.
    pub(super) fn last_rates_deg_s(&self) -> [f64; 2] {
        self.rates_deg_s
    }

    pub(super) fn is_reported(&self, barrier: &Barrier) -> bool {
        self.reported.contains(barrier)
    }

    pub(super) fn report(&mut self, barrier: Barrier) {
        self.reported.push(barrier);
    }

    /// Records that the antenna has left the barrier: the next entry is news again.
    pub(super) fn leave(&mut self, barrier: &Barrier) {
        self.reported.retain(|reported| reported != barrier);
    }

    /// Returns the rates of the axes, degrees a second. An axis that misses an angle for a moment
    /// keeps its last rate. An axis whose drive is off, or on in the other direction, turns only
    /// once it has left the range of a standing axis. `rest_width_deg`: width of that range.
    pub(super) fn rates(
        &mut self,
        look: &Measured,
        intervals: Intervals,
        has_elevation: bool,
        rest_width_deg: f64,
    ) -> [f64; 2] {
        let before = self.last;
        if before.is_some_and(|before| span(&before, look) < APART) {
            return self.rates_deg_s;
        }
        self.last = Some(*look);
        let mut rates = before.map_or([0.0; 2], |before| rates_deg_s(&before, look));
        let BoundsMonitor { rates_deg_s: last_rates, angles, rests, .. } = &mut *self;
        let last = last_rates.iter().zip(angles).zip(rests).zip(intervals.0);
        for ((rate, axis), (((last_rate, last), rest), interval)) in
            rates.iter_mut().zip(look.axes).zip(last)
        {
            let Some(angle_deg) = axis.angle_deg else {
                if interval.is_known && !is_at_limit(axis) {
                    *rate = *last_rate;
                }
                continue;
            };
            let Some((last_deg, last_time)) = last.replace((angle_deg, look.requested)) else {
                continue;
            };
            let bridged = before.is_some_and(|before| before.requested < look.requested);
            // Without an angle in the previous position, compute the rate from the last known
            // angle.
            if bridged && *rate == 0.0 {
                *rate = bridged_rate_deg_s(angle_deg - last_deg, look.requested, last_time);
            }
            let turned_deg = Angle::from_degrees(angle_deg - last_deg).wrapped_180().degrees();
            // Noise, gusts and rounding change the reading of a standing axis. Between two
            // consecutive positions, they would look like a rate into a keep-out.
            let has_left = rest.leave(turned_deg, rest_width_deg);
            if !has_left && !is_driven(axis, *rate) {
                *rate = 0.0;
            }
        }
        // A second axis other than elevation does not belong to the antenna.
        let [first, second] = rates;
        let rates = [first, if has_elevation { second } else { 0.0 }];
        self.rates_deg_s = rates;
        rates
    }
}

/// Returns the max time between two measurements. The unit may have measured the reply to a
/// repeated query at any time since the first query.
fn span(before: &Measured, after: &Measured) -> Duration {
    let interval = after.requested.saturating_duration_since(before.requested);
    interval.max(after.received.saturating_duration_since(before.received))
}

/// Returns the rates of the axes, degrees a second; zero for positions that cannot be compared.
fn rates_deg_s(before: &Measured, after: &Measured) -> [f64; 2] {
    let span = span(before, after);
    if span.is_zero() || span > SPAN {
        return [0.0; 2];
    }
    let angles = before.axes.iter().zip(&after.axes);
    let mut rates = [0.0; 2];
    for (rate, (before, after)) in rates.iter_mut().zip(angles) {
        let turned = before.angle_deg.zip(after.angle_deg).map_or(0.0, |(a, b)| b - a);
        *rate = Angle::from_degrees(turned).wrapped_180().degrees() / span.as_secs_f64();
    }
    rates
}
