//! A driven axis, in counts of its sensor. Slow speed and ramps are the simulator's own
//! choices.

use std::ops::RangeInclusive;

use super::AxisOptions;
use crate::{
    protocol::rc2000c::{AxisDrive, Sense, Speed},
    sim::mechanics::{CommandDelay, Gear, Mechanics, MinimumRun, Sensor},
};

/// Share of slow speed in the full rate.
const SLOW: f64 = 0.2;
/// Time in which a drive comes to its full rate, seconds.
const RAMP_S: f64 = 0.5;
/// Time in which an axis without power comes to rest from it, seconds.
const COAST_S: f64 = 0.8;
/// Distance within which an auto move has arrived.
const ARRIVED_COUNTS: f64 = 0.3;
/// Time without motion after which a drive is jammed.
const STALL_S: f64 = 1.0;

/// Goal of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Goal {
    /// No power: coast and stand.
    Still,
    /// Turn for a time.
    Jog { sense: Sense, rate_counts_s: f64, left_s: f64 },
    /// Go to a count and stand there.
    AutoMove(f64),
}

/// External trouble of an axis.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Trouble {
    /// The axis cannot be turned.
    pub(super) is_stuck: bool,
    /// The drive takes too much current.
    pub(super) is_overloaded: bool,
    /// The axis turns without a command.
    pub(super) runs_away: bool,
}

/// A driven axis.
#[derive(Debug, Clone)]
pub(super) struct Axis {
    counts: f64,
    rate_counts_s: f64,
    /// Goal that the unit reports.
    goal: Goal,
    /// Goal that the drive follows after its dead time.
    obeyed: Goal,
    dead_time: CommandDelay<Goal>,
    minimum_run: MinimumRun,
    gear: Gear,
    sensor: Sensor,
    counts_per_deg: f64,
    /// Time from full rate to rest without power, seconds.
    coasting_s: f64,
    travel: RangeInclusive<f64>,
    full_rate_counts_s: f64,
    /// Remaining share of the full rate, 0 to 1.
    strength: f64,
    /// Only the elevation reports its limits as an alarm.
    has_limit_alarm: bool,
    trouble: Trouble,
    alarm: Option<AxisDrive>,
    stalled_s: f64,
}

impl Axis {
    pub(super) fn new(
        counts: u16,
        options: &AxisOptions,
        mechanics: &Mechanics,
        seed: u64,
        has_limit_alarm: bool,
    ) -> Self {
        let [min, max] = [*options.travel.start(), *options.travel.end()].map(f64::from);
        Self {
            counts: f64::from(counts).max(min).min(max),
            rate_counts_s: 0.0,
            goal: Goal::Still,
            obeyed: Goal::Still,
            dead_time: CommandDelay::new(mechanics),
            minimum_run: MinimumRun::new(mechanics),
            gear: Gear::new(mechanics),
            sensor: Sensor::new(mechanics, seed),
            counts_per_deg: options.counts_per_deg,
            coasting_s: mechanics.coasting_s(COAST_S),
            travel: min..=max,
            full_rate_counts_s: options.full_rate_counts_s,
            strength: 1.0,
            has_limit_alarm,
            trouble: Trouble::default(),
            alarm: None,
            stalled_s: 0.0,
        }
    }

    pub(super) fn set_trouble(&mut self, trouble: Trouble) {
        self.trouble = trouble;
    }

    pub(super) fn set_strength(&mut self, strength: f64) {
        self.strength = strength;
    }

    fn fast_counts_s(&self) -> f64 {
        self.full_rate_counts_s * self.strength
    }

    /// Acceleration of the drive.
    fn ramp_counts_s2(&self) -> f64 {
        self.full_rate_counts_s / RAMP_S
    }

    /// Deceleration of an axis without power.
    fn coast_counts_s2(&self) -> f64 {
        self.full_rate_counts_s / self.coasting_s
    }

    /// Reading of the sensor.
    pub(super) fn counts(&self) -> u16 {
        (self.counts + self.sensor.error_deg() * self.counts_per_deg).round() as u16
    }

    /// Limit at which the axis stands.
    pub(super) fn limit(&self) -> Option<Sense> {
        if self.counts <= *self.travel.start() {
            Some(Sense::Negative)
        } else if self.counts >= *self.travel.end() {
            Some(Sense::Positive)
        } else {
            None
        }
    }

    pub(super) fn reaches(&self, counts: u16) -> bool {
        self.travel.contains(&counts.into())
    }

    /// Reported state. An axis that coasts is reported as still.
    pub(super) fn drive(&self) -> AxisDrive {
        if let Some(alarm) = self.alarm {
            return alarm;
        }
        match self.goal {
            Goal::Still => AxisDrive::Still,
            Goal::AutoMove(_) => AxisDrive::AutoMove,
            Goal::Jog { sense, .. } if self.rate_counts_s * sign(sense) < 0.0 => {
                AxisDrive::Pending(sense)
            }
            Goal::Jog { sense, .. } => AxisDrive::Moving(sense),
        }
    }

    /// Returns `true` if the metal turns.
    pub(super) fn is_turning(&self) -> bool {
        self.rate_counts_s != 0.0
    }

    pub(super) fn has_arrived(&self) -> bool {
        self.goal == Goal::Still && !self.is_turning()
    }

    pub(super) fn is_auto_moving(&self) -> bool {
        matches!(self.goal, Goal::AutoMove(_))
    }

    pub(super) fn stop(&mut self) {
        self.set_goal(Goal::Still);
    }

    /// Sets the goal; the drive follows it after its dead time.
    fn set_goal(&mut self, goal: Goal) {
        self.goal = goal;
        self.dead_time.command(goal);
    }

    /// Ends the drive's goal but keeps a pending one.
    fn end(&mut self) {
        self.obeyed = Goal::Still;
        if self.dead_time.is_idle() {
            self.goal = Goal::Still;
        }
    }

    pub(super) fn jog(&mut self, sense: Sense, speed: Speed, duration_s: f64) {
        let rate_counts_s = match speed {
            Speed::Slow => SLOW * self.fast_counts_s(),
            Speed::Fast => self.fast_counts_s(),
        };
        self.begin(Goal::Jog { sense, rate_counts_s, left_s: duration_s });
    }

    pub(super) fn auto_move(&mut self, counts: u16) {
        self.begin(Goal::AutoMove(counts.into()));
    }

    /// Sets the goal. A drive in alarm takes no power, except in a limit alarm.
    fn begin(&mut self, goal: Goal) {
        if self.alarm == Some(AxisDrive::Limit) {
            self.alarm = None;
        }
        if self.alarm.is_none() {
            self.set_goal(goal);
            self.stalled_s = 0.0;
        }
    }

    /// Clears the alarm; it comes back while its cause lasts.
    pub(super) fn reset(&mut self) {
        self.alarm = None;
        self.stalled_s = 0.0;
    }

    fn fail(&mut self, alarm: AxisDrive) {
        self.alarm = Some(alarm);
        self.dead_time.clear();
        self.end();
    }

    pub(super) fn advance(&mut self, step_s: f64) {
        self.sensor.advance(step_s);
        if let Some(obeyed) = self.dead_time.advance(step_s) {
            self.obeyed = obeyed;
        }
        self.minimum_run.advance(self.obeyed != Goal::Still, step_s);
        let is_commanded = self.goal != Goal::Still;
        if self.trouble.runs_away {
            self.fail(AxisDrive::Runaway);
            self.turn(SLOW * self.full_rate_counts_s, step_s);
            return;
        }
        if self.trouble.is_overloaded && is_commanded {
            self.fail(AxisDrive::Overcurrent);
        }
        if self.trouble.is_stuck {
            self.rate_counts_s = 0.0;
            self.stalled_s = if is_commanded { self.stalled_s + step_s } else { 0.0 };
            if self.stalled_s >= STALL_S {
                self.fail(AxisDrive::Jammed);
            }
            return;
        }
        let must_run_on = self.must_run_on();
        let runs_on_counts_s = self.fast_counts_s().copysign(self.rate_counts_s);
        let (wanted_counts_s, powered_s) = match &mut self.obeyed {
            Goal::Still => (0.0, step_s),
            Goal::AutoMove(_) if must_run_on => (runs_on_counts_s, step_s),
            Goal::AutoMove(target) => {
                let target = *target;
                (self.approach(target, step_s), step_s)
            }
            Goal::Jog { sense, rate_counts_s, left_s } => {
                let powered_s = step_s.min(*left_s);
                *left_s -= powered_s;
                (*rate_counts_s * sign(*sense), powered_s)
            }
        };
        self.turn(wanted_counts_s, powered_s);
        if matches!(self.obeyed, Goal::Jog { left_s, .. } if left_s <= 0.0) {
            self.end();
            self.turn(0.0, step_s - powered_s);
        }
        if let Goal::AutoMove(target) = self.obeyed
            && !self.must_run_on()
            && (target - self.counts).abs() < ARRIVED_COUNTS
            && self.rate_counts_s.abs() <= self.coast_counts_s2() * step_s
        {
            self.counts = target;
            self.rate_counts_s = 0.0;
            self.end();
        }
    }

    /// Returns `true` while the minimum run keeps the drive on.
    fn must_run_on(&self) -> bool {
        self.is_turning() && self.minimum_run.must_keep_running()
    }

    /// Turns for `step_s` while the rate approaches `wanted_counts_s`.
    fn turn(&mut self, wanted_counts_s: f64, step_s: f64) {
        let is_braking = wanted_counts_s.abs() < self.rate_counts_s.abs()
            || wanted_counts_s * self.rate_counts_s < 0.0;
        let ramp = if is_braking { self.coast_counts_s2() } else { self.ramp_counts_s2() };
        let max_change = step_s * ramp;
        let change = wanted_counts_s - self.rate_counts_s;
        self.rate_counts_s += change.clamp(-max_change, max_change);
        let turned_deg = self.rate_counts_s * step_s / self.counts_per_deg;
        self.counts += self.gear.turn(turned_deg) * self.counts_per_deg;
        let end = if self.rate_counts_s < 0.0 { *self.travel.start() } else { *self.travel.end() };
        let is_beyond = (self.counts - end) * self.rate_counts_s >= 0.0;
        if is_beyond && self.rate_counts_s != 0.0 {
            self.counts = end;
            self.rate_counts_s = 0.0;
            if matches!(self.obeyed, Goal::Jog { .. }) {
                self.end();
                if self.has_limit_alarm {
                    self.alarm = Some(AxisDrive::Limit);
                }
            }
        }
    }

    /// Fastest rate from which the axis can still halt at `target`.
    fn approach(&self, target: f64, step_s: f64) -> f64 {
        let distance = target - self.counts;
        // Less than the actual braking, so that the braking never falls behind.
        let brake = 0.8 * self.coast_counts_s2();
        let half = brake * step_s / 2.0;
        let fastest = (half * half + 2.0 * brake * distance.abs()).sqrt() - half;
        fastest.min(distance.abs() / step_s).min(self.fast_counts_s()).copysign(distance)
    }
}

fn sign(sense: Sense) -> f64 {
    match sense {
        Sense::Negative => -1.0,
        Sense::Positive => 1.0,
    }
}

#[cfg(test)]
mod tests;
