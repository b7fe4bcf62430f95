//! Kinematics of a rotator. The ramp is the simulator's own choice.

use super::RotatorOptions;
use super::travel::Travel;
use crate::protocol::rotator_genius::{
    Configuration, Direction, Moving, RotatorKind, WholeDegrees,
};
use crate::sim::mechanics::{CommandDelay, Gear, Mechanics, MinimumRun, Sensor};

/// Distance that the rotator coasts from full rate, degrees; also the default stop offset.
const COAST_DEG: f64 = 2.0;

/// Max time between rest and full rate, seconds.
const MAX_RAMP_S: f64 = 1.0;

/// State of the drive.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Drive {
    Off,
    /// Turn without a target, until the next command.
    Free(Direction),
    /// Turn to a target from the start angle.
    To {
        target: WholeDegrees,
        start: WholeDegrees,
        direction: Direction,
    },
}

/// Rotator of the unit.
#[derive(Debug, Clone)]
pub(super) struct Rotor {
    pub(super) name: String,
    pub(super) kind: RotatorKind,
    pub(super) limit_cw: WholeDegrees,
    pub(super) limit_ccw: WholeDegrees,
    /// Reported offset such as declination, degrees; the sensor's angle already includes it.
    pub(super) offset_deg: i16,
    pub(super) stop_offset_deg: u8,
    has_sensor: bool,
    is_sensor_broken: bool,
    is_stuck: bool,
    /// Reading of a frozen sensor, if frozen.
    frozen: Option<WholeDegrees>,
    rests_falsely: bool,
    travel: Travel,
    full_rate_deg_s: f64,
    /// Remaining share of the full rate, 0 to 1.
    strength: f64,
    /// Position on the travel, degrees; beyond its ends if outside the limits.
    place_deg: f64,
    rate_deg_s: f64,
    drive: Drive,
    /// Direction in which the motor has power.
    powered: Moving,
    mechanics: Mechanics,
    dead_time: CommandDelay<Moving>,
    minimum_run: MinimumRun,
    gear: Gear,
    sensor: Sensor,
}

impl Rotor {
    pub(super) fn new(options: &RotatorOptions, mechanics: &Mechanics, seed: u64) -> Self {
        let travel = travel(options.limit_cw, options.limit_ccw);
        Self {
            name: options.name.clone(),
            kind: options.kind,
            limit_cw: options.limit_cw,
            limit_ccw: options.limit_ccw,
            offset_deg: options.offset_deg,
            stop_offset_deg: options.stop_offset_deg,
            has_sensor: options.has_sensor,
            is_sensor_broken: false,
            is_stuck: false,
            frozen: None,
            rests_falsely: false,
            travel,
            full_rate_deg_s: options.full_rate_deg_s,
            strength: 1.0,
            place_deg: travel.place(degrees(options.position)),
            rate_deg_s: 0.0,
            drive: Drive::Off,
            powered: Moving::Stopped,
            mechanics: *mechanics,
            dead_time: CommandDelay::new(mechanics),
            minimum_run: MinimumRun::new(mechanics),
            gear: Gear::new(mechanics),
            sensor: Sensor::new(mechanics, seed),
        }
    }

    /// Returns the true angle, 0 to 360 degrees.
    pub(super) fn angle_deg(&self) -> f64 {
        self.travel.angle_deg(self.place_deg)
    }

    /// Returns the reading of the sensor; `None` without a working sensor.
    pub(super) fn measured(&self) -> Option<WholeDegrees> {
        self.can_measure().then(|| self.frozen.unwrap_or_else(|| self.sensed()))
    }

    /// Returns `true` if the sensor reads outside the limits; `false` without a sensor.
    pub(super) fn is_outside_limits(&self) -> bool {
        self.can_measure() && !self.travel.contains(self.place_deg)
    }

    /// Returns the direction of the drive; a stopped rotator may still coast.
    pub(super) fn moving(&self) -> Moving {
        match self.drive {
            Drive::Off => Moving::Stopped,
            Drive::Free(Direction::Clockwise)
            | Drive::To { direction: Direction::Clockwise, .. } => Moving::Clockwise,
            Drive::Free(_) | Drive::To { .. } => Moving::CounterClockwise,
        }
    }

    /// Returns the target and the start angle of a go-to.
    pub(super) fn journey(&self) -> Option<(WholeDegrees, WholeDegrees)> {
        match self.drive {
            Drive::To { target, start, .. } => Some((target, start)),
            Drive::Off | Drive::Free(_) => None,
        }
    }

    /// Returns `true` if the status reports rest although the rotator may turn.
    pub(super) fn rests_falsely(&self) -> bool {
        self.rests_falsely
    }

    pub(super) fn is_turning(&self) -> bool {
        self.rate_deg_s != 0.0
    }

    pub(super) fn place(&mut self, angle: WholeDegrees) {
        self.place_deg = self.travel.place(degrees(angle));
        self.rate_deg_s = 0.0;
        self.drive = Drive::Off;
        self.cut_power();
    }

    pub(super) fn stop(&mut self) {
        self.switch(Drive::Off);
    }

    /// Switches the drive; the motor obeys after the dead time.
    fn switch(&mut self, drive: Drive) {
        self.drive = drive;
        self.dead_time.command(self.moving());
    }

    /// Stops the motor, and lets the axis coast.
    pub(super) fn lose_power(&mut self) {
        self.drive = Drive::Off;
        self.cut_power();
    }

    fn cut_power(&mut self) {
        self.dead_time.clear();
        self.powered = Moving::Stopped;
    }

    /// Starts a turn to `target`. Returns `false`, without effect, if there is no sensor or
    /// `target` is beyond the limits.
    pub(super) fn go_to(&mut self, target: WholeDegrees) -> bool {
        let target_place = self.travel.place(degrees(target));
        if !self.can_measure() || !self.travel.contains(target_place) {
            return false;
        }
        let is_back = target_place < self.travel.nearest(self.place_deg);
        let direction = if is_back { Direction::CounterClockwise } else { Direction::Clockwise };
        self.set_out(target, direction);
        true
    }

    /// Turns to the limit, or without a target from outside the limits. Returns `false`, without
    /// effect, if there is no sensor.
    pub(super) fn rotate(&mut self, direction: Direction) -> bool {
        if !self.can_measure() {
            return false;
        }
        if self.is_outside_limits() {
            self.switch(Drive::Free(direction));
        } else {
            let limit = match direction {
                Direction::Clockwise => self.limit_cw,
                Direction::CounterClockwise => self.limit_ccw,
            };
            self.set_out(limit, direction);
        }
        true
    }

    fn set_out(&mut self, target: WholeDegrees, direction: Direction) {
        self.place_deg = self.travel.nearest(self.place_deg);
        self.switch(Drive::To { target, start: self.angle(), direction });
    }

    /// Adopts a configuration without its name, and stops the drive.
    pub(super) fn configure(&mut self, configuration: &Configuration) {
        let angle_deg = self.angle_deg();
        self.limit_cw = configuration.limit_cw();
        self.limit_ccw = configuration.limit_ccw();
        self.kind = configuration.kind();
        self.stop_offset_deg = configuration.stop_offset_deg();
        self.travel = travel(self.limit_cw, self.limit_ccw);
        self.place_deg = self.travel.place(angle_deg);
        self.stop();
    }

    /// Sets the faults. Stops the drive of a rotator that loses its sensor.
    pub(super) fn set_faults(&mut self, is_sensor_broken: bool, is_stuck: bool) {
        self.is_sensor_broken = is_sensor_broken;
        self.is_stuck = is_stuck;
        if !self.can_measure() {
            self.stop();
        }
    }

    pub(super) fn set_strength(&mut self, strength: f64) {
        self.strength = strength;
    }

    /// Sets the errors in the status.
    pub(super) fn set_lies(&mut self, is_frozen: bool, rests_falsely: bool) {
        let angle = self.frozen.unwrap_or_else(|| self.sensed());
        self.frozen = is_frozen.then_some(angle);
        self.rests_falsely = rests_falsely;
    }

    pub(super) fn advance(&mut self, step_s: f64) {
        if let Some(powered) = self.dead_time.advance(step_s) {
            self.powered = powered;
        }
        self.minimum_run.advance(self.powered != Moving::Stopped, step_s);
        let may_end = self.powered == Moving::Stopped || !self.minimum_run.must_keep_running();
        if self.has_arrived() && may_end {
            self.drive = Drive::Off;
            self.cut_power();
        }
        let rate = self.full_rate_deg_s * self.strength;
        let requested = match self.powered {
            Moving::Stopped => 0.0,
            Moving::Clockwise => rate,
            Moving::CounterClockwise => -rate,
        };
        let own_s = (2.0 * COAST_DEG / self.full_rate_deg_s).min(MAX_RAMP_S);
        let is_coasting = self.powered == Moving::Stopped;
        let ramp_s = if is_coasting { self.mechanics.coasting_s(own_s) } else { own_s };
        let ramp = self.full_rate_deg_s / ramp_s * step_s;
        self.rate_deg_s += (requested - self.rate_deg_s).clamp(-ramp, ramp);
        if self.is_stuck {
            self.rate_deg_s = 0.0;
        }
        self.place_deg += self.gear.turn(self.rate_deg_s * step_s);
        self.sensor.advance(step_s);
    }

    /// Returns `true` if the rotator has reached the stop offset before its target.
    fn has_arrived(&self) -> bool {
        let Drive::To { target, direction, .. } = self.drive else { return false };
        let distance = self.travel.place(degrees(target)) - self.place_deg;
        let left = match direction {
            Direction::Clockwise => distance,
            Direction::CounterClockwise => -distance,
        };
        left <= f64::from(self.stop_offset_deg)
    }

    fn can_measure(&self) -> bool {
        self.has_sensor && !self.is_sensor_broken
    }

    fn angle(&self) -> WholeDegrees {
        WholeDegrees::nearest(self.angle_deg()).unwrap_or(WholeDegrees::MAX)
    }

    fn sensed(&self) -> WholeDegrees {
        let sensed_deg = self.angle_deg() + self.sensor.error_deg();
        // The unit reports an elevation below the horizon as 0.
        let sensed_deg = match self.kind {
            RotatorKind::Elevation => sensed_deg.max(0.0),
            RotatorKind::Azimuth => sensed_deg.rem_euclid(360.0),
        };
        WholeDegrees::nearest(sensed_deg).unwrap_or(WholeDegrees::MAX)
    }
}

fn degrees(angle: WholeDegrees) -> f64 {
    f64::from(angle.degrees())
}

fn travel(limit_cw: WholeDegrees, limit_ccw: WholeDegrees) -> Travel {
    Travel::new(degrees(limit_cw), degrees(limit_ccw))
}

#[cfg(test)]
mod tests;
