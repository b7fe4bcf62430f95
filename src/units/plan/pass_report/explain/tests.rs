//! Errors of known causes, put into passes of real satellites.

use std::collections::BTreeMap;

use glam::{DQuat, DVec3};
use jiff::Timestamp;

use super::{Cause, Evidence, Explanation};
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
/// `AZEL_EXPLAIN_CASES` sets another number.
const CASES: u32 = 200;
const CASES_OF_TWO: u32 = 50;
/// Standard deviation of both angles, degrees.
const NOISE_DEG: f64 = 0.02;
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

/// Passes of low satellites that come up well, over three days.
fn flights() -> Vec<Flight> {
    let catalog = bundled().unwrap();
    let site = Station::default().site;
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
    fn at(&self, time: Timestamp) -> AzEl {
        self.propagator.look_from(self.site, time).unwrap().direction
    }

    fn times(&self) -> impl Iterator<Item = Timestamp> {
        let from = self.pass.aos.time;
        let count = (self.pass.duration_s() / STEP_S) as u32;
        (0..=count).map(move |step| add_seconds(from, f64::from(step) * STEP_S))
    }

    /// Elements whose satellite is a little further on.
    fn shifted(&self, mean_anomaly_deg: f64) -> Elements {
        let mut written = serde_json::to_value(&self.elements).unwrap();
        let anomaly = written["mean_anomaly_deg"].as_f64().unwrap();
        written["mean_anomaly_deg"] = (anomaly + mean_anomaly_deg).into();
        // The plane differs too, as it does between two real sets.
        let node = written["node_deg"].as_f64().unwrap();
        written["node_deg"] = (node + mean_anomaly_deg / 2.0).into();
        serde_json::from_value(written).unwrap()
    }
}

fn deg(deg: f64) -> Angle {
    Angle::from_degrees(deg)
}

/// A number from -1 to 1, but not close to zero.
fn signed(random: &mut Random) -> f64 {
    let size = 0.15 + 0.85 * f64::from(random.below(10_000)) / 10_000.0;
    if random.below(2) == 0 { size } else { -size }
}

/// From the normal distribution, nearly.
fn normal(random: &mut Random) -> f64 {
    (0..12).map(|_| f64::from(random.below(1_000_000)) / 1e6).sum::<f64>() - 6.0
}

/// Draws one of eight causes.
fn drawn(random: &mut Random, flight: &Flight) -> (&'static str, Cause) {
    match random.below(8) {
        0 => (
            "late",
            Cause::Late {
                late_s: 2.0 * signed(random).powi(2).max(0.025).copysign(signed(random)),
            },
        ),
        1 => ("azimuth", Cause::AzimuthOffset { offset_deg: signed(random) }),
        2 => ("elevation", Cause::ElevationOffset { offset_deg: signed(random) }),
        3 => ("tilt", Cause::Tilt { north_deg: signed(random), east_deg: signed(random) }),
        4 => ("azimuth scale", Cause::AzimuthScale { per_mille: 5.0 * signed(random) }),
        5 => ("elevation scale", Cause::ElevationScale { per_mille: 20.0 * signed(random) }),
        6 => ("elements", Cause::OtherElements { epoch: flight.elements.epoch() }),
        _ => ("slow drives", Cause::SlowDrives { rate_deg_s: 0.0 }),
    }
}

/// What an antenna with this cause measures, without noise.
fn measured(flight: &Flight, cause: &mut Cause, other: &Propagator) -> Vec<(Timestamp, AzEl)> {
    let directions: Vec<(Timestamp, AzEl)> =
        flight.times().map(|time| (time, flight.at(time))).collect();
    measured_of(flight, &directions, cause, other)
}

/// What one measures with this cause as well that would measure `directions`.
fn measured_of(
    flight: &Flight,
    directions: &[(Timestamp, AzEl)],
    cause: &mut Cause,
    other: &Propagator,
) -> Vec<(Timestamp, AzEl)> {
    let mut azimuth_deg = directions[0].1.azimuth.degrees();
    let mut before = directions[0].1.azimuth;
    if let Cause::SlowDrives { rate_deg_s } = cause {
        let rates = directions.windows(2).map(|pair| {
            let turned = (pair[1].1.azimuth - pair[0].1.azimuth).wrapped_180().degrees();
            turned.abs() / STEP_S
        });
        // So that some of the pass is lost, and the antenna comes back.
        *rate_deg_s = 0.85 * rates.fold(0.0, f64::max);
    }
    let mut slow: Option<(f64, f64)> = None;
    let each = directions.iter().map(|(time, at)| {
        azimuth_deg += (at.azimuth - before).wrapped_180().degrees();
        before = at.azimuth;
        let AzEl { azimuth, elevation } = *at;
        let direction = match *cause {
            Cause::Late { late_s } => flight.at(add_seconds(*time, -late_s)),
            Cause::AzimuthOffset { offset_deg } => {
                AzEl { azimuth: azimuth + deg(offset_deg), elevation }
            }
            Cause::ElevationOffset { offset_deg } => {
                AzEl { azimuth, elevation: elevation + deg(offset_deg) }
            }
            Cause::Tilt { north_deg, east_deg } => {
                let lean = DVec3::new(deg(north_deg).radians(), -deg(east_deg).radians(), 0.0);
                AzEl::from_enu(DQuat::from_scaled_axis(lean) * at.to_enu())
            }
            Cause::AzimuthScale { per_mille } => {
                AzEl { azimuth: azimuth + deg(azimuth_deg * per_mille / 1000.0), elevation }
            }
            Cause::ElevationScale { per_mille } => {
                AzEl { azimuth, elevation: deg(elevation.degrees() * (1.0 + per_mille / 1000.0)) }
            }
            Cause::OtherElements { .. } => other.look_from(flight.site, *time).unwrap().direction,
            Cause::SlowDrives { rate_deg_s } => {
                let most = rate_deg_s * STEP_S;
                let (az, el) = slow.map_or((azimuth_deg, elevation.degrees()), |(az, el)| {
                    let turned = |from: f64, to: f64| from + (to - from).clamp(-most, most);
                    (turned(az, azimuth_deg), turned(el, elevation.degrees()))
                });
                slow = Some((az, el));
                AzEl { azimuth: deg(az).wrapped_360(), elevation: deg(el) }
            }
        };
        (*time, direction)
    });
    each.collect()
}

/// With noise on both angles of the sky.
fn noisy(exact: &[(Timestamp, AzEl)], random: &mut Random) -> Vec<(Timestamp, AzEl)> {
    let each = exact.iter().map(|(time, at)| {
        let across = normal(random) * NOISE_DEG / at.elevation.radians().cos().max(0.02);
        let azimuth = (at.azimuth + deg(across)).wrapped_360();
        let elevation = at.elevation + deg(normal(random) * NOISE_DEG);
        (*time, AzEl { azimuth, elevation })
    });
    each.collect()
}

fn is_same_kind(a: &Cause, b: &Cause) -> bool {
    std::mem::discriminant(a) == std::mem::discriminant(b)
}

/// The sizes of a cause.
fn sizes(cause: &Cause) -> Vec<f64> {
    match *cause {
        Cause::Late { late_s } => vec![late_s],
        Cause::AzimuthOffset { offset_deg } | Cause::ElevationOffset { offset_deg } => {
            vec![offset_deg]
        }
        Cause::Tilt { north_deg, east_deg } => vec![north_deg, east_deg],
        Cause::AzimuthScale { per_mille } | Cause::ElevationScale { per_mille } => vec![per_mille],
        Cause::SlowDrives { rate_deg_s } => vec![rate_deg_s],
        Cause::OtherElements { .. } => Vec::new(),
    }
}

/// Three times the standard deviation that the noise gives to the size of a cause whose error, without
/// noise, is that of `exact`. The error grows with the size.
fn noise_of_size(flight: &Flight, cause: &Cause, exact: &[(Timestamp, AzEl)]) -> f64 {
    if let Cause::SlowDrives { .. } = cause {
        return 0.01;
    }
    let used = exact.iter().step_by((1.0 / STEP_S) as usize);
    let off_deg = used.map(|(time, at)| at.separation(flight.at(*time)).degrees());
    let whole: f64 = off_deg.map(|off_deg| off_deg * off_deg).sum();
    let size = sizes(cause).iter().map(|size| size * size).sum::<f64>().sqrt();
    // Each of two sizes is known less well than one of them alone.
    let parts = sizes(cause).len() as f64;
    3.0 * parts * size * NOISE_DEG / whole.sqrt()
}

/// By how much noise may change the size of a cause that acts together with another.
fn noise_of_one_of_two(cause: &Cause) -> f64 {
    match cause {
        Cause::Late { .. } | Cause::Tilt { .. } => 0.06,
        Cause::AzimuthScale { .. } | Cause::ElevationScale { .. } => 1.5,
        _ => 0.03,
    }
}

/// Squares of the noise by which a cause misses an error without noise, beyond which noise does not
/// hide it: one in a thousand, beside what [`super::ALIKE`] lets pass.
const EXCLUDED: f64 = 40.0;

/// Whether these directions, which have no noise, exclude the cause.
fn is_excluded(cause: &Cause, evidence: &Evidence<'_>, others: &[(Timestamp, Propagator)]) -> bool {
    let found = evidence.explanations(others);
    let of = found.iter().find(|it| it.with.is_none() && is_same_kind(&it.cause, cause));
    let count = evidence.points().count() as f64;
    of.is_none_or(|of| count * (of.left_deg / NOISE_DEG).powi(2) > EXCLUDED)
}

#[test]
fn the_true_cause_of_an_error_is_named_first_or_with_those_that_look_alike() {
    let cases = std::env::var("AZEL_EXPLAIN_CASES").map_or(CASES, |cases| cases.parse().unwrap());
    let flights = flights();
    let mut random = Random::new(SEED);
    // By cause: cases, named, of the right size, lines with more than one cause.
    let mut table = BTreeMap::<&str, [u32; 4]>::new();
    for case in 0..cases {
        let flight = &flights[random.below(flights.len() as u32) as usize];
        let (name, mut cause) = drawn(&mut random, flight);
        let other = flight.shifted(0.3 * signed(&mut random));
        let other = Propagator::new(&other).unwrap();
        let exact = measured(flight, &mut cause, &other);
        let seen = noisy(&exact, &mut random);
        let evidence =
            Evidence::new(AZ_EL, true).with_pass(&flight.propagator, flight.site, seen.into_iter());
        let others = [(flight.elements.epoch(), other)];
        let found = evidence.explanations(&others);
        let line: Vec<&Explanation> = found.iter().filter(|it| it.is_alike).collect();
        let named = line.iter().find(|it| is_same_kind(&it.cause, &cause));
        let noise = noise_of_size(flight, &cause, &exact);
        let is_right = |it: &&&Explanation| {
            let mut pairs = sizes(&it.cause).into_iter().zip(sizes(&cause));
            pairs.all(|(got, true_size)| {
                (got - true_size).abs() <= (0.1 * true_size.abs()).max(noise)
            })
        };
        let exact = Evidence::new(AZ_EL, true).with_pass(
            &flight.propagator,
            flight.site,
            exact.iter().copied(),
        );
        for wrong in line.iter().filter(|it| !is_same_kind(&it.cause, &cause)) {
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

/// A minute tells less than a pass: lines hold several causes, and none that the minute excludes.
#[test]
fn a_line_of_several_holds_the_true_cause_and_none_that_the_positions_exclude() {
    let flights = flights();
    let mut random = Random::new(SEED);
    let (mut explained, mut named, mut several, mut wrong) = (0, 0, 0, 0);
    for case in 0..CASES {
        let flight = &flights[random.below(flights.len() as u32) as usize];
        let (_, mut cause) = drawn(&mut random, flight);
        // An azimuth scale counts from where the azimuth began to be counted, before this minute.
        if matches!(cause, Cause::AzimuthScale { .. }) {
            continue;
        }
        let other = flight.shifted(0.3 * signed(&mut random));
        let others = [(flight.elements.epoch(), Propagator::new(&other).unwrap())];
        let mut exact = measured(flight, &mut cause, &others[0].1);
        let from = random.below(exact.len() as u32 - 120) as usize;
        exact = exact[from..from + 120].to_vec();
        let seen = noisy(&exact, &mut random);
        let of = |directions: Vec<(Timestamp, AzEl)>| {
            Evidence::new(AZ_EL, true).with_pass(
                &flight.propagator,
                flight.site,
                directions.into_iter(),
            )
        };
        let found = of(seen).explanations(&others);
        let line: Vec<&Explanation> = found.iter().filter(|it| it.is_alike).collect();
        if line.is_empty() {
            continue;
        }
        explained += 1;
        several += u32::from(line.len() > 1);
        named += u32::from(line.iter().any(|it| it.causes().any(|it| is_same_kind(it, &cause))));
        let exact = of(exact);
        for it in line.iter().filter(|it| it.with.is_none() && !is_same_kind(&it.cause, &cause)) {
            wrong += 1;
            let is_excluded = is_excluded(&it.cause, &exact, &others);
            assert!(!is_excluded, "case {case}, {cause:?}: {it:?} is in the line");
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
    // Cases, those that no single cause explains, of them named, of the right size, alone.
    let mut row = [0_u32; 5];
    let is_of_drives = |it: &Cause| matches!(it, Cause::SlowDrives { .. });
    // Only one of both can be, and comes first.
    let moves = |it: &Cause| matches!(it, Cause::Late { .. } | Cause::OtherElements { .. });
    for case in 0..cases {
        let flight = &flights[random.below(flights.len() as u32) as usize];
        let (mut first, mut second) = loop {
            let ((_, first), (_, second)) =
                (drawn(&mut random, flight), drawn(&mut random, flight));
            let is_drawn = is_same_kind(&first, &second) || is_of_drives(&first);
            if !is_drawn && !is_of_drives(&second) && !moves(&second) {
                break (first, second);
            }
        };
        let other = Propagator::new(&flight.shifted(0.3 * signed(&mut random))).unwrap();
        let once = measured(flight, &mut first, &other);
        let exact = measured_of(flight, &once, &mut second, &other);
        let seen = noisy(&exact, &mut random);
        let evidence =
            Evidence::new(AZ_EL, true).with_pass(&flight.propagator, flight.site, seen.into_iter());
        let found = evidence.explanations(&[(flight.elements.epoch(), other)]);
        row[0] += 1;
        let by_one = found.iter().find(|it| it.with.is_none());
        let squares =
            exact.iter().map(|(time, at)| at.separation(flight.at(*time)).degrees().powi(2));
        let error_deg = (squares.sum::<f64>() / exact.len() as f64).sqrt();
        // Noise is left, and a trifle that the second cause does.
        let trifle_deg = NOISE_DEG * 2_f64.sqrt() + 0.035 * error_deg;
        if by_one.is_some_and(|it| it.left_deg < trifle_deg) {
            continue;
        }
        row[1] += 1;
        let line: Vec<&Explanation> = found.iter().filter(|it| it.is_alike).collect();
        let is_named = |it: &&&Explanation| {
            [&first, &second].iter().all(|of| it.causes().any(|cause| is_same_kind(cause, of)))
        };
        let named = line.iter().find(is_named);
        row[2] += u32::from(named.is_some());
        let is_right = named.is_some_and(|named| {
            named.causes().all(|got| {
                let of = if is_same_kind(got, &first) { &first } else { &second };
                let noise = noise_of_one_of_two(of);
                sizes(got).into_iter().zip(sizes(of)).all(|(got, true_size)| {
                    (got - true_size).abs() <= (0.1 * true_size.abs()).max(noise)
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
            let exact = flight.times().map(|time| (time, flight.at(add_seconds(time, -late_s))));
            // Half a minute of each.
            noisy(&exact.take(60).collect::<Vec<_>>(), &mut random)
        });
        let flown: Vec<_> = flown.collect();
        let mut evidence = Evidence::new(AZ_EL, true);
        for (flight, flown) in flights.iter().zip(&flown) {
            let of_one = Evidence::new(AZ_EL, true).with_pass(
                &flight.propagator,
                flight.site,
                flown.iter().copied(),
            );
            ambiguous +=
                u32::from(of_one.explanations(&[]).iter().filter(|it| it.is_alike).count() > 1);
            evidence = evidence.with_pass(&flight.propagator, flight.site, flown.iter().copied());
        }
        let found = evidence.explanations(&[]);
        let Cause::Late { late_s: told_s } = found[0].cause else { panic!("{found:?}") };
        assert!(found[0].with.is_none() && (told_s - late_s).abs() < 0.1 * late_s, "{found:?}");
        assert_eq!(found.iter().filter(|it| it.is_alike).count(), 1, "{found:?}");
        count += 1;
    }
    assert!(ambiguous > count, "{ambiguous} of {count} times four passes leave it open alone");
}

#[test]
fn the_way_to_a_pass_under_way_is_not_taken_for_slow_drives() {
    let flights = flights();
    let mut random = Random::new(SEED);
    for flight in &flights {
        // 9 deg away at first, and on its way at 1.5 deg/s.
        let begun = flight.pass.aos.time;
        let exact = flight.times().map(|time| {
            let AzEl { azimuth, elevation } = flight.at(time);
            let gone_s = crate::astro::time::seconds_between(begun, time);
            let away = deg((9.0 - 1.5 * gone_s).max(0.0));
            (time, AzEl { azimuth: azimuth + away, elevation })
        });
        let seen = noisy(&exact.collect::<Vec<_>>(), &mut random);
        let evidence =
            Evidence::new(AZ_EL, true).with_pass(&flight.propagator, flight.site, seen.into_iter());
        let found = evidence.explanations(&[]);
        let is_of_drives = |it: &Explanation| matches!(it.cause, Cause::SlowDrives { .. });
        assert!(!found.iter().any(is_of_drives), "{found:?}");
    }
}

#[test]
fn an_error_of_noise_alone_is_not_explained() {
    let flights = flights();
    let mut random = Random::new(SEED);
    for flight in &flights {
        let exact: Vec<_> = flight.times().map(|time| (time, flight.at(time))).collect();
        let seen = noisy(&exact, &mut random);
        let evidence =
            Evidence::new(AZ_EL, true).with_pass(&flight.propagator, flight.site, seen.into_iter());
        let found = evidence.explanations(&[]);
        assert!(found.iter().all(|it| it.left_deg > 0.9 * NOISE_DEG), "{found:?}");
    }
    let flight = &flights[0];
    let few = flight.times().take(10).map(|time| (time, flight.at(time)));
    assert_eq!(
        Evidence::new(AZ_EL, true)
            .with_pass(&flight.propagator, flight.site, few)
            .explanations(&[]),
        []
    );
}

#[test]
fn a_late_antenna_is_explained_while_its_pass_goes_on_and_a_small_error_is_not() {
    let flight = &flights()[0];
    let mut random = Random::new(SEED);
    for late_s in [0.5, 0.0] {
        let exact = flight.times().map(|time| (time, flight.at(add_seconds(time, -late_s))));
        let seen = noisy(&exact.collect::<Vec<_>>(), &mut random);
        let evidence =
            Evidence::new(AZ_EL, true).with_pass(&flight.propagator, flight.site, seen.into_iter());
        let found = evidence.explained(0.05, &[]);
        if late_s < 0.1 {
            assert_eq!(found, None);
            continue;
        }
        let found = found.unwrap();
        let Cause::Late { late_s: told_s } = found.by.cause else { panic!("{found:?}") };
        assert!((told_s - late_s).abs() < 0.1 && found.by.share > 0.8, "{found:?}");
        assert_eq!(evidence.explained(found.error_deg + 0.01, &[]), None, "too small to be told");
    }
}

#[test]
fn a_rotator_of_azimuth_alone_has_no_error_of_its_elevation() {
    let flights = flights();
    let flight = &flights[0];
    let seen = flight.times().map(|time| {
        let mut at = flight.at(time);
        at.azimuth = (at.azimuth + deg(0.5)).wrapped_360();
        at.elevation = Angle::ZERO;
        (time, at)
    });
    let evidence = Evidence::new(AZ_EL, false).with_pass(&flight.propagator, flight.site, seen);
    let found = evidence.explanations(&[]);
    let Cause::AzimuthOffset { offset_deg } = found[0].cause else { panic!("{found:?}") };
    assert!((offset_deg - 0.5).abs() < 1e-6);
    let of_elevation = |it: &Explanation| {
        matches!(
            it.cause,
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
        let axes = |time| xy_mount::axes_from_azel(flight.at(time), lower_axis);
        let turned = |time: Timestamp| {
            let (from, to) = (axes(time), axes(add_seconds(time, 1.0)));
            (to.lower - from.lower).degrees().abs().max((to.upper - from.upper).degrees().abs())
        };
        let rate_deg_s = 0.85 * flight.times().map(turned).fold(0.0, f64::max);
        let most = rate_deg_s * STEP_S;
        let mut at = axes(flight.pass.aos.time);
        let mut off_deg = 0.0_f64;
        let exact = flight.times().map(|time| {
            let to = axes(time);
            let step =
                |from: Angle, to: Angle| from + deg((to - from).degrees().clamp(-most, most));
            at = AxisAngles { lower: step(at.lower, to.lower), upper: step(at.upper, to.upper) };
            let direction = xy_mount::azel_from_axes(at, lower_axis);
            off_deg = off_deg.max(direction.separation(flight.at(time)).degrees());
            (time, direction)
        });
        let seen = noisy(&exact.collect::<Vec<_>>(), &mut random);
        if off_deg < 20.0 * NOISE_DEG {
            continue;
        }
        named += 1;
        let evidence =
            Evidence::new(XY, true).with_pass(&flight.propagator, flight.site, seen.into_iter());
        let found = evidence.explanations(&[]);
        let Cause::SlowDrives { rate_deg_s: told } = found[0].cause else { panic!("{found:?}") };
        assert!((told - rate_deg_s).abs() < 0.02 * rate_deg_s, "{told} for {rate_deg_s}");
    }
    assert!(named > 10, "{named}");
}
