//! One antenna: the best sequence of takes, by dynamic programming over the last take. Only
//! neighbours in a sequence need time between them, so the best sequence that ends with a take
//! follows from the best ones that end with each take before it, whatever the slews are.

use super::{Problem, Row, Take};

/// The takes of one antenna, prepared for repeated solution.
pub(super) struct Line {
    antenna: usize,
    /// Takes by start.
    by_start: Vec<u32>,
    /// Positions in `by_start`, by end.
    by_end: Vec<u32>,
    /// For each position in `by_start`: how many of `by_end` have ended so early that any leg
    /// fits.
    far: Vec<u32>,
    /// For each position, the range of `near`.
    near_of: Vec<(u32, u32)>,
    /// Positions before, of which the leg just fits, and its slew.
    near: Vec<(u32, u32)>,
}

/// The best sequence.
pub(super) struct Sequence {
    pub(super) row: Row,
    pub(super) takes: Vec<u32>,
}

/// The best sequence up to a take.
#[derive(Clone, Copy)]
struct Best {
    row: Row,
    before: Option<u32>,
}

impl Line {
    pub(super) fn new(problem: &Problem<'_>, antenna: usize) -> Self {
        let indexed = problem.takes.iter().zip(0_u32..);
        let own = indexed.filter(|(take, _)| take.antenna as usize == antenna);
        let mut by_start: Vec<u32> = own.map(|(_, index)| index).collect();
        let span =
            |take: &u32| problem.take(*take).map_or((0, 0), |take| (take.from_ms, take.to_ms));
        by_start.sort_by_key(|take| (span(take), *take));
        let ends: Vec<i64> = by_start.iter().map(|take| span(take).1).collect();
        let end = |position: &u32| ends.get(*position as usize).copied().unwrap_or_default();
        let mut by_end: Vec<u32> = (0..by_start.len() as u32).collect();
        by_end.sort_by_key(|position| (end(position), *position));

        let longest_ms = problem.slews.longest_ms(antenna);
        let (mut far, mut near_of, mut near) = (Vec::new(), Vec::new(), Vec::new());
        for take in &by_start {
            let (from_ms, _) = span(take);
            let first = by_end.partition_point(|before| end(before) + longest_ms <= from_ms);
            let last = by_end.partition_point(|before| end(before) <= from_ms);
            far.push(first as u32);
            let start = near.len() as u32;
            for before in by_end.get(first..last).unwrap_or_default() {
                let Some(earlier) = by_start.get(*before as usize) else { continue };
                let leg = problem.slews.between(*earlier as usize, *take as usize);
                if end(before) + leg.needs_ms <= from_ms {
                    near.push((*before, leg.slew_ms as u32));
                }
            }
            near_of.push((start, near.len() as u32));
        }
        Self { antenna, by_start, by_end, far, near_of, near }
    }

    /// The sequence that is worth most; `worth` is the row of a take, `None` for one that is out.
    pub(super) fn best(
        &self,
        problem: &Problem<'_>,
        worth: &dyn Fn(u32, &Take) -> Option<Row>,
    ) -> Sequence {
        let mut best: Vec<Option<Best>> = Vec::with_capacity(self.by_start.len());
        let mut ahead = Ahead::new(problem.slews.longest_ms(self.antenna));
        let mut passed = 0;
        let each = self.by_start.iter().zip(&self.far).zip(&self.near_of);
        for ((take, far), near) in each {
            for before in self.by_end.get(passed..*far as usize).unwrap_or_default() {
                if let Some(Some(of_before)) = best.get(*before as usize) {
                    ahead.add(*before, of_before.row);
                }
            }
            passed = *far as usize;
            let own = problem.take(*take).and_then(|it| worth(*take, it));
            let found = own.and_then(|own| {
                let first = problem.slews.first_ms(*take as usize);
                let first = first.map(|ms| Best { row: Row::ZERO.slewed(ms), before: None });
                let far = ahead.best.iter().filter_map(|(before, row)| {
                    let earlier = self.by_start.get(*before as usize)?;
                    let leg = problem.slews.between(*earlier as usize, *take as usize);
                    Some(Best { row: row.slewed(leg.slew_ms), before: Some(*before) })
                });
                let near = self.near.get(near.0 as usize..near.1 as usize).unwrap_or_default();
                let near = near.iter().filter_map(|(before, slew_ms)| {
                    let row = best.get(*before as usize)?.as_ref()?.row;
                    Some(Best { row: row.slewed((*slew_ms).into()), before: Some(*before) })
                });
                let all = first.into_iter().chain(far).chain(near);
                let best = all.reduce(|a, b| if b.row > a.row { b } else { a })?;
                Some(Best { row: best.row + own, ..best })
            });
            best.push(found);
        }
        self.traced(&best)
    }

    fn traced(&self, best: &[Option<Best>]) -> Sequence {
        let mut last: Option<(u32, Best)> = None;
        for (position, found) in (0..).zip(best) {
            let Some(found) = found else { continue };
            let least = last.map_or(Row::ZERO, |(_, best)| best.row);
            if found.row > least {
                last = Some((position, *found));
            }
        }
        let row = last.map_or(Row::ZERO, |(_, best)| best.row);
        let at = |position: u32| best.get(position as usize).copied().flatten();
        let back = std::iter::successors(last.map(|(position, _)| position), |position| {
            at(*position)?.before
        });
        let mut takes: Vec<u32> =
            back.filter_map(|position| self.by_start.get(position as usize).copied()).collect();
        takes.reverse();
        Sequence { row, takes }
    }
}

/// The best sequences of which the last take has ended so early that any leg fits: those that are
/// worth most, and of those all that may still have the fewest slews.
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
        match row.classes().cmp(top.classes()) {
            std::cmp::Ordering::Less => {}
            std::cmp::Ordering::Greater => {
                self.best.clear();
                self.best.push((position, row));
            }
            std::cmp::Ordering::Equal => {
                self.best.push((position, row));
                let slews = self.best.iter().map(|(_, row)| row.slew_ms());
                let least_ms = slews.min().unwrap_or_default();
                let most_ms = least_ms + self.longest_ms;
                self.best.retain(|(_, row)| row.slew_ms() <= most_ms);
            }
        }
    }
}
