//! Several antennas, or limits of takes a day: dynamic programming over the last take of every
//! antenna, the passes with possible second takes, and the use of each limit.
//!
//! The classes of the found row are the best; the slews decide between equal rows only as far as
//! the kept states allow.

use super::{PassPart, Problem, Row};

/// Max number of states before the search ends without a result.
const MAX_STATES: usize = 4_000;
/// Max number of states that are not compared.
const FEW_STATES: usize = 24;

const NONE: u32 = u32::MAX;

/// Pass with a take, while other takes of it may follow.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Open {
    pass: u32,
    /// Take of a first part that waits for its second part.
    first: Option<u32>,
}

#[derive(Debug, Clone)]
struct SearchState {
    row: Row,
    /// Last take by antenna; [`NONE`] before its first take.
    last: Vec<u32>,
    open: Vec<Open>,
    /// Limits, each with the number of its takes.
    used: Vec<(u32, u32)>,
    /// Last step of the trail.
    step: u32,
}

/// Endings at a take: no later take belongs to its pass, or to its limit.
#[derive(Debug, Clone, Copy, Default)]
struct Closes {
    pass: bool,
    limit: bool,
}

/// Takes of a search.
pub(super) struct Scope {
    /// Takes, each free or fixed (`true`): every schedule has the fixed ones.
    pub(super) takes: Vec<(u32, bool)>,
    /// Max number of free takes towards each limit.
    pub(super) left: Vec<u32>,
    /// Take of each antenna before the start of the search.
    pub(super) before: Vec<Option<u32>>,
}

/// Returns the best takes by antenna, and subtracts the cost of the search from `effort`. Returns
/// `None` if there are too many states, or if the cost exceeds the remaining `effort`.
pub(super) fn best(problem: &Problem<'_>, scope: Scope, effort: &mut u64) -> Option<Vec<Vec<u32>>> {
    let Scope { takes: mut order, left, before } = scope;
    let key =
        |take: u32| problem.take(take).map(|entry| (entry.from_ms, entry.to_ms, entry.antenna));
    // A state knows only the last take of each antenna, so process takes by their start.
    order.sort_by_key(|(take, _)| (key(*take), *take));
    let closes = closes(problem, &order);

    let last = before.into_iter().map(|take| take.unwrap_or(NONE)).collect();
    let start =
        SearchState { row: Row::ZERO, last, open: Vec::new(), used: Vec::new(), step: NONE };
    let mut search = StateSearch { problem, left, trail: Vec::new(), effort: 0 };
    let found = search.run(start, &order, &closes, *effort);
    *effort = effort.saturating_sub(search.effort);
    Some(search.traced(found?))
}

impl StateSearch<'_> {
    /// Returns the last step of the best trail.
    fn run(
        &mut self,
        start: SearchState,
        order: &[(u32, bool)],
        closes: &[Closes],
        effort: u64,
    ) -> Option<u32> {
        let mut states = vec![start];
        let mut after_pruning = 1;
        for ((take, stays), closes) in order.iter().zip(closes) {
            let entry = self.problem.take(*take)?;
            let extended: Vec<SearchState> =
                states.iter().filter_map(|state| self.extended(state, *take, *stays)).collect();
            if *stays {
                states = extended;
            } else {
                states.extend(extended);
            }
            self.effort += 1 + states.len() as u64;
            if closes.pass {
                // A first part whose second part can no longer come is worth nothing.
                let waits = |state: &SearchState| {
                    state.open.iter().any(|open| open.pass == entry.pass && open.first.is_some())
                };
                states.retain(|state| !waits(state));
                for state in &mut states {
                    state.open.retain(|open| open.pass != entry.pass);
                }
            }
            // States that differ only in an irrelevant limit become equal.
            if let Some(limit) = entry.limit.filter(|_| closes.limit) {
                for state in &mut states {
                    state.used.retain(|(used, _)| *used != limit);
                }
            }
            // Pruning compares all pairs, so it waits until the states have doubled.
            if states.len() > FEW_STATES.max(2 * after_pruning) {
                self.prune(&mut states, entry.from_ms);
                after_pruning = states.len();
            }
            if states.len() > MAX_STATES || self.effort > effort {
                return None;
            }
        }
        // The first of equal states wins, so that two runs give the same schedule.
        let best = states.into_iter().reduce(|a, b| if b.row > a.row { b } else { a })?;
        Some(best.step)
    }
}

fn closes(problem: &Problem<'_>, order: &[(u32, bool)]) -> Vec<Closes> {
    let mut pass_seen = vec![false; problem.passes];
    let mut limit_seen = vec![false; problem.limits.len()];
    let first = |flags: &mut Vec<bool>, index: u32| {
        flags.get_mut(index as usize).is_some_and(|flag| !std::mem::replace(flag, true))
    };
    let mut closes: Vec<Closes> = order
        .iter()
        .rev()
        .map(|(take, stays)| {
            let Some(entry) = problem.take(*take) else { return Closes::default() };
            let limit = entry.limit.filter(|_| !stays);
            Closes {
                pass: first(&mut pass_seen, entry.pass),
                limit: limit.is_some_and(|limit| first(&mut limit_seen, limit)),
            }
        })
        .collect();
    closes.reverse();
    closes
}

struct StateSearch<'a> {
    problem: &'a Problem<'a>,
    /// Max number of free takes towards each limit.
    left: Vec<u32>,
    /// Previous step, and the take.
    trail: Vec<(u32, u32)>,
    effort: u64,
}

impl StateSearch<'_> {
    /// Returns `state` with one more take; `None` if it does not fit. A fixed take counts towards
    /// no limit, and its pass needs no check.
    fn extended(&mut self, state: &SearchState, take: u32, stays: bool) -> Option<SearchState> {
        let entry = self.problem.take(take)?;
        let antenna = entry.antenna as usize;
        let open = state.open.iter().position(|open| open.pass == entry.pass);
        match (entry.part, open.and_then(|open| state.open.get(open))) {
            _ if stays => {}
            (PassPart::Alone | PassPart::First, None) => {}
            (PassPart::Second, Some(open)) => {
                let first = self.problem.take(open.first?)?;
                // A hand-over needs a second antenna that starts once the first has ended.
                if first.antenna == entry.antenna || first.to_ms > entry.from_ms {
                    return None;
                }
            }
            _ => return None,
        }
        let used = entry.limit.filter(|_| !stays).map(|limit| {
            let used = state.used.iter().find(|(used, _)| *used == limit);
            (limit, used.map_or(0, |(_, count)| *count) + 1)
        });
        if let Some((limit, count)) = used
            && count > self.left.get(limit as usize).copied().unwrap_or(u32::MAX)
        {
            return None;
        }
        let slew_ms = match *state.last.get(antenna)? {
            NONE => self.problem.slews.first_ms(take as usize)?,
            last => self.problem.slew_ms(last, take)?,
        };
        let mut new = state.clone();
        new.row = state.row + entry.row.slewed(slew_ms);
        *new.last.get_mut(antenna)? = take;
        if let Some(open) = open {
            new.open.get_mut(open)?.first = None;
        } else if !stays {
            let first = (entry.part == PassPart::First).then_some(take);
            new.open.push(Open { pass: entry.pass, first });
            new.open.sort_by_key(|open| open.pass);
        }
        if let Some((limit, count)) = used {
            new.used.retain(|(used, _)| *used != limit);
            new.used.push((limit, count));
        }
        new.step = self.trail.len() as u32;
        self.trail.push((state.step, take));
        Some(new)
    }

    /// Drops each state for which another state allows the same continuations and is worth as much.
    fn prune(&mut self, states: &mut Vec<SearchState>, now_ms: i64) {
        let problem = self.problem;
        let free = |(antenna, last): (usize, &u32)| {
            let longest_ms = problem.slews.longest_ms(antenna);
            let ended = |last: u32| problem.take(last).map_or(i64::MIN, |take| take.to_ms);
            // An antenna without a take is not free: its first slew may no longer fit.
            let is_free = *last != NONE && ended(*last) + longest_ms <= now_ms;
            if is_free { None } else { Some(*last) }
        };
        let mut sorted: Vec<(SearchState, Vec<Option<u32>>)> = states
            .drain(..)
            .map(|state| {
                let busy = state.last.iter().enumerate().map(free).collect();
                (state, busy)
            })
            .collect();
        // Sort the best first: only a state with at least the same worth can dominate another.
        sorted.sort_by_key(|(state, _)| std::cmp::Reverse(state.row));
        let mut retained: Vec<(SearchState, Vec<Option<u32>>)> = Vec::new();
        for (state, busy) in sorted {
            let beaten = retained.iter().position(|(better, freer)| {
                let is_freer =
                    |(own, other): (&Option<u32>, &Option<u32>)| own.is_none() || own == other;
                freer.iter().zip(&busy).all(is_freer)
                    && better.open.iter().all(|open| state.open.contains(open))
                    && state
                        .open
                        .iter()
                        .all(|open| open.first.is_none() || better.open.contains(open))
                    && better.used.iter().all(|(limit, count)| {
                        state.used.iter().any(|(used, other)| used == limit && other >= count)
                    })
            });
            self.effort += beaten.unwrap_or(retained.len()) as u64 / 8;
            if beaten.is_none() {
                retained.push((state, busy));
            }
        }
        states.extend(retained.into_iter().map(|(state, _)| state));
    }

    fn traced(&self, step: u32) -> Vec<Vec<u32>> {
        let mut takes = vec![Vec::new(); self.problem.antennas];
        let mut step = step;
        while let Some((before, take)) = self.trail.get(step as usize) {
            let antenna = self.problem.take(*take).map(|take| take.antenna as usize);
            if let Some(takes) = antenna.and_then(|antenna| takes.get_mut(antenna)) {
                takes.push(*take);
            }
            step = *before;
        }
        for takes in &mut takes {
            takes.reverse();
        }
        takes
    }
}
