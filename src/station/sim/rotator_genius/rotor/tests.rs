//! Tests with turns in steps of 50 ms.

use std::time::Duration;

use super::*;
use crate::protocol::rotator_genius::{RotatorName, RotatorNumber};

const STEP_S: f64 = 0.05;

fn angle(degrees: u16) -> WholeDegrees {
    WholeDegrees::new(degrees).unwrap()
}

fn rotor(position: u16, [cw, ccw]: [u16; 2]) -> Rotor {
    Rotor::perfect(&RotatorOptions {
        position: angle(position),
        limit_cw: angle(cw),
        limit_ccw: angle(ccw),
        ..RotatorOptions::default()
    })
}

impl Rotor {
    pub(in crate::sim::rotator_genius) fn perfect(options: &RotatorOptions) -> Self {
        Self::new(options, &Mechanics::default(), 1)
    }
}

/// Turns for a time and returns all angles on the way.
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
    // The rotator continues without a target, over north and through the arc.
    assert!(rotor.rotate(Direction::Clockwise));
    run(&mut rotor, 60.0);
    assert_eq!((rotor.moving(), rotor.journey()), (Moving::Clockwise, None));
    assert!(!rotor.is_outside_limits() && rotor.is_turning());
    rotor.stop();
    assert_eq!(rotor.moving(), Moving::Stopped);
    let before = rotor.angle_deg();
    run(&mut rotor, 2.0);
    assert!(!rotor.is_turning() && (rotor.angle_deg() - before - 1.9).abs() < 0.01);
    // After more than a turn, the way back still leads through the arc.
    assert!(rotor.go_to(angle(200)));
    assert_eq!(rotor.moving(), Moving::Clockwise);
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
    // With a full turn, both ends are in the north.
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
    assert!(rates.iter().all(|rate| rate.abs() <= rotor.full_rate_deg_s + 1e-6));
    let ramps = rates.windows(2).map(|pair| (pair[1] - pair[0]) / STEP_S);
    assert!(
        ramps.into_iter().all(|ramp| ramp.abs() <= 4.0 + 1e-6),
        "from 4 degrees a second in 2 degrees"
    );
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

fn imperfect(mechanics: Mechanics) -> Rotor {
    Rotor::new(&RotatorOptions { position: angle(100), ..RotatorOptions::default() }, &mechanics, 7)
}

#[test]
fn a_late_drive_starts_and_stops_late_but_says_at_once_what_it_does() {
    let mut rotor =
        imperfect(Mechanics { dead_time: Duration::from_millis(500), ..Mechanics::default() });
    assert!(rotor.go_to(angle(200)));
    assert_eq!(rotor.moving(), Moving::Clockwise);
    assert!(run(&mut rotor, 0.5).iter().all(|deg| (deg - 100.0).abs() < 1e-9));
    run(&mut rotor, 3.0);
    let at_stop_deg = rotor.angle_deg();
    rotor.stop();
    assert_eq!(rotor.moving(), Moving::Stopped);
    run(&mut rotor, 0.5);
    assert!((rotor.angle_deg() - at_stop_deg - 2.0).abs() < 0.1, "at full rate");
    run(&mut rotor, 5.0);
    assert!((rotor.angle_deg() - at_stop_deg - 4.0).abs() < 0.3 && !rotor.is_turning());
}

#[test]
fn it_coasts_and_runs_on_as_long_as_it_is_told() {
    let coasting = Some(Duration::from_secs(3));
    let mut rotor = imperfect(Mechanics { coasting, ..Mechanics::default() });
    assert!(rotor.go_to(angle(200)));
    run(&mut rotor, 60.0);
    // The rotator coasts half of 3 s at 4 degrees per second, from 2 degrees before the target.
    assert!((rotor.angle_deg() - 204.0).abs() < 0.3, "{}", rotor.angle_deg());

    let minimum_run = Duration::from_secs(2);
    let mut rotor = imperfect(Mechanics { minimum_run, ..Mechanics::default() });
    assert!(rotor.go_to(angle(101)));
    run(&mut rotor, 30.0);
    assert!(rotor.angle_deg() > 105.0, "{}", rotor.angle_deg());
}

#[test]
fn play_and_noise_show_in_the_readings() {
    let mut rotor = imperfect(Mechanics { backlash_deg: 3.0, ..Mechanics::default() });
    assert!(rotor.go_to(angle(120)));
    run(&mut rotor, 20.0);
    assert!(rotor.go_to(angle(100)));
    let deg = rotor.angle_deg();
    // Without play, 4 degrees per second would have changed the angle.
    run(&mut rotor, 1.0);
    assert!((rotor.angle_deg() - deg).abs() < 1e-9);
    run(&mut rotor, 20.0);
    assert_eq!(rotor.measured(), Some(angle(100)));

    let mut rotor = imperfect(Mechanics { noise_deg: 1.0, ..Mechanics::default() });
    let mut readings = std::collections::BTreeSet::new();
    for _ in 0..1000 {
        rotor.advance(STEP_S);
        readings.extend(rotor.measured());
    }
    assert_eq!(readings, [99, 100, 101].map(angle).into());
}
