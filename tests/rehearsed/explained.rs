//! Errors of known causes in simulated units, and what the reports of their passes make of them.
//! `AZEL_EXPLAIN_CASES=200 cargo test --release --test azel rehearsed::explained -- --nocapture` is the
//! long form.

use std::{collections::BTreeMap, time::Duration};

use azel::{
    astro::{Angle, PointingModel, xy_mount},
    engine::Command,
    orbit::{Catalog, Elements, Pass, PassSearch, Propagator, bundled, passes},
    plan::pass_report::{Cause, Explanation},
    record::RowKind,
    sim::{InMemory as _, Misreading, Trouble},
    station::Station,
};
use jiff::{Timestamp, ToSpan as _};

use super::{recorded::reports, scene::Scene};
use crate::common::{
    dice::Dice,
    units::{self, antenna, measured, start, until},
};

const SEED: u64 = 20_260_812;
/// `AZEL_EXPLAIN_CASES` sets another number.
const CASES: u32 = 2;
/// Standard deviation of both angles, degrees.
const NOISE_DEG: f64 = 0.02;
/// Of a simulated Satrak.
const FULL_RATE_DEG_S: f64 = 5.0;

/// What is wrong with a simulated Satrak.
enum Wrong {
    Unit(Trouble),
    /// It tracks with these, which the station had before.
    Elements(Elements),
}

/// A pass, and the elements that predict it.
struct Flight {
    elements: Elements,
    pass: Pass,
}

/// A cause that a simulated Satrak can have, and what brings it about.
fn drawn(case: u32, flight: &Flight, dice: &mut Dice) -> (Cause, Wrong) {
    let signed = |dice: &mut Dice, most: f64| {
        let size = most * dice.between(0.15, 1.0);
        if dice.chance(0.5) { size } else { -size }
    };
    let misreads =
        |model| Wrong::Unit(Trouble::Misreads(Misreading { model, noise_deg: NOISE_DEG }));
    let none = PointingModel::default();
    match case % 7 {
        1 => {
            let late = Duration::from_millis(50 + dice.below(1950) as u64);
            (Cause::Late { late_s: late.as_secs_f64() }, Wrong::Unit(Trouble::ClockLate(late)))
        }
        2 => {
            let azimuth_offset_deg = signed(dice, 1.0);
            let cause = Cause::AzimuthOffset { offset_deg: azimuth_offset_deg };
            (cause, misreads(PointingModel { azimuth_offset_deg, ..none }))
        }
        3 => {
            let elevation_offset_deg = signed(dice, 1.0);
            let cause = Cause::ElevationOffset { offset_deg: elevation_offset_deg };
            (cause, misreads(PointingModel { elevation_offset_deg, ..none }))
        }
        0 => {
            let (tilt_north_deg, tilt_east_deg) = (signed(dice, 1.0), signed(dice, 1.0));
            let cause = Cause::Tilt { north_deg: tilt_north_deg, east_deg: tilt_east_deg };
            (cause, misreads(PointingModel { tilt_north_deg, tilt_east_deg, ..none }))
        }
        4 => {
            // Fast enough for all but the quickest part of the pass.
            let rate_deg_s = 0.85 * flight.fastest_axis_deg_s();
            let share = rate_deg_s / FULL_RATE_DEG_S;
            (Cause::SlowDrives { rate_deg_s, axis: None }, Wrong::Unit(Trouble::SlowDrives(share)))
        }
        5 => {
            let old = flight.older(signed(dice, 0.3));
            (Cause::OtherElements { epoch: old.epoch() }, Wrong::Elements(old))
        }
        _ => {
            let elevation_scale = signed(dice, 0.02);
            let cause = Cause::ElevationScale { per_mille: 1000.0 * elevation_scale };
            (cause, misreads(PointingModel { elevation_scale, ..none }))
        }
    }
}

impl Flight {
    /// Rate of the faster one of the axes of the Satrak's mount where it is greatest.
    fn fastest_axis_deg_s(&self) -> f64 {
        let propagator = Propagator::new(&self.elements).unwrap();
        let axes = |time: Timestamp| {
            let look = propagator.look_from(Station::default().site, time).unwrap();
            let axes = xy_mount::axes_from_azel(look.direction, Angle::ZERO);
            [axes.lower.degrees(), axes.upper.degrees()]
        };
        let seconds = 0..self.pass.duration_s() as i64;
        let rate = seconds.map(|second| {
            let time = self.pass.aos.time + second.seconds();
            let (from, to) = (axes(time), axes(time + 1.second()));
            from.iter().zip(to).map(|(from, to)| (to - from).abs()).fold(0.0, f64::max)
        });
        rate.fold(0.0, f64::max)
    }

    /// Elements of a second before, by which the satellite is this much further on, and its plane
    /// half as much.
    fn older(&self, by_deg: f64) -> Elements {
        let mut written = serde_json::to_value(&self.elements).unwrap();
        let epoch: Timestamp = serde_json::from_value(written["epoch"].clone()).unwrap();
        written["epoch"] = serde_json::to_value(epoch - 1.second()).unwrap();
        let moved_deg = written["mean_motion_rev_day"].as_f64().unwrap() * 360.0 / 86_400.0;
        for (name, change) in [("mean_anomaly_deg", by_deg - moved_deg), ("node_deg", by_deg / 2.0)]
        {
            let changed = (written[name].as_f64().unwrap() + change).rem_euclid(360.0);
            written[name] = changed.into();
        }
        serde_json::from_value(written).unwrap()
    }
}

/// A pass of one of the favourites that comes up well.
fn flight(station: &Station, catalog: &Catalog, dice: &mut Dice) -> Option<Flight> {
    let favourites = station.favourites.numbers();
    let elements = catalog.get(*favourites.get(dice.below(favourites.len()))?)?;
    let propagator = Propagator::new(elements).ok()?;
    let search = PassSearch {
        aos_elevation: station.aos_elevation(),
        floor: Angle::from_degrees(20.0),
        ..PassSearch::new(station.site, start(), start() + 24.hours())
    };
    let found = passes(&propagator, &search, &|| false);
    let short: Vec<&Pass> = found.iter().filter(|pass| pass.duration_s() < 700.0).collect();
    let place = dice.below(short.len().max(1));
    short.get(place).map(|pass| Flight { elements: elements.clone(), pass: **pass })
}

/// What the report of a pass that the Satrak tracks makes of what is wrong.
async fn explained(wrong: Wrong, flight: &Flight) -> Vec<Explanation> {
    let number = flight.elements.catalog_number();
    let mut station = Station { favourites: [number].into(), ..units::station() };
    station.antennas.retain(|antenna| antenna.name == "Dish");
    // A unit that misreads a rising satellite stands no lower than that.
    station.antennas[0].limits.minimum_elevation_deg = 0.0;
    // Slow drives take some minutes to the place where the satellite rises.
    let is_slow = matches!(wrong, Wrong::Unit(Trouble::SlowDrives(_)));
    let start = flight.pass.aos.time - if is_slow { 8.minutes() } else { 2.minutes() };
    let (scene, trouble) = match wrong {
        Wrong::Unit(trouble) => (Scene::recorded(start, &station), Some(trouble)),
        Wrong::Elements(old) => (Scene::with_old_elements(start, &station, &old), None),
    };
    let client = scene.client();
    let dish = measured(&client, "Dish").await;
    let noise = Misreading { model: PointingModel::default(), noise_deg: NOISE_DEG };
    for trouble in std::iter::once(Trouble::Misreads(noise)).chain(trouble) {
        assert!(scene.units.dish.set_trouble(trouble, true));
    }
    let key = until("the pass", || {
        let lists = client.snapshot().pass_lists.clone();
        let listed = lists.favourites.passes.iter().find(|it| it.number() == number)?.key();
        Some(listed)
    })
    .await;
    client.send(Command::Track { antenna: dish, pass: key, is_agreed: true }).unwrap();
    until("the track", || antenna(&client, "Dish")?.1.tracks).await;
    let [row] = &reports(&scene).await[..] else { panic!("one report of {:?}", RowKind::Pass) };
    serde_json::from_value(row.data["report"]["causes"].clone()).unwrap()
}

fn sizes(cause: &Cause) -> Vec<(f64, f64)> {
    match *cause {
        Cause::Late { late_s } => vec![(late_s, 0.03)],
        Cause::AzimuthOffset { offset_deg } | Cause::ElevationOffset { offset_deg } => {
            vec![(offset_deg, 0.02)]
        }
        Cause::Tilt { north_deg, east_deg } => vec![(north_deg, 0.03), (east_deg, 0.03)],
        Cause::ElevationScale { per_mille } => vec![(per_mille, 0.5)],
        Cause::SlowDrives { rate_deg_s, .. } => vec![(rate_deg_s, 0.02)],
        Cause::AzimuthScale { .. }
        | Cause::OtherElements { .. }
        | Cause::OtherSite { .. }
        | Cause::Stuck { .. } => Vec::new(),
    }
}

#[tokio::test(start_paused = true)]
async fn the_cause_that_a_simulated_unit_was_given_is_named_in_the_report_of_its_pass() {
    let cases = std::env::var("AZEL_EXPLAIN_CASES").map_or(CASES, |cases| cases.parse().unwrap());
    let mut dice = Dice::new(SEED);
    let catalog = bundled().unwrap();
    // By cause: cases, named, of the right size, lines with more than one cause.
    let mut table = BTreeMap::<String, [u32; 4]>::new();
    for case in 0..cases {
        let flight = loop {
            if let Some(flight) = flight(&Station::default(), &catalog, &mut dice) {
                break flight;
            }
        };
        let (cause, wrong) = drawn(case, &flight, &mut dice);
        let found = explained(wrong, &flight).await;
        let line: Vec<&Explanation> = found.iter().collect();
        let kind = std::mem::discriminant(&cause);
        let named = line.iter().find(|it| std::mem::discriminant(&it.cause) == kind);
        let is_right = named.is_some_and(|named| {
            let pairs = sizes(&named.cause).into_iter().zip(sizes(&cause));
            pairs.into_iter().all(|((got, noise), (true_size, _))| {
                (got - true_size).abs() <= (0.1 * true_size.abs()).max(noise)
            })
        });
        let written = serde_json::to_value(cause).unwrap();
        let row = table.entry(written["cause"].as_str().unwrap().to_owned()).or_default();
        row[0] += 1;
        row[1] += u32::from(named.is_some());
        row[2] += u32::from(is_right);
        row[3] += u32::from(line.len() > 1);
        if !is_right {
            println!(
                "case {case}, {cause:?} in a pass of {} at {}: {found:?}",
                flight.elements.catalog_number(),
                flight.pass.aos.time
            );
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
