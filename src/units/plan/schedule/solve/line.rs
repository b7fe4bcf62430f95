//! Best sequence of takes of one antenna, by dynamic programming over the last take. Only
//! neighbours in a sequence need time between them. So the best sequence that ends with a take
//! follows from the best sequences that end with each earlier take, for any slews. A sequence may
//! contain several parts of a pass, one after the other.

use super::{Problem, Row, Take};

/// Takes of one antenna, prepared for repeated solution.
pub(super) struct AntennaLine {
    antenna: usize,
    /// Takes of the antenna, sorted by start.
    by_start: Vec<u32>,
    /// Positions in `by_start`, by end.
    by_end: Vec<u32>,
    /// Counts for each position in `by_start`: how many of `by_end` have ended so early that any
    /// leg fits, and how many have ended in total.
    ended: Vec<(u32, u32)>,
}

/// Best sequence of takes.
pub(super) struct Sequence {
    pub(super) row: Row,
    pub(super) takes: Vec<u32>,
}

/// Best sequence up to a take.
#[derive(Clone, Copy)]
struct Best {
    row: Row,
    before: Option<u32>,
}

impl AntennaLine {
    pub(super) fn new(problem: &Problem<'_>, antenna: usize) -> Self {
        let indexed = problem.takes.iter().zip(0_u32..);
        let own = indexed.filter(|(take, _)| take.antenna as usize == antenna);
        let mut by_start: Vec<u32> = own.map(|(_, index)| index).collect();
        let span =
            |take: &u32| problem.take(*take).map_or((0, 0), |take| (take.from_ms, take.to_ms));
        // The index breaks ties, so that the result does not depend on the order of the input.
        by_start.sort_by_key(|take| (span(take), *take));
        let ends: Vec<i64> = by_start.iter().map(|take| span(take).1).collect();
        let end = |position: &u32| ends.get(*position as usize).copied().unwrap_or_default();
        let mut by_end: Vec<u32> = (0..by_start.len() as u32).collect();
        by_end.sort_by_key(|position| (end(position), *position));

        // A leg is costly to compute. If any leg fits, its time is irrelevant.
        let longest_ms = problem.slews.longest_ms(antenna);
        let ended = |take: &u32| {
            let (from_ms, _) = span(take);
            let count_until = |ms: i64| by_end.partition_point(|before| end(before) <= ms) as u32;
            (count_until(from_ms - longest_ms), count_until(from_ms))
        };
        let ended = by_start.iter().map(ended).collect();
        Self { antenna, by_start, by_end, ended }
    }

    /// Returns the sequence with the highest worth; `worth` returns the row of a take, `None` for
    /// an excluded take.
    pub(super) fn best(
        &self,
        problem: &Problem<'_>,
        worth: &dyn Fn(u32, &Take) -> Option<Row>,
    ) -> Sequence {
        let mut best: Vec<Option<Best>> = Vec::with_capacity(self.by_start.len());
        let mut ahead = Ahead::new(problem.slews.longest_ms(self.antenna));
        let mut passed = 0;
        for (take, (far, near)) in self.by_start.iter().zip(&self.ended) {
            for before in self.by_end.get(passed..*far as usize).unwrap_or_default() {
                if let Some(Some(of_before)) = best.get(*before as usize) {
                    ahead.add(*before, of_before.row);
                }
            }
            // The takes are sorted by start, so `far` never falls and no sequence is added twice.
            passed = *far as usize;
            let own = problem.take(*take).and_then(|entry| worth(*take, entry));
            let found = own.and_then(|own| {
                let first = problem.slews.first_ms(*take as usize);
                let mut best_before =
                    first.map(|ms| Best { row: Row::ZERO.slewed(ms), before: None });
                let near = self.by_end.get(passed..*near as usize).unwrap_or_default();
                // Start with the latest, which likely have the highest worth.
                let near = near.iter().rev().filter_map(|before| {
                    Some((*before, best.get(*before as usize)?.as_ref()?.row))
                });
                for (before, row) in ahead.best.iter().copied().chain(near) {
                    // A slew only reduces the row, so few legs need computation.
                    if best_before.is_some_and(|best| row <= best.row) {
                        continue;
                    }
                    let earlier = self.by_start.get(before as usize)?;
                    let Some(slew_ms) = problem.slew_ms(*earlier, *take) else { continue };
                    let row = row.slewed(slew_ms);
                    if best_before.is_none_or(|best| row > best.row) {
                        best_before = Some(Best { row, before: Some(before) });
                    }
                }
                let best_so_far = best_before?;
                Some(Best { row: best_so_far.row + own, ..best_so_far })
            });
            best.push(found);
        }
        self.traced(&best)
    }

    fn traced(&self, best: &[Option<Best>]) -> Sequence {
        let mut last: Option<(u32, Best)> = None;
        for (position, found) in (0..).zip(best) {
            let Some(found) = found else { continue };
            // An empty sequence is worth zero, so skip a sequence that is worth less.
            let row_so_far = last.map_or(Row::ZERO, |(_, best)| best.row);
            if found.row > row_so_far {
                last = Some((position, *found));
            }
        }
        let row = last.map_or(Row::ZERO, |(_, best)| best.row);
        let step_at = |position: u32| best.get(position as usize).copied().flatten();
        let back = std::iter::successors(last.map(|(position, _)| position), |position| {
            step_at(*position)?.before
        });
        let mut takes: Vec<u32> =
            back.filter_map(|position| self.by_start.get(position as usize).copied()).collect();
        takes.reverse();
        Sequence { row, takes }
    }
}

/// Best sequences whose last take has ended so early that any leg fits: the sequences with the
/// highest worth, and among these all that may still have the fewest slews.
struct Ahead {
    longest_ms: i64,
    best: Vec<(u32, Row)>,
}

impl Ahead {
    fn new(longest_ms: i64) -> Self {
        Self { longest_ms, best: Vec::new() }
    }

    fn add(&mut self, position: u32, row: Row) {
        let Some((_, top)) = self.best.first() else {
            self.best.push((position, row));
            return;
        };
        match row.before_slews().cmp(top.before_slews()) {
            // Slews come last in the comparison: no slew compensates for a lower row.
            std::cmp::Ordering::Less => {}
            std::cmp::Ordering::Greater => {
                self.best.clear();
                self.best.push((position, row));
            }
            std::cmp::Ordering::Equal => {
                self.best.push((position, row));
                let slews = self.best.iter().map(|(_, row)| row.slew_ms());
                let min_ms = slews.min().unwrap_or_default();
                // The next leg adds at most `longest_ms`, so sequences within that margin may still
                // win.
                let max_ms = min_ms + self.longest_ms;
                self.best.retain(|(_, row)| row.slew_ms() <= max_ms);
            }
        }
    }
}
