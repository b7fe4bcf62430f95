//! Bounds by prices of passes and of limits. Each take of a pass pays a price, which makes the
//! antennas independent of each other. With any prices, the best sequences of all antennas plus the
//! prices are worth at least as much as any schedule (weak duality). The price of a pass rises
//! while several takes use it and falls while none does, until the bound meets the found schedule.
//!
//! The solver bounds one class at a time, over the schedules that are worth no less in the previous
//! classes. A round that is worth less there pays for the missing worth.

use super::{AntennaLine, Problem, Row, Take};

/// Share of a whole pass, and the min step of a price.
const ONE: i64 = 1000;
/// Max number of price updates.
const ROUNDS: usize = 60;
/// Number of rounds without a better bound after which the steps are halved.
const PATIENCE: usize = 5;
/// Index of the only cell of price rows.
const CELL: usize = 0;

#[derive(Clone)]
struct Prices {
    passes: Vec<i64>,
    limits: Vec<i64>,
    /// Price for each previous class, for missing as much as its most valuable take.
    classes: Vec<i64>,
}

/// Class to bound, and its context.
struct Bounded<'a> {
    problem: &'a Problem<'a>,
    lines: &'a [AntennaLine],
    class: usize,
    /// Found schedule.
    row: &'a Row,
    /// Worth of the most valuable take of each previous class.
    maxima: Vec<i64>,
}

/// Result for the takes of all antennas at some prices.
struct Round {
    /// Upper bound of the class, in thousandths.
    bound: i64,
    /// Excess, in thousandths: takes of each pass beyond one, takes of each limit beyond its max,
    /// and missing most valuable takes in each previous class.
    excess: Vec<i64>,
}

/// Returns an upper bound of `class` for any schedule that is worth no less than `row` in the
/// previous classes.
pub(super) fn bound(problem: &Problem<'_>, lines: &[AntennaLine], row: &Row, class: usize) -> i64 {
    let max_worth = |class| {
        let numbers = problem.takes.iter().map(|take| take.row.number(class));
        // Use at least 1, because prices are divided by this value.
        numbers.max().unwrap_or_default().max(1)
    };
    let bounded =
        Bounded { problem, lines, class, row, maxima: (0..class).map(max_worth).collect() };
    // Without prices, the bound is the worth of independent antennas.
    let mut prices = Prices {
        passes: vec![0; problem.passes],
        limits: vec![0; problem.limits.len()],
        classes: vec![0; class],
    };
    let reached = row.number(class);
    let mut now = bounded.round(&prices);
    let mut best = now.bound;
    let (mut share, mut patience) = (1.0_f64, PATIENCE);
    for _ in 0..ROUNDS {
        // Use Polyak's step: the gap over the square of the subgradient's length.
        let gap = now.bound - reached * ONE;
        if best.div_euclid(ONE) <= reached || !prices.step(&now, gap as f64 * share) {
            break;
        }
        now = bounded.round(&prices);
        if now.bound < best {
            (best, patience) = (now.bound, PATIENCE);
        } else {
            // Near the optimum, the steps overshoot, and the bound stagnates until they shrink.
            patience -= 1;
            if patience == 0 {
                (share, patience) = (share / 2.0, PATIENCE);
            }
        }
    }
    // A schedule with `reached` exists, so a smaller bound would be wrong.
    best.div_euclid(ONE).max(reached)
}

impl Bounded<'_> {
    /// Returns the worth of a take less its prices, in thousandths. Rounds up, so that the bound
    /// remains an upper bound.
    fn paid(&self, prices: &Prices, take: &Take) -> i64 {
        let of_pass = prices.passes.get(take.pass as usize).copied().unwrap_or_default();
        let of_limit = take.limit.and_then(|limit| prices.limits.get(limit as usize));
        let before = prices.classes.iter().zip(&self.maxima).enumerate();
        let before =
            before.map(|(class, (price, max))| -(-price * take.row.number(class)).div_euclid(*max));
        take.row.number(self.class) * ONE + before.sum::<i64>()
            - (of_pass * take.share).div_euclid(ONE)
            - of_limit.copied().unwrap_or_default()
    }

    fn round(&self, prices: &Prices) -> Round {
        let Self { problem, lines, class, row, maxima } = self;
        let paid = |_, take: &Take| Some(Row::single(CELL, self.paid(prices, take)));
        let found: Vec<_> = lines.iter().map(|line| line.best(problem, &paid)).collect();
        // Each pass may be taken once without an excess.
        let mut over_pass = vec![-ONE; problem.passes];
        let limits = problem.limits.iter().map(|max| -ONE * i64::from(*max));
        let mut over_limit: Vec<i64> = limits.collect();
        let mut missing: Vec<i64> = (0..*class).map(|class| row.number(class)).collect();
        let all = found.iter().flat_map(|sequence| &sequence.takes);
        for take in all.filter_map(|take| problem.take(*take)) {
            if let Some(excess) = over_pass.get_mut(take.pass as usize) {
                *excess += take.share;
            }
            let limit = take.limit.and_then(|limit| over_limit.get_mut(limit as usize));
            if let Some(used) = limit {
                *used += ONE;
            }
            for (class, missing) in missing.iter_mut().enumerate() {
                *missing -= take.row.number(class);
            }
        }
        let of_limits = prices.limits.iter().zip(problem.limits);
        let of_limits: i64 = of_limits.map(|(price, max)| price * i64::from(*max)).sum();
        let of_classes = prices.classes.iter().zip(maxima).enumerate();
        let of_classes =
            of_classes.map(|(class, (price, max))| (price * row.number(class)).div_euclid(*max));
        let bound = found.iter().map(|sequence| sequence.row.number(CELL)).sum::<i64>()
            + prices.passes.iter().sum::<i64>()
            + of_limits
            - of_classes.sum::<i64>();
        let missing = missing.into_iter().zip(maxima).map(|(missing, max)| missing * ONE / max);
        let excess = over_pass.into_iter().chain(over_limit).chain(missing).collect();
        Round { bound, excess }
    }
}

impl Prices {
    /// Moves the prices by a step whose size follows from `gap`. Returns `false` if no price can
    /// move.
    fn step(&mut self, round: &Round, gap: f64) -> bool {
        let prices = || self.passes.iter().chain(&self.limits).chain(&self.classes);
        let moving = round.excess.iter().zip(prices());
        // A price of zero cannot fall, so it must not shorten the step of the others.
        let moving = moving.filter(|(excess, price)| **excess > 0 || **price > 0);
        let length: f64 = moving.map(|(excess, _)| (*excess as f64 / ONE as f64).powi(2)).sum();
        if length <= 0.0 {
            return false;
        }
        let step = gap / length;
        let prices = self.passes.iter_mut().chain(&mut self.limits).chain(&mut self.classes);
        for (excess, price) in round.excess.iter().zip(prices) {
            let moved = (step * *excess as f64 / ONE as f64).round() as i64;
            *price = price.saturating_add(moved).max(0);
        }
        true
    }
}
