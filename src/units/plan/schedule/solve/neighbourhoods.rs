//! Search in large neighbourhoods: the search chooses some passes again as well as possible, while
//! all other takes stay. A schedule only improves, and the search ends when no neighbourhood
//! improves it.

use super::{
    Problem, Row, Take,
    vector::{self, Scope},
};

/// Number of consecutive passes that the search chooses at once. With too many states, it chooses
/// their halves.
const AT_ONCE: usize = 16;
/// Max number of passes that are not halved.
const FEW: usize = 4;

impl Problem<'_> {
    /// Improves a schedule until no neighbourhood does, or until `effort` is used up.
    pub(super) fn refined(&self, takes: Vec<Vec<u32>>, effort: &mut u64) -> Vec<Vec<u32>> {
        let in_a_row = self.passes_by_start();
        // Neighbourhoods overlap by half, so that passes on both sides of a border meet in one.
        let rows = (0..in_a_row.len()).step_by(AT_ONCE / 2);
        let rows = rows.filter_map(|start| {
            in_a_row.get(start..in_a_row.len().min(start + AT_ONCE)).map(<[u32]>::to_vec)
        });
        // Passes that share a limit may be too far apart for one row.
        let of_limits = (0..self.limits.len() as u32).map(|limit| self.around_limit(limit));
        let neighbourhoods: Vec<Vec<u32>> = rows.chain(of_limits).collect();
        let mut by_pass = vec![Vec::new(); self.passes];
        for (index, take) in (0..).zip(self.takes) {
            if let Some(own) = by_pass.get_mut(take.pass as usize) {
                own.push(index);
            }
        }
        let mut schedule = (self.row(&takes), takes);
        loop {
            // An improvement may allow another one in a neighbourhood that was tried before.
            let before = schedule.0;
            for passes in &neighbourhoods {
                self.choose_again(&by_pass, passes, &mut schedule, effort);
            }
            if schedule.0 == before || *effort == 0 {
                return schedule.1;
            }
        }
    }

    fn choose_again(
        &self,
        by_pass: &[Vec<u32>],
        passes: &[u32],
        schedule: &mut (Row, Vec<Vec<u32>>),
        effort: &mut u64,
    ) {
        let of_passes = passes.iter().filter_map(|pass| by_pass.get(*pass as usize)).flatten();
        let free: Vec<u32> = of_passes.copied().collect();
        let spans = || free.iter().filter_map(|take| self.take(*take));
        let Some(from_ms) = spans().map(|take| take.from_ms).min() else { return };
        let to_ms = spans().map(|take| take.to_ms).max().unwrap_or(from_ms);
        let mut is_free = vec![false; self.passes];
        for pass in passes {
            if let Some(free) = is_free.get_mut(*pass as usize) {
                *free = true;
            }
        }
        let stays = |take: &&u32| {
            self.take(**take).is_some_and(|entry| is_free.get(entry.pass as usize) != Some(&true))
        };
        let fixed_takes = schedule.1.iter().map(|own| own.iter().filter(stays).copied().collect());
        let fixed_takes: Vec<Vec<u32>> = fixed_takes.collect();
        // Only the takes that stay within the neighbourhood, and the first one after it, affect the
        // choice.
        let ranges = fixed_takes.iter().map(|own| {
            let begun = |at_ms: i64| {
                own.partition_point(|take| {
                    self.take(*take).is_some_and(|of_take| of_take.from_ms < at_ms)
                })
            };
            begun(from_ms)..own.len().min(begun(to_ms) + 1)
        });
        let ranges: Vec<_> = ranges.collect();
        let neighbours = fixed_takes.iter().zip(&ranges);
        let neighbours =
            neighbours.flat_map(|(own, range)| own.get(range.clone()).unwrap_or_default());
        let before = fixed_takes.iter().zip(&ranges);
        let before = before.map(|(own, range)| own.get(range.start.checked_sub(1)?).copied());
        let used = self.used(fixed_takes.iter().flatten());
        let left = self.limits.iter().zip(used).map(|(max, used)| max.saturating_sub(used));
        let scope = Scope {
            takes: free
                .iter()
                .map(|take| (*take, false))
                .chain(neighbours.map(|take| (*take, true)))
                .collect(),
            left: left.collect(),
            before: before.collect(),
        };
        match vector::best(self, scope, effort) {
            Some(found) => {
                let all = fixed_takes.iter().zip(&ranges).zip(found);
                let takes: Vec<Vec<u32>> = all
                    .map(|((own, range), found)| {
                        let before = own.get(..range.start).unwrap_or_default();
                        let after = own.get(range.end..).unwrap_or_default();
                        [before, &found, after].concat()
                    })
                    .collect();
                let row = self.row(&takes);
                // Ignore equal schedules; otherwise the search would never end.
                if row > schedule.0 {
                    *schedule = (row, takes);
                }
            }
            // There are too many states for all passes at once, but each half may still improve.
            None if *effort > 0 && passes.len() > FEW => {
                let (first, second) = passes.split_at(passes.len() / 2);
                self.choose_again(by_pass, first, schedule, effort);
                self.choose_again(by_pass, second, schedule, effort);
            }
            None => {}
        }
    }

    fn passes_by_start(&self) -> Vec<u32> {
        let mut starts: Vec<Option<i64>> = vec![None; self.passes];
        for take in self.takes {
            if let Some(start) = starts.get_mut(take.pass as usize) {
                *start = Some(start.map_or(take.from_ms, |start| start.min(take.from_ms)));
            }
        }
        let started = (0..).zip(&starts).filter_map(|(pass, start)| Some(((*start)?, pass)));
        let mut passes: Vec<(i64, u32)> = started.collect();
        passes.sort_unstable();
        passes.into_iter().map(|(_, pass)| pass).collect()
    }

    /// Returns the passes that count towards a limit, and the passes that an antenna can take only
    /// instead of one of them.
    fn around_limit(&self, limit: u32) -> Vec<u32> {
        let own: Vec<&Take> = self.takes.iter().filter(|take| take.limit == Some(limit)).collect();
        let is_beside = |take: &Take| {
            // Takes further apart than the longest slew do not compete for the antenna.
            let margin_ms = self.slews.longest_ms(take.antenna as usize);
            own.iter().any(|other| {
                other.pass == take.pass
                    || other.antenna == take.antenna
                        && other.from_ms < take.to_ms + margin_ms
                        && take.from_ms < other.to_ms + margin_ms
            })
        };
        let overlapping = self.takes.iter().filter(|take| is_beside(take));
        let mut passes: Vec<(i64, u32)> =
            overlapping.map(|take| (take.from_ms, take.pass)).collect();
        passes.sort_unstable();
        let mut found = Vec::new();
        for (_, pass) in passes {
            if !found.contains(&pass) {
                found.push(pass);
            }
        }
        found
    }
}
