//! Errors of known causes in simulated units, and what the reports of their passes make of them.
//! `AZEL_EXPLAIN_CASES=200 cargo test --test azel rehearsed::explained -- --nocapture` takes an hour.

use std::{collections::BTreeMap, time::Duration};

use azel::{
    astro::{Angle, PointingModel},
    engine::Command,
    orbit::{Catalog, Pass, PassSearch, Propagator, bundled, passes},
    plan::pass_report::{Cause, Explanation},
    record::RowKind,
    sim::{InMemory as _, Misreading, Trouble},
    station::Station,
};
use jiff::ToSpan as _;

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

/// A cause that a simulated Satrak can have, and what brings it about.
fn drawn(case: u32, dice: &mut Dice) -> (Cause, Trouble) {
    let signed = |dice: &mut Dice, most: f64| {
        let size = most * dice.between(0.15, 1.0);
        if dice.chance(0.5) { size } else { -size }
    };
    let misreads = |model| Trouble::Misreads(Misreading { model, noise_deg: NOISE_DEG });
    let none = PointingModel::default();
    match case % 5 {
        1 => {
            let late = Duration::from_millis(50 + dice.below(1950) as u64);
            (Cause::Late { late_s: late.as_secs_f64() }, Trouble::ClockLate(late))
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
        _ => {
            let elevation_scale = signed(dice, 0.02);
            let cause = Cause::ElevationScale { per_mille: 1000.0 * elevation_scale };
            (cause, misreads(PointingModel { elevation_scale, ..none }))
        }
    }
}

/// A pass of one of the favourites that comes up well.
fn pass(station: &Station, catalog: &Catalog, dice: &mut Dice) -> Option<(u32, Pass)> {
    let favourites = station.favourites.numbers();
    let number = *favourites.get(dice.below(favourites.len()))?;
    let propagator = Propagator::new(catalog.get(number)?).ok()?;
    let search = PassSearch {
        aos_elevation: station.aos_elevation(),
        floor: Angle::from_degrees(20.0),
        ..PassSearch::new(station.site, start(), start() + 24.hours())
    };
    let found = passes(&propagator, &search, &|| false);
    let short: Vec<&Pass> = found.iter().filter(|pass| pass.duration_s() < 700.0).collect();
    let place = dice.below(short.len().max(1));
    short.get(place).map(|pass| (number, **pass))
}

/// What the report of a pass that the Satrak tracks makes of this trouble.
async fn explained(trouble: Trouble, number: u32, pass: &Pass) -> Vec<Explanation> {
    let mut station = Station { favourites: [number].into(), ..units::station() };
    station.antennas.retain(|antenna| antenna.name == "Dish");
    let scene = Scene::recorded(pass.aos.time - 2.minutes(), &station);
    let client = scene.client();
    let dish = measured(&client, "Dish").await;
    let noise = Misreading { model: PointingModel::default(), noise_deg: NOISE_DEG };
    for trouble in [Trouble::Misreads(noise), trouble] {
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
    serde_json::from_value(row.data["report"]["explanations"].clone()).unwrap()
}

fn sizes(cause: &Cause) -> Vec<(f64, f64)> {
    match *cause {
        Cause::Late { late_s } => vec![(late_s, 0.03)],
        Cause::AzimuthOffset { offset_deg } | Cause::ElevationOffset { offset_deg } => {
            vec![(offset_deg, 0.02)]
        }
        Cause::Tilt { north_deg, east_deg } => vec![(north_deg, 0.03), (east_deg, 0.03)],
        Cause::ElevationScale { per_mille } => vec![(per_mille, 0.5)],
        _ => Vec::new(),
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
        let (cause, trouble) = drawn(case, &mut dice);
        let (number, pass) = loop {
            if let Some(pass) = pass(&Station::default(), &catalog, &mut dice) {
                break pass;
            }
        };
        let found = explained(trouble, number, &pass).await;
        let line: Vec<&Explanation> = found.iter().filter(|it| it.is_alike).collect();
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
                "case {case}, {cause:?} in a pass of {number} at {}: {found:?}",
                pass.aos.time
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
