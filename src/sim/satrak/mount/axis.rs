//! A driven axis. Rate, ramp and travel are the simulator's own choices.

use std::ops::RangeInclusive;

use crate::protocol::satrak::AxisMotion;

const LOWEST_DEG: f64 = 5.0;
const HIGHEST_DEG: f64 = 175.0;
/// Travel of an axis, degrees.
pub(super) const TRAVEL_DEG: RangeInclusive<f64> = LOWEST_DEG..=HIGHEST_DEG;
/// Reading at the zenith, degrees.
pub(super) const ZENITH_DEG: f64 = 90.0;
pub(super) const MAX_RATE_DEG_S: f64 = 5.0;
pub(super) const RAMP_DEG_S2: f64 = 5.0;
/// Distance within which the axis has arrived, degrees.
const ARRIVED_DEG: f64 = 0.002;

/// Goal of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Goal {
    /// Slow down and stand.
    Still,
    /// Run at a rate, degrees per second.
    Rate(f64),
    /// Go to an angle and stand there, degrees.
    Angle(f64),
    /// Stay on a moving angle: degrees, and degrees per second.
    Follow(f64, f64),
}

/// A driven axis.
#[derive(Debug, Clone, Copy)]
pub(in crate::sim::satrak) struct Axis {
    angle_deg: f64,
    rate_deg_s: f64,
    goal: Goal,
    /// Ratio of the drive's rate to the commanded one.
    drive_scale: f64,
    is_motor_dead: bool,
}

impl Axis {
    pub(super) fn parked() -> Self {
        Self {
            angle_deg: ZENITH_DEG,
            rate_deg_s: 0.0,
            goal: Goal::Still,
            drive_scale: 1.0,
            is_motor_dead: false,
        }
    }

    pub(super) fn place(&mut self, angle_deg: f64) {
        self.angle_deg = angle_deg.clamp(LOWEST_DEG, HIGHEST_DEG);
        self.rate_deg_s = 0.0;
        self.goal = Goal::Still;
    }

    pub(super) fn set_drive_scale(&mut self, scale: f64) {
        self.drive_scale = scale;
    }

    pub(super) fn set_motor_dead(&mut self, is_dead: bool) {
        self.is_motor_dead = is_dead;
    }

    /// Mechanical angle, degrees.
    pub(in crate::sim::satrak) fn angle_deg(&self) -> f64 {
        self.angle_deg
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
        self.angle_deg >= HIGHEST_DEG
    }

    pub(in crate::sim::satrak) fn is_at_lower_end(&self) -> bool {
        self.angle_deg <= LOWEST_DEG
    }

    pub(in crate::sim::satrak) fn stop(&mut self) {
        self.goal = Goal::Still;
    }

    /// Runs until told otherwise, or to the end of the travel.
    pub(in crate::sim::satrak) fn run(&mut self, rate_deg_s: f64) {
        let rate = (rate_deg_s * self.drive_scale).clamp(-MAX_RATE_DEG_S, MAX_RATE_DEG_S);
        self.goal = if rate == 0.0 { Goal::Still } else { Goal::Rate(rate) };
    }

    pub(in crate::sim::satrak) fn step(&mut self, by_deg: f64) {
        if by_deg != 0.0 {
            self.go_to(self.angle_deg + by_deg);
        }
    }

    pub(super) fn go_to(&mut self, angle_deg: f64) {
        self.goal = Goal::Angle(angle_deg.clamp(LOWEST_DEG, HIGHEST_DEG));
    }

    pub(super) fn follow(&mut self, angle_deg: f64, step_s: f64) {
        let angle = angle_deg.clamp(LOWEST_DEG, HIGHEST_DEG);
        let rate = match self.goal {
            Goal::Follow(before, _) => (angle - before) / step_s,
            _ => 0.0,
        };
        self.goal = Goal::Follow(angle, rate);
    }

    pub(super) fn advance(&mut self, step_s: f64) {
        if self.is_motor_dead {
            self.rate_deg_s = 0.0;
            return;
        }
        let wanted = match self.goal {
            Goal::Still => 0.0,
            Goal::Rate(rate) => rate,
            Goal::Angle(angle) => self.approach(angle, step_s),
            Goal::Follow(angle, rate) => rate + self.approach(angle - rate * step_s, step_s),
        };
        let ramp = RAMP_DEG_S2 * step_s;
        let wanted = wanted.clamp(-MAX_RATE_DEG_S, MAX_RATE_DEG_S);
        self.rate_deg_s += (wanted - self.rate_deg_s).clamp(-ramp, ramp);
        self.angle_deg += self.rate_deg_s * step_s;
        if let Goal::Angle(angle) = self.goal
            && (self.angle_deg - angle).abs() < ARRIVED_DEG
            && self.rate_deg_s.abs() <= ramp
        {
            self.angle_deg = angle;
            self.rate_deg_s = 0.0;
            self.goal = Goal::Still;
        }
        if !TRAVEL_DEG.contains(&self.angle_deg) {
            self.angle_deg = self.angle_deg.clamp(LOWEST_DEG, HIGHEST_DEG);
            self.rate_deg_s = 0.0;
            if matches!(self.goal, Goal::Rate(_)) {
                self.goal = Goal::Still;
            }
        }
    }

    /// Fastest rate from which the axis can still halt at `angle_deg`.
    fn approach(&self, angle_deg: f64, step_s: f64) -> f64 {
        let away = angle_deg - self.angle_deg;
        // A little less than the ramp, so that the braking never falls behind.
        let brake = 0.9 * RAMP_DEG_S2;
        let half = brake * step_s / 2.0;
        let fastest = (half * half + 2.0 * brake * away.abs()).sqrt() - half;
        fastest.min(away.abs() / step_s).copysign(away)
    }
}
