//! Tests that recover known models from points with noise.

use jiff::Timestamp;

use super::*;
use crate::{
    astro::{Angle, AzEl, PointingModel, Site, Term, sun_moon, time::add_seconds},
    orbit::{PassSearch, Propagator, bundled, passes},
    plan::schedule::testing::Random,
};

const SEED: u64 = 2_026;
const CASES: u32 = 200;

fn uniform(random: &mut Random, start: f64, end: f64) -> f64 {
    start + (end - start) * f64::from(random.below(1_000_000)) / 1e6
}

/// Returns a value of the normal distribution, by Box and Muller.
fn normal(random: &mut Random) -> f64 {
    let (a, b) = (uniform(random, 1e-9, 1.0), uniform(random, 0.0, std::f64::consts::TAU));
    (-2.0 * a.ln()).sqrt() * b.cos()
}

fn any_model(random: &mut Random) -> PointingModel {
    let mut model = PointingModel::default();
    for term in Term::ALL {
        let max = match term {
            Term::AzimuthOffset | Term::ElevationOffset => 5.0,
            Term::ElevationScale => 0.01,
            _ => 1.0,
        };
        *model.place(term) = uniform(random, -max, max);
    }
    model
}

/// Fits points that belong to no pass.
fn fit_scattered(points: &[Point], terms: &[Term]) -> Result<Fit, CannotFit> {
    fit(points.chunks(1), terms)
}

fn any_direction(random: &mut Random, elevations_deg: (f64, f64)) -> AzEl {
    let (from_deg, to_deg) = elevations_deg;
    AzEl::from_degrees(uniform(random, 0.0, 360.0), uniform(random, from_deg, to_deg))
}

/// Returns a point with this noise in its reading.
fn point(
    kind: Kind,
    target: AzEl,
    model: &PointingModel,
    noise_deg: f64,
    random: &mut Random,
) -> Point {
    let mut measured = model.reading(target).unwrap();
    let aside_deg = noise_deg * normal(random) / target.elevation.radians().cos();
    measured.azimuth = measured.azimuth + Angle::from_degrees(aside_deg);
    measured.elevation = measured.elevation + Angle::from_degrees(noise_deg * normal(random));
    Point { kind, time: Timestamp::UNIX_EPOCH, direction: target, measured, weight: 1.0 }
}

fn points(
    model: &PointingModel,
    (count, noise_deg): (usize, f64),
    elevations_deg: (f64, f64),
    random: &mut Random,
) -> Vec<Point> {
    let one = |_| {
        let target = any_direction(random, elevations_deg);
        point(Kind::Satellite, target, model, noise_deg, random)
    };
    (0..count).map(one).collect()
}

#[test]
fn what_is_read_and_where_it_points_are_inverse_to_each_other() {
    let mut random = Random::new(SEED);
    for case in 0..2_000 {
        let model = any_model(&mut random);
        let sky = any_direction(&mut random, (0.0, 85.0));
        let reading = model.reading(sky).unwrap();
        let back = model.direction(reading);
        assert!(back.separation(sky).degrees() < 1e-6, "case {case}: {model:?} {sky:?} {back:?}");
        let again = model.reading(back).unwrap();
        assert!(again.separation(reading).degrees() < 1e-6, "case {case}: {model:?} {reading:?}");
    }
}

#[test]
fn a_model_without_terms_changes_nothing() {
    let model = PointingModel::default();
    for (azimuth_deg, elevation_deg) in [(0.0, 0.0), (213.0, 41.0), (359.9, 89.0)] {
        let sky = AzEl::from_degrees(azimuth_deg, elevation_deg);
        assert!(model.reading(sky).unwrap().separation(sky).degrees() < 1e-9);
        assert!(model.direction(sky).separation(sky).degrees() < 1e-9);
    }
}

#[test]
fn each_term_acts_as_its_name_says() {
    let read = |term: Term, azimuth_deg: f64, elevation_deg: f64| {
        let mut model = PointingModel::default();
        *model.place(term) = 0.1;
        let sky = AzEl::from_degrees(azimuth_deg, elevation_deg);
        let reading = model.reading(sky).unwrap();
        let azimuth_deg = (reading.azimuth - sky.azimuth).wrapped_180().degrees();
        [azimuth_deg, (reading.elevation - sky.elevation).degrees()]
    };
    let north = read(Term::TiltNorth, 0.0, 40.0);
    assert!(north[0].abs() < 1e-3 && (north[1] - 0.1).abs() < 1e-3, "{north:?}");
    let east = read(Term::TiltEast, 90.0, 40.0);
    assert!(east[0].abs() < 1e-3 && (east[1] - 0.1).abs() < 1e-3, "{east:?}");
    // The beam lies to the left: the axis turns further to the right, and more so at higher
    // elevations.
    let [low, high] = [0.0, 60.0].map(|elevation_deg| read(Term::Collimation, 10.0, elevation_deg));
    assert!((low[0] - 0.1).abs() < 1e-3 && (high[0] - 0.2).abs() < 1e-3, "{low:?} {high:?}");
    let leans = read(Term::NonPerpendicularity, 10.0, 45.0);
    assert!((leans[0] - 0.1).abs() < 1e-3, "{leans:?}");
    let [flat, steep] = [0.0, 60.0].map(|elevation_deg| read(Term::Sag, 10.0, elevation_deg));
    assert!((flat[1] - 0.1).abs() < 1e-3 && (steep[1] - 0.05).abs() < 1e-3, "{flat:?} {steep:?}");
}

#[test]
fn intervals_hold_the_terms_and_are_as_small_as_they_can_be() {
    let mut random = Random::new(SEED);
    let mut sufficient = 0;
    let mut squares = [0.0; Term::COUNT];
    let mut noises = 0.0;
    for case in 0..CASES {
        let model = any_model(&mut random);
        let noise_deg = uniform(&mut random, 0.01, 0.1);
        let points = points(&model, (80, noise_deg), (8.0, 82.0), &mut random);
        let fit = fit_scattered(&points, &Term::ALL).unwrap();
        assert_eq!(fit.fitted, Term::ALL, "seed {SEED}, case {case}");
        let found = fit.noise[0];
        assert_eq!((found.kind, found.points), (Kind::Satellite, 80));
        noises += found.noise_deg / noise_deg / f64::from(CASES);
        for (term, square) in Term::ALL.into_iter().zip(&mut squares) {
            let interval = fit.interval(term).unwrap();
            let deviation = interval.value - model.term(term);
            sufficient += u32::from(deviation.abs() <= interval.half);
            // The bound of Cramer and Rao is the covariance for the true noise.
            let bound = fit.covariance(term, term) * (noise_deg / found.noise_deg).powi(2);
            *square += deviation * deviation / bound / f64::from(CASES);
        }
    }
    let share = f64::from(sufficient) / f64::from(CASES) / Term::COUNT as f64;
    let ratios = squares.map(f64::sqrt);
    println!("seed {SEED}: {share:.4} held, {ratios:.3?} times the bound, noise {noises:.3}");
    assert!((0.93..=0.97).contains(&share), "{share}");
    assert!(ratios.iter().all(|ratio| *ratio <= 1.3), "{ratios:?}");
    assert!((0.9..=1.1).contains(&noises), "{noises}");
}

/// Returns points like in real passes: some seconds apart, along one or a few paths over the sky.
fn of_passes(
    model: &PointingModel,
    count: usize,
    noise_deg: f64,
    random: &mut Random,
) -> Vec<Vec<Point>> {
    let catalog = bundled().unwrap();
    let site = Site::new(41.0, 29.0, 100.0).unwrap();
    let start: Timestamp = "2026-08-12T05:00:00Z".parse().unwrap();
    let search = PassSearch {
        aos_elevation: Angle::from_degrees(5.0),
        floor: Angle::from_degrees(20.0),
        ..PassSearch::new(site, start, add_seconds(start, 86_400.0))
    };
    let mut points = Vec::new();
    for _ in 0..count {
        let numbers = [25_544, 27_424, 43_013, 54_234];
        let elements = catalog.get(numbers[random.below(4) as usize]).unwrap();
        let propagator = Propagator::new(elements).unwrap();
        let found = passes(&propagator, &search, &|| false);
        let pass = found[random.below(found.len() as u32) as usize];
        let read = |step: u32| {
            let time = add_seconds(pass.aos.time, pass.duration_s() * f64::from(step) / 50.0);
            let target = propagator.look_from(site, time).unwrap().direction;
            Point { time, ..point(Kind::Satellite, target, model, noise_deg, random) }
        };
        points.push((0..50).map(read).collect());
    }
    points
}

#[test]
fn over_few_passes_an_interval_holds_its_term_or_is_not_given() {
    let mut random = Random::new(SEED);
    let (mut inside_count, mut sufficient, mut shared) = (0, 0, 0);
    for case in 0..CASES {
        let mut model = any_model(&mut random);
        model.elevation_scale /= 2.0;
        let count = 1 + case as usize % 3;
        let fit =
            fit(of_passes(&model, count, 0.02, &mut random).iter().map(Vec::as_slice), &Term::ALL)
                .unwrap();
        shared += fit.shared.len();
        for term in Term::ALL {
            let Some(interval) = fit.interval(term) else { continue };
            inside_count += 1;
            sufficient += u32::from((interval.value - model.term(term)).abs() <= interval.half);
        }
    }
    let share = f64::from(sufficient) / f64::from(inside_count);
    println!("seed {SEED}: {share:.4} of {inside_count} held, {shared} not given");
    assert!(
        (0.93..=0.995).contains(&share) && inside_count > 300 && shared > 100,
        "{share} {inside_count} {shared}"
    );
}

#[test]
fn one_peak_of_the_sun_does_not_count_for_exact() {
    let mut random = Random::new(SEED);
    let site = Site::new(41.0, 29.0, 100.0).unwrap();
    for case in 0..CASES {
        let model = any_model(&mut random);
        let mut all = points(&model, (20, 0.02), (8.0, 82.0), &mut random);
        let time: Timestamp = "2026-08-12T09:00:00Z".parse().unwrap();
        let target = sun_moon::sun(site, time);
        let measured = point(Kind::Sun, target, &model, 0.3, &mut random).measured;
        all.push(Point::of_sun(site, time, measured, 1.0));
        let with_sun = fit_scattered(&all, &Term::ALL).unwrap();
        let short = fit_scattered(&all[..20], &Term::ALL).unwrap();
        for term in Term::ALL {
            let half = |fit: &Fit| fit.interval(term).map(|interval| interval.half);
            let [Some(full), Some(partial)] = [&with_sun, &short].map(half) else { continue };
            assert!(full > 0.9 * partial, "case {case}, {term:?}: {full} {partial}");
        }
    }
}

#[test]
fn without_noise_the_model_is_found_as_it_is() {
    let mut random = Random::new(SEED);
    for _ in 0..20 {
        let model = any_model(&mut random);
        let fit = fit_scattered(&points(&model, (60, 0.0), (8.0, 82.0), &mut random), &Term::ALL)
            .unwrap();
        for term in Term::ALL {
            assert!((fit.model.term(term) - model.term(term)).abs() < 1e-6, "{term:?}");
        }
    }
}

#[test]
fn terms_that_the_points_do_not_tell_apart_are_named_and_left_out() {
    let mut random = Random::new(SEED);
    let model = any_model(&mut random);
    let level = points(&model, (60, 0.02), (30.0, 30.0), &mut random);
    let fit = fit_scattered(&level, &Term::ALL).unwrap();
    let alike =
        |term: Term| fit.alike.iter().find(|alike| alike.term == term).map(|pair| &*pair.others);
    assert_eq!(alike(Term::Collimation), Some(&[Term::AzimuthOffset][..]));
    assert_eq!(alike(Term::NonPerpendicularity), Some(&[Term::AzimuthOffset][..]));
    assert_eq!(alike(Term::ElevationScale), Some(&[Term::ElevationOffset][..]));
    assert_eq!(alike(Term::Sag), Some(&[Term::ElevationOffset][..]));
    assert_eq!((fit.model.sag_deg, fit.interval(Term::Sag)), (0.0, None));
    assert_eq!(fit.correlation(Term::Sag, Term::ElevationOffset), None);
    // The remaining terms still describe these points.
    assert!((0.8..1.2).contains(&(fit.noise[0].noise_deg / 0.02)), "{:?}", fit.noise);
    assert!(fit.correlation(Term::TiltNorth, Term::TiltEast).unwrap().abs() < 0.5);
}

#[test]
fn peaks_of_sun_and_moon_have_a_noise_of_their_own() {
    let mut random = Random::new(SEED);
    let site = Site::new(41.0, 29.0, 100.0).unwrap();
    let start: Timestamp = "2026-08-12T05:00:00Z".parse().unwrap();
    let model = any_model(&mut random);
    let mut all = points(&model, (60, 0.02), (8.0, 82.0), &mut random);
    let times =
        (0..100).map(|step| crate::astro::time::add_seconds(start, 360.0 * f64::from(step)));
    for time in times {
        let (sun, moon) = (sun_moon::sun(site, time), sun_moon::moon(site, time));
        if sun.elevation_deg() > 5.0 {
            let measured = point(Kind::Sun, sun, &model, 0.3, &mut random).measured;
            all.push(Point::of_sun(site, time, measured, 1.0));
        }
        if moon.elevation_deg() > 5.0 {
            let measured = point(Kind::Moon, moon, &model, 0.1, &mut random).measured;
            all.push(Point::of_moon(site, time, measured, 1.0));
        }
    }
    let fit = fit_scattered(&all, &Term::ALL).unwrap();
    assert_eq!(fit.noise.len(), 3, "{:?}", fit.noise);
    for (found, noise_deg) in fit.noise.iter().zip([0.02, 0.3, 0.1]) {
        assert!((0.7..1.3).contains(&(found.noise_deg / noise_deg)), "{:?}", fit.noise);
    }
    for term in Term::ALL {
        let Interval { value, half } = fit.interval(term).unwrap();
        assert!((value - model.term(term)).abs() < 2.0 * half, "{term:?} {value} {half}");
    }
}

#[test]
fn few_points_or_such_without_numbers_are_refused() {
    let mut random = Random::new(SEED);
    let mut few = points(&PointingModel::default(), (7, 0.02), (8.0, 82.0), &mut random);
    assert_eq!(fit_scattered(&few, &Term::ALL), Err(CannotFit::TooFew(7)));
    let mut odd = few[0];
    odd.weight = f64::NAN;
    few.push(odd);
    odd = few[0];
    odd.measured.azimuth = Angle::from_radians(f64::INFINITY);
    few.push(odd);
    assert_eq!(fit_scattered(&few, &Term::ALL), Err(CannotFit::TooFew(7)));
}

#[test]
fn a_term_that_is_not_wanted_is_zero_and_the_others_are_fitted() {
    let mut random = Random::new(SEED);
    let model = PointingModel {
        azimuth_offset_deg: 0.4,
        elevation_offset_deg: -0.2,
        ..PointingModel::default()
    };
    let points = points(&model, (200, 0.02), (8.0, 82.0), &mut random);
    let terms = [Term::AzimuthOffset, Term::ElevationOffset];
    let fit = fit_scattered(&points, &terms).unwrap();
    assert_eq!((&fit.fitted[..], fit.alike.len()), (&terms[..], 0));
    for term in Term::ALL {
        let Some(found) = fit.interval(term) else {
            assert_eq!((fit.model.term(term), terms.contains(&term)), (0.0, false), "{term:?}");
            continue;
        };
        assert!((found.value - model.term(term)).abs() < 2.0 * found.half, "{term:?}");
    }
    let all = fit_scattered(&points, &Term::ALL).unwrap();
    let half = |fit: &Fit| fit.interval(Term::AzimuthOffset).unwrap().half;
    assert!(half(&fit) < half(&all), "fewer terms are known better");
}
