//! Prices of passes and of limits: the price that a take of a pass has to pay makes the antennas
//! independent of each other. With any prices, the best sequences of all antennas together with
//! the prices themselves are worth at least as much as any schedule (weak duality, which holds for
//! rows as for numbers). Prices rise while a pass is taken more than once and fall while nobody
//! takes it, class after class, until the bound meets what was found.

use super::{Line, Part, Problem, Row, Solution, Take, vector};

/// The share of a whole pass.
const ONE: i64 = 1000;
/// Rounds of new prices in each class.
const ROUNDS: usize = 60;
/// Rounds without a better bound after which the steps are halved.
const PATIENCE: usize = 5;
/// Rounds between two attempts to make a schedule of what the antennas take.
const REPAIR_EVERY: usize = 6;

#[derive(Clone)]
struct Prices {
    of_pass: Vec<Row>,
    of_limit: Vec<Row>,
}

/// What all antennas take at some prices.
#[derive(Clone)]
struct Round {
    bound: Row,
    takes: Vec<Vec<u32>>,
    /// In thousandths: how much more than once each pass is taken.
    over_pass: Vec<i64>,
    over_limit: Vec<i64>,
}

pub(super) fn solve(problem: &Problem<'_>, lines: &[Line]) -> Solution {
    let mut prices = Prices {
        of_pass: vec![Row::ZERO; problem.passes],
        of_limit: vec![Row::ZERO; problem.limits.len()],
    };
    let mut now = prices.round(problem, lines);
    let mut best = (prices.clone(), now.clone());
    let (mut takes, mut row) = problem.repaired(lines, now.takes.clone());
    // Whole passes make a smaller search.
    if let Some(whole) = vector::best(problem, &|take| take.is_whole) {
        let found = problem.improved(lines, whole);
        if found.1 > row {
            (takes, row) = found;
        }
    }
    for class in 0..Row::CLASSES {
        if best.1.bound.number(class) == row.number(class) {
            continue;
        }
        (prices, now) = best.clone();
        let (mut share, mut patience) = (1.0_f64, PATIENCE);
        for round in 0..ROUNDS {
            let gap = now.bound.number(class) - row.number(class);
            if gap <= 0 || !prices.step(&now, class, gap as f64 * share) {
                break;
            }
            now = prices.round(problem, lines);
            if now.bound < best.1.bound {
                (best, patience) = ((prices.clone(), now.clone()), PATIENCE);
            } else {
                patience -= 1;
                if patience == 0 {
                    (share, patience) = (share / 2.0, PATIENCE);
                }
            }
            if round % REPAIR_EVERY == 0 {
                let found = problem.repaired(lines, now.takes.clone());
                if found.1 > row {
                    (takes, row) = found;
                }
            }
            if best.1.bound.number(class) == row.number(class) {
                break;
            }
        }
        // Below an open class, a bound says nothing.
        if best.1.bound.number(class) != row.number(class) {
            break;
        }
    }
    let bound = best.1.bound;
    let (takes, row) = problem.handed_over(lines, (takes, row));
    Solution { takes, row, bound: bound.max(row) }
}

impl Prices {
    fn of(&self, take: &Take) -> Row {
        let of_pass = self.of_pass.get(take.pass as usize).copied().unwrap_or_default();
        let of_pass = if take.share == ONE { of_pass } else { of_pass.thousandths(take.share) };
        let of_limit = take.limit.and_then(|limit| self.of_limit.get(limit as usize));
        of_pass + of_limit.copied().unwrap_or_default()
    }

    fn round(&self, problem: &Problem<'_>, lines: &[Line]) -> Round {
        let paid = |_, take: &Take| Some(take.row - self.of(take));
        let found: Vec<_> = lines.iter().map(|line| line.best(problem, &paid)).collect();
        let mut over_pass = vec![-ONE; problem.passes];
        let mut over_limit: Vec<i64> =
            problem.limits.iter().map(|most| -ONE * i64::from(*most)).collect();
        let all = found.iter().flat_map(|sequence| &sequence.takes);
        for take in all.filter_map(|take| problem.take(*take)) {
            if let Some(over) = over_pass.get_mut(take.pass as usize) {
                *over += take.share;
            }
            let limit = take.limit.and_then(|limit| over_limit.get_mut(limit as usize));
            if let Some(over) = limit {
                *over += ONE;
            }
        }
        let of_limits = self.of_limit.iter().zip(problem.limits);
        let of_limits = of_limits.map(|(price, most)| price.times(i64::from(*most)));
        let bound = found.iter().map(|sequence| sequence.row).sum::<Row>()
            + self.of_pass.iter().copied().sum()
            + of_limits.sum();
        let takes = found.into_iter().map(|sequence| sequence.takes).collect();
        Round { bound, takes, over_pass, over_limit }
    }

    /// Moves the prices in one class by a step whose size follows from `gap`. Returns `false` if
    /// nothing is left to move.
    fn step(&mut self, round: &Round, class: usize, gap: f64) -> bool {
        let over = round.over_pass.iter().chain(&round.over_limit);
        let moving = over.zip(self.of_pass.iter().chain(&self.of_limit));
        let moving = moving.filter(|(over, price)| **over > 0 || **price > Row::ZERO);
        let length: f64 = moving.map(|(over, _)| (*over as f64 / ONE as f64).powi(2)).sum();
        if length <= 0.0 {
            return false;
        }
        let step = (gap / length).ceil().max(1.0) as i64;
        let each = round.over_pass.iter().zip(&mut self.of_pass);
        for (over, price) in each.chain(round.over_limit.iter().zip(&mut self.of_limit)) {
            let moved = *price + Row::at(class, (step * over).div_euclid(ONE));
            *price = moved.max(Row::ZERO);
        }
        true
    }
}

impl Problem<'_> {
    /// A schedule of what the antennas would take, which may hold passes twice and more of a
    /// satellite than its limit allows.
    fn repaired(&self, lines: &[Line], mut takes: Vec<Vec<u32>>) -> (Vec<Vec<u32>>, Row) {
        let mut is_taken = vec![false; self.passes];
        let mut left = self.limits.to_vec();
        for takes in &mut takes {
            takes.retain(|take| {
                let Some(it) = self.take(*take) else { return false };
                let taken = is_taken.get_mut(it.pass as usize);
                let Some(taken) = taken.filter(|taken| !**taken) else { return false };
                let limit = it.limit.and_then(|limit| left.get_mut(limit as usize));
                if it.part != Part::Alone || limit.as_deref() == Some(&0) {
                    return false;
                }
                *taken = true;
                if let Some(left) = limit {
                    *left -= 1;
                }
                true
            });
            // A pass that is gone leaves two neighbours without the leg that led over it.
            let mut kept: Vec<u32> = Vec::new();
            for take in takes.iter() {
                let fits = kept.last().is_none_or(|last| self.fits(*last, *take))
                    && (!kept.is_empty() || self.slews.first_ms(*take as usize).is_some());
                if fits {
                    kept.push(*take);
                }
            }
            *takes = kept;
        }
        self.improved(lines, takes)
    }

    /// Returns `true` if the second take can follow the first.
    pub(super) fn fits(&self, before: u32, take: u32) -> bool {
        self.slew_ms(before, take).is_some()
    }
}
