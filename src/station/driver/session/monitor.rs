//! Rates of an antenna by its measured positions, whoever drives it, and the barriers that were
//! reported.

use std::time::Duration;

use crate::{
    astro::Angle,
    clock::Instant,
    device::{Axis, AxisMotion, Drive, Measured},
    driver::gate::Intervals,
    plan::Barrier,
};

/// Rates are taken between positions no further apart than this.
const SPAN: Duration = Duration::from_secs(5);
/// Rates are taken between positions at least this far apart: one step of a unit that counts whole
/// degrees would be a great rate between two that follow at once.
const APART: Duration = Duration::from_millis(150);
/// Angles that differ by less are equal, degrees.
const ROUNDING_DEG: f64 = 1e-6;
/// Values that were measured and reported last.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Watch {
    /// When the position that was judged last came in.
    looked: Option<Instant>,
    /// The later of the two positions that the rates were taken between.
    last: Option<Measured>,
    /// The last angle of each axis, degrees, and when it was asked for.
    angles: [Option<(f64, Instant)>; 2],
    /// Where readings of each axis may be without a motion.
    rests: [RestRange; 2],
    /// Rates of the axes between the last two positions, degrees a second.
    rates_deg_s: [f64; 2],
    /// Barriers that were reported and have not been left since.
    reported: Vec<Barrier>,
}

/// Readings of an axis that may stand.
///
/// A reading that swings within this range is rounding, noise or sway. A reading beyond an end drags the
/// range along, so that an axis that goes on leaves it with each reading.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct RestRange {
    /// Distance from the last reading to the lower and to the upper end, degrees.
    below_deg: f64,
    above_deg: f64,
}

impl RestRange {
    /// Takes a reading that differs by `turned_deg` from the last one. Returns `true` if it is not within
    /// a range of `width_deg` with those before.
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

/// Rate since an angle before readings without one, degrees a second.
fn bridged_rate_deg_s(turned_deg: f64, now: Instant, asked: Instant) -> f64 {
    let span = now.saturating_duration_since(asked);
    if span.is_zero() || span > SPAN {
        return 0.0;
    }
    Angle::from_degrees(turned_deg).wrapped_180().degrees() / span.as_secs_f64()
}

fn is_at_limit(axis: Axis) -> bool {
    axis.plus_limit != axis.minus_limit
}

impl Watch {
    /// Returns `true`, once for each position.
    pub(super) fn is_new(&mut self, look: &Measured) -> bool {
        self.looked.replace(look.received) != Some(look.received)
    }

    /// Rates of the axes between the last two positions, degrees a second.
    pub(super) fn last_rates_deg_s(&self) -> [f64; 2] {
        self.rates_deg_s
    }

    pub(super) fn is_reported(&self, barrier: &Barrier) -> bool {
        self.reported.contains(barrier)
    }

    pub(super) fn report(&mut self, barrier: Barrier) {
        self.reported.push(barrier);
    }

    /// The antenna has left the barrier: the next time is news again.
    pub(super) fn leave(&mut self, barrier: &Barrier) {
        self.reported.retain(|reported| reported != barrier);
    }

    /// Rates of the axes, degrees a second. One that reports no angle for a moment keeps its last
    /// rate. One whose drive is off, or on in the other direction, turns only once it has left the range
    /// in which a standing axis is read.
    /// `rest_width_deg`: width of that range.
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
        let Watch { rates_deg_s: last_rates, angles, rests, .. } = &mut *self;
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
            let Some((last_deg, asked)) = last.replace((angle_deg, look.requested)) else {
                continue;
            };
            let bridged = before.is_some_and(|before| before.requested < look.requested);
            // Without an angle in the position before, the rate comes from the last one that had
            // one.
            if bridged && *rate == 0.0 {
                *rate = bridged_rate_deg_s(angle_deg - last_deg, look.requested, asked);
            }
            let turned_deg = Angle::from_degrees(angle_deg - last_deg).wrapped_180().degrees();
            // Noise, gusts and rounding change the reading of a standing axis. Between two
            // positions that follow at once they would be a rate that leads into a keep-out.
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

/// Longest time between two measurements. The reply to a repeated question may have been measured
/// at any time since the first.
fn span(before: &Measured, after: &Measured) -> Duration {
    let asked = after.requested.saturating_duration_since(before.requested);
    asked.max(after.received.saturating_duration_since(before.received))
}

/// Rates of the axes, degrees a second; zero between positions that cannot be compared.
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
