//! Comparison of the pass search with two others, in one run: `cargo bench --bench passes`.
//!
//! - `sgp4-predict` with steps wide enough to be fast and close enough to lose only a few passes.
//!   One column has the cost of AOS and LOS alone, which is all that its search gives. Another adds
//!   the greatest elevation and the directions, each in as few steps as find it.
//! - The SGP4 library that all three searches use, with a state every 10 s. Each crossing is halved
//!   down to a millisecond, and each maximum near the horizon is examined more closely.
//!
//! All searches work on one core; the last column is Azel's search on two. Times are wall times
//! and, in brackets, processor times. The shares compare processor times, and on two cores wall
//! times. The grid needs minutes for the whole catalog and most of an hour for a week of it. The
//! bench therefore runs the latter only with `-- --all`.

// A bench prints its results, and may panic.
#![allow(clippy::print_stdout, clippy::unwrap_used, clippy::indexing_slicing)]

use std::{
    hint::black_box,
    time::{Duration, Instant},
};

use azel::{
    astro::{Site, frames, time},
    orbit::{
        Elements, PassSearch, Propagator, bundled, passes_and_effort, passes_of_all, tle_lines,
    },
};
use chrono::{DateTime, TimeDelta, Utc};
use glam::DVec3;
use sgp4_predict::{
    Degrees, GeodeticPoint, MaxElevationOpts, Predictor, Refinement, Tle, Transit, TransitIterOpts,
};

const LATITUDE_DEG: f64 = 41.02;
const LONGITUDE_DEG: f64 = 29.17;
const ALTITUDE_M: f64 = 100.0;
const START: &str = "2026-08-12T00:00:00Z";
const GRID_S: f64 = 10.0;
/// Number of runs if a run is short; the shortest counts.
const RUNS: usize = 7;

fn site() -> Site {
    Site::new(LATITUDE_DEG, LONGITUDE_DEG, ALTITUDE_M).unwrap()
}

fn search(days: f64) -> PassSearch {
    let from = START.parse().unwrap();
    PassSearch::new(site(), from, time::add_seconds(from, days * time::DAY_S))
}

/// A satellite, prepared for each method.
struct Satellite {
    number: u32,
    ours: Propagator,
    theirs: Option<Predictor>,
    plain: sgp4::Constants,
    epoch: jiff::Timestamp,
}

impl Satellite {
    fn new(elements: &Elements) -> Option<Self> {
        let [first, second] = tle_lines(elements).ok()?;
        let tle: Option<Tle> = format!("{}\n{first}\n{second}", elements.name()).parse().ok();
        let read = sgp4::Elements::from_tle(None, first.as_bytes(), second.as_bytes()).ok()?;
        Some(Self {
            number: elements.catalog_number(),
            ours: Propagator::new(elements).ok()?,
            theirs: tle.and_then(|tle| Predictor::from_tle(&tle).ok()),
            plain: sgp4::Constants::from_elements_afspc_compatibility_mode(&read).ok()?,
            epoch: elements.epoch(),
        })
    }
}

/// Shortest of several runs, seconds: in wall time, and in processor time of this process. Other
/// work on the machine does not lengthen the processor time.
#[derive(Clone, Copy)]
struct Shortest {
    wall_s: f64,
    cpu_s: f64,
}

/// Returns the shortest run, and the result of the last run.
fn timed<T>(runs: usize, mut run: impl FnMut() -> T) -> (Shortest, T) {
    let mut shortest = Shortest { wall_s: f64::INFINITY, cpu_s: f64::INFINITY };
    let mut result = None;
    for _ in 0..runs {
        let (start, start_cpu_s) = (Instant::now(), cpu_s());
        result = Some(black_box(run()));
        let (wall_s, cpu_s) = (start.elapsed().as_secs_f64(), cpu_s() - start_cpu_s);
        shortest.wall_s = shortest.wall_s.min(wall_s);
        shortest.cpu_s = shortest.cpu_s.min(cpu_s);
    }
    (shortest, result.unwrap())
}

/// Returns the processor time of this process, seconds.
#[cfg(unix)]
fn cpu_s() -> f64 {
    let clock = nix::time::ClockId::CLOCK_PROCESS_CPUTIME_ID;
    Duration::from(clock.now().unwrap()).as_secs_f64()
}

/// Returns NaN: other systems have no measurement.
#[cfg(not(unix))]
fn cpu_s() -> f64 {
    f64::NAN
}

fn ours(satellites: &[Satellite], days: f64, threads: usize) -> (Shortest, usize) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let propagators: Vec<&Propagator> = satellites.iter().map(|one| &one.ours).collect();
    let search = search(days);
    let run = || passes_of_all(&propagators, &search, &|_| (), &|| false).map(black_box).count();
    // The timing is within the pool, because waking a thread takes as long as a week of one
    // satellite.
    pool.install(|| timed(RUNS, run))
}

const THEIR_SITE: GeodeticPoint = GeodeticPoint {
    latitude: Degrees(LATITUDE_DEG),
    longitude: Degrees(LONGITUDE_DEG),
    altitude: ALTITUDE_M,
};

/// Returns the time and number of passes of `sgp4-predict`, and calls `then` for each pass.
fn theirs(
    satellites: &[Satellite],
    days: f64,
    then: impl Fn(&Predictor, &Transit),
) -> (Shortest, usize) {
    let from: DateTime<Utc> = START.parse().unwrap();
    let to = from + TimeDelta::milliseconds((days * time::DAY_S * 1e3) as i64);
    let options = TransitIterOpts {
        min_step: TimeDelta::seconds(10),
        max_step: TimeDelta::seconds(600),
        walk_step: TimeDelta::seconds(30),
        max_transit_duration: TimeDelta::days(30),
        skip_leading_partial: false,
        clamp_to_interval: true,
    };
    let runs = if satellites.len() > 1000 { 1 } else { RUNS };
    timed(runs, || {
        let transits = |predictor: &Predictor| {
            predictor
                .transits_iter_with_opts(
                    THEIR_SITE,
                    from..to,
                    Degrees(0.0),
                    options,
                    Refinement::default(),
                )
                .map_while(Result::ok)
                .inspect(|transit| then(predictor, transit))
                .count()
        };
        satellites.iter().filter_map(|one| one.theirs.as_ref()).map(transits).sum()
    })
}

/// Computes the maximum elevation of a pass, and the directions of AOS and LOS.
fn describe(predictor: &Predictor, transit: &Transit) {
    let Transit { start, end } = *transit;
    // The search needs at least two steps within the pass to see a fall.
    let scan_step = ((end - start) / 3).clamp(TimeDelta::milliseconds(1), TimeDelta::minutes(30));
    black_box(predictor.observe_at(start, THEIR_SITE)).unwrap();
    black_box(predictor.observe_at(end, THEIR_SITE)).unwrap();
    let options = MaxElevationOpts { scan_step };
    black_box(predictor.max_elevation_with_opts(start..end, THEIR_SITE, options)).unwrap();
}

/// Sky over the site at the instants of a grid.
struct Grid {
    from: jiff::Timestamp,
    /// Upward direction and site, in the axes of the states, per step.
    steps: Vec<(DVec3, DVec3)>,
}

impl Grid {
    fn new(days: f64) -> Self {
        let from: jiff::Timestamp = START.parse().unwrap();
        let count = (days * time::DAY_S / GRID_S) as usize;
        let steps = (0..=count).map(|step| Self::sky(from, step as f64 * GRID_S)).collect();
        Self { from, steps }
    }

    fn sky(from: jiff::Timestamp, at_s: f64) -> (DVec3, DVec3) {
        let to_teme = frames::teme_to_ecef(time::add_seconds(from, at_s)).transpose();
        let up = frames::ecef_to_enu(site()).transpose() * DVec3::Z;
        (to_teme * up, to_teme * frames::site_ecef_km(site()))
    }

    /// Returns the sine of the elevation; -1 without a state.
    fn height(&self, one: &Satellite, at_s: f64, (up, site_km): (DVec3, DVec3)) -> f64 {
        let minutes = (time::seconds_between(one.epoch, self.from) + at_s) / 60.0;
        one.plain.propagate(sgp4::MinutesSinceEpoch(minutes)).map_or(-1.0, |state| {
            let line = DVec3::from_array(state.position) - site_km;
            line.dot(up) / line.length()
        })
    }

    fn passes(&self, one: &Satellite) -> usize {
        let exact = |at_s: f64| self.height(one, at_s, Self::sky(self.from, at_s));
        let (mut count, mut last) = (0, [-1.0_f64; 2]);
        for (step, sky) in self.steps.iter().enumerate() {
            let at_s = step as f64 * GRID_S;
            let here = self.height(one, at_s, *sky);
            let [before, previous] = last;
            if step == 0 {
                count += usize::from(here >= 0.0);
            } else if (previous >= 0.0) != (here >= 0.0) {
                black_box(crossing(&exact, at_s - GRID_S, at_s));
                count += usize::from(here >= 0.0);
            }
            let is_crest = step > 1 && previous > before && previous > here;
            if is_crest && previous > -0.01 {
                let highest = crest(&exact, at_s - 2.0 * GRID_S, at_s);
                count += usize::from(previous < 0.0 && highest >= 0.0);
            }
            last = [previous, here];
        }
        count
    }
}

fn crossing(height: &impl Fn(f64) -> f64, from_s: f64, to_s: f64) -> f64 {
    let (mut from_s, mut to_s) = (from_s, to_s);
    let rises = height(from_s) < 0.0;
    while to_s - from_s > 1e-3 {
        let middle_s = f64::midpoint(from_s, to_s);
        if (height(middle_s) < 0.0) == rises {
            from_s = middle_s;
        } else {
            to_s = middle_s;
        }
    }
    from_s
}

fn crest(height: &impl Fn(f64) -> f64, from_s: f64, to_s: f64) -> f64 {
    let (mut from_s, mut to_s) = (from_s, to_s);
    while to_s - from_s > 1e-3 {
        let third_s = (to_s - from_s) / 3.0;
        if height(from_s + third_s) < height(to_s - third_s) {
            from_s += third_s;
        } else {
            to_s -= third_s;
        }
    }
    height(f64::midpoint(from_s, to_s))
}

fn grid(satellites: &[Satellite], days: f64) -> (Shortest, usize) {
    let grid = Grid::new(days);
    timed(1, || satellites.iter().map(|one| grid.passes(one)).sum())
}

/// Returns the peak of the resident memory, MB.
fn max_memory_mb() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<f64>().ok()? / 1024.0)
}

/// Runs the whole search first, before the other searches use any memory.
fn measure_memory() {
    let before_mb = max_memory_mb();
    let catalog = bundled().unwrap();
    let propagators: Vec<Propagator> =
        catalog.iter().filter_map(|elements| Propagator::new(elements).ok()).collect();
    let found = passes_of_all(&propagators, &search(1.0), &|_| (), &|| false);
    let after_mb = max_memory_mb();
    let passes = found.count();
    if let (Some(before_mb), Some(after_mb)) = (before_mb, after_mb) {
        println!(
            "memory: {:.1} MB for the catalog, what is prepared of it, and {passes} passes",
            after_mb - before_mb
        );
    }
}

fn measure_effort(satellites: &[Satellite]) {
    let search = search(1.0);
    let (mut passes, mut states) = (0, 0);
    for one in satellites {
        let (found, effort) = passes_and_effort(&one.ours, &search, &|| false);
        passes += found.len();
        states += effort;
    }
    println!("effort: {:.3} states a pass", states as f64 / passes as f64);
}

fn told(Shortest { wall_s, cpu_s }: Shortest) -> String {
    format!("{:.3} ms ({:.3})", wall_s * 1e3, cpu_s * 1e3)
}

fn main() {
    let all = std::env::args().any(|argument| argument == "--all");
    measure_memory();
    let catalog = bundled().unwrap();
    let satellites: Vec<Satellite> = catalog.iter().filter_map(Satellite::new).collect();
    measure_effort(&satellites);
    println!(
        "{:>14} {:>21} {:>32} {:>32} {:>32} {:>16}",
        "", "this search", "sgp4-predict", "its AOS and LOS alone", "10 s grid", "two cores"
    );
    let iss = satellites.iter().position(|one| one.number == 25_544).unwrap();
    let cases = [
        ("1 x 7 d", iss..iss + 1, 7.0),
        ("100 x 7 d", 0..100, 7.0),
        ("all x 1 d", 0..satellites.len(), 1.0),
        ("all x 7 d", 0..satellites.len(), 7.0),
    ];
    for (name, which, days) in cases {
        let chosen = &satellites[which];
        let (one, passes) = ours(chosen, days, 1);
        let (two, _) = ours(chosen, days, 2);
        let compared = |(other, found): (Shortest, usize)| {
            let more = found as f64 - passes as f64;
            format!("{} {:.0}x {more:+.0}", told(other), other.cpu_s / one.cpu_s)
        };
        let long = chosen.len() > 1000 && days > 1.0;
        let by_grid = if long && !all { "-".to_owned() } else { compared(grid(chosen, days)) };
        println!(
            "{name:>14} {:>21} {:>32} {:>32} {by_grid:>32} {:>8.3} ms {:.2}x   {passes} passes",
            told(one),
            compared(theirs(chosen, days, describe)),
            compared(theirs(chosen, days, |_, _| ())),
            two.wall_s * 1e3,
            one.wall_s / two.wall_s,
        );
    }
}
