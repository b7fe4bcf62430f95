//! Search in large neighbourhoods: some passes are chosen again, as well as can be, while the takes
//! of all others stay. A schedule only ever becomes better, and ends where no neighbourhood improves
//! it.

use super::{
    Problem, Row, Take,
    vector::{self, Role},
};

/// Passes in a row that are chosen again at once. If that makes too many states, their halves are.
const AT_ONCE: usize = 16;
/// Fewer are not halved.
const FEW: usize = 4;

impl Problem<'_> {
    /// Improves a schedule until no neighbourhood does, or no `effort` is left.
    pub(super) fn refined(&self, takes: Vec<Vec<u32>>, effort: &mut u64) -> Vec<Vec<u32>> {
        let in_a_row = self.passes_by_start();
        let rows = (0..in_a_row.len()).step_by(AT_ONCE / 2);
        let rows = rows.filter_map(|start| {
            in_a_row.get(start..in_a_row.len().min(start + AT_ONCE)).map(<[u32]>::to_vec)
        });
        let of_limits = (0..self.limits.len() as u32).map(|limit| self.around_limit(limit));
        let neighbourhoods: Vec<Vec<u32>> = rows.chain(of_limits).collect();
        let mut schedule = (self.row(&takes), takes);
        loop {
            let before = schedule.0;
            for passes in &neighbourhoods {
                self.choose_again(passes, &mut schedule, effort);
            }
            if schedule.0 == before || *effort == 0 {
                return schedule.1;
            }
        }
    }

    fn choose_again(&self, passes: &[u32], schedule: &mut (Row, Vec<Vec<u32>>), effort: &mut u64) {
        let mut is_free = vec![false; self.passes];
        for pass in passes {
            if let Some(free) = is_free.get_mut(*pass as usize) {
                *free = true;
            }
        }
        let mut is_taken = vec![false; self.takes.len()];
        for take in schedule.1.iter().flatten() {
            if let Some(taken) = is_taken.get_mut(*take as usize) {
                *taken = true;
            }
        }
        let role = |index: u32, take: &Take| {
            if is_free.get(take.pass as usize) == Some(&true) {
                Role::Free
            } else if is_taken.get(index as usize) == Some(&true) {
                Role::Stays
            } else {
                Role::Out
            }
        };
        match vector::best(self, &role, effort) {
            Some(takes) => {
                let row = self.row(&takes);
                if row > schedule.0 {
                    *schedule = (row, takes);
                }
            }
            None if *effort > 0 && passes.len() > FEW => {
                let (first, second) = passes.split_at(passes.len() / 2);
                self.choose_again(first, schedule, effort);
                self.choose_again(second, schedule, effort);
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

    /// The passes that count towards a limit, and those that an antenna can take only instead of
    /// one of them.
    fn around_limit(&self, limit: u32) -> Vec<u32> {
        let own: Vec<&Take> = self.takes.iter().filter(|take| take.limit == Some(limit)).collect();
        let is_beside = |take: &Take| {
            let margin_ms = self.slews.longest_ms(take.antenna as usize);
            own.iter().any(|other| {
                other.pass == take.pass
                    || other.antenna == take.antenna
                        && other.from_ms < take.to_ms + margin_ms
                        && take.from_ms < other.to_ms + margin_ms
            })
        };
        let beside = self.takes.iter().filter(|take| is_beside(take));
        let mut passes: Vec<(i64, u32)> = beside.map(|take| (take.from_ms, take.pass)).collect();
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
