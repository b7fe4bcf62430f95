//! Comparison of schedules with a MILP of the same data, solved by `HiGHS`; its results are in
//! `tests/data/schedule_milp.csv`. The cases are fifty random days, then ten times some hours with
//! partial passes and hand-overs. Two hundred days of other antennas and rules follow, with a limit
//! of passes a day for a quarter of the satellites. `cargo test` checks every tenth day. These
//! commands check all days, and solve them again:
//!
//! ```text
//! AZEL_SCHEDULE_EVERY=1 cargo test --release --lib days_are_as_good -- --nocapture
//! AZEL_SCHEDULE_DAYS=/tmp/days.json cargo test --release --lib days_are_as_good
//! python3 -m venv /tmp/highs && /tmp/highs/bin/pip install highspy
//! /tmp/highs/bin/python tests/schedule/milp.py /tmp/days.json tests/data/schedule_milp.csv
//! python3 tests/schedule/greedy.py /tmp/days.json tests/data/schedule_milp.csv
//! ```

use super::*;
use crate::plan::schedule::{
    board::Board,
    solve::{PassPart, Slews as _},
};

const DAYS: u64 = 50;
const DAYS_IN_PARTS: u64 = 10;
const DAYS_WITH_LIMITS: u64 = 200;
const RESULTS: &str = include_str!("../../../../../tests/data/schedule_milp.csv");

/// Calls `check` for a day with three or four antennas of any kind, by any rule, with limits.
fn day_with_limits(day: u64, check: impl FnOnce(&Request<'_>)) {
    let mut random = Random::new(SEED + 100 + day);
    let mut station = any_three_antennas(&mut random);
    if random.below(2) == 0 {
        let mut more = any_three_antennas(&mut random).antennas.swap_remove(1);
        more.id = crate::station::AntennaId(4);
        station.antennas.push(more);
    }
    let start = add_seconds(noon(), day as f64 * 86_400.0);
    let mut satellites = low_satellites(&mut random, 30);
    for satellite in &mut satellites {
        let max = 1 + random.below(3);
        satellite.limits.max_per_day = (random.below(4) == 0).then_some(max);
    }
    let rules =
        [ChooseBy::Elevation, ChooseBy::Duration, ChooseBy::MostPasses, ChooseBy::MostMinutes];
    let choose_by = rules[random.below(4) as usize];
    let antennas = planned(&station, start);
    let list = candidates(&station, &antennas, &satellites, start, 24.0);
    check(&Request { choose_by, ..request(&antennas, &list) });
}

/// Calls `check` for a day, or for some hours with partial passes. The number of satellites forces
/// each antenna to choose. Every fifth case limits the passes of some satellites.
fn day(day: u64, check: impl FnOnce(&Request<'_>)) {
    if day >= DAYS + DAYS_IN_PARTS {
        return day_with_limits(day, check);
    }
    let station = three_antennas();
    let mut random = Random::new(SEED + 100 + day);
    let start = add_seconds(noon(), day as f64 * 86_400.0);
    let in_parts = day >= DAYS;
    let (count, hours) = if in_parts { (14, 4.0) } else { (45, 24.0) };
    let mut satellites = low_satellites(&mut random, count);
    for satellite in satellites.iter_mut().step_by(9).filter(|_| day.is_multiple_of(5)) {
        satellite.limits.max_per_day = Some(if in_parts { 1 } else { 3 });
    }
    let antennas = planned(&station, start);
    let list = candidates(&station, &antennas, &satellites, start, hours);
    let partial = Partial { min_share: 0.4, min_s: 90.0, step_s: 120.0, hand_over: true };
    check(&Request { partial: in_parts.then_some(partial), ..request(&antennas, &list) });
}

fn written(day: u64, request: &Request<'_>) -> serde_json::Value {
    let board = Board::new(request);
    let all = 0..board.takes.len();
    let fits = |a: usize, b: usize| {
        board.takes[a].to_ms <= board.takes[b].from_ms && board.legs.slew_ms(a, b).is_some()
    };
    // The second part of a pass continues on another antenna after the end of the first.
    let go_on = |a: usize, b: usize| {
        let (first, second) = (&board.takes[a], &board.takes[b]);
        first.antenna != second.antenna && first.to_ms <= second.from_ms
    };
    let excludes = |a: usize, b: usize| {
        let (one, other) = (&board.takes[a], &board.takes[b]);
        match (one.part, other.part) {
            (PassPart::First, PassPart::Second) if one.pass == other.pass => !go_on(a, b),
            (PassPart::Second, PassPart::First) if one.pass == other.pass => !go_on(b, a),
            _ => one.antenna == other.antenna && !fits(a, b) && !fits(b, a),
        }
    };
    let pairs = all.clone().flat_map(|a| (a + 1..board.takes.len()).map(move |b| (a, b)));
    let conflicts: Vec<(usize, usize)> = pairs.filter(|(a, b)| excludes(*a, *b)).collect();
    let takes: Vec<_> = all
        .map(|index| {
            let (take, fact) = (&board.takes[index], &board.facts[index]);
            serde_json::json!({
                "pass": take.pass,
                "part": match take.part {
                    PassPart::Alone => "alone",
                    PassPart::First => "first",
                    PassPart::Second => "second",
                },
                "limit": take.limit,
                "class": fact.class.index(),
                "worth": fact.worth,
                "height": take.height_mdeg,
                "possible": board.legs.first_ms(index).is_some(),
            })
        })
        .collect();
    serde_json::json!({
        "day": day, "takes": takes, "limits": board.limits, "conflicts": conflicts,
    })
}

#[test]
fn days_are_as_good_as_a_general_solver_makes_them() {
    if let Some(path) = std::env::var_os("AZEL_SCHEDULE_DAYS") {
        let mut days = Vec::new();
        for number in 0..DAYS + DAYS_IN_PARTS + DAYS_WITH_LIMITS {
            day(number, |request| days.push(written(number, request)));
        }
        std::fs::write(path, serde_json::to_vec(&days).unwrap()).unwrap();
        return;
    }
    let every = std::env::var("AZEL_SCHEDULE_EVERY").ok();
    let every: usize = every.and_then(|text| text.parse().ok()).unwrap_or(10);
    let rows: Vec<Vec<i64>> = RESULTS
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    assert_eq!(rows.len() as u64, DAYS + DAYS_IN_PARTS + DAYS_WITH_LIMITS);
    let (mut optimal, mut days, mut count) = (0, 0, 0);
    for numbers in rows.iter().step_by(every) {
        let (number, best) = (numbers[0], &numbers[1..]);
        days += 1;
        day(number as u64, |request| {
            let schedule = plan(request);
            let reached = worth(&schedule);
            // If the rule ignores priorities, a single class follows *Always*.
            let best = &best[..reached.len()];
            assert!(reached[..] <= *best, "day {number}: {reached:?} {best:?}");
            let first = reached.iter().zip(best).find(|(reached, best)| reached != best);
            if let Some((reached, best)) = first {
                println!("day {number}: {reached} of {best}");
                assert!(reached * 100 >= best * 99, "day {number}: {reached} of {best}");
            }
            let mut is_as_good = true;
            for (class, best) in schedule.worth.iter().zip(best) {
                match class.proof {
                    Proof::Best => assert_eq!(class.worth, *best, "day {number} {class:?}"),
                    Proof::AtMost(bound) => {
                        assert!(!is_as_good || *best <= bound, "day {number} {class:?}");
                    }
                }
                is_as_good &= *best >= class.worth;
            }
            count += schedule.entries.len();
            optimal += u64::from(reached[..] == *best);
        });
    }
    println!("{days} days with {count} entries: the best in {optimal}");
    assert!(optimal * 10 >= days * 9, "{optimal} of {days}");
}
