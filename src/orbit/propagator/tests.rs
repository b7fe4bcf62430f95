//! States near to the epoch and far from it.

use proptest::prelude::*;

use super::*;
use crate::bundled;

#[test]
fn any_time_gives_a_state_or_a_reason() {
    let catalog = bundled().unwrap();
    // The orbits are low, of half a day, geosynchronous, and far and eccentric.
    let propagators: Vec<Propagator> = [25_544, 24_876, 54_743, 25_867]
        .map(|number| Propagator::new(catalog.get(number).unwrap()).unwrap())
        .into();
    let times = Timestamp::MIN.as_second()..Timestamp::MAX.as_second();
    proptest!(|(second in times, near_s in -4e9..4e9_f64)| {
        for propagator in &propagators {
            let far = Timestamp::from_second(second).unwrap();
            let near = time::add_seconds(propagator.epoch, near_s);
            for time in [far, near, Timestamp::MIN, Timestamp::MAX] {
                if let Ok(state) = propagator.state_at(time) {
                    prop_assert!(state.position_km.length() >= WGS72_RADIUS_KM);
                }
            }
        }
    });
    for propagator in &propagators {
        assert_eq!(propagator.state_at(Timestamp::MAX), Err(PropagationError::TooFarFromEpoch));
    }
}

#[test]
fn far_from_its_epoch_no_object_is_away_from_the_earth() {
    let catalog = bundled().unwrap();
    let (mut defined, mut refused) = (0, 0);
    for elements in catalog.iter().step_by(29) {
        let Ok(propagator) = Propagator::new(elements) else { continue };
        let apogee_km = elements.heights().apogee_km + 6378.0;
        for years in [-90.0, -40.0, -20.0, -10.0, -3.0, -0.1, 0.1, 3.0, 10.0, 40.0, 90.0] {
            let time = time::add_seconds(elements.epoch(), years * 365.25 * time::DAY_S);
            let one = propagator.state_at(time);
            refused += u32::from(one == Err(PropagationError::TooFarFromEpoch));
            for state in [one.ok(), propagator.states_at(&[time])[0]].into_iter().flatten() {
                defined += 1;
                let times = state.position_km.length() / apogee_km;
                assert!(times < 10.5, "{} at {years} years: {times}", elements.name());
            }
        }
    }
    assert!(defined > 5_000 && refused > 100, "{defined} {refused}");
}

#[test]
fn what_is_surely_up_has_a_state_at_its_epoch() {
    let iss = bundled().unwrap().get(25_544).unwrap().sgp4();
    let calls = std::cell::Cell::new(0);
    let angles = (0.0..=180.0_f64, 0.0..360.0_f64, 0.0..360.0_f64, 0.0..360.0_f64);
    let sizes = (CLOSE_REV_DAY..17.5, 0.0..SMALL_ECCENTRICITY, -10.0..10.0_f64);
    proptest!(ProptestConfig::with_cases(20_000), |(angles in angles, sizes in sizes)| {
        let (inclination, right_ascension, argument_of_perigee, mean_anomaly) = angles;
        let (mean_motion, eccentricity, drag_term) = sizes;
        let numbers = sgp4::Elements {
            inclination, right_ascension, argument_of_perigee, mean_anomaly, mean_motion,
            eccentricity, drag_term, ..iss.clone()
        };
        if is_surely_up_at_epoch(&numbers) {
            let (_, constants) = start(&numbers).unwrap();
            prop_assert!(sgp4_state(&constants, 0.0, &mut Resumable::default()).is_ok());
            calls.set(calls.get() + 1);
        }
    });
    assert!(calls.get() > 10_000, "{}", calls.get());
    let all = bundled().unwrap();
    let surely = all.iter().filter(|elements| is_surely_up_at_epoch(&elements.sgp4())).count();
    assert!(surely * 10 > all.len() * 8, "{surely} of {}", all.len());
}

#[test]
fn velocities_drift_from_the_change_of_positions_as_fast_as_is_said() {
    for elements in bundled().unwrap().iter() {
        let propagator = Propagator::new(elements).unwrap();
        let Some(secular) = propagator.secular() else { continue };
        for hour in [1.0, 37.3, 101.7, 160.1] {
            let at_s = hour * 3600.0;
            if !secular.is_near_circular_at(at_s / 60.0) {
                continue;
            }
            let state = |offset_s: f64| {
                propagator.state_after(at_s + offset_s, &mut Resumable::default()).unwrap()
            };
            let moved_km = state(0.5).position_km - state(-0.5).position_km;
            let drift_km_s = (moved_km - state(0.0).velocity_km_s).length();
            let said_km_s = propagator.drift_km_s(at_s);
            // One set in five hundred drifts faster than `said_km_s`.
            assert!(drift_km_s < 2.5 * said_km_s, "{elements:?}: {drift_km_s} {said_km_s}");
        }
    }
}

#[test]
fn states_of_a_resonant_orbit_do_not_depend_on_what_was_asked_before() {
    let catalog = bundled().unwrap();
    let numbers = [24_876, 54_743, 44_334, 25_867];
    let days = proptest::collection::vec(-400.0..400.0_f64, 1..30);
    proptest!(|(days in days, number in 0..numbers.len())| {
        let elements = catalog.get(numbers[number]).unwrap();
        let propagator = Propagator::new(elements).unwrap();
        for day in days {
            let time = time::add_seconds(propagator.epoch, day * time::DAY_S);
            let fresh = Propagator::new(elements).unwrap();
            prop_assert_eq!(propagator.state_at(time), fresh.state_at(time), "{}", day);
        }
    });
}

#[test]
fn an_integration_is_resumed_near_what_is_asked_for() {
    let elements = bundled().unwrap().get(44_334).unwrap().clone();
    let propagator = Propagator::new(&elements).unwrap();
    let resumed_after = |day: f64| {
        propagator.state_at(time::add_seconds(propagator.epoch, day * time::DAY_S)).unwrap();
        propagator.resonance.get().0.unwrap().t() as i32 / 720
    };
    let halves = [(100.2, 200), (107.0, 200), (101.0, 200), (130.0, 260), (99.7, 199), (-3.2, -6)];
    for (day, half_days) in halves {
        assert_eq!(resumed_after(day), half_days, "{day}");
    }
}

#[test]
fn several_states_are_those_of_each_time() {
    // The orbits are low, about to decay, of half a day, geosynchronous, and far and eccentric.
    for number in [25_544, 43_881, 24_876, 54_743, 25_867] {
        let catalog = bundled().unwrap();
        let propagator = Propagator::new(catalog.get(number).unwrap()).unwrap();
        for (days, count) in [(-2.0, 1), (0.0, 8), (1.5, 13), (60.0, 3), (40_000.0, 2)] {
            let time = |step: u32| {
                let seconds = days * time::DAY_S + f64::from(step) * 500.0;
                time::add_seconds(propagator.epoch, seconds)
            };
            let times: Vec<Timestamp> = (0..count).map(time).collect();
            let several = propagator.states_at(&times);
            assert_eq!(several.len(), times.len());
            for (utc, several) in times.iter().zip(several) {
                let one = propagator.state_at(*utc).ok();
                assert_eq!(several.is_some(), one.is_some(), "{number} {utc}");
                let off_km = several.zip(one).map(|(a, b)| a.position_km - b.position_km);
                assert!(off_km.is_none_or(|deviation| deviation.length() < 2e-8), "{number} {utc}");
            }
        }
    }
}

#[test]
fn an_orbit_starts_as_the_library_starts_it() {
    for elements in bundled().unwrap().iter() {
        let numbers = elements.sgp4();
        let (_, constants) = start(&numbers).unwrap();
        let theirs = sgp4::Constants::from_elements_afspc_compatibility_mode(&numbers);
        assert_eq!(constants, theirs.unwrap());
    }
}

#[test]
fn places_of_several_satellites_are_those_of_each() {
    let catalog = bundled().unwrap();
    let propagators: Vec<Propagator> = [25_544, 43_881, 24_876, 54_743, 25_867]
        .into_iter()
        .chain(catalog.iter().map(Elements::catalog_number).step_by(1000))
        .map(|number| Propagator::new(catalog.get(number).unwrap()).unwrap())
        .collect();
    let near = propagators.iter().zip(0..).map(|(propagator, hour)| {
        (propagator, time::add_seconds(propagator.epoch, 5000.0 * f64::from(hour)))
    });
    let requests: Vec<_> = near.chain([(&propagators[0], Timestamp::MAX)]).collect();
    let places = Propagator::over_ground(&requests);
    assert_eq!(places.len(), requests.len());
    for ((propagator, time), found) in requests.into_iter().zip(places) {
        let one = propagator.state_at(time).ok().map(|state| state.over_ground(time));
        assert_eq!(found.is_some(), one.is_some(), "{time}");
        let Some((found, one)) = found.zip(one) else { continue };
        let off_km = (found.position_km - one.position_km).length();
        assert!(off_km < 2e-8, "{time} {off_km}");
        let off_km_s = (found.velocity_km_s - one.velocity_km_s).length();
        assert!(off_km_s < 1e-10, "{time} {off_km_s}");
    }
}

#[test]
fn time_may_turn_back_over_the_epoch() {
    let catalog = bundled().unwrap();
    let elements = catalog.get(54_743).unwrap();
    let propagator = Propagator::new(elements).unwrap();
    let time = |days: f64| time::add_seconds(elements.epoch(), days * time::DAY_S);
    let first = propagator.state_at(time(3.0));
    assert!(propagator.state_at(time(-3.0)).is_ok());
    assert_eq!(propagator.state_at(time(3.0)), first);
}
