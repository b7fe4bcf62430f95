//! Kinematics of an X/Y mount: X is the lower axis, and both axes read 90 degrees at the
//! zenith.

mod axis;

use crate::astro::xy_mount::{AxisAngles, axes_from_azel, azel_from_axes};
use crate::astro::{Angle, AzEl};
use crate::sim::Mechanics;

use self::axis::{Axis, ZENITH_DEG};

/// X/Y mount with both axes.
#[derive(Debug, Clone)]
pub(super) struct Mount {
    pub(super) x: Axis,
    pub(super) y: Axis,
}

impl Mount {
    /// Creates a mount parked at the zenith, with this travel and full rate and these imperfections
    /// for both axes.
    pub(super) fn new(
        ends_deg: [f64; 2],
        full_rate_deg_s: f64,
        mechanics: &Mechanics,
        seed: u64,
    ) -> Self {
        let seed = seed.rotate_left(1);
        let axis = |number| Axis::parked(ends_deg, full_rate_deg_s, mechanics, seed ^ number);
        Self { x: axis(0), y: axis(1) }
    }

    /// Moves both axes to these angles at once, degrees.
    pub(super) fn place(&mut self, [x_deg, y_deg]: [f64; 2]) {
        self.x.place(x_deg);
        self.y.place(y_deg);
    }

    pub(super) fn stop(&mut self) {
        self.x.stop();
        self.y.stop();
    }

    pub(super) fn is_moving(&self) -> bool {
        self.x.motion().is_moving() || self.y.motion().is_moving()
    }

    /// Sends each axis to its mechanical angle, degrees, without a common path. Returns `false`,
    /// without effect, if an angle is beyond its travel.
    pub(super) fn go_to(&mut self, [x_deg, y_deg]: [f64; 2]) -> bool {
        let reachable = self.x.reaches(x_deg) && self.y.reaches(y_deg);
        if reachable {
            self.x.go_to(x_deg);
            self.y.go_to(y_deg);
        }
        reachable
    }

    /// Keeps both axes on a moving target, given by its position after `step_s` seconds.
    pub(super) fn follow(&mut self, [x_deg, y_deg]: [f64; 2], step_s: f64) {
        self.x.follow(x_deg, step_s);
        self.y.follow(y_deg, step_s);
    }

    pub(super) fn advance(&mut self, step_s: f64) {
        self.x.advance(step_s);
        self.y.advance(step_s);
    }

    /// Returns the sensor readings minus the true angles, degrees.
    pub(super) fn errors_deg(&self) -> [f64; 2] {
        [self.x.error_deg(), self.y.error_deg()]
    }

    pub(super) fn set_drive_scales(&mut self, x: f64, y: f64) {
        self.x.set_drive_scale(x);
        self.y.set_drive_scale(y);
    }

    pub(super) fn set_strength(&mut self, [x, y]: [f64; 2]) {
        self.x.set_strength(x);
        self.y.set_strength(y);
    }

    pub(super) fn set_dead_motors(&mut self, x: bool, y: bool) {
        self.x.set_motor_dead(x);
        self.y.set_motor_dead(y);
    }
}

/// Returns the X and Y angles that point at `direction`, degrees.
pub(super) fn xy_from_azel(direction: AzEl, lower_axis: Angle) -> [f64; 2] {
    let axes = axes_from_azel(direction, lower_axis);
    [ZENITH_DEG + axes.lower.degrees(), ZENITH_DEG + axes.upper.degrees()]
}

/// Returns the direction of X and Y angles in degrees.
pub(super) fn azel_from_xy([x_deg, y_deg]: [f64; 2], lower_axis: Angle) -> AzEl {
    let axes = AxisAngles {
        lower: Angle::from_degrees(x_deg - ZENITH_DEG),
        upper: Angle::from_degrees(y_deg - ZENITH_DEG),
    };
    azel_from_axes(axes, lower_axis)
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::axis::RAMP_S;
    use super::*;
    use crate::protocol::satrak::AxisMotion;

    const STEP_S: f64 = 0.05;
    const MAX_RATE_DEG_S: f64 = 5.0;

    fn mount() -> Mount {
        Mount::new([5.0, 175.0], MAX_RATE_DEG_S, &Mechanics::default(), 1)
    }

    fn run(mount: &mut Mount, seconds: f64) -> Vec<f64> {
        let steps = (seconds / STEP_S).round() as usize;
        let mut angles = Vec::new();
        for _ in 0..steps {
            mount.advance(STEP_S);
            angles.push(mount.x.angle_deg());
        }
        angles
    }

    #[test]
    fn the_documents_status_example_fits_its_own_elevation() {
        let direction = azel_from_xy([80.0, 35.0], Angle::ZERO);
        assert!((direction.elevation_deg() - 34.35).abs() < 0.06);
        let back = xy_from_azel(direction, Angle::ZERO);
        assert!((back[0] - 80.0).abs() < 1e-9 && (back[1] - 35.0).abs() < 1e-9);
    }

    #[test]
    fn an_axis_ramps_and_halts_at_its_angle_without_overshoot() {
        for target in [90.01, 91.0, 130.0, 174.9, 12.0] {
            let mut mount = mount();
            assert!(mount.go_to([target, 90.0]));
            let angles = run(&mut mount, 40.0);
            assert!((mount.x.angle_deg() - target).abs() < 1e-9, "{target}");
            assert!(!mount.is_moving(), "{target}");
            let max = angles.iter().map(|angle| (angle - 90.0).abs()).fold(0.0, f64::max);
            assert!(max <= (target - 90.0).abs() + 0.01, "{target} {max}");
        }
    }

    #[test]
    fn rates_and_accelerations_stay_within_their_bounds() {
        let mut mount = mount();
        mount.x.run(50.0);
        let angles = run(&mut mount, 3.0);
        let rates: Vec<f64> = angles.windows(2).map(|pair| (pair[1] - pair[0]) / STEP_S).collect();
        assert!(rates.iter().all(|rate| *rate <= MAX_RATE_DEG_S + 1e-9));
        let jumps = rates.windows(2).map(|pair| (pair[1] - pair[0]) / STEP_S);
        assert!(jumps.into_iter().all(|ramp| ramp.abs() <= MAX_RATE_DEG_S / RAMP_S + 1e-6));
        mount.stop();
        run(&mut mount, 1.2);
        assert!(!mount.is_moving());
    }

    #[test]
    fn the_end_switches_end_a_run_in_one_direction_only() {
        let mut mount = mount();
        mount.x.run(5.0);
        run(&mut mount, 30.0);
        assert!(mount.x.is_at_upper_end() && !mount.x.is_at_lower_end());
        assert!(!mount.is_moving());
        mount.x.run(-5.0);
        run(&mut mount, 1.0);
        assert!(!mount.x.is_at_upper_end() && mount.is_moving());
        assert!(!mount.go_to([90.0, 176.0]));
    }

    #[test]
    fn a_moving_target_is_followed_without_lag() {
        let mut mount = mount();
        let mut worst: f64 = 0.0;
        for step in 0..400 {
            let target = 95.0 + 2.0 * f64::from(step) * STEP_S;
            mount.follow([target, 90.0], STEP_S);
            mount.advance(STEP_S);
            if step > 100 {
                worst = worst.max((mount.x.angle_deg() - target).abs());
            }
        }
        assert!(worst < 0.01, "{worst}");
    }

    #[test]
    fn a_weak_drive_is_slower_and_the_travel_is_that_of_the_mount() {
        let mut mount = Mount::new([20.0, 160.0], 3.0, &Mechanics::default(), 1);
        assert!(!mount.go_to([170.0, 90.0]));
        mount.set_strength([0.5; 2]);
        mount.x.run(5.0);
        let angles = run(&mut mount, 10.0);
        let fastest = angles.windows(2).map(|pair| (pair[1] - pair[0]) / STEP_S);
        assert!((fastest.fold(0.0, f64::max) - 1.5).abs() < 1e-9);
        run(&mut mount, 100.0);
        assert!(mount.x.is_at_upper_end() && (mount.x.angle_deg() - 160.0).abs() < 1e-9);
    }

    #[test]
    fn a_dead_motor_does_not_move() {
        let mut mount = mount();
        mount.set_dead_motors(true, false);
        mount.x.run(5.0);
        mount.y.run(5.0);
        run(&mut mount, 1.0);
        assert_eq!(mount.x.motion(), AxisMotion::Still);
        assert_eq!(mount.y.motion(), AxisMotion::Positive);
    }

    fn imperfect(mechanics: Mechanics) -> Mount {
        Mount::new([5.0, 175.0], MAX_RATE_DEG_S, &mechanics, 7)
    }

    #[test]
    fn a_late_drive_starts_and_stops_late_and_then_follows_without_lag() {
        let dead_time = Duration::from_millis(500);
        let mut mount = imperfect(Mechanics { dead_time, ..Mechanics::default() });
        assert!(mount.go_to([130.0, 90.0]));
        assert!(run(&mut mount, 0.5).iter().all(|deg| (deg - 90.0).abs() < 1e-9));
        run(&mut mount, 2.0);
        let deg = mount.x.angle_deg();
        mount.stop();
        run(&mut mount, 0.5);
        assert!((mount.x.angle_deg() - deg - 2.5).abs() < 0.2, "at full rate");
        run(&mut mount, 5.0);
        assert!(!mount.is_moving());
        let start = mount.x.angle_deg();
        for step in 0..200 {
            let target = start + 2.0 * f64::from(step) * STEP_S;
            mount.follow([target, 90.0], STEP_S);
            mount.advance(STEP_S);
            let deviation = target - mount.x.angle_deg();
            match step {
                0..10 => assert!((mount.x.angle_deg() - start).abs() < 1e-9, "{step}"),
                100.. => assert!(deviation.abs() < 0.01, "{step} {deviation}"),
                _ => {}
            }
        }
    }

    #[test]
    fn coasting_minimum_run_play_and_noise_are_as_told() {
        let coasting = Some(Duration::from_secs(3));
        let mut mount = imperfect(Mechanics { coasting, ..Mechanics::default() });
        mount.x.run(5.0);
        run(&mut mount, 3.0);
        let deg = mount.x.angle_deg();
        mount.stop();
        run(&mut mount, 3.5);
        assert!((mount.x.angle_deg() - deg - 7.5).abs() < 0.3 && !mount.is_moving());

        let minimum_run = Duration::from_secs(1);
        let mut mount = imperfect(Mechanics { minimum_run, ..Mechanics::default() });
        assert!(mount.go_to([90.2, 90.0]));
        let farthest = run(&mut mount, 10.0).into_iter().fold(0.0, f64::max);
        assert!(farthest > 91.0 && (mount.x.angle_deg() - 90.2).abs() < 1e-9, "{farthest}");

        let mut mount = imperfect(Mechanics { backlash_deg: 1.0, ..Mechanics::default() });
        assert!(mount.go_to([90.2, 90.0]));
        // The drive first crosses half a degree of play.
        assert!(run(&mut mount, 0.4).iter().all(|deg| (deg - 90.0).abs() < 1e-9));
        run(&mut mount, 5.0);
        assert!((mount.x.angle_deg() - 90.2).abs() < 1e-9 && !mount.is_moving());

        let mut mount = imperfect(Mechanics { noise_deg: 0.3, ..Mechanics::default() });
        let errors = (0..1000).map(|_| {
            mount.advance(STEP_S);
            mount.errors_deg()[0]
        });
        let widest = errors.map(f64::abs).fold(0.0, f64::max);
        assert!((0.25..=0.3).contains(&widest), "{widest}");
    }
}
