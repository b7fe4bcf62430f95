//! Tests of known errors, added to passes of real satellites.

mod antennas;
mod draws;

use std::collections::BTreeMap;

use jiff::Timestamp;

use self::antennas::{drawn, measured, measured_of, normal, shaken, signed};
use super::{Axis, Cause, Evidence, Explained, Explanation, PathSource};
use crate::{
    astro::{
        Angle, AzEl, Site,
        time::add_seconds,
        xy_mount::{self, AxisAngles},
    },
    orbit::{Elements, Pass, PassSearch, Propagator, bundled, passes},
    plan::schedule::testing::Random,
    station::{Mount, Station},
};

const SEED: u64 = 20_260_812;
/// Number of cases; `AZEL_EXPLAIN_CASES` sets another number.
const CASES: u32 = 200;
const CASES_OF_TWO: u32 = 50;
/// Standard deviation of both angles, degrees.
const NOISE_DEG: f64 = 0.02;
const HALF_BEAM_DEG: f64 = 0.1;
/// Unit that computes its track and reports neither clock nor place.
const UNIT: PathSource = PathSource::Unit { clock_ahead_s: None, place: None };
const STEP_S: f64 = 0.5;
const AZ_EL: Mount = Mount::AzEl {
    azimuth_from_deg: -180.0,
    azimuth_to_deg: 540.0,
    elevation_from_deg: 0.0,
    elevation_to_deg: 90.0,
};
const XY: Mount =
    Mount::Xy { lower_axis_azimuth_deg: 0.0, travel_from_deg: 5.0, travel_to_deg: 175.0 };

struct Flight {
    elements: Elements,
    propagator: Propagator,
    site: Site,
    pass: Pass,
}

/// Returns passes of low satellites with a high elevation, over three days.
fn flights() -> Vec<Flight> {
    let catalog = bundled().unwrap();
    let site = Station::default().site.airless();
    let start: Timestamp = "2026-08-12T00:00:00Z".parse().unwrap();
    let mut flights = Vec::new();
    for number in [25_544, 43_013, 37_849, 25_338] {
        let Some(elements) = catalog.get(number) else { continue };
        let propagator = Propagator::new(elements).unwrap();
        let search = PassSearch {
            aos_elevation: Angle::from_degrees(5.0),
            floor: Angle::from_degrees(20.0),
            ..PassSearch::new(site, start, add_seconds(start, 3.0 * 86_400.0))
        };
        for pass in passes(&propagator, &search, &|| false) {
            let propagator = Propagator::new(elements).unwrap();
            flights.push(Flight { elements: elements.clone(), propagator, site, pass });
        }
    }
    assert!(flights.len() > 20, "{}", flights.len());
    flights
}

impl Flight {
    fn direction_at(&self, time: Timestamp) -> AzEl {
        self.propagator.look_from(self.site, time).unwrap().direction
    }

    fn times(&self) -> impl Iterator<Item = Timestamp> {
        let start = self.pass.aos.time;
        let count = (self.pass.duration_s() / STEP_S) as u32;
        (0..=count).map(move |step| add_seconds(start, f64::from(step) * STEP_S))
    }

    /// Returns elements whose satellite is slightly ahead.
    fn shifted(&self, mean_anomaly_deg: f64) -> Elements {
        let mut written = serde_json::to_value(&self.elements).unwrap();
        let anomaly = written["mean_anomaly_deg"].as_f64().unwrap();
        written["mean_anomaly_deg"] = (anomaly + mean_anomaly_deg).into();
        // The plane differs too, like between two real sets.
        let node = written["node_deg"].as_f64().unwrap();
        written["node_deg"] = (node + mean_anomaly_deg / 2.0).into();
        serde_json::from_value(written).unwrap()
    }
}

fn deg(deg: f64) -> Angle {
    Angle::from_degrees(deg)
}

/// Adds noise to both angles on the sky.
fn noisy(exact: &[(Timestamp, AzEl)], random: &mut Random) -> Vec<(Timestamp, AzEl)> {
    let shakes = |random: &mut Random| NOISE_DEG * normal(random);
    let shifted = exact.iter().map(|(time, direction)| {
        let (right_deg, up_deg) = (shakes(random), shakes(random));
        (*time, shaken(*direction, right_deg, up_deg))
    });
    shifted.collect()
}

/// Adjusts slow drives to a flight: they fail at the fastest azimuth, and catch up later.
fn sized_for(flight: &Flight, cause: Cause) -> Cause {
    let Cause::SlowDrives { axis, .. } = cause else { return cause };
    let rates = flight.times().map(|time| {
        let (start, end) =
            (flight.direction_at(time), flight.direction_at(add_seconds(time, STEP_S)));
        (end.azimuth - start.azimuth).wrapped_180().degrees().abs() / STEP_S
    });
    Cause::SlowDrives { rate_deg_s: 0.85 * rates.fold(0.0, f64::max), axis }
}

fn is_same_kind(a: &Cause, b: &Cause) -> bool {
    std::mem::discriminant(a) == std::mem::discriminant(b)
}

fn sizes(cause: &Cause) -> Vec<f64> {
    match *cause {
        Cause::Late { late_s } => vec![late_s],
        Cause::AzimuthOffset { offset_deg } | Cause::ElevationOffset { offset_deg } => {
            vec![offset_deg]
        }
        Cause::Tilt { north_deg, east_deg } => vec![north_deg, east_deg],
        Cause::AzimuthScale { per_mille } | Cause::ElevationScale { per_mille } => vec![per_mille],
        Cause::SlowDrives { rate_deg_s, .. } => vec![rate_deg_s],
        Cause::OtherSite { north_km, east_km } => vec![north_km, east_km],
        Cause::OtherElements { .. } | Cause::Refraction | Cause::Stuck { .. } => Vec::new(),
    }
}

/// Returns three times the standard deviation that the noise gives to the size of a cause. `exact`
/// contains the error of that cause without noise, which grows with the size.
fn noise_of_size(flight: &Flight, cause: &Cause, exact: &[(Timestamp, AzEl)]) -> f64 {
    if let Cause::SlowDrives { .. } = cause {
        return 0.01;
    }
    let used = exact.iter().step_by((1.0 / STEP_S) as usize);
    let off_deg =
        used.map(|(time, direction)| direction.separation(flight.direction_at(*time)).degrees());
    let whole: f64 = off_deg.map(|off_deg| off_deg * off_deg).sum();
    let size = sizes(cause).iter().map(|size| size * size).sum::<f64>().sqrt();
    // Two sizes together are less certain than one of them alone.
    let parts = sizes(cause).len() as f64;
    3.0 * parts * size * NOISE_DEG / whole.sqrt()
}

/// Returns the max effect of noise on the size of a cause that acts together with another.
fn noise_of_one_of_two(cause: &Cause) -> f64 {
    match cause {
        Cause::Late { .. } | Cause::Tilt { .. } => 0.06,
        Cause::AzimuthScale { .. } | Cause::ElevationScale { .. } => 1.5,
        _ => 0.03,
    }
}

/// Min sum of squares, in variances of the noise, by which a cause misses an error without noise
/// and noise cannot hide it. One in a thousand passes, besides the tolerance of [`super::ALIKE`].
const EXCLUDED: f64 = 40.0;

/// Returns `true` if these directions, which have no noise, exclude the cause.
fn is_excluded(cause: &Cause, evidence: &Evidence<'_>, others: &[(Timestamp, Propagator)]) -> bool {
    let singles = evidence.singles(others).into_iter().map(|(_, found)| found);
    let all = singles.chain(evidence.slow_drives()).chain(evidence.stuck());
    let mut same = all.filter(|found| is_same_kind(&found.cause, cause));
    same.all(|found| found.fit.left > EXCLUDED * NOISE_DEG.to_radians().powi(2))
}

#[test]
fn the_true_cause_of_an_error_is_named_first_or_with_those_that_look_alike() {
    let cases = std::env::var("AZEL_EXPLAIN_CASES").map_or(CASES, |cases| cases.parse().unwrap());
    let flights = flights();
    let mut random = Random::new(SEED);
    // The columns count by cause: cases, named, of the right size, and lines with more than one
    // cause.
    let mut table = BTreeMap::<&str, [u32; 4]>::new();
    for case in 0..cases {
        let flight = &flights[random.below(flights.len() as u32) as usize];
        let (name, cause) = drawn(&mut random, flight);
        let cause = sized_for(flight, cause);
        let other = flight.shifted(0.3 * signed(&mut random));
        let other = Propagator::new(&other).unwrap();
        let exact = measured(flight, AZ_EL, &cause, &other);
        let noisy_track = noisy(&exact, &mut random);
        let evidence = Evidence::new(AZ_EL, true, deg(HALF_BEAM_DEG)).with_pass(
            &flight.propagator,
            flight.site,
            UNIT,
            noisy_track.into_iter(),
        );
        let others = [(flight.elements.epoch(), other)];
        let found = evidence.explanations(&others);
        let line: Vec<&Explanation> = found.iter().collect();
        let named = line.iter().find(|explanation| is_same_kind(&explanation.cause, &cause));
        let noise = noise_of_size(flight, &cause, &exact);
        let is_right = |line_item: &&&Explanation| {
            let mut pairs = sizes(&line_item.cause).into_iter().zip(sizes(&cause));
            pairs.all(|(size, true_size)| {
                (size - true_size).abs() <= (0.1 * true_size.abs()).max(noise)
            })
        };
        let exact = Evidence::new(AZ_EL, true, deg(HALF_BEAM_DEG)).with_pass(
            &flight.propagator,
            flight.site,
            UNIT,
            exact.iter().copied(),
        );
        for wrong in line.iter().filter(|explanation| !is_same_kind(&explanation.cause, &cause)) {
            let is_excluded = is_excluded(&wrong.cause, &exact, &others);
            assert!(!is_excluded, "case {case}, {cause:?}: {wrong:?} is in the line");
        }
        let row = table.entry(name).or_default();
        row[0] += 1;
        row[1] += u32::from(named.is_some());
        let is_right = named.as_ref().is_some_and(is_right);
        row[2] += u32::from(is_right);
        row[3] += u32::from(line.len() > 1);
        if !is_right {
            println!("case {case}, {cause:?}: {found:?}");
        }
    }
    println!("seed {SEED}, {cases} cases: cause, cases, named, right size, lines of several");
    for (name, row) in &table {
        println!("{name:16} {row:?}");
    }
    let total = |place: usize| table.values().map(|row| row[place]).sum::<u32>();
    assert!(f64::from(total(1)) >= 0.95 * f64::from(total(0)), "named");
    assert!(f64::from(total(2)) >= 0.95 * f64::from(total(0)), "of the right size");
}

/// A minute contains less information than a pass: lines contain several causes, and none that the
/// minute excludes.
#[test]
fn a_line_of_several_holds_the_true_cause_and_none_that_the_positions_exclude() {
    let flights = flights();
    let mut random = Random::new(SEED);
    let (mut explained, mut named, mut several, mut wrong) = (0, 0, 0, 0);
    for case in 0..CASES {
        let flight = &flights[random.below(flights.len() as u32) as usize];
        let (_, cause) = drawn(&mut random, flight);
        let cause = sized_for(flight, cause);
        // An azimuth scale counts from the start of the azimuth count, before this minute.
        if matches!(cause, Cause::AzimuthScale { .. }) {
            continue;
        }
        let other = flight.shifted(0.3 * signed(&mut random));
        let others = [(flight.elements.epoch(), Propagator::new(&other).unwrap())];
        let mut exact = measured(flight, AZ_EL, &cause, &others[0].1);
        let start = random.below(exact.len() as u32 - 120) as usize;
        exact = exact[start..start + 120].to_vec();
        let noisy_track = noisy(&exact, &mut random);
        let evidence_of = |directions: Vec<(Timestamp, AzEl)>| {
            Evidence::new(AZ_EL, true, deg(HALF_BEAM_DEG)).with_pass(
                &flight.propagator,
                flight.site,
                UNIT,
                directions.into_iter(),
            )
        };
        let found = evidence_of(noisy_track).explanations(&others);
        let line: Vec<&Explanation> = found.iter().collect();
        if line.is_empty() {
            continue;
        }
        explained += 1;
        several += u32::from(line.len() > 1);
        named += u32::from(line.iter().any(|explanation| {
            explanation.causes().any(|drawn_cause| is_same_kind(drawn_cause, &cause))
        }));
        let exact = evidence_of(exact);
        for line_item in line.iter().filter(|explanation| {
            explanation.partner.is_none() && !is_same_kind(&explanation.cause, &cause)
        }) {
            wrong += 1;
            let is_excluded = is_excluded(&line_item.cause, &exact, &others);
            assert!(!is_excluded, "case {case}, {cause:?}: {line_item:?} is in the line");
        }
    }
    println!(
        "seed {SEED}: {explained} explained, {named} named, {several} of several, {wrong} more"
    );
    assert!(f64::from(named) >= 0.95 * f64::from(explained), "{named} of {explained}");
    assert!(several > 20 && wrong > 20, "{several} {wrong}");
}

#[test]
fn two_causes_that_act_together_are_named_together_with_their_sizes() {
    let cases =
        std::env::var("AZEL_EXPLAIN_CASES").map_or(CASES_OF_TWO, |cases| cases.parse().unwrap());
    let flights = flights();
    let mut random = Random::new(SEED);
    // The columns count: cases, those that no single cause explains, and of these those named, of
    // the right size, and alone.
    let mut row = [0_u32; 5];
    let is_of_drives = |cause: &Cause| matches!(cause, Cause::SlowDrives { .. });
    // Only one of both is possible, and it comes first.
    let moves = |cause: &Cause| matches!(cause, Cause::Late { .. } | Cause::OtherElements { .. });
    for case in 0..cases {
        let flight = &flights[random.below(flights.len() as u32) as usize];
        let (first, second) = loop {
            let ((_, first), (_, second)) =
                (drawn(&mut random, flight), drawn(&mut random, flight));
            let is_drawn = is_same_kind(&first, &second) || is_of_drives(&first);
            if !is_drawn && !is_of_drives(&second) && !moves(&second) {
                break (first, second);
            }
        };
        let other = Propagator::new(&flight.shifted(0.3 * signed(&mut random))).unwrap();
        let once = measured(flight, AZ_EL, &first, &other);
        let exact = measured_of(flight, AZ_EL, &once, &second, &other);
        let noisy_track = noisy(&exact, &mut random);
        let evidence = Evidence::new(AZ_EL, true, deg(HALF_BEAM_DEG)).with_pass(
            &flight.propagator,
            flight.site,
            UNIT,
            noisy_track.into_iter(),
        );
        let found = evidence.explanations(&[(flight.elements.epoch(), other)]);
        row[0] += 1;
        let by_one = found.iter().find(|explanation| explanation.partner.is_none());
        let squares = exact.iter().map(|(time, direction)| {
            direction.separation(flight.direction_at(*time)).degrees().powi(2)
        });
        let error_deg = (squares.sum::<f64>() / exact.len() as f64).sqrt();
        // The fit leaves noise and a small part of the second cause.
        let trifle_deg = NOISE_DEG * 2_f64.sqrt() + 0.035 * error_deg;
        if by_one.is_some_and(|explanation| explanation.left_deg < trifle_deg) {
            continue;
        }
        row[1] += 1;
        let line: Vec<&Explanation> = found.iter().collect();
        let is_named = |line_item: &&&Explanation| {
            [&first, &second]
                .iter()
                .all(|part| line_item.causes().any(|cause| is_same_kind(cause, part)))
        };
        let named = line.iter().find(is_named);
        row[2] += u32::from(named.is_some());
        let is_right = named.is_some_and(|named| {
            named.causes().all(|found_cause| {
                let one = if is_same_kind(found_cause, &first) { &first } else { &second };
                let noise = noise_of_one_of_two(one);
                sizes(found_cause).into_iter().zip(sizes(one)).all(|(size, true_size)| {
                    (size - true_size).abs() <= (0.1 * true_size.abs()).max(noise)
                })
            })
        });
        row[3] += u32::from(is_right);
        row[4] += u32::from(line.len() == 1);
        if !is_right {
            println!("case {case}, {first:?} and {second:?}: {found:?}");
        }
    }
    println!("seed {SEED}: cases, explained by none alone, named, right size, alone: {row:?}");
    assert!(row[1] > cases / 2, "{row:?}");
    assert!(f64::from(row[2]) >= 0.95 * f64::from(row[1]), "named: {row:?}");
    assert!(f64::from(row[3]) >= 0.9 * f64::from(row[1]), "of the right size: {row:?}");
}

#[test]
fn several_passes_tell_apart_what_one_does_not() {
    let flights = flights();
    let mut random = Random::new(SEED);
    let (mut ambiguous, mut count) = (0, 0);
    for flights in flights.chunks_exact(4) {
        let late_s = 0.3 + f64::from(random.below(1000)) / 1000.0;
        let flown = flights.iter().map(|flight| {
            let exact =
                flight.times().map(|time| (time, flight.direction_at(add_seconds(time, -late_s))));
            // Use half a minute of each pass.
            noisy(&exact.take(60).collect::<Vec<_>>(), &mut random)
        });
        let flown: Vec<_> = flown.collect();
        let mut evidence = Evidence::new(AZ_EL, true, deg(HALF_BEAM_DEG));
        for (flight, flown) in flights.iter().zip(&flown) {
            let of_one = Evidence::new(AZ_EL, true, deg(HALF_BEAM_DEG)).with_pass(
                &flight.propagator,
                flight.site,
                UNIT,
                flown.iter().copied(),
            );
            ambiguous += u32::from(of_one.explanations(&[]).len() > 1);
            evidence =
                evidence.with_pass(&flight.propagator, flight.site, UNIT, flown.iter().copied());
        }
        let found = evidence.explanations(&[]);
        let Cause::Late { late_s: told_s } = found[0].cause else { panic!("{found:?}") };
        assert!(found[0].partner.is_none() && (told_s - late_s).abs() < 0.1 * late_s, "{found:?}");
        assert_eq!(found.len(), 1, "{found:?}");
        count += 1;
    }
    assert!(ambiguous > count, "{ambiguous} of {count} times four passes leave it open alone");
}

#[test]
fn the_way_to_a_pass_under_way_is_not_taken_for_slow_drives() {
    let flights = flights();
    let mut random = Random::new(SEED);
    for flight in &flights {
        // The antenna is 9 degrees away at first, and approaches at 1.5 degrees per second.
        let begun = flight.pass.aos.time;
        let exact = flight.times().map(|time| {
            let AzEl { azimuth, elevation } = flight.direction_at(time);
            let gone_s = crate::astro::time::seconds_between(begun, time);
            let angle_away = deg((9.0 - 1.5 * gone_s).max(0.0));
            (time, AzEl { azimuth: azimuth + angle_away, elevation })
        });
        let measured = noisy(&exact.collect::<Vec<_>>(), &mut random);
        let evidence = Evidence::new(AZ_EL, true, deg(HALF_BEAM_DEG)).with_pass(
            &flight.propagator,
            flight.site,
            UNIT,
            measured.into_iter(),
        );
        let found = evidence.explanations(&[]);
        let is_of_drives =
            |explanation: &Explanation| matches!(explanation.cause, Cause::SlowDrives { .. });
        assert!(!found.iter().any(is_of_drives), "{found:?}");
    }
}

#[test]
fn an_error_of_noise_alone_is_not_explained() {
    let flights = flights();
    let mut random = Random::new(SEED);
    for flight in &flights {
        let exact: Vec<_> = flight.times().map(|time| (time, flight.direction_at(time))).collect();
        let measured = noisy(&exact, &mut random);
        let evidence = Evidence::new(AZ_EL, true, deg(HALF_BEAM_DEG)).with_pass(
            &flight.propagator,
            flight.site,
            UNIT,
            measured.into_iter(),
        );
        let found = evidence.explanations(&[]);
        assert!(
            found.iter().all(|explanation| explanation.left_deg > 0.9 * NOISE_DEG),
            "{found:?}"
        );
    }
    let flight = &flights[0];
    let few = flight.times().take(10).map(|time| (time, flight.direction_at(time)));
    assert_eq!(
        Evidence::new(AZ_EL, true, deg(HALF_BEAM_DEG))
            .with_pass(&flight.propagator, flight.site, UNIT, few)
            .explanations(&[]),
        []
    );
}

#[test]
fn a_late_antenna_is_explained_while_its_pass_goes_on_and_a_small_error_is_not() {
    let flight = &flights()[0];
    let mut random = Random::new(SEED);
    for late_s in [0.5, 0.0] {
        let exact =
            flight.times().map(|time| (time, flight.direction_at(add_seconds(time, -late_s))));
        let measured = noisy(&exact.collect::<Vec<_>>(), &mut random);
        let evidence = Evidence::new(AZ_EL, true, deg(HALF_BEAM_DEG)).with_pass(
            &flight.propagator,
            flight.site,
            UNIT,
            measured.into_iter(),
        );
        let found = evidence.explained(0.05, &[]);
        if late_s < 0.1 {
            assert_eq!(found, None);
            continue;
        }
        let found = found.unwrap();
        let Cause::Late { late_s: told_s } = found.causes[0].cause else { panic!("{found:?}") };
        assert!((told_s - late_s).abs() < 0.1 && found.causes[0].share > 0.8, "{found:?}");
        assert_eq!(evidence.explained(found.error_deg + 0.01, &[]), None, "too small to be told");
    }
}

#[test]
fn a_rotator_of_azimuth_alone_has_no_error_of_its_elevation() {
    let flights = flights();
    let flight = &flights[0];
    let measured = flight.times().map(|time| {
        let mut direction = flight.direction_at(time);
        direction.azimuth = (direction.azimuth + deg(0.5)).wrapped_360();
        direction.elevation = Angle::ZERO;
        (time, direction)
    });
    let evidence = Evidence::new(AZ_EL, false, deg(HALF_BEAM_DEG)).with_pass(
        &flight.propagator,
        flight.site,
        UNIT,
        measured,
    );
    let found = evidence.explanations(&[]);
    let Cause::AzimuthOffset { offset_deg } = found[0].cause else { panic!("{found:?}") };
    assert!((offset_deg - 0.5).abs() < 1e-6);
    let of_elevation = |explanation: &Explanation| {
        matches!(
            explanation.cause,
            Cause::ElevationOffset { .. } | Cause::ElevationScale { .. } | Cause::Tilt { .. }
        )
    };
    assert!(!found.iter().any(of_elevation), "{found:?}");
}

#[test]
fn slow_drives_of_crossed_axes_are_told_by_the_rate_of_those_axes() {
    let flights = flights();
    let mut random = Random::new(SEED);
    let lower_axis = Angle::ZERO;
    let mut named = 0;
    for flight in &flights {
        let axes = |time| xy_mount::axes_from_azel(flight.direction_at(time), lower_axis);
        let turned = |time: Timestamp| {
            let (start_axes, end_axes) = (axes(time), axes(add_seconds(time, 1.0)));
            (end_axes.lower - start_axes.lower)
                .degrees()
                .abs()
                .max((end_axes.upper - start_axes.upper).degrees().abs())
        };
        let rate_deg_s = 0.85 * flight.times().map(turned).fold(0.0, f64::max);
        let max = rate_deg_s * STEP_S;
        let mut axes_now = axes(flight.pass.aos.time);
        let mut off_deg = 0.0_f64;
        let exact = flight.times().map(|time| {
            let goal = axes(time);
            let step =
                |start: Angle, end: Angle| start + deg((end - start).degrees().clamp(-max, max));
            axes_now = AxisAngles {
                lower: step(axes_now.lower, goal.lower),
                upper: step(axes_now.upper, goal.upper),
            };
            let direction = xy_mount::azel_from_axes(axes_now, lower_axis);
            off_deg = off_deg.max(direction.separation(flight.direction_at(time)).degrees());
            (time, direction)
        });
        let measured = noisy(&exact.collect::<Vec<_>>(), &mut random);
        if off_deg < 20.0 * NOISE_DEG {
            continue;
        }
        named += 1;
        let evidence = Evidence::new(XY, true, deg(HALF_BEAM_DEG)).with_pass(
            &flight.propagator,
            flight.site,
            UNIT,
            measured.into_iter(),
        );
        let found = evidence.explanations(&[]);
        let Cause::SlowDrives { rate_deg_s: rate_found, .. } = found[0].cause else {
            panic!("{found:?}")
        };
        assert!(
            (rate_found - rate_deg_s).abs() < 0.02 * rate_deg_s,
            "{rate_found} for {rate_deg_s}"
        );
    }
    assert!(named > 10, "{named}");
}

/// The fit removes the clock error that a unit reports, and names it if it makes a part of the
/// error.
#[test]
fn the_clock_that_a_unit_tells_is_named_beside_what_is_left() {
    let mut random = Random::new(SEED);
    for flight in flights().iter().take(8) {
        let other = Propagator::new(&flight.elements).unwrap();
        let once = measured(flight, AZ_EL, &Cause::Late { late_s: 0.7 }, &other);
        let offset = Cause::AzimuthOffset { offset_deg: 1.3 };
        let measured_both = noisy(&measured_of(flight, AZ_EL, &once, &offset, &other), &mut random);
        let late = noisy(&once, &mut random);
        let path_source = PathSource::Unit { clock_ahead_s: Some(-0.69), place: None };
        let found = |track: &[(Timestamp, AzEl)]| {
            Evidence::new(AZ_EL, true, deg(HALF_BEAM_DEG))
                .with_pass(&flight.propagator, flight.site, path_source, track.iter().copied())
                .explanations(&[])
        };
        let [only] = found(&late)[..] else { panic!("{:?}", found(&late)) };
        assert_eq!((only.cause, only.partner), (Cause::Late { late_s: 0.69 }, None));
        let [pair] = found(&measured_both)[..] else { panic!("{:?}", found(&measured_both)) };
        assert_eq!(pair.cause, Cause::Late { late_s: 0.69 });
        let Some(Cause::AzimuthOffset { offset_deg }) = pair.partner else { panic!("{pair:?}") };
        assert!((offset_deg - 1.3).abs() < 0.05, "{pair:?}");
    }
}

#[test]
fn the_place_that_a_unit_tells_is_the_cause_and_a_right_one_rules_the_site_out() {
    let flights = flights();
    let flight = &flights[0];
    let other = Propagator::new(&flight.elements).unwrap();
    let wrong = Cause::OtherSite { north_km: 5.0, east_km: -4.0 };
    let exact = measured(flight, AZ_EL, &wrong, &other);
    let noisy_track = noisy(&exact, &mut Random::new(SEED));
    let found = |place: Option<Site>| {
        let source = PathSource::Unit { clock_ahead_s: Some(0.0), place };
        Evidence::new(AZ_EL, true, deg(HALF_BEAM_DEG))
            .with_pass(&flight.propagator, flight.site, source, noisy_track.iter().copied())
            .explanations(&[])
    };
    let is_of_site = |found: &[Explanation]| {
        found.iter().any(|explanation| is_same_kind(&explanation.cause, &wrong))
    };
    let latitude_deg = flight.site.latitude().degrees() + 5.0 / 111.2;
    let east_deg = -4.0 / (111.2 * flight.site.latitude().radians().cos());
    let longitude_deg = flight.site.longitude().degrees() + east_deg;
    let site = Site::new(latitude_deg, longitude_deg, flight.site.altitude_m()).unwrap();
    let explained = found(Some(site));
    assert!(explained.len() == 1 && is_of_site(&explained), "{explained:?}");
    assert!(is_of_site(&found(None)), "{:?}", found(None));
    assert!(!is_of_site(&found(Some(flight.site))), "{:?}", found(Some(flight.site)));
}

/// Positions sent by Azel depend on no clock, place or elements of a unit.
#[test]
fn what_azel_computes_itself_is_no_cause_of_a_track_by_positions() {
    let flights = flights();
    for flight in flights.iter().take(8) {
        let other = Propagator::new(&flight.shifted(0.3)).unwrap();
        let elements = Cause::OtherElements { epoch: flight.elements.epoch() };
        let exact = measured(flight, AZ_EL, &elements, &other);
        let noisy_track = noisy(&exact, &mut Random::new(SEED));
        let found = Evidence::new(AZ_EL, true, deg(HALF_BEAM_DEG))
            .with_pass(&flight.propagator, flight.site, PathSource::Azel, noisy_track.into_iter())
            .explanations(&[(flight.elements.epoch(), other)]);
        let is_of_unit =
            |cause: &Cause| matches!(cause, Cause::OtherElements { .. } | Cause::OtherSite { .. });
        assert!(!found.iter().any(|explanation| explanation.causes().any(is_of_unit)), "{found:?}");
    }
}

/// A drive stops half way, in one axis and in both.
#[test]
fn a_stuck_axis_is_named_with_the_time_since_when_it_stands() {
    let flights = flights();
    let mut random = Random::new(SEED);
    for flight in flights.iter().take(8) {
        let other = Propagator::new(&flight.elements).unwrap();
        let start = add_seconds(flight.pass.aos.time, 0.3 * flight.pass.duration_s());
        for axis in [Some(Axis::Azimuth), None] {
            let exact = measured(flight, AZ_EL, &Cause::Stuck { start, axis }, &other);
            let noisy_track = noisy(&exact, &mut random);
            let found = Evidence::new(AZ_EL, true, deg(HALF_BEAM_DEG))
                .with_pass(&flight.propagator, flight.site, UNIT, noisy_track.into_iter())
                .explanations(&[]);
            let Some(Cause::Stuck { start: found_since, axis: named }) =
                found.first().map(|best| best.cause)
            else {
                panic!("{found:?}")
            };
            let off_s = crate::astro::time::seconds_between(start, found_since).abs();
            assert!(off_s < 15.0 && named == axis, "{off_s} {named:?} for {axis:?}");
        }
    }
}

#[test]
fn after_an_axis_did_not_turn_as_commanded_only_drives_explain_an_error() {
    let flight = &flights()[0];
    let mut random = Random::new(SEED);
    let start = add_seconds(flight.pass.aos.time, 0.3 * flight.pass.duration_s());
    let stuck = Cause::Stuck { start, axis: Some(Axis::Azimuth) };
    let late = Cause::Late { late_s: 20.0 };
    for (cause, is_named) in [(stuck, true), (late, false)] {
        let exact = measured(flight, AZ_EL, &cause, &flight.propagator);
        let noisy_track = noisy(&exact, &mut random);
        let evidence = || {
            Evidence::new(AZ_EL, true, deg(HALF_BEAM_DEG)).with_pass(
                &flight.propagator,
                flight.site,
                UNIT,
                noisy_track.iter().copied(),
            )
        };
        let names = |found: &[Explanation]| {
            found.first().is_some_and(|best| is_same_kind(&best.cause, &cause))
        };
        assert!(names(&evidence().explanations(&[])), "{cause:?}");
        let found = evidence().only_drives().explanations(&[]);
        assert_eq!(names(&found), is_named, "{found:?}");
    }
}

/// A unit ignores refraction. That cause is known; Azel names it if it matters, and no other cause
/// replaces it.
#[test]
fn the_refraction_that_a_unit_leaves_out_is_named_beside_any_other_cause() {
    let mut random = Random::new(SEED);
    let flights = flights();
    let low = |flight: &&Flight| flight.pass.max_elevation().degrees() < 40.0;
    for flight in flights.iter().filter(low) {
        let site = Station::default().site;
        let found = |exact: &[(Timestamp, AzEl)], source, random: &mut Random| {
            let noisy_track = noisy(exact, random);
            Evidence::new(AZ_EL, true, deg(HALF_BEAM_DEG))
                .with_pass(&flight.propagator, site, source, noisy_track.into_iter())
                .explanations(&[])
        };
        let alone = measured(flight, AZ_EL, &Cause::Refraction, &flight.propagator);
        let named = found(&alone, UNIT, &mut random);
        let [only] = named[..] else { panic!("{named:?}") };
        assert_eq!((only.cause, only.partner), (Cause::Refraction, None));
        let offset = Cause::AzimuthOffset { offset_deg: 0.4 };
        let measured_both = measured_of(flight, AZ_EL, &alone, &offset, &flight.propagator);
        let named = found(&measured_both, UNIT, &mut random);
        let best = named.first().unwrap();
        let Some(Cause::AzimuthOffset { offset_deg }) =
            best.causes().find(|cause| is_same_kind(cause, &offset))
        else {
            panic!("{named:?}")
        };
        assert!((offset_deg - 0.4).abs() < 0.02, "{named:?}");
        // Azel includes refraction, so it cannot be missing.
        let named = found(&measured_both, PathSource::Azel, &mut random);
        assert!(
            !named
                .iter()
                .any(|explanation| explanation.causes().any(|cause| *cause == Cause::Refraction))
        );
    }
}

#[test]
fn what_explains_a_small_error_does_not_explain_a_large_one() {
    let explained = |cause| {
        let explanation = Explanation { cause, partner: None, left_deg: 0.01, share: 0.97 };
        Explained { causes: vec![explanation], error_deg: 0.5 }
    };
    let late = explained(Cause::Late { late_s: 0.4 });
    let stuck = explained(Cause::Stuck { start: Timestamp::UNIX_EPOCH, axis: Some(Axis::X) });
    for (off_deg, late_can, stuck_can) in [(0.6, true, true), (6.0, false, true)] {
        let deviation = Angle::from_degrees(off_deg);
        assert_eq!(
            (late.can_make(deviation), stuck.can_make(deviation)),
            (late_can, stuck_can),
            "{off_deg}"
        );
    }
}
