//! Kinematics of one rotator. Rate and ramp are own choices.

use super::RotatorOptions;
use super::travel::Travel;
use crate::protocol::rotator_genius::{
    Configuration, Direction, Moving, RotatorKind, WholeDegrees,
};

/// Full rate, degrees per second.
const RATE_DEG_S: f64 = 4.0;
/// How fast it gets there and coasts down again. From the full rate it coasts 2
/// degrees, the default stop offset.
const RAMP_DEG_S2: f64 = 4.0;

/// What the drive does.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Drive {
    Off,
    /// Until told otherwise.
    Free(Direction),
    /// To a target, from where it was when it set out.
    To {
        target: WholeDegrees,
        start: WholeDegrees,
        direction: Direction,
    },
}

/// One rotator of the device.
#[derive(Debug, Clone)]
pub(super) struct Rotor {
    pub(super) name: String,
    pub(super) kind: RotatorKind,
    pub(super) limit_cw: WholeDegrees,
    pub(super) limit_ccw: WholeDegrees,
    /// Declination and the like, which the sensor's angle includes already.
    pub(super) offset_deg: i16,
    pub(super) stop_offset_deg: u8,
    has_sensor: bool,
    is_sensor_broken: bool,
    is_stuck: bool,
    travel: Travel,
    /// On the travel; beyond its ends when outside the limits.
    place_deg: f64,
    rate_deg_s: f64,
    drive: Drive,
}

impl Rotor {
    pub(super) fn new(options: &RotatorOptions) -> Self {
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
            travel,
            place_deg: travel.place(degrees(options.position)),
            rate_deg_s: 0.0,
            drive: Drive::Off,
        }
    }

    /// Where it points, 0 to 360 degrees.
    pub(super) fn angle_deg(&self) -> f64 {
        self.travel.angle_deg(self.place_deg)
    }

    /// What the sensor shows.
    pub(super) fn measured(&self) -> Option<WholeDegrees> {
        self.can_measure().then(|| self.angle())
    }

    /// Without a sensor nothing is known.
    pub(super) fn is_outside_limits(&self) -> bool {
        self.can_measure() && !self.travel.contains(self.place_deg)
    }

    /// Whether it is driven; it may still coast.
    pub(super) fn moving(&self) -> Moving {
        match self.drive {
            Drive::Off => Moving::Stopped,
            Drive::Free(Direction::Clockwise)
            | Drive::To { direction: Direction::Clockwise, .. } => Moving::Clockwise,
            Drive::Free(_) | Drive::To { .. } => Moving::CounterClockwise,
        }
    }

    /// Where it goes and where it set out.
    pub(super) fn journey(&self) -> Option<(WholeDegrees, WholeDegrees)> {
        match self.drive {
            Drive::To { target, start, .. } => Some((target, start)),
            Drive::Off | Drive::Free(_) => None,
        }
    }

    pub(super) fn is_turning(&self) -> bool {
        self.rate_deg_s != 0.0
    }

    pub(super) fn stop(&mut self) {
        self.drive = Drive::Off;
    }

    /// `false`, and nothing happens, without a sensor or beyond the limits.
    pub(super) fn go_to(&mut self, target: WholeDegrees) -> bool {
        let target_place = self.travel.place(degrees(target));
        if !self.can_measure() || !self.travel.contains(target_place) {
            return false;
        }
        self.place_deg = self.travel.nearest(self.place_deg);
        let direction = if target_place < self.place_deg {
            Direction::CounterClockwise
        } else {
            Direction::Clockwise
        };
        self.drive = Drive::To { target, start: self.angle(), direction };
        true
    }

    /// Inside the limits it goes to the limit, outside it just goes. `false`, and
    /// nothing happens, without a sensor.
    pub(super) fn rotate(&mut self, direction: Direction) -> bool {
        if self.can_measure() && self.is_outside_limits() {
            self.drive = Drive::Free(direction);
            return true;
        }
        let is_accepted = self.go_to(match direction {
            Direction::Clockwise => self.limit_cw,
            Direction::CounterClockwise => self.limit_ccw,
        });
        // Standing on the limit or a little beyond, it is still asked to go this way.
        if let Drive::To { direction: way, .. } = &mut self.drive
            && is_accepted
        {
            *way = direction;
        }
        is_accepted
    }

    /// Takes everything of a configuration but the name, and is no longer driven.
    pub(super) fn configure(&mut self, configuration: &Configuration) {
        let angle_deg = self.angle_deg();
        self.limit_cw = configuration.limit_cw();
        self.limit_ccw = configuration.limit_ccw();
        self.kind = configuration.kind();
        self.stop_offset_deg = configuration.stop_offset_deg();
        self.travel = travel(self.limit_cw, self.limit_ccw);
        self.place_deg = self.travel.place(angle_deg);
        self.drive = Drive::Off;
    }

    /// A rotator that loses its sensor is no longer driven.
    pub(super) fn set_faults(&mut self, is_sensor_broken: bool, is_stuck: bool) {
        self.is_sensor_broken = is_sensor_broken;
        self.is_stuck = is_stuck;
        if !self.can_measure() {
            self.drive = Drive::Off;
        }
    }

    pub(super) fn advance(&mut self, step_s: f64) {
        if self.has_arrived() {
            self.drive = Drive::Off;
        }
        let wanted = match self.moving() {
            Moving::Stopped => 0.0,
            Moving::Clockwise => RATE_DEG_S,
            Moving::CounterClockwise => -RATE_DEG_S,
        };
        let ramp = RAMP_DEG_S2 * step_s;
        self.rate_deg_s += (wanted - self.rate_deg_s).clamp(-ramp, ramp);
        if self.is_stuck {
            self.rate_deg_s = 0.0;
        }
        self.place_deg += self.rate_deg_s * step_s;
    }

    /// Whether the target is as near as the stop offset, or passed.
    fn has_arrived(&self) -> bool {
        let Drive::To { target, direction, .. } = self.drive else { return false };
        let away = self.travel.place(degrees(target)) - self.place_deg;
        let left = match direction {
            Direction::Clockwise => away,
            Direction::CounterClockwise => -away,
        };
        left <= f64::from(self.stop_offset_deg)
    }

    fn can_measure(&self) -> bool {
        self.has_sensor && !self.is_sensor_broken
    }

    fn angle(&self) -> WholeDegrees {
        WholeDegrees::nearest(self.angle_deg()).unwrap_or(WholeDegrees::MAX)
    }
}

fn degrees(angle: WholeDegrees) -> f64 {
    f64::from(angle.degrees())
}

fn travel(limit_cw: WholeDegrees, limit_ccw: WholeDegrees) -> Travel {
    Travel::new(degrees(limit_cw), degrees(limit_ccw))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::rotator_genius::{RotatorName, RotatorNumber};

    const STEP_S: f64 = 0.05;

    fn angle(degrees: u16) -> WholeDegrees {
        WholeDegrees::new(degrees).unwrap()
    }

    fn rotor(position: u16, [cw, ccw]: [u16; 2]) -> Rotor {
        Rotor::new(&RotatorOptions {
            position: angle(position),
            limit_cw: angle(cw),
            limit_ccw: angle(ccw),
            ..RotatorOptions::default()
        })
    }

    /// Turns for a time and gives all angles on the way.
    fn run(rotor: &mut Rotor, seconds: f64) -> Vec<f64> {
        let steps = (seconds / STEP_S).round() as usize;
        let mut angles = Vec::new();
        for _ in 0..steps {
            rotor.advance(STEP_S);
            angles.push(rotor.angle_deg());
        }
        angles
    }

    #[test]
    fn the_coast_ends_on_the_target() {
        for target in [359, 100, 0, 173] {
            let mut rotor = rotor(173, [359, 0]);
            assert!(rotor.go_to(angle(target)));
            assert_eq!(rotor.journey(), Some((angle(target), angle(173))));
            run(&mut rotor, 60.0);
            assert_eq!(rotor.measured(), Some(angle(target)));
            assert!(!rotor.is_turning() && !rotor.is_outside_limits());
            assert_eq!((rotor.journey(), rotor.moving()), (None, Moving::Stopped));
        }
    }

    #[test]
    fn without_a_stop_offset_it_slips_past_the_limit() {
        let mut rotor = rotor(260, [270, 90]);
        rotor.stop_offset_deg = 0;
        assert!(rotor.rotate(Direction::Clockwise));
        run(&mut rotor, 10.0);
        assert_eq!(rotor.measured(), Some(angle(272)));
        assert!(rotor.is_outside_limits() && !rotor.is_turning());
        // From there it goes on without a target, over north and through the arc.
        assert!(rotor.rotate(Direction::Clockwise));
        run(&mut rotor, 60.0);
        assert_eq!((rotor.moving(), rotor.journey()), (Moving::Clockwise, None));
        assert!(!rotor.is_outside_limits() && rotor.is_turning());
        rotor.stop();
        assert_eq!(rotor.moving(), Moving::Stopped);
        let before = rotor.angle_deg();
        run(&mut rotor, 2.0);
        assert!(!rotor.is_turning() && (rotor.angle_deg() - before - 1.9).abs() < 0.01);
    }

    #[test]
    fn a_turn_over_north_takes_the_arc_between_the_limits() {
        let mut rotor = rotor(310, [30, 300]);
        assert!(rotor.go_to(angle(20)));
        assert_eq!(rotor.moving(), Moving::Clockwise);
        let angles = run(&mut rotor, 30.0);
        assert!(angles.iter().all(|angle| !(21.0..309.0).contains(angle)));
        assert_eq!(rotor.measured(), Some(angle(20)));
        assert!(!rotor.go_to(angle(180)));
        // On a full turn the ends lie in the north on both sides.
        let mut rotor = self::rotor(350, [360, 0]);
        assert!(rotor.go_to(angle(0)));
        assert_eq!(rotor.moving(), Moving::CounterClockwise);
        let angles = run(&mut rotor, 100.0);
        assert!(angles.iter().all(|angle| *angle < 351.0));
    }

    #[test]
    fn from_outside_it_goes_back_over_the_nearer_end() {
        for (position, way) in [(280, Moving::CounterClockwise), (80, Moving::Clockwise)] {
            let mut rotor = rotor(position, [270, 90]);
            assert!(rotor.is_outside_limits() && rotor.go_to(angle(180)));
            assert_eq!(rotor.moving(), way, "{position}");
            run(&mut rotor, 60.0);
            assert_eq!(rotor.measured(), Some(angle(180)));
        }
    }

    #[test]
    fn rate_and_ramp_stay_within_their_bounds() {
        let mut rotor = rotor(10, [359, 0]);
        rotor.rotate(Direction::Clockwise);
        let mut angles = run(&mut rotor, 5.0);
        rotor.rotate(Direction::CounterClockwise);
        angles.extend(run(&mut rotor, 3.0));
        let rates: Vec<f64> = angles.windows(2).map(|pair| (pair[1] - pair[0]) / STEP_S).collect();
        assert!(rates.iter().all(|rate| rate.abs() <= RATE_DEG_S + 1e-6));
        let ramps = rates.windows(2).map(|pair| (pair[1] - pair[0]) / STEP_S);
        assert!(ramps.into_iter().all(|ramp| ramp.abs() <= RAMP_DEG_S2 + 1e-6));
    }

    #[test]
    fn without_its_sensor_it_is_neither_driven_nor_outside() {
        let mut rotor = rotor(280, [270, 90]);
        assert!(rotor.rotate(Direction::Clockwise));
        rotor.set_faults(true, false);
        assert_eq!((rotor.measured(), rotor.moving()), (None, Moving::Stopped));
        assert!(!rotor.is_outside_limits());
        assert!(!rotor.rotate(Direction::Clockwise) && !rotor.go_to(angle(180)));
    }

    #[test]
    fn new_limits_leave_it_where_it_is() {
        let mut rotor = rotor(100, [359, 0]);
        let configuration = Configuration::new(
            RotatorNumber::One,
            [angle(30), angle(300)],
            RotatorKind::Elevation,
            0,
            RotatorName::new("").unwrap(),
        );
        rotor.configure(&configuration.unwrap());
        assert_eq!(rotor.measured(), Some(angle(100)));
        assert!(rotor.is_outside_limits());
    }
}
