//! Driven axis, in counts of its sensor. Slow speed and ramps are the simulator's own choices.

use std::ops::RangeInclusive;

use super::AxisOptions;
use crate::{
    protocol::rc2000c::{AxisDrive, Sense, Speed},
    sim::mechanics::{CommandDelay, Gear, Mechanics, MinimumRun, Sensor},
};

/// Slow speed as a share of the full rate.
const SLOW: f64 = 0.2;
/// Time from rest to full rate, seconds.
const RAMP_S: f64 = 0.5;
/// Time from full rate to rest without power, seconds.
const COAST_S: f64 = 0.8;
/// Distance within which an auto move has arrived, counts.
const ARRIVED_COUNTS: f64 = 0.3;
/// Time without motion that jams a drive, seconds.
const STALL_S: f64 = 1.0;

/// Goal of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Goal {
    /// No power: the axis coasts to rest.
    Still,
    /// Turn for a limited time.
    Jog { sense: Sense, rate_counts_s: f64, left_s: f64 },
    /// Motion to a count, where the axis rests.
    AutoMove(f64),
}

/// External trouble of an axis.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct AxisTrouble {
    /// `true` if the axis cannot be turned.
    pub(super) is_stuck: bool,
    /// `true` if the drive takes too much current.
    pub(super) is_overloaded: bool,
    /// `true` if the axis turns without a command.
    pub(super) runs_away: bool,
}

/// Driven axis with drive, gear and sensor.
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
    /// `true` for the elevation, the only axis that reports its limits as an alarm.
    has_limit_alarm: bool,
    trouble: AxisTrouble,
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
            trouble: AxisTrouble::default(),
            alarm: None,
            stalled_s: 0.0,
        }
    }

    pub(super) fn set_trouble(&mut self, trouble: AxisTrouble) {
        self.trouble = trouble;
    }

    pub(super) fn set_strength(&mut self, strength: f64) {
        self.strength = strength;
    }

    fn fast_counts_s(&self) -> f64 {
        self.full_rate_counts_s * self.strength
    }

    /// Returns the acceleration of the drive, counts per second squared.
    fn ramp_counts_s2(&self) -> f64 {
        self.full_rate_counts_s / RAMP_S
    }

    /// Returns the deceleration of an axis without power, counts per second squared.
    fn coast_counts_s2(&self) -> f64 {
        self.full_rate_counts_s / self.coasting_s
    }

    /// Returns the reading of the sensor, counts.
    pub(super) fn counts(&self) -> u16 {
        (self.counts + self.sensor.error_deg() * self.counts_per_deg).round() as u16
    }

    /// Returns the limit at which the axis rests; `None` between the limits.
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

    /// Returns the reported state. A coasting axis is reported as still.
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

    /// Returns `true` if the axis really turns.
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

    /// Clears the alarm, which returns while its cause lasts.
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

    /// Returns the max rate from which the axis can still stop at `target`, counts per second.
    fn approach(&self, target: f64, step_s: f64) -> f64 {
        let distance = target - self.counts;
        // Plan less than the actual braking, so that the braking never comes too late.
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
