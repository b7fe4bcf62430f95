//! Pass search against plain sampling, over orbits and sites of any kind.

use azel::{
    astro::{Angle, Site, time},
    orbit::{Elements, Pass, PassSearch, Propagator, bundled, passes, read_elements},
};
use jiff::Timestamp;
use proptest::prelude::*;

/// Tolerance at the horizon, degrees: within it, up and down are both right.
const LEVEL_DEG: f64 = 1e-4;

/// Returns the times at which the passes differ from samples taken every `step_s`.
fn differences(
    propagator: &Propagator,
    elements: &Elements,
    search: &PassSearch,
    found: &[Pass],
    step_s: f64,
) -> Vec<String> {
    let length_s = time::seconds_between(search.start, search.end);
    let mut differences = Vec::new();
    for index in 0..=(length_s / step_s) as usize {
        let at = time::add_seconds(search.start, index as f64 * step_s);
        let Ok(look) = propagator.look_from(search.site.airless(), at) else {
            // After its epoch, a decayed satellite stays down.
            if at > elements.epoch() {
                break;
            }
            continue;
        };
        let height_deg = (look.direction.elevation - search.aos_elevation).degrees();
        let is_within = found.iter().any(|pass| (pass.aos.time..=pass.los.time).contains(&at));
        if is_within != (height_deg >= 0.0) && height_deg.abs() > LEVEL_DEG {
            differences.push(format!("{height_deg} degrees above the horizon at {at}"));
        }
    }
    differences
}

/// Returns some of the round orbits, which resemble each other, and all eccentric ones.
fn chosen(catalog: &azel::orbit::Catalog) -> Vec<&Elements> {
    catalog
        .iter()
        .enumerate()
        .filter(|(index, elements)| index % 600 == 0 || elements.eccentricity() > 0.3)
        .map(|(_, elements)| elements)
        .collect()
}

#[test]
fn a_satellite_is_up_exactly_within_its_passes() {
    let catalog = bundled().unwrap();
    let from = catalog.newest_epoch().unwrap();
    let to = time::add_seconds(from, time::DAY_S);
    for (site, horizon_deg) in [
        (Site::new(41.02, 29.17, 100.0).unwrap(), 5.0),
        (Site::new(-78.0, 167.0, 0.0).unwrap(), 0.0),
    ] {
        let aos_elevation = Angle::from_degrees(horizon_deg);
        let search = PassSearch { aos_elevation, ..PassSearch::new(site, from, to) };
        for elements in chosen(&catalog) {
            let propagator = Propagator::new(elements).unwrap();
            let found = passes(&propagator, &search, &|| false);
            let wrong = differences(&propagator, elements, &search, &found, 20.0);
            assert!(wrong.is_empty(), "{} {wrong:#?}", elements.catalog_number());
        }
    }
}

#[test]
fn an_orbit_against_the_turn_of_the_earth_loses_no_pass() {
    let from: Timestamp = "2026-08-11T06:00:00Z".parse().unwrap();
    let to = time::add_seconds(from, time::DAY_S);
    let search = PassSearch::new(Site::new(3.0, 29.0, 100.0).unwrap(), from, to);
    // Towards 180 degrees, a long-period term of SGP4 grows without bounds.
    for inclination in [179.0, 179.9, 179.97, 179.99, 179.998, 179.9999, 180.0] {
        for eccentricity in [0.0003, 0.003, 0.02] {
            let message = serde_json::json!({
                "NORAD_CAT_ID": 5, "EPOCH": "2026-08-11T01:21:00", "MEAN_MOTION": 14.2,
                "ECCENTRICITY": eccentricity, "INCLINATION": inclination,
                "RA_OF_ASC_NODE": 100, "ARG_OF_PERICENTER": 40, "MEAN_ANOMALY": 10, "BSTAR": 0
            });
            let elements = read_elements(&message.to_string()).elements.remove(0);
            let propagator = Propagator::new(&elements).unwrap();
            let found = passes(&propagator, &search, &|| false);
            let wrong = differences(&propagator, &elements, &search, &found, 20.0);
            // Where SGP4's velocity is off, AOS and LOS may be off by one sample.
            assert!(wrong.len() < 4 && found.len() > 12, "{inclination} {eccentricity} {wrong:#?}");
        }
    }
}

/// Draws any orbit whose perigee clears or nearly clears the ground.
fn any_elements() -> impl Strategy<Value = Elements> {
    let round = prop_oneof![Just(0.0), 0.0..0.002_f64, 0.0..0.06_f64];
    let low = (11.0..16.5_f64, round.clone());
    let middle = (0.5..12.0_f64, prop_oneof![round, 0.0..0.9_f64]);
    let still = (0.99..1.015_f64, 0.0..0.02_f64);
    let size = prop_oneof![low, middle, still];
    let inclination = prop_oneof![0.0..180.0_f64, 0.0..0.1_f64, 89.0..99.0_f64, Just(180.0)];
    let angles = [0.0..360.0_f64, 0.0..360.0, 0.0..360.0];
    let bstar = prop_oneof![-1e-4..1e-3_f64, -0.01..0.05_f64, Just(0.0)];
    (size, inclination, angles, bstar).prop_filter_map("decayed", |(size, i, angles, bstar)| {
        let (motion, eccentricity) = size;
        let message = serde_json::json!({
            "NORAD_CAT_ID": 5, "EPOCH": "2026-08-11T01:21:00", "MEAN_MOTION": motion,
            "ECCENTRICITY": eccentricity, "INCLINATION": i, "RA_OF_ASC_NODE": angles[0],
            "ARG_OF_PERICENTER": angles[1], "MEAN_ANOMALY": angles[2], "BSTAR": bstar
        });
        let elements = read_elements(&message.to_string()).elements.pop()?;
        let axis_km = (398_600.8 / (motion * std::f64::consts::TAU / 86_400.0).powi(2)).cbrt();
        (axis_km * (1.0 - eccentricity) > 6_440.0).then_some(elements)
    })
}

fn any_search() -> impl Strategy<Value = PassSearch> {
    let latitude = prop_oneof![-90.0..=90.0_f64, Just(90.0), Just(-90.0), Just(0.0)];
    let site = (latitude, -180.0..180.0_f64, -100.0..5000.0_f64);
    let aos_deg = prop_oneof![Just(0.0), -5.0..35.0_f64, -60.0..80.0_f64];
    let start_days = prop_oneof![-2.0..5.0_f64, -400.0..400.0_f64];
    let hours = prop_oneof![12.0..30.0_f64, 0.01..3.0_f64];
    (site, aos_deg, 0.0..89.0_f64, start_days, hours).prop_map(
        |(site, aos_deg, floor_deg, start_days, hours)| {
            let epoch: Timestamp = "2026-08-11T01:21:00Z".parse().unwrap();
            let from = time::add_seconds(epoch, start_days * time::DAY_S);
            let (latitude, longitude, altitude) = site;
            PassSearch {
                site: Site::new(latitude, longitude, altitude).unwrap(),
                start: from,
                end: time::add_seconds(from, hours * 3600.0),
                aos_elevation: Angle::from_degrees(aos_deg),
                floor: Angle::from_degrees(floor_deg),
            }
        },
    )
}

/// Returns the number of cases from `PROPTEST_CASES`, or a default that suits a slow build.
fn cases() -> ProptestConfig {
    let asked = std::env::var("PROPTEST_CASES").ok().and_then(|cases| cases.parse().ok());
    ProptestConfig {
        cases: asked.unwrap_or(120),
        max_shrink_iters: 300,
        ..ProptestConfig::default()
    }
}

/// Returns `true` if the velocities of SGP4 agree with the change of its positions. They disagree
/// far from the epoch, or with a drag that ends the orbit in days.
fn is_an_orbit(propagator: &Propagator, search: &PassSearch) -> bool {
    let length_s = time::seconds_between(search.start, search.end);
    (0..=200).all(|index| {
        let state = |offset_s| {
            let at_s = length_s * f64::from(index) / 200.0 + offset_s;
            propagator.state_at(time::add_seconds(search.start, at_s))
        };
        let (Ok(before), Ok(now), Ok(after)) = (state(-1.0), state(0.0), state(1.0)) else {
            return true;
        };
        let moved_km = after.position_km - before.position_km;
        (0.5 * moved_km - now.velocity_km_s).length() < 0.02
    })
}

proptest! {
    #![proptest_config(cases())]

    #[test]
    fn any_orbit_over_any_site_is_up_exactly_within_its_passes(
        elements in any_elements(),
        search in any_search(),
    ) {
        let propagator = Propagator::new(&elements).unwrap();
        prop_assume!(is_an_orbit(&propagator, &search));
        let all = PassSearch { floor: search.aos_elevation, ..search };
        let found = passes(&propagator, &all, &|| false);
        let wrong = differences(&propagator, &elements, &all, &found, 30.0);
        prop_assert!(wrong.is_empty(), "{wrong:#?} of {found:#?}");
        for pass in &found {
            let Pass { aos, tca, los, starts_before, ends_after } = *pass;
            prop_assert!(aos.time <= tca.time && tca.time <= los.time);
            prop_assert!(starts_before == (aos.time == search.start) || starts_before);
            prop_assert!(!ends_after || los.time <= search.end);
        }
        prop_assert!(found.windows(2).all(|pair| pair[0].los.time < pair[1].aos.time));

        // A floor removes passes and changes none.
        let floored = passes(&propagator, &search, &|| false);
        let high = |pass: &&Pass| (pass.max_elevation() - search.floor).degrees() > LEVEL_DEG;
        let expected: Vec<&Pass> = found.iter().filter(high).collect();
        let kept: Vec<&Pass> = floored.iter().filter(high).collect();
        prop_assert_eq!(kept.len(), expected.len());
        for (kept, expected) in kept.into_iter().zip(expected) {
            prop_assert!(time::seconds_between(kept.aos.time, expected.aos.time).abs() < 0.01);
            let off = kept.max_elevation() - expected.max_elevation();
            prop_assert!(off.abs().degrees() < LEVEL_DEG);
        }
        let lowest = search.floor.radians().max(search.aos_elevation.radians());
        let grazes = |pass: &Pass| pass.max_elevation().radians() >= lowest - LEVEL_DEG.to_radians();
        prop_assert!(floored.iter().all(grazes));
    }
}
