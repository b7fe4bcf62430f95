//! Pass search against brute force: the same propagator sampled every second, with crossings by
//! bisection. The search neither misses nor invents a pass; times and elevations are as promised.
//!
//! The test draws satellites of every kind. `AZEL_DRAW` in the environment sets their number, and a
//! whole day instead of some hours. `AZEL_ELEMENTS` names a folder with more TLE files.

use azel::{
    astro::{Angle, Site, time},
    orbit::{Elements, Pass, PassSearch, Propagator, bundled, passes, read_elements},
};
use jiff::Timestamp;
use rayon::prelude::*;

const DEFAULT_DRAW: usize = 36;
const DEFAULT_HOURS: f64 = 5.0;
const GRID_S: f64 = 1.0;
const MAX_OFF_S: f64 = 0.01;
const MAX_OFF_DEG: f64 = 1e-4;
/// Rate of elevation below which the test compares elevations instead of times, degrees per second.
const SLOW_DEG_S: f64 = 0.002;

/// Returns sites at three latitudes.
fn sites() -> [Site; 3] {
    [(41.02, 29.17, 100.0), (-0.2, -78.5, 2800.0), (78.23, 15.4, 450.0)]
        .map(|(latitude, longitude, altitude)| Site::new(latitude, longitude, altitude).unwrap())
}

/// Returns an even draw of all satellites, an equal number of the rare kinds, and some known
/// orbits.
fn drawn(draw: usize) -> Vec<Elements> {
    let catalog = bundled().unwrap();
    let mut all: Vec<Elements> = catalog.iter().cloned().collect();
    if let Ok(folder) = std::env::var("AZEL_ELEMENTS") {
        let mut files: Vec<_> =
            std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.sort();
        for file in files.iter().filter(|file| file.to_string_lossy().contains("debris")) {
            all.extend(read_elements(&std::fs::read_to_string(file).unwrap()).elements);
        }
    }
    let rare = |elements: &&Elements| {
        elements.eccentricity() > 0.04
            || elements.mean_motion_rev_day() < 6.5
            || elements.mean_motion_rev_day() > 15.9
    };
    let every = |among: Vec<&Elements>, count: usize| -> Vec<Elements> {
        let stride = (among.len() / count).max(1);
        among.into_iter().step_by(stride).take(count).cloned().collect()
    };
    let mut chosen = every(all.iter().collect(), draw / 2);
    chosen.extend(every(all.iter().filter(rare).collect(), draw / 2));
    // A Molniya orbit, a transfer orbit, a geostationary orbit, and one far out.
    let known = [40_296, 25_867, 54_743, 43_435].map(|number| catalog.get(number).cloned());
    chosen.extend(known.into_iter().flatten());
    chosen
}

/// Sky of one satellite: elevation in degrees, by seconds from the start; `None` without a state.
struct Sky {
    propagator: Propagator,
    site: Site,
    from: Timestamp,
}

impl Sky {
    fn elevation_deg(&self, at_s: f64) -> Option<f64> {
        let look =
            self.propagator.look_from(self.site.airless(), time::add_seconds(self.from, at_s));
        look.ok().map(|look| look.direction.elevation_deg())
    }

    fn rate_deg_s(&self, at_s: f64) -> f64 {
        let at = |offset_s: f64| self.elevation_deg(at_s + offset_s).unwrap_or(f64::NAN);
        at(0.5) - at(-0.5)
    }

    fn crossing_s(&self, mut below_s: f64, mut above_s: f64, horizon_deg: f64) -> f64 {
        for _ in 0..24 {
            let middle_s = f64::midpoint(below_s, above_s);
            if self.elevation_deg(middle_s).unwrap() < horizon_deg {
                below_s = middle_s;
            } else {
                above_s = middle_s;
            }
        }
        f64::midpoint(below_s, above_s)
    }
}

/// A stay above the horizon, in seconds from the start.
struct Stay {
    aos_s: f64,
    los_s: f64,
    highest_s: f64,
    highest_deg: f64,
}

/// Returns the stays above the horizon on a grid of elevations.
fn stays(sky: &Sky, grid: &[f64], horizon_deg: f64, length_s: f64) -> Vec<Stay> {
    let mut found: Vec<Stay> = Vec::new();
    let mut last_up = false;
    for (index, elevation_deg) in grid.iter().copied().enumerate() {
        let at_s = (index as f64 * GRID_S).min(length_s);
        let before_s = at_s - GRID_S;
        let is_up = elevation_deg >= horizon_deg;
        match (last_up, is_up) {
            (false, true) => {
                let aos_s =
                    if index == 0 { 0.0 } else { sky.crossing_s(before_s, at_s, horizon_deg) };
                found.push(Stay { aos_s, los_s: length_s, highest_s: at_s, highest_deg: -90.0 });
            }
            (true, false) => {
                found.last_mut().unwrap().los_s = sky.crossing_s(at_s, before_s, horizon_deg);
            }
            _ => {}
        }
        if let Some(stay) =
            found.last_mut().filter(|stay| is_up && elevation_deg > stay.highest_deg)
        {
            (stay.highest_s, stay.highest_deg) = (at_s, elevation_deg);
        }
        last_up = is_up;
    }
    for stay in &mut found {
        refine_top(sky, stay);
    }
    found
}

/// Refines the top by ternary search around the highest point of the grid.
fn refine_top(sky: &Sky, stay: &mut Stay) {
    let mut low_s = (stay.highest_s - GRID_S).max(stay.aos_s);
    let mut high_s = (stay.highest_s + GRID_S).min(stay.los_s);
    for _ in 0..24 {
        let (a, b) = (low_s + (high_s - low_s) / 3.0, high_s - (high_s - low_s) / 3.0);
        if sky.elevation_deg(a) < sky.elevation_deg(b) { low_s = a } else { high_s = b }
    }
    stay.highest_s = f64::midpoint(low_s, high_s);
    stay.highest_deg = sky.elevation_deg(stay.highest_s).unwrap();
}

/// Returns the faults of the found passes.
fn faults(sky: &Sky, found: &[Pass], expected: &[Stay]) -> Vec<String> {
    let seconds = |at: Timestamp| time::seconds_between(sky.from, at);
    let mut faults = Vec::new();
    let mut left: Vec<&Pass> = found.iter().collect();
    for stay in expected {
        let near = |pass: &&Pass| {
            seconds(pass.aos.time) < stay.los_s + 1.0 && seconds(pass.los.time) > stay.aos_s - 1.0
        };
        let Some(index) = left.iter().position(near) else {
            faults.push(format!("missed {} to {}", stay.aos_s, stay.los_s));
            continue;
        };
        let pass = left.remove(index);
        for (name, point, at_s) in [
            ("AOS", pass.aos, stay.aos_s),
            ("TCA", pass.tca, stay.highest_s),
            ("LOS", pass.los, stay.los_s),
        ] {
            let off_s = (seconds(point.time) - at_s).abs();
            let off_deg =
                (point.direction.elevation_deg() - sky.elevation_deg(at_s).unwrap()).abs();
            let is_slow = sky.rate_deg_s(at_s).abs() < SLOW_DEG_S && off_deg < MAX_OFF_DEG;
            if off_s > MAX_OFF_S && !is_slow {
                faults.push(format!("{name} {at_s} is off by {off_s} s, {off_deg} deg"));
            }
        }
        let off_deg = (pass.max_elevation().degrees() - stay.highest_deg).abs();
        if off_deg > MAX_OFF_DEG {
            faults.push(format!("top at {} is off by {off_deg} deg", stay.highest_s));
        }
    }
    faults.extend(left.iter().map(|pass| format!("invented {pass:?}")));
    faults
}

/// Returns `true` if only one answer is right: the highest point of the stay is clearly above or
/// below the floor.
fn is_settled(stay: &Stay, floor_deg: f64) -> bool {
    (stay.highest_deg - floor_deg).abs() > MAX_OFF_DEG
}

#[test]
fn no_pass_is_missed_and_none_invented() {
    let draw = std::env::var("AZEL_DRAW").ok().map(|draw| draw.parse::<usize>().unwrap());
    let hours = if draw.is_some() { 24.0 } else { DEFAULT_HOURS };
    let chosen = drawn(draw.unwrap_or(DEFAULT_DRAW));
    let from: Timestamp = "2026-08-12T00:00:00Z".parse().unwrap();
    let length_s = hours * 3600.0;
    let work: Vec<(Site, &Elements)> =
        sites().into_iter().flat_map(|site| chosen.iter().map(move |one| (site, one))).collect();
    let results: Vec<(usize, Vec<String>)> = work
        .par_iter()
        .map(|(site, elements)| {
            let propagator = Propagator::new(elements).unwrap();
            let sky = Sky { propagator, site: *site, from };
            let grid: Vec<f64> = (0..=(length_s / GRID_S) as usize)
                .map_while(|index| sky.elevation_deg(index as f64 * GRID_S))
                .collect();
            let (mut count, mut wrong) = (0, Vec::new());
            for (aos_deg, floor_deg) in [(0.0, 0.0), (0.0, 10.0), (10.0, 10.0)] {
                let search = PassSearch {
                    aos_elevation: Angle::from_degrees(aos_deg),
                    floor: Angle::from_degrees(floor_deg),
                    ..PassSearch::new(*site, from, time::add_seconds(from, length_s))
                };
                let mut expected = stays(&sky, &grid, aos_deg, length_s);
                let mut found = passes(&sky.propagator, &search, &|| false);
                expected
                    .retain(|stay| stay.highest_deg >= floor_deg && is_settled(stay, floor_deg));
                found.retain(|pass| {
                    let top_deg = pass.max_elevation().degrees();
                    (top_deg - floor_deg).abs() > MAX_OFF_DEG
                });
                count += expected.len();
                let name = format!("{} {}", elements.catalog_number(), elements.name());
                wrong.extend(faults(&sky, &found, &expected).into_iter().map(|fault| {
                    format!("{name} from {aos_deg} over {floor_deg} at {site:?}: {fault}")
                }));
            }
            (count, wrong)
        })
        .collect();
    let count: usize = results.iter().map(|(count, _)| count).sum();
    let wrong: Vec<String> = results.into_iter().flat_map(|(_, wrong)| wrong).collect();
    println!("{count} passes of {} satellites over three sites", chosen.len());
    assert!(count > chosen.len() && wrong.is_empty(), "{} wrong: {wrong:#?}", wrong.len());
}
