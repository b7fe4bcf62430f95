//! Tests with random antennas, with and without a fault.

use std::collections::BTreeMap;

use super::{
    super::{Axis, Cause, Evidence, Explanation},
    AZ_EL, Flight, UNIT, XY,
    antennas::{axes_deg, measured, normal, shaken, signed},
    deg, flights, is_same_kind,
};
use crate::{
    astro::{AzEl, time::add_seconds},
    orbit::Propagator,
    plan::schedule::testing::Random,
    station::Mount,
};
use jiff::Timestamp;

/// Default seed; `AZEL_SEED` and `AZEL_CASES` set other values.
const SEED: u64 = 45;
const CASES: u64 = 100;

fn number(name: &str, default: u64) -> u64 {
    std::env::var(name).map_or(default, |value| value.parse().unwrap())
}

fn draw_fraction(random: &mut Random) -> f64 {
    f64::from(random.below(10_000)) / 10_000.0
}

/// Noise of a sensor, and of an antenna in the wind.
struct TrackNoise {
    white_deg: f64,
    wind_deg: f64,
    /// Correlation time of the wind, seconds.
    lasts_s: f64,
}

impl TrackNoise {
    fn drawn(random: &mut Random) -> Self {
        let white_deg = 0.002 + 0.05 * draw_fraction(random).powi(2);
        let wind_deg = if random.below(2) == 0 { 0.0 } else { 0.05 * draw_fraction(random) };
        Self { white_deg, wind_deg, lasts_s: 1.0 + 29.0 * draw_fraction(random) }
    }

    /// Returns the root mean square of both angles together, degrees.
    fn rms_deg(&self) -> f64 {
        (2.0 * (self.white_deg.powi(2) + self.wind_deg.powi(2))).sqrt()
    }

    fn on(&self, exact: &[(Timestamp, AzEl)], random: &mut Random) -> Vec<(Timestamp, AzEl)> {
        let keeps = (-super::STEP_S / self.lasts_s).exp();
        let gust = self.wind_deg * (1.0 - keeps * keeps).sqrt();
        let mut wind = [0, 1].map(|_| self.wind_deg * normal(random));
        let shifted = exact.iter().map(|(time, direction)| {
            wind = wind.map(|wind| keeps * wind + gust * normal(random));
            let [right, up] = wind.map(|wind| wind + self.white_deg * normal(random));
            (*time, shaken(*direction, right, up))
        });
        shifted.collect()
    }
}

const KINDS: [&str; 11] = [
    "site",
    "late",
    "azimuth",
    "elevation",
    "tilt",
    "azimuth scale",
    "elevation scale",
    "stuck axis",
    "slow axis",
    "slow drives",
    "elements",
];

/// Returns a cause of this kind with a size of about one degree.
fn cause(kind: &str, flight: &Flight, mount: Mount, random: &mut Random) -> Cause {
    let axes = match mount {
        Mount::AzEl { .. } => [Axis::Azimuth, Axis::Elevation],
        Mount::Xy { .. } => [Axis::X, Axis::Y],
    };
    let axis = Some(axes[random.below(2) as usize]);
    let size = signed(random);
    match kind {
        "site" => Cause::OtherSite { north_km: 8.0 * size, east_km: 8.0 * signed(random) },
        "late" => Cause::Late { late_s: 2.0 * size },
        "azimuth" => Cause::AzimuthOffset { offset_deg: size },
        "elevation" => Cause::ElevationOffset { offset_deg: size },
        "tilt" => Cause::Tilt { north_deg: size, east_deg: signed(random) },
        "azimuth scale" => Cause::AzimuthScale { per_mille: 8.0 * size },
        "elevation scale" => Cause::ElevationScale { per_mille: 20.0 * size },
        "stuck axis" => {
            let after_s = flight.pass.duration_s() * 0.9 * draw_fraction(random);
            Cause::Stuck { start: add_seconds(flight.pass.aos.time, after_s), axis }
        }
        "slow axis" | "slow drives" => {
            let axis = axis.filter(|_| kind == "slow axis");
            let needed = needed_deg_s(flight, mount, axis.map(|axis| usize::from(axis == axes[1])));
            Cause::SlowDrives { rate_deg_s: needed * (0.3 + 0.6 * draw_fraction(random)), axis }
        }
        "elements" => Cause::OtherElements { epoch: flight.elements.epoch() },
        kind => panic!("{kind}"),
    }
}

/// Returns the rate that one axis needs, or the faster of both, degrees per second.
fn needed_deg_s(flight: &Flight, mount: Mount, axis: Option<usize>) -> f64 {
    let mut azimuth_deg = flight.direction_at(flight.pass.aos.time).azimuth.degrees();
    let mut before: Option<(AzEl, [f64; 2])> = None;
    let rates = flight.times().map(|time| {
        let direction = flight.direction_at(time);
        if let Some((last, _)) = before {
            azimuth_deg += (direction.azimuth - last.azimuth).wrapped_180().degrees();
        }
        let end = axes_deg(mount, direction, azimuth_deg);
        let start = before.replace((direction, end)).map_or(end, |(_, first)| first);
        let rate = |place: usize| (end[place] - start[place]).abs() / super::STEP_S;
        axis.map_or_else(|| rate(0).max(rate(1)), rate)
    });
    rates.fold(0.0, f64::max)
}

fn explained(
    flight: &Flight,
    mount: Mount,
    half_beam_deg: f64,
    measured: &[(Timestamp, AzEl)],
    others: &[(Timestamp, Propagator)],
) -> Vec<Explanation> {
    let evidence = Evidence::new(mount, true, deg(half_beam_deg)).with_pass(
        &flight.propagator,
        flight.site,
        UNIT,
        measured.iter().copied(),
    );
    evidence.explanations(others)
}

/// `AZEL_SEED=1 AZEL_CASES=1000 cargo test --release -p azel-units --lib explain::tests::draws --
/// --nocapture` runs the long form of both tests.
#[test]
fn no_cause_is_named_without_one() {
    let (seed, cases) = (number("AZEL_SEED", SEED), number("AZEL_CASES", CASES));
    let flights = flights();
    let mut named = 0;
    for case in seed..seed + cases {
        let mut random = Random::new(case);
        let flight = &flights[random.below(flights.len() as u32) as usize];
        let mount = if random.below(2) == 0 { AZ_EL } else { XY };
        let noise = TrackNoise::drawn(&mut random);
        let exact: Vec<_> = flight.times().map(|time| (time, flight.direction_at(time))).collect();
        let measured = noise.on(&exact, &mut random);
        let other = flight.shifted(0.3 * signed(&mut random));
        let others = [(flight.elements.epoch(), Propagator::new(&other).unwrap())];
        // The narrowest beams lose the satellite in this noise.
        let half_beam_deg = noise.rms_deg() * (0.5 + 4.0 * draw_fraction(&mut random));
        let found = explained(flight, mount, half_beam_deg, &measured, &others);
        if !found.is_empty() {
            named += 1;
            println!("case {case}: {found:?}");
        }
    }
    println!("seeds {seed} to {}: {named} of {cases} named", seed + cases - 1);
    assert_eq!(named, 0);
}

#[test]
fn a_single_cause_is_named_or_among_three() {
    let (seed, cases) = (number("AZEL_SEED", SEED), number("AZEL_CASES", CASES));
    let flights = flights();
    // The columns count by kind: cases, named, named alone.
    let mut table = BTreeMap::<&str, [u32; 3]>::new();
    for case in seed..seed + cases {
        let mut random = Random::new(case);
        let noise = TrackNoise::drawn(&mut random);
        let kind = KINDS[(case % KINDS.len() as u64) as usize];
        let mut tries = 0;
        let (flight, mount, cause, other, exact, effect_deg) = loop {
            tries += 1;
            assert!(tries < 1000, "{kind}");
            let flight = &flights[random.below(flights.len() as u32) as usize];
            let mount = if random.below(2) == 0 { AZ_EL } else { XY };
            let cause = cause(kind, flight, mount, &mut random);
            let other = flight.shifted(0.3 * signed(&mut random));
            let other = Propagator::new(&other).unwrap();
            let exact = measured(flight, mount, &cause, &other);
            let squares = exact.iter().map(|(time, direction)| {
                direction.separation(flight.direction_at(*time)).degrees()
            });
            let square: f64 = squares.map(|off_deg| off_deg * off_deg).sum();
            let effect_deg = (square / exact.len() as f64).sqrt();
            if effect_deg > 3.0 * noise.rms_deg() && effect_deg < 30.0 {
                break (flight, mount, cause, other, exact, effect_deg);
            }
        };
        let noisy_track = noise.on(&exact, &mut random);
        let others = [(flight.elements.epoch(), other)];
        // The error spoils the pass, but the noise does not.
        let half_beam_deg =
            (effect_deg * (0.4 + 0.6 * draw_fraction(&mut random))).max(2.0 * noise.rms_deg());
        let found = explained(flight, mount, half_beam_deg, &noisy_track, &others);
        let is_right = found.iter().any(|found| {
            found.partner.is_none()
                && is_same_kind(&found.cause, &cause)
                && is_of_axis(found, &cause)
        });
        assert!(found.len() <= 3);
        let row = table.entry(kind).or_default();
        row[0] += 1;
        row[1] += u32::from(is_right);
        row[2] += u32::from(is_right && found.len() == 1);
        if !is_right {
            println!(
                "case {case}, {} {cause:?}, {effect_deg:.3} deg, noise {:.3}, beam {half_beam_deg:.3}, {} white {:.3} wind {:.3} lasts {:.0}: {found:?}",
                matches!(mount, Mount::Xy { .. }),
                noise.rms_deg(),
                flight.pass.aos.time,
                noise.white_deg,
                noise.wind_deg,
                noise.lasts_s,
            );
        }
    }
    println!("seeds {seed} to {}: cause, cases, named, named alone", seed + cases - 1);
    for (kind, row) in &table {
        println!("{kind:16} {row:?}");
    }
    let total = |place: usize| table.values().map(|row| f64::from(row[place])).sum::<f64>();
    assert!(total(1) >= 0.95 * total(0), "{} of {}", total(1), total(0));
}

/// Returns `true` if the explanation names the faulty axis, or both.
fn is_of_axis(found: &Explanation, cause: &Cause) -> bool {
    let axis = |cause: &Cause| match *cause {
        Cause::SlowDrives { axis, .. } | Cause::Stuck { axis, .. } => axis,
        _ => None,
    };
    axis(cause).is_none() || axis(&found.cause).is_none() || axis(&found.cause) == axis(cause)
}
