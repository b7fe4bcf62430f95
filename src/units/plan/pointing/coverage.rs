//! Test of how often an interval contains the true term, by noise and number of passes.
//!
//! These tests compute orbits, mount and noise independently: they turn the axes one after the
//! other, and search the readings that point at a satellite. The long form runs a thousand fits for
//! each row:
//!
//! ```text
//! AZEL_SEED=1 AZEL_CASES=1000 cargo test --release -p azel-units --lib coverage -- --nocapture
//! ```

use std::f64::consts::TAU;

use jiff::{SignedDuration, Timestamp};

use super::{Kind, Point, fit};
use crate::astro::{AzEl, PointingModel, Term};

const DEFAULT_CASES: u64 = 10;
const DEG: f64 = TAU / 360.0;
/// Seconds between two points, correlation time of the noise (decay to 1/e, seconds), and site.
const STEP_S: f64 = 10.0;
const MEMORY_S: f64 = 30.0;
const LATITUDE: f64 = 41.0 * DEG;

/// Lehmer sequence with a multiplier by Cannon.
struct Draws(u128);

impl Draws {
    fn new(seed: u64) -> Self {
        let mut draws = Self((u128::from(seed) << 1) | 1);
        for _ in 0..8 {
            draws.share();
        }
        draws
    }

    /// Returns a number from 0 to 1.
    fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(0xda94_2042_e4dd_58b5);
        ((self.0 >> 75) as f64) / 2.0_f64.powi(53)
    }

    fn uniform(&mut self, start: f64, end: f64) -> f64 {
        start + (end - start) * self.share()
    }

    /// Returns a number from the normal distribution, by the polar method.
    fn normal(&mut self) -> f64 {
        loop {
            let (a, b) = (self.uniform(-1.0, 1.0), self.uniform(-1.0, 1.0));
            let square = a * a + b * b;
            if square > 0.0 && square < 1.0 {
                return a * (-2.0 * square.ln() / square).sqrt();
            }
        }
    }
}

/// Circular orbit over a round Earth.
#[derive(Clone, Copy)]
struct Orbit {
    radius_km: f64,
    inclination: f64,
    node: f64,
    start: f64,
}

impl Orbit {
    fn any(draws: &mut Draws) -> Self {
        Self {
            radius_km: draws.uniform(6_850.0, 7_250.0),
            inclination: draws.uniform(50.0, 100.0) * DEG,
            node: draws.uniform(0.0, TAU),
            start: draws.uniform(0.0, TAU),
        }
    }

    /// Returns azimuth and elevation at `at_s` seconds, radians.
    fn look(self, at_s: f64) -> [f64; 2] {
        let along = self.start + (398_600.0 / self.radius_km.powi(3)).sqrt() * at_s;
        let (sin_u, cos_u) = along.sin_cos();
        let (sin_i, cos_i) = self.inclination.sin_cos();
        // The sky turns backwards over the site, which lies in the plane of x and z.
        let (sin_n, cos_n) = (self.node - TAU / 86_164.0 * at_s).sin_cos();
        let position = [
            self.radius_km * (cos_u * cos_n - sin_u * cos_i * sin_n),
            self.radius_km * (cos_u * sin_n + sin_u * cos_i * cos_n),
            self.radius_km * sin_u * sin_i,
        ];
        let (sin_l, cos_l) = LATITUDE.sin_cos();
        let [x, y, z] = [position[0] - 6_371.0 * cos_l, position[1], position[2] - 6_371.0 * sin_l];
        let (north, up) = (z * cos_l - x * sin_l, x * cos_l + z * sin_l);
        [y.atan2(north).rem_euclid(TAU), up.atan2(y.hypot(north))]
    }

    /// Returns the times above 5 degrees, seconds; `None` if the pass stays too low or comes too
    /// near to the zenith.
    fn pass(self) -> Option<Vec<f64>> {
        let steps = |from_s: f64, step_s: f64| {
            (0_u32..700).map(move |step| from_s + step_s * f64::from(step))
        };
        let elevation = |at_s: &f64| self.look(*at_s)[1];
        let top_s = steps(0.0, 10.0).max_by(|a, b| elevation(a).total_cmp(&elevation(b)))?;
        if !(20.0 * DEG..86.0 * DEG).contains(&elevation(&top_s)) {
            return None;
        }
        let rise_s = steps(top_s, -1.0).take_while(|at_s| elevation(at_s) > 5.0 * DEG).last()?;
        Some(steps(rise_s, STEP_S).take_while(|at_s| elevation(at_s) > 5.0 * DEG).collect())
    }
}

fn any_pass(draws: &mut Draws) -> (Orbit, Vec<f64>) {
    loop {
        let orbit = Orbit::any(draws);
        if let Some(times_s) = orbit.pass().filter(|times_s| times_s.len() > 10) {
            return (orbit, times_s);
        }
    }
}

/// Turns a vector (east, north, up) by an angle about an axis, by the right-hand rule.
fn turned(v: [f64; 3], axis: [f64; 3], angle: f64) -> [f64; 3] {
    let (sin, cos) = angle.sin_cos();
    let dot = (0..3).map(|i| axis[i] * v[i]).sum::<f64>() * (1.0 - cos);
    let cross = [
        axis[1] * v[2] - axis[2] * v[1],
        axis[2] * v[0] - axis[0] * v[2],
        axis[0] * v[1] - axis[1] * v[0],
    ];
    std::array::from_fn(|i| v[i] * cos + cross[i] * sin + axis[i] * dot)
}

/// Mount with errors, degrees in the order of [`Term::ALL`].
struct Errors([f64; Term::COUNT]);

impl Errors {
    fn any(draws: &mut Draws) -> Self {
        Self(Term::ALL.map(|term| {
            let size = if term == Term::ElevationScale { 0.004 } else { 0.5 };
            draws.uniform(-size, size)
        }))
    }

    /// Returns the direction of the beam for these angles of the axes.
    fn beam(&self, [azimuth, elevation]: [f64; 2]) -> [f64; 2] {
        let [.., tilt_north, tilt_east, collimation, leans, _, _] = self.0;
        let beam = turned([0.0, 1.0, 0.0], [0.0, 0.0, 1.0], collimation * DEG);
        let beam = turned(beam, [1.0, 0.0, 0.0], elevation);
        let beam = turned(beam, [0.0, 1.0, 0.0], -leans * DEG);
        let beam = turned(beam, [0.0, 0.0, 1.0], -azimuth);
        let lean = tilt_north.hypot(tilt_east);
        let beam = turned(beam, [-tilt_north / lean, tilt_east / lean, 0.0], lean * DEG);
        [beam[0].atan2(beam[1]), beam[2].asin()]
    }

    /// Returns the readings of the axes for this direction of the beam, radians.
    fn reading(&self, sky: [f64; 2]) -> [f64; 2] {
        let mut axes = sky;
        for _ in 0..40 {
            let beam = self.beam(axes);
            let deviation = (sky[0] - beam[0] + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
            axes = [axes[0] + deviation, axes[1] + sky[1] - beam[1]];
        }
        let [azimuth_offset, elevation_offset, .., scale, sag] = self.0;
        let [azimuth, elevation] = axes;
        let read = elevation * (1.0 + scale) + (elevation_offset + sag * elevation.cos()) * DEG;
        [azimuth + azimuth_offset * DEG, read]
    }
}

#[derive(Debug, Clone, Copy)]
enum Errs {
    /// Independent noise in each point, 0.05 degrees.
    White,
    /// Correlated noise from point to point, 0.05 degrees.
    Correlated,
    /// Time error of each pass of 0.04 s, and 0.02 degrees in each point.
    Late,
    /// Mixture of all kinds.
    All,
    /// Error of each axis that changes only from pass to pass, 0.03 degrees, and the same size in
    /// each point.
    Constant,
}

impl Errs {
    const ALL: [Self; 5] = [Self::White, Self::Correlated, Self::Late, Self::All, Self::Constant];

    /// Returns white, correlated and constant noise, degrees, and time error, seconds.
    fn sizes(self) -> [f64; 4] {
        match self {
            Self::White => [0.05, 0.0, 0.0, 0.0],
            Self::Correlated => [0.0, 0.05, 0.0, 0.0],
            Self::Late => [0.02, 0.0, 0.0, 0.04],
            Self::All => [0.03, 0.03, 0.0, 0.04],
            Self::Constant => [0.03, 0.0, 0.03, 0.0],
        }
    }
}

/// Returns the points of a pass that a drive with such errors yields.
fn any_points(mount: &Errors, errs: Errs, draws: &mut Draws) -> Vec<Point> {
    let (orbit, times_s) = any_pass(draws);
    let [white, correlated, constant, late] = errs.sizes();
    let keeps = (-STEP_S / MEMORY_S).exp();
    let late_s = late * draws.normal();
    let constant = [0; 2].map(|_| constant * draws.normal());
    let mut slow = [0; 2].map(|_| draws.normal());
    let mut points = Vec::new();
    let mut time = Timestamp::UNIX_EPOCH;
    for at_s in times_s {
        let sky = orbit.look(at_s);
        let read = mount.reading(orbit.look(at_s + late_s));
        let noise = [0, 1]
            .map(|axis| (white * draws.normal() + correlated * slow[axis] + constant[axis]) * DEG);
        let degrees = |[azimuth, elevation]: [f64; 2]| {
            AzEl::from_degrees((azimuth / DEG).rem_euclid(360.0), elevation / DEG)
        };
        points.push(Point {
            kind: Kind::Satellite,
            time,
            direction: degrees(sky),
            measured: degrees([read[0] + noise[0] / sky[1].cos(), read[1] + noise[1]]),
            weight: 1.0,
        });
        slow = slow.map(|old| keeps * old + (1.0 - keeps * keeps).sqrt() * draws.normal());
        time += SignedDuration::from_secs(10);
    }
    points
}

#[test]
fn intervals_hold_the_terms_whatever_the_noise_of_the_passes() {
    let number = |name: &str, default: u64| {
        std::env::var(name).map_or(default, |text| text.parse().unwrap())
    };
    let (seed, cases) = (number("AZEL_SEED", 1), number("AZEL_CASES", DEFAULT_CASES));
    // A small number of fits varies by some percent.
    let enough = if cases >= 1_000 { 0.93 } else { 0.85 };
    let mut short = Vec::new();
    for (passes, errs) in [1, 2, 5, 20].into_iter().flat_map(|n| Errs::ALL.map(|errs| (n, errs))) {
        let draws = &mut Draws::new(seed);
        let (mut inside_count, mut sufficient, mut halves) = (0_u32, 0_u32, 0.0);
        for _ in 0..cases {
            let mount = Errors::any(draws);
            let runs: Vec<_> = (0..passes).map(|_| any_points(&mount, errs, draws)).collect();
            let fit = fit(runs.iter().map(Vec::as_slice), &Term::ALL).unwrap();
            for (term, truth) in Term::ALL.into_iter().zip(mount.0) {
                let Some(interval) = fit.interval(term) else { continue };
                inside_count += 1;
                sufficient += u32::from((interval.value - truth).abs() <= interval.half);
                halves += if term == Term::AzimuthOffset { interval.half } else { 0.0 };
            }
        }
        let share = f64::from(sufficient) / f64::from(inside_count.max(1));
        let half_deg = halves / cases as f64;
        println!(
            "seed {seed}, {cases} fits to {passes} passes, {errs:?}: {share:.3} of {inside_count} intervals \
             hold, azimuth offset ±{half_deg:.3}°"
        );
        assert!(inside_count > 0);
        if share < enough {
            short.push((passes, errs, share));
        }
    }
    assert!(short.is_empty(), "{short:?}");
}

#[test]
fn the_mount_of_this_test_errs_as_the_terms_say() {
    let draws = &mut Draws::new(3);
    for _ in 0..200 {
        let mount = Errors::any(draws);
        let mut model = PointingModel::default();
        for (term, value) in Term::ALL.into_iter().zip(mount.0) {
            *model.place(term) = value;
        }
        let sky = [draws.uniform(0.0, TAU), draws.uniform(5.0, 85.0) * DEG];
        let [azimuth, elevation] = mount.reading(sky).map(|angle| angle / DEG);
        let reading = model.reading(AzEl::from_degrees(sky[0] / DEG, sky[1] / DEG)).unwrap();
        let off_deg = reading.separation(AzEl::from_degrees(azimuth, elevation)).degrees();
        assert!(off_deg < 1e-6, "{:?}: {off_deg}", mount.0);
    }
}
