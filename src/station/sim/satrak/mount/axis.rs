//! Driven axis. The ramp is the simulator's own choice.

use crate::{
    protocol::satrak::AxisMotion,
    sim::mechanics::{CommandDelay, Gear, Mechanics, MinimumRun, Sensor},
};

/// Reading at the zenith, degrees.
pub(super) const ZENITH_DEG: f64 = 90.0;
/// Time from rest to full rate, seconds.
pub(super) const RAMP_S: f64 = 1.0;
/// Max distance from the target at which the axis has arrived, degrees.
const ARRIVED_DEG: f64 = 0.002;

/// Goal of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Goal {
    /// Rest after slowing down.
    Still,
    /// Motion at a rate, degrees per second.
    Rate(f64),
    /// Motion to an angle in degrees, where the axis rests.
    Angle(f64),
    /// Motion with a moving angle: degrees, and degrees per second.
    Follow(f64, f64),
}

/// Driven axis with drive, gear and sensor.
#[derive(Debug, Clone)]
pub(in crate::sim::satrak) struct Axis {
    angle_deg: f64,
    rate_deg_s: f64,
    /// Goal that the drive follows after its dead time.
    goal: Goal,
    dead_time: CommandDelay<Goal>,
    minimum_run: MinimumRun,
    gear: Gear,
    sensor: Sensor,
    /// Time from full rate to rest without power, seconds.
    coasting_s: f64,
    /// Both ends of the travel.
    ends_deg: [f64; 2],
    full_rate_deg_s: f64,
    /// Remaining share of the full rate, 0 to 1.
    strength: f64,
    /// Ratio of the drive's rate to the commanded rate.
    drive_scale: f64,
    is_motor_dead: bool,
}

impl Axis {
    /// Creates an axis at the zenith, or as near to it as its travel permits.
    pub(super) fn parked(
        [lower_deg, upper_deg]: [f64; 2],
        full_rate_deg_s: f64,
        mechanics: &Mechanics,
        seed: u64,
    ) -> Self {
        let ends_deg = [lower_deg.min(upper_deg), upper_deg.max(lower_deg)];
        Self {
            angle_deg: clamped(ends_deg, ZENITH_DEG),
            rate_deg_s: 0.0,
            goal: Goal::Still,
            dead_time: CommandDelay::new(mechanics),
            minimum_run: MinimumRun::new(mechanics),
            gear: Gear::new(mechanics),
            sensor: Sensor::new(mechanics, seed),
            coasting_s: mechanics.coasting_s(RAMP_S),
            ends_deg,
            full_rate_deg_s,
            strength: 1.0,
            drive_scale: 1.0,
            is_motor_dead: false,
        }
    }

    pub(super) fn place(&mut self, angle_deg: f64) {
        self.angle_deg = clamped(self.ends_deg, angle_deg);
        self.rate_deg_s = 0.0;
        self.goal = Goal::Still;
        self.dead_time.clear();
    }

    pub(super) fn reaches(&self, angle_deg: f64) -> bool {
        let [lowest_deg, highest_deg] = self.ends_deg;
        (lowest_deg..=highest_deg).contains(&angle_deg)
    }

    pub(super) fn set_strength(&mut self, strength: f64) {
        self.strength = strength;
    }

    fn max_rate_deg_s(&self) -> f64 {
        self.full_rate_deg_s * self.strength
    }

    fn ramp_deg_s2(&self) -> f64 {
        self.full_rate_deg_s / RAMP_S
    }

    pub(super) fn set_drive_scale(&mut self, scale: f64) {
        self.drive_scale = scale;
    }

    pub(super) fn set_motor_dead(&mut self, is_dead: bool) {
        self.is_motor_dead = is_dead;
    }

    /// Returns the mechanical angle, degrees.
    pub(in crate::sim::satrak) fn angle_deg(&self) -> f64 {
        self.angle_deg
    }

    /// Returns the reading of the sensor minus the angle, degrees.
    pub(super) fn error_deg(&self) -> f64 {
        self.sensor.error_deg()
    }

    pub(in crate::sim::satrak) fn motion(&self) -> AxisMotion {
        if self.rate_deg_s > 0.0 {
            AxisMotion::Positive
        } else if self.rate_deg_s < 0.0 {
            AxisMotion::Negative
        } else {
            AxisMotion::Still
        }
    }

    pub(in crate::sim::satrak) fn is_at_upper_end(&self) -> bool {
        self.angle_deg >= self.ends_deg[1]
    }

    pub(in crate::sim::satrak) fn is_at_lower_end(&self) -> bool {
        self.angle_deg <= self.ends_deg[0]
    }

    pub(in crate::sim::satrak) fn stop(&mut self) {
        self.dead_time.command(Goal::Still);
    }

    /// Runs until the next command or the end of the travel.
    pub(in crate::sim::satrak) fn run(&mut self, rate_deg_s: f64) {
        let max_rate = self.max_rate_deg_s();
        let rate = (rate_deg_s * self.drive_scale).clamp(-max_rate, max_rate);
        self.dead_time.command(if rate == 0.0 { Goal::Still } else { Goal::Rate(rate) });
    }

    pub(in crate::sim::satrak) fn step(&mut self, by_deg: f64) {
        if by_deg != 0.0 {
            self.go_to(self.angle_deg + by_deg);
        }
    }

    pub(super) fn go_to(&mut self, angle_deg: f64) {
        self.dead_time.command(Goal::Angle(clamped(self.ends_deg, angle_deg)));
    }

    pub(super) fn follow(&mut self, angle_deg: f64, step_s: f64) {
        let angle = clamped(self.ends_deg, angle_deg);
        let newest = match self.dead_time.newest_mut() {
            Some(newest) => newest,
            None => &mut self.goal,
        };
        if let Goal::Follow(before, _) = *newest {
            *newest = Goal::Follow(angle, (angle - before) / step_s);
        } else {
            self.dead_time.command(Goal::Follow(angle, 0.0));
        }
    }

    pub(super) fn advance(&mut self, step_s: f64) {
        self.sensor.advance(step_s);
        if let Some(goal) = self.dead_time.advance(step_s) {
            self.goal = goal;
        }
        self.minimum_run.advance(self.goal != Goal::Still, step_s);
        if self.is_motor_dead {
            self.rate_deg_s = 0.0;
            return;
        }
        let max_rate = self.max_rate_deg_s();
        let requested = match self.goal {
            Goal::Still => 0.0,
            Goal::Rate(rate) => rate,
            Goal::Angle(_) if self.must_run_on() => max_rate.copysign(self.rate_deg_s),
            Goal::Angle(angle) => self.approach(angle, step_s),
            Goal::Follow(angle, rate) => rate + self.approach(angle - rate * step_s, step_s),
        };
        let ramp_deg_s2 = match self.goal {
            Goal::Still => self.full_rate_deg_s / self.coasting_s,
            Goal::Rate(_) | Goal::Angle(_) | Goal::Follow(..) => self.ramp_deg_s2(),
        };
        let ramp = ramp_deg_s2 * step_s;
        let requested = requested.clamp(-max_rate, max_rate);
        self.rate_deg_s += (requested - self.rate_deg_s).clamp(-ramp, ramp);
        self.angle_deg += self.gear.turn(self.rate_deg_s * step_s);
        if let Goal::Angle(angle) = self.goal
            && !self.must_run_on()
            && (self.angle_deg - angle).abs() < ARRIVED_DEG
            && self.rate_deg_s.abs() <= ramp
        {
            self.angle_deg = angle;
            self.rate_deg_s = 0.0;
            self.goal = Goal::Still;
        }
        if !self.reaches(self.angle_deg) {
            self.angle_deg = clamped(self.ends_deg, self.angle_deg);
            self.rate_deg_s = 0.0;
            if matches!(self.goal, Goal::Rate(_)) {
                self.goal = Goal::Still;
            }
        }
    }

    /// Returns `true` while the minimum run keeps the drive on.
    fn must_run_on(&self) -> bool {
        self.rate_deg_s != 0.0 && self.minimum_run.must_keep_running()
    }

    /// Returns the max rate from which the axis can still stop at `angle_deg`, degrees per second.
    fn approach(&self, angle_deg: f64, step_s: f64) -> f64 {
        let distance = angle_deg - self.angle_deg;
        // Plan a little less than the ramp, so that the braking never comes too late.
        let brake = 0.9 * self.ramp_deg_s2();
        let half = brake * step_s / 2.0;
        let fastest = (half * half + 2.0 * brake * distance.abs()).sqrt() - half;
        fastest.min(distance.abs() / step_s).copysign(distance)
    }
}

fn clamped([lowest_deg, highest_deg]: [f64; 2], angle_deg: f64) -> f64 {
    angle_deg.max(lowest_deg).min(highest_deg)
}
