use super::*;
use crate::astro::time::add_seconds;

/// Returns a pass in a straight line over the ground at 7.5 km/s and a height of 800 km. It comes
/// within `km` of the site and flies towards `towards_deg`; one sample per second.
fn pass(km: f64, towards_deg: f64) -> Vec<Sample> {
    let sample = |second: i32| {
        let along = 7.5 * f64::from(second);
        let direction = AzEl::from_enu(glam::DVec3::new(km, along, 800.0));
        let azimuth = direction.azimuth + Angle::from_degrees(towards_deg);
        let time = add_seconds(jiff::Timestamp::UNIX_EPOCH, f64::from(second) + 400.0);
        Sample { time, direction: AzEl { azimuth: azimuth.wrapped_360(), ..direction } }
    };
    (-400..=400).map(sample).collect()
}

fn axes(azimuth_to_deg: f64, elevation_to_deg: f64, rate_deg_s: f64) -> AzElAxes {
    AzElAxes {
        azimuth_deg: (0.0, azimuth_to_deg),
        elevation_deg: Some((0.0, elevation_to_deg)),
        rates_deg_s: [rate_deg_s; 2],
    }
}

fn waiting() -> Start {
    Start { axes_deg: [Some(100.0), Some(0.0)], lead_s: 3600.0, sets_out: true }
}

/// Returns the chosen flip, and its root mean square error in degrees.
fn best(samples: &[Sample], axes: AzElAxes, start: Start) -> (Flip, f64) {
    let planned = axes.best(samples, 1.0, start, Flip::None);
    (planned.flip, axes.error_deg(samples, 1.0, start, &planned))
}

#[test]
fn a_usual_pass_stays_plain() {
    let (flip, error_deg) = best(&pass(600.0, 120.0), axes(360.0, 180.0, 4.0), waiting());
    assert_eq!(flip, Flip::None);
    assert!(error_deg < 1e-6, "{error_deg}");
}

#[test]
fn through_north_the_axes_are_flipped_where_they_can_be() {
    let samples = pass(600.0, 275.0);
    let (flip, plain_deg) = best(&samples, axes(360.0, 90.0, 4.0), waiting());
    assert!(flip == Flip::None && plain_deg > 10.0, "{flip:?} {plain_deg}");
    let (flip, error_deg) = best(&samples, axes(360.0, 180.0, 4.0), waiting());
    assert!(flip == Flip::Whole && error_deg < 1e-6, "{flip:?} {error_deg}");
    let (flip, error_deg) = best(&samples, axes(450.0, 180.0, 4.0), waiting());
    assert!(flip == Flip::None && error_deg < 1e-6, "{flip:?} {error_deg}");
}

#[test]
fn close_to_the_zenith_the_elevation_goes_on_over_it() {
    for (km, towards_deg) in [(20.0, 90.0), (-20.0, 90.0), (20.0, 0.0), (-5.0, 200.0)] {
        let samples = pass(km, towards_deg);
        let (_, plain_deg) = best(&samples, axes(360.0, 90.0, 2.0), waiting());
        let (flip, error_deg) = best(&samples, axes(360.0, 180.0, 2.0), waiting());
        assert!(matches!(flip, Flip::FromTop | Flip::UntilTop), "{flip:?} {km} {towards_deg}");
        assert!(error_deg < plain_deg / 2.0 && error_deg < 0.6, "{error_deg} {plain_deg}");
    }
}

#[test]
fn the_axes_keep_to_their_rates_and_ends() {
    for km in [0.0, 3.0, 50.0, 600.0] {
        for towards_deg in [0.0, 95.0, 180.0, 275.0] {
            let samples = pass(km, towards_deg);
            for axes in [axes(360.0, 90.0, 3.0), axes(450.0, 180.0, 3.0), axes(200.0, 120.0, 3.0)] {
                for flip in std::iter::once(Flip::None).chain(axes.others(&samples)) {
                    let planned = axes.along(&samples, 1.0, waiting(), flip);
                    let ends_deg = [axes.azimuth_deg, axes.elevation_deg.unwrap()];
                    for (axis, (from_deg, to_deg)) in planned.axes_deg.iter().zip(ends_deg) {
                        assert_eq!(axis.len(), samples.len());
                        assert!(axis.iter().all(|degrees| (from_deg..=to_deg).contains(degrees)));
                        let fastest = axis.windows(2).map(|two| (two[1] - two[0]).abs());
                        assert!(fastest.fold(0.0, f64::max) < 3.0 + 1e-6);
                    }
                }
            }
        }
    }
}

#[test]
fn in_the_middle_of_a_pass_the_axes_stay_on_their_side() {
    let samples = pass(600.0, 275.0);
    let late = &samples[380..];
    let azimuth_deg = late[0].direction.azimuth_deg();
    let elevation_deg = late[0].direction.elevation_deg();
    let over_there = (azimuth_deg + 180.0).rem_euclid(360.0);
    let start =
        |axes_deg: [f64; 2]| Start { axes_deg: axes_deg.map(Some), lead_s: 0.0, sets_out: false };
    let plain = pass(600.0, 120.0);
    let (flip, _) = best(late, axes(360.0, 180.0, 4.0), start([over_there, 180.0 - elevation_deg]));
    assert_eq!(flip, Flip::Whole);
    // Plain is as good in the end, but the axes need a minute to get there.
    let late = &plain[600..];
    let first = late[0].direction;
    let flipped = [(first.azimuth_deg() + 180.0).rem_euclid(360.0), 180.0 - first.elevation_deg()];
    assert_eq!(best(late, axes(360.0, 180.0, 2.0), start(flipped)).0, Flip::Whole);
    assert_eq!(best(late, axes(360.0, 180.0, 2.0), waiting()).0, Flip::None);
}

/// An axis too slow for the turn through north continues from its current position, not from its
/// course.
#[test]
fn a_slow_axis_in_the_middle_of_an_unwrap_goes_on_from_where_it_stands() {
    let samples = pass(600.0, 275.0);
    let before_north =
        |two: &[Sample]| two[1].direction.azimuth_deg() - two[0].direction.azimuth_deg() < -180.0;
    let after_north =
        |two: &[Sample]| two[1].direction.azimuth_deg() - two[0].direction.azimuth_deg() > 180.0;
    let crossing = samples.windows(2).position(|two| before_north(two) || after_north(two));
    let crossing = crossing.unwrap();
    let left = &samples[crossing - 20..];
    let last_deg = left.last().unwrap().direction.azimuth_deg();
    for at_deg in [100.0, 180.0, 260.0] {
        let axes = axes(360.0, 90.0, 1.1);
        let start = Start { axes_deg: [Some(at_deg), Some(40.0)], lead_s: 0.0, sets_out: true };
        let planned = axes.along(left, 1.0, start, Flip::None);
        let [azimuths, elevations] = &planned.axes_deg;
        assert!((azimuths[0] - at_deg).abs() < 1e-9, "{at_deg}: {}", azimuths[0]);
        for axis in [azimuths, elevations] {
            let turned = axis.windows(2).map(|two| (two[1] - two[0]).abs());
            assert!(turned.fold(0.0, f64::max) < 1.1 + 1e-6, "{at_deg}");
        }
        let end_deg = azimuths.last().unwrap();
        assert!((end_deg - last_deg).abs() < 1e-6, "{at_deg}: {end_deg} for {last_deg}");
        // An axis that has time to reach its course begins on it.
        let early = Start { lead_s: 600.0, ..start };
        let course = axes.along(left, 1.0, Start::default(), Flip::None);
        assert_eq!(axes.along(left, 1.0, early, Flip::None).axes_deg, course.axes_deg);
    }
}

#[test]
fn an_azimuth_alone_is_never_flipped() {
    let alone = AzElAxes { elevation_deg: None, ..axes(360.0, 180.0, 4.0) };
    assert_eq!(alone.others(&pass(5.0, 0.0)).count(), 0);
    assert_eq!(best(&pass(600.0, 275.0), alone, waiting()).0, Flip::None);
}

#[test]
fn the_best_elevation_costs_least() {
    for azimuth_deg in (0..360).step_by(20) {
        for elevation_deg in [62.0, 75.0, 89.0] {
            for to_deg in [90.0, 110.0, 180.0] {
                let direction = AzEl::from_degrees(123.0, elevation_deg);
                let ends = Some(ElevationEnds::new((10.0, to_deg)));
                let view = View::new(direction, false, ends);
                let azimuth_deg = f64::from(azimuth_deg);
                let azimuth = sin_cos(azimuth_deg);
                let best_deg = View::elevation_deg((direction, false), ends, azimuth_deg);
                let best = view.cost(azimuth, sin_cos(best_deg));
                assert!((best - view.azimuth_cost(azimuth)).abs() < 1e-12);
                let others = (10..=180).map(f64::from).filter(|degrees| *degrees <= to_deg);
                let min = others
                    .map(|min_cost| view.cost(azimuth, sin_cos(min_cost)))
                    .fold(9.0, f64::min);
                assert!(best < min + 1e-12, "{azimuth_deg} {elevation_deg} {to_deg}");
            }
        }
    }
}
