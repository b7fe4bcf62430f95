//! Tests of random cases against brute force. A million cases:
//!
//! ```text
//! AZEL_SCHEDULE_CASES=1000000 cargo test --release --lib schedule::solve -- --nocapture
//! ```

use super::*;
use crate::plan::schedule::{row::Class, testing::Random};
use crate::station::Priority;

const SEED: u64 = 15;

/// Path from the end of one take to the start of another.
#[derive(Clone, Copy)]
struct Leg {
    needs_ms: i64,
    slew_ms: i64,
}

/// Slews by table: they follow no geometry, so a path through a third place may be shorter.
struct SlewTable {
    legs: Vec<Leg>,
    first_ms: Vec<Option<i64>>,
    /// Start and end of each take, milliseconds.
    spans_ms: Vec<(i64, i64)>,
}

impl SlewTable {
    fn leg(&self, start: usize, end: usize) -> Leg {
        self.legs[start * self.spans_ms.len() + end]
    }
}

impl Slews for SlewTable {
    fn first_ms(&self, end: usize) -> Option<i64> {
        self.first_ms[end]
    }

    fn slew_ms(&self, start: usize, end: usize) -> Option<i64> {
        let Leg { needs_ms, slew_ms } = self.leg(start, end);
        (self.spans_ms[start].1 + needs_ms <= self.spans_ms[end].0).then_some(slew_ms)
    }

    fn longest_ms(&self, _: usize) -> i64 {
        40
    }
}

struct Case {
    antennas: usize,
    passes: usize,
    takes: Vec<Take>,
    limits: Vec<u32>,
    slews: SlewTable,
}

impl Case {
    fn random(random: &mut Random, antennas: usize, passes: usize) -> Self {
        let limits: Vec<u32> = (0..random.below(3)).map(|_| 1 + random.below(2)).collect();
        let mut takes = Vec::new();
        for pass in 0..passes as u32 {
            let at_ms = random.below(250) as i64;
            let class = match random.below(6) {
                0 => Class::Always,
                number => Class::Priority(Priority::try_from(1 + (number as i64) % 3).unwrap()),
            };
            let limit = limits.len().checked_sub(1).map(|last| random.below(last as u32 + 1));
            let limit = limit.filter(|_| random.below(2) == 0);
            for antenna in 0..antennas as u32 {
                for _ in 0..random.below(3) {
                    let from_ms = at_ms + random.below(30) as i64;
                    let length_ms = 1 + random.below(90) as i64;
                    let row = Row::new(class, random.below(5) as i64).risen(at_ms);
                    let (to_ms, part) = (from_ms + length_ms, PassPart::Alone);
                    let (share, is_whole) = (1000, random.below(2) == 0);
                    takes.push(Take {
                        pass,
                        antenna,
                        limit,
                        part,
                        from_ms,
                        to_ms,
                        share,
                        is_whole,
                        height_mdeg: at_ms % 90_000,
                        row,
                    });
                }
                if antennas > 1 && random.below(4) == 0 {
                    let middle_ms = at_ms + 15 + random.below(5) as i64;
                    let row = Row::new(class, 1 + random.below(5) as i64);
                    for (part, from_ms, to_ms) in [
                        (PassPart::First, at_ms, middle_ms),
                        (PassPart::Second, middle_ms, middle_ms + 20),
                    ] {
                        let limit = limit.filter(|_| part == PassPart::First);
                        let (share, is_whole) = (500, false);
                        takes.push(Take {
                            pass,
                            antenna,
                            limit,
                            part,
                            from_ms,
                            to_ms,
                            share,
                            is_whole,
                            height_mdeg: at_ms % 90_000,
                            row,
                        });
                    }
                }
            }
        }
        takes.sort_by_key(|take| (take.antenna, take.from_ms));
        let count = takes.len();
        let leg = |random: &mut Random| {
            let slew_ms = random.below(31) as i64;
            Leg { needs_ms: slew_ms + random.below(10) as i64, slew_ms }
        };
        let legs = (0..count * count).map(|_| leg(random)).collect();
        let first = |random: &mut Random| (random.below(9) > 0).then(|| random.below(30) as i64);
        let first_ms = (0..count).map(|_| first(random)).collect();
        let spans_ms = takes.iter().map(|take| (take.from_ms, take.to_ms)).collect();
        let slews = SlewTable { legs, first_ms, spans_ms };
        Self { antennas, passes, takes, limits, slews }
    }

    fn problem(&self, effort: u64) -> Problem<'_> {
        Problem {
            antennas: self.antennas,
            passes: self.passes,
            takes: &self.takes,
            limits: &self.limits,
            slews: &self.slews,
            effort,
        }
    }

    /// Returns the worth of the takes; `None` if they exclude each other.
    fn worth(&self, chosen: &[Vec<u32>]) -> Option<Row> {
        let problem = self.problem(0);
        for takes in chosen {
            if let Some(first) = takes.first() {
                self.slews.first_ms[*first as usize]?;
            }
            for pair in takes.windows(2) {
                let [a, b] = [pair[0], pair[1]].map(|take| self.takes[take as usize]);
                let leg = self.slews.leg(pair[0] as usize, pair[1] as usize);
                if a.to_ms + leg.needs_ms > b.from_ms {
                    return None;
                }
            }
        }
        for pass in 0..self.passes as u32 {
            let of_pass = chosen.iter().flatten().map(|take| self.takes[*take as usize]);
            let mut of_pass: Vec<Take> = of_pass.filter(|take| take.pass == pass).collect();
            of_pass.sort_by_key(|take| take.from_ms);
            let is_right = match &of_pass[..] {
                [] => true,
                [only] => only.part == PassPart::Alone,
                [a, b] => {
                    (a.part, b.part) == (PassPart::First, PassPart::Second)
                        && a.antenna != b.antenna
                        && a.to_ms <= b.from_ms
                }
                _ => false,
            };
            if !is_right {
                return None;
            }
        }
        problem.keeps_limits(chosen).then(|| problem.row(chosen))
    }

    /// Returns the best of all choices.
    fn brute_force(&self) -> Row {
        let mut best = Row::ZERO;
        let mut chosen = vec![Vec::new(); self.antennas];
        self.extend(0, &mut chosen, &mut best);
        best
    }

    fn extend(&self, next: usize, chosen: &mut Vec<Vec<u32>>, best: &mut Row) {
        if let Some(row) = self.worth(chosen) {
            *best = row.max(*best);
        }
        for take in next..self.takes.len() {
            let antenna = self.takes[take].antenna as usize;
            let is_after = chosen[antenna].last().is_none_or(|last: &u32| {
                self.takes[*last as usize].to_ms <= self.takes[take].from_ms
            });
            if is_after {
                chosen[antenna].push(take as u32);
                self.extend(take + 1, chosen, best);
                chosen[antenna].pop();
            }
        }
    }
}

fn cases() -> u64 {
    std::env::var("AZEL_SCHEDULE_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(10_000)
}

#[test]
fn one_antenna_does_as_well_as_brute_force() {
    let mut random = Random::new(SEED);
    let mut take_count = 0;
    for case in 0..cases() {
        let passes = 1 + random.below(6) as usize;
        let case_ = Case::random(&mut random, 1, passes);
        let solution = case_.problem(1_000_000).solve();
        assert_eq!(case_.worth(&solution.takes), Some(solution.row), "case {case}");
        let best = case_.brute_force();
        if case_.limits.is_empty() {
            assert_eq!(solution.row, best, "case {case}");
        }
        assert_eq!(solution.row.classes(), best.classes(), "case {case}");
        assert_eq!(solution.bound.classes(), best.classes(), "case {case}");
        take_count += solution.takes[0].len();
    }
    println!("{} cases of seed {SEED}, {take_count} takes", cases());
    assert!(take_count as u64 > cases());
}

#[test]
fn several_antennas_do_as_well_as_brute_force() {
    let mut random = Random::new(SEED + 1);
    let mut handed_over = 0;
    for case in 0..cases() / 4 {
        let antennas = 2 + random.below(2) as usize;
        let passes = 1 + random.below(4) as usize;
        let case_ = Case::random(&mut random, antennas, passes);
        let solution = case_.problem(1_000_000).solve();
        assert_eq!(case_.worth(&solution.takes), Some(solution.row), "case {case}");
        let best = case_.brute_force();
        assert_eq!(solution.row.classes(), best.classes(), "case {case}");
        let parts = solution.takes.iter().flatten().map(|take| case_.takes[*take as usize].part);
        handed_over += parts.filter(|part| *part == PassPart::First).count();
    }
    println!("{} cases of seed {}, {handed_over} handed over", cases() / 4, SEED + 1);
    assert!(handed_over as u64 > cases() / 100);
}

#[test]
fn where_not_all_is_tried_bounds_hold_and_the_best_is_often_reached() {
    let mut random = Random::new(SEED + 2);
    let mut reached = 0;
    for case in 0..cases() / 4 {
        let antennas = 1 + random.below(3) as usize;
        let passes = 1 + random.below(4) as usize;
        let case_ = Case::random(&mut random, antennas, passes);
        // Some cases lack the effort for every neighbourhood.
        let problem = case_.problem(u64::from(random.below(400)));
        let lines: Vec<AntennaLine> =
            (0..antennas).map(|antenna| AntennaLine::new(&problem, antenna)).collect();
        let solution = problem.solve_in_part(&lines);
        assert_eq!(case_.worth(&solution.takes), Some(solution.row), "case {case}");
        for greedy in problem.greedy() {
            assert!(case_.worth(&greedy).unwrap() <= solution.row, "case {case}");
        }
        let best = case_.brute_force();
        assert!(solution.row.classes() <= best.classes(), "case {case}");
        for class in 0..Row::CLASSES {
            let is_as_good =
                (0..class).all(|index| best.number(index) >= solution.row.number(index));
            let bound = solution.bound.number(class);
            assert!(!is_as_good || best.number(class) <= bound, "case {case}, class {class}");
        }
        reached += u64::from(solution.row.classes() == best.classes());
    }
    println!("{} cases of seed {}, best reached in {reached}", cases() / 4, SEED + 2);
    assert!(reached * 10 > cases() / 4 * 7, "{reached}");
}
