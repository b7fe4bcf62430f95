//! The best choice among takes: ways of taking passes, each on one antenna for a span of time.
//! Knows only spans, rows and slews.
//!
//! One antenna that can take each pass only once is solved exactly (`line.rs`). Several antennas, or
//! one with limits of takes a day, are solved exactly as long as the number of states allows (`vector.rs`). Beyond
//! that, the better of two greedy schedules (`greedy.rs`) is improved part by part
//! (`neighbourhoods.rs`), and prices bound what any schedule can be worth (`prices.rs`).

mod greedy;
mod line;
mod neighbourhoods;
mod prices;
#[cfg(test)]
mod tests;
mod vector;

use super::row::Row;
use line::AntennaLine;
use vector::Scope;

/// How a take shares its pass with others.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PassPart {
    /// It excludes all other takes of its pass.
    Alone,
    /// It counts only together with a [`PassPart::Second`] of its pass on another antenna, which
    /// begins when it has ended.
    First,
    Second,
}

/// One way of taking a pass.
#[derive(Debug, Clone, Copy)]
pub(super) struct Take {
    /// Index of the pass.
    pub(super) pass: u32,
    /// Index of the antenna.
    pub(super) antenna: u32,
    /// Index of the limit that it counts towards; `None` for the second part of a pass.
    pub(super) limit: Option<u32>,
    pub(super) part: PassPart,
    pub(super) from_ms: i64,
    /// Later than `from_ms`.
    pub(super) to_ms: i64,
    /// How much of its pass it is, thousandths rounded down: parts of a pass that can be taken
    /// together make no more than 1000, and what stands alone is 1000.
    pub(super) share: i64,
    /// Nothing that the antenna could take is cut off.
    pub(super) is_whole: bool,
    /// The greatest elevation of its pass, thousandths of a degree.
    pub(super) height_mdeg: i64,
    pub(super) row: Row,
}

/// The slews of all antennas.
pub(super) trait Slews {
    /// From where the antenna stands at first, milliseconds; `None` if it cannot be at `end` in time.
    fn first_ms(&self, end: usize) -> Option<i64>;

    /// Between two takes of one antenna of which the second begins later, milliseconds; `None` if
    /// it cannot be at the second in time.
    fn slew_ms(&self, start: usize, end: usize) -> Option<i64>;

    /// No slew between takes takes longer, with the set-up. Where two takes are that far apart, the
    /// second can follow, if a way leads there at all.
    fn longest_ms(&self, antenna: usize) -> i64;
}

pub(super) struct Problem<'a> {
    pub(super) antennas: usize,
    pub(super) passes: usize,
    /// By antenna, then by start.
    pub(super) takes: &'a [Take],
    /// How many takes may count towards each limit.
    pub(super) limits: &'a [u32],
    pub(super) slews: &'a dyn Slews,
    /// Places looked at before the search for the proved best is given up.
    pub(super) effort: u64,
}

/// Takes that exclude each other nowhere.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Solution {
    /// By antenna, each in the order of time.
    pub(super) takes: Vec<Vec<u32>>,
    /// Worth of the takes, with their slews.
    pub(super) row: Row,
    /// No solution is worth more.
    pub(super) bound: Row,
}

impl Problem<'_> {
    pub(super) fn take(&self, index: u32) -> Option<&Take> {
        self.takes.get(index as usize)
    }

    pub(super) fn solve(&self) -> Solution {
        let lines: Vec<AntennaLine> =
            (0..self.antennas).map(|antenna| AntennaLine::new(self, antenna)).collect();
        if let [line] = &lines[..] {
            let takes = vec![line.best(self, &|_, take| Some(take.row)).takes];
            let row = self.row(&takes);
            // A line knows neither limits nor other parts of a pass, so its best may break both.
            if self.keeps_limits(&takes) && self.takes_none_twice(&takes) {
                return Solution { takes, row, bound: row };
            }
        }
        let mut effort = self.effort;
        let all = Scope {
            takes: (0..self.takes.len() as u32).map(|take| (take, false)).collect(),
            left: self.limits.to_vec(),
            before: vec![None; self.antennas],
        };
        if let Some(takes) = vector::best(self, all, &mut effort) {
            // The classes are the best already, but pruning may have dropped states with fewer
            // slews.
            let takes = self.refined(takes, &mut self.effort.clone());
            let row = self.row(&takes);
            return Solution { takes, row, bound: row };
        }
        self.solve_in_part(&lines)
    }

    /// The best schedule that is found, for where there are too many states to try them all.
    fn solve_in_part(&self, lines: &[AntennaLine]) -> Solution {
        let start = self.greedy().into_iter().max_by_key(|takes| self.row(takes));
        let takes = self.refined(start.unwrap_or_default(), &mut self.effort.clone());
        let row = self.row(&takes);
        let bound = (0..Row::CLASSES).fold(row, |bound, class| {
            bound.with_number(class, prices::bound(self, lines, &row, class))
        });
        Solution { takes, row, bound }
    }

    /// Returns the worth of takes, with their slews.
    pub(super) fn row(&self, takes: &[Vec<u32>]) -> Row {
        takes.iter().map(|takes| self.row_of_one(takes)).sum()
    }

    fn row_of_one(&self, takes: &[u32]) -> Row {
        let worth: Row =
            takes.iter().filter_map(|take| self.take(*take)).map(|entry| entry.row).sum();
        let first = takes.first().and_then(|first| self.slews.first_ms(*first as usize));
        let pairs = takes.iter().zip(takes.iter().skip(1));
        let slews = pairs.filter_map(|(a, b)| self.slews.slew_ms(*a as usize, *b as usize));
        worth.slewed(slews.sum::<i64>() + first.unwrap_or_default())
    }

    /// The slew between two takes of which the second starts later; `None` where the leg does
    /// not fit.
    fn slew_ms(&self, before: u32, take: u32) -> Option<i64> {
        let (earlier, later) = (self.take(before)?, self.take(take)?);
        if earlier.to_ms > later.from_ms {
            return None;
        }
        self.slews.slew_ms(before as usize, take as usize)
    }

    /// Returns `true` if the second take can follow the first.
    fn fits(&self, before: u32, take: u32) -> bool {
        self.slew_ms(before, take).is_some()
    }

    fn keeps_limits(&self, takes: &[Vec<u32>]) -> bool {
        let used = self.used(takes.iter().flatten());
        used.iter().zip(self.limits).all(|(used, max)| used <= max)
    }

    fn takes_none_twice(&self, takes: &[Vec<u32>]) -> bool {
        let mut is_taken = vec![false; self.passes];
        takes.iter().flatten().filter_map(|take| self.take(*take)).all(|take| {
            let flag = is_taken.get_mut(take.pass as usize);
            flag.is_none_or(|flag| !std::mem::replace(flag, true))
        })
    }

    /// How many of these takes count towards each limit.
    fn used<'t>(&self, takes: impl Iterator<Item = &'t u32>) -> Vec<u32> {
        let mut used = vec![0; self.limits.len()];
        for limit in takes.filter_map(|take| self.take(*take)?.limit) {
            if let Some(used) = used.get_mut(limit as usize) {
                *used += 1;
            }
        }
        used
    }
}
