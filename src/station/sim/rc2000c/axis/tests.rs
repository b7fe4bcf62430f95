use std::time::Duration;

use super::*;

const STEP_S: f64 = 0.05;

fn axis() -> Axis {
    imperfect(Mechanics::default())
}

fn imperfect(mechanics: Mechanics) -> Axis {
    Axis::new(1000, &AxisOptions::ELEVATION, &mechanics, 7, true)
}

fn run(axis: &mut Axis, seconds: f64) -> Vec<f64> {
    (0..(seconds / STEP_S).round() as usize)
        .map(|_| {
            axis.advance(STEP_S);
            axis.counts
        })
        .collect()
}

#[test]
fn an_auto_move_ramps_and_halts_at_its_count_without_overshoot() {
    for target in [1001, 1005, 1400, 1830, 30] {
        let mut axis = axis();
        axis.auto_move(target);
        let positions = run(&mut axis, 40.0);
        assert_eq!((axis.counts(), axis.drive()), (target, AxisDrive::Still), "{target}");
        assert!(!axis.is_turning());
        let farthest = positions.iter().map(|counts| (counts - 1000.0).abs()).fold(0.0, f64::max);
        assert!(farthest <= (f64::from(target) - 1000.0).abs() + ARRIVED_COUNTS, "{target}");
    }
}

#[test]
fn rates_and_ramps_stay_within_their_bounds() {
    let mut axis = axis();
    axis.jog(Sense::Positive, Speed::Fast, 3.0);
    let positions = run(&mut axis, 6.0);
    let rates: Vec<f64> = positions.windows(2).map(|pair| (pair[1] - pair[0]) / STEP_S).collect();
    assert!(rates.iter().all(|rate| (0.0..=axis.fast_counts_s() + 1e-9).contains(rate)));
    let jumps = rates.windows(2).map(|pair| (pair[1] - pair[0]) / STEP_S);
    assert!(jumps.into_iter().all(|jump| jump.abs() <= axis.ramp_counts_s2() + 1e-6));
}

#[test]
fn after_a_jog_the_axis_runs_out_untold() {
    let mut axis = axis();
    axis.jog(Sense::Negative, Speed::Fast, 1.0);
    run(&mut axis, 0.5);
    assert_eq!(axis.drive(), AxisDrive::Moving(Sense::Negative));
    run(&mut axis, 0.5);
    let released = axis.counts;
    assert_eq!(axis.drive(), AxisDrive::Still);
    assert!(axis.is_turning());
    run(&mut axis, 1.0);
    assert!(!axis.is_turning());
    // The braking distance is v squared over 2 a.
    assert!((released - axis.counts - 16.0).abs() < 1.5, "{released} {}", axis.counts);
}

#[test]
fn a_reversed_jog_is_pending_until_the_axis_has_run_out() {
    let mut axis = axis();
    axis.jog(Sense::Positive, Speed::Fast, 1.0);
    run(&mut axis, 0.8);
    axis.jog(Sense::Negative, Speed::Slow, 3.0);
    assert_eq!(axis.drive(), AxisDrive::Pending(Sense::Negative));
    run(&mut axis, 1.5);
    assert_eq!(axis.drive(), AxisDrive::Moving(Sense::Negative));
}

#[test]
fn a_limit_ends_a_jog_and_is_left_the_other_way() {
    let mut axis = axis();
    axis.jog(Sense::Positive, Speed::Fast, 60.0);
    run(&mut axis, 30.0);
    assert_eq!((axis.limit(), axis.drive()), (Some(Sense::Positive), AxisDrive::Limit));
    axis.jog(Sense::Negative, Speed::Slow, 1.0);
    run(&mut axis, 1.0);
    assert_eq!((axis.limit(), axis.drive()), (None, AxisDrive::Still));
    assert!(axis.reaches(30) && axis.reaches(1830) && !axis.reaches(29) && !axis.reaches(1831));
}

#[test]
fn a_stuck_axis_is_jammed_after_a_while_until_it_is_reset() {
    let mut axis = axis();
    axis.set_trouble(AxisTrouble { is_stuck: true, ..AxisTrouble::default() });
    axis.auto_move(1400);
    run(&mut axis, 0.9);
    assert_eq!(axis.drive(), AxisDrive::AutoMove);
    run(&mut axis, 0.2);
    assert_eq!((axis.drive(), axis.counts()), (AxisDrive::Jammed, 1000));
    axis.set_trouble(AxisTrouble::default());
    axis.auto_move(1400);
    run(&mut axis, 1.0);
    assert_eq!(axis.counts(), 1000);
    axis.reset();
    axis.auto_move(1400);
    run(&mut axis, 30.0);
    assert_eq!(axis.counts(), 1400);
}

#[test]
fn current_and_runaway_are_alarms_too() {
    let mut axis = axis();
    axis.set_trouble(AxisTrouble { is_overloaded: true, ..AxisTrouble::default() });
    run(&mut axis, 1.0);
    assert_eq!(axis.drive(), AxisDrive::Still);
    axis.jog(Sense::Positive, Speed::Slow, 1.0);
    run(&mut axis, 0.1);
    assert_eq!(axis.drive(), AxisDrive::Overcurrent);
    axis.set_trouble(AxisTrouble { runs_away: true, ..AxisTrouble::default() });
    run(&mut axis, 2.0);
    assert_eq!(axis.drive(), AxisDrive::Runaway);
    assert!(axis.counts() > 1010 && axis.is_turning());
}

#[test]
fn a_late_drive_starts_and_stops_late_but_says_at_once_what_it_does() {
    let dead_time = Duration::from_millis(500);
    let mut axis = imperfect(Mechanics { dead_time, ..Mechanics::default() });
    axis.auto_move(1400);
    assert_eq!(axis.drive(), AxisDrive::AutoMove);
    assert!(run(&mut axis, 0.5).iter().all(|counts| (counts - 1000.0).abs() < 1e-9));
    run(&mut axis, 2.0);
    let counts = axis.counts;
    axis.stop();
    assert_eq!(axis.drive(), AxisDrive::Still);
    run(&mut axis, 0.5);
    assert!((axis.counts - counts - 20.0).abs() < 1.0, "at full rate");
    // The time of a jog begins when the drive obeys.
    run(&mut axis, 5.0);
    axis.jog(Sense::Positive, Speed::Fast, 1.0);
    run(&mut axis, 1.4);
    assert_eq!(axis.drive(), AxisDrive::Moving(Sense::Positive));
    run(&mut axis, 0.2);
    assert_eq!(axis.drive(), AxisDrive::Still);
}

#[test]
fn coasting_minimum_run_play_and_noise_are_as_told() {
    let coasting = Some(Duration::from_secs(3));
    let mut axis = imperfect(Mechanics { coasting, ..Mechanics::default() });
    axis.jog(Sense::Positive, Speed::Fast, 1.0);
    run(&mut axis, 1.0);
    let counts = axis.counts;
    run(&mut axis, 3.5);
    // The axis coasts half of 3 s at 40 counts a second.
    assert!((axis.counts - counts - 60.0).abs() < 2.0 && !axis.is_turning());

    let minimum_run = Duration::from_secs(1);
    let mut axis = imperfect(Mechanics { minimum_run, ..Mechanics::default() });
    axis.auto_move(1002);
    let farthest = run(&mut axis, 10.0).into_iter().fold(0.0, f64::max);
    assert!(farthest > 1020.0 && axis.counts() == 1002, "{farthest}");

    let mut axis = imperfect(Mechanics { backlash_deg: 1.0, ..Mechanics::default() });
    axis.auto_move(1005);
    // The drive first crosses ten counts of play.
    assert!(run(&mut axis, 0.4).iter().all(|counts| (counts - 1000.0).abs() < 1e-9));
    run(&mut axis, 5.0);
    assert_eq!((axis.counts(), axis.drive()), (1005, AxisDrive::Still));

    let mut axis = imperfect(Mechanics { noise_deg: 0.1, ..Mechanics::default() });
    let mut readings = std::collections::BTreeSet::new();
    for _ in 0..1000 {
        axis.advance(STEP_S);
        readings.insert(axis.counts());
    }
    assert_eq!(readings, (998..=1002).collect());
}
