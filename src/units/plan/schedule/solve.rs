//! Best choice among takes: ways to take passes, each on one antenna for a span of time. The solver
//! knows only spans, rows and slews.
//!
//! `line.rs` solves one antenna that can take each pass only once exactly. `vector.rs` solves
//! several antennas, or one with limits of takes a day, exactly as long as the number of states
//! allows. Beyond that, `neighbourhoods.rs` improves the better of two greedy schedules
//! (`greedy.rs`) part by part, and `prices.rs` bounds the worth of any schedule.

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

/// Relation of a take to other takes of its pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PassPart {
    /// Take that excludes all other takes of its pass.
    Alone,
    /// First part, which counts only together with a [`PassPart::Second`] of its pass on another
    /// antenna. The second part begins after the end of the first.
    First,
    Second,
}

/// Single way to take a pass.
#[derive(Debug, Clone, Copy)]
pub(super) struct Take {
    /// Index of the pass in the problem.
    pub(super) pass: u32,
    /// Index of the antenna in the problem.
    pub(super) antenna: u32,
    /// Index of the limit that includes the take; `None` for the second part of a pass.
    pub(super) limit: Option<u32>,
    pub(super) part: PassPart,
    pub(super) from_ms: i64,
    /// End of the take, milliseconds, later than `from_ms`.
    pub(super) to_ms: i64,
    /// Share of its pass, thousandths rounded down: combined parts of a pass make at most 1000, and
    /// a take that stands alone is 1000.
    pub(super) share: i64,
    /// `true` if the take contains the whole possible span.
    pub(super) is_whole: bool,
    /// Maximum elevation of its pass, thousandths of a degree.
    pub(super) height_mdeg: i64,
    pub(super) row: Row,
}

/// Slews of all antennas.
pub(super) trait Slews {
    /// Returns the slew from the first position of the antenna, milliseconds; `None` if it cannot
    /// be at `end` in time.
    fn first_ms(&self, end: usize) -> Option<i64>;

    /// Returns the slew between two takes of one antenna, the second of which begins later,
    /// milliseconds. Returns `None` if the antenna cannot be at the second in time.
    fn slew_ms(&self, start: usize, end: usize) -> Option<i64>;

    /// Returns the max slew between takes, with the set-up, milliseconds. With this time between
    /// two takes, the second can follow the first if any path leads there.
    fn longest_ms(&self, antenna: usize) -> i64;
}

pub(super) struct Problem<'a> {
    pub(super) antennas: usize,
    pub(super) passes: usize,
    /// Takes by antenna, then by start.
    pub(super) takes: &'a [Take],
    /// Max number of takes towards each limit.
    pub(super) limits: &'a [u32],
    pub(super) slews: &'a dyn Slews,
    /// Max number of checked places before the search for the proved best ends.
    pub(super) effort: u64,
}

/// Takes that do not exclude each other.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Solution {
    /// Takes by antenna, each in the order of time.
    pub(super) takes: Vec<Vec<u32>>,
    /// Worth of the takes, with their slews.
    pub(super) row: Row,
    /// Upper bound of the worth of any solution.
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
            // A line knows neither limits nor other parts of a pass, so its best sequence may
            // violate both.
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

    /// Returns the best schedule found, if there are too many states to try all of them.
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

    /// Returns the slew between two takes, the second of which starts later; `None` if the leg does
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

    /// Returns how many of these takes count towards each limit.
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
