//! Slews between takes, by the real axes of each antenna.

use std::{
    cell::{OnceCell, RefCell},
    collections::HashMap,
};

use super::{
    request::PlannedAntenna,
    solve::{Slews, Take},
    way::ms,
};
use crate::station::BetweenPasses;

/// Axis positions at both ends of a take, degrees as the mount counts.
pub(super) type LegEnds = [[f64; 2]; 2];

/// Takes of a schedule with the paths between them. Azel searches for a path round barriers only if
/// it decides, and once each.
pub(super) struct Legs<'a> {
    antennas: &'a [PlannedAntenna],
    takes: Vec<Stop>,
    longest_ms: Vec<i64>,
    found: RefCell<HashMap<(usize, usize, i64), Option<i64>>>,
}

struct Stop {
    antenna: usize,
    from_ms: i64,
    to_ms: i64,
    ends_deg: LegEnds,
    is_fixed: bool,
    /// Time from the park position to the start, and from the end back, milliseconds; `None` if no
    /// path leads there.
    from_park_ms: OnceCell<Option<i64>>,
    to_park_ms: OnceCell<Option<i64>>,
}

impl<'a> Legs<'a> {
    /// Creates the legs. `takes` contains the axis positions at both ends, and whether the take is
    /// fixed.
    pub(super) fn new(
        antennas: &'a [PlannedAntenna],
        takes: impl Iterator<Item = (Take, LegEnds, bool)>,
    ) -> Self {
        let stops = takes.map(|(take, ends_deg, is_fixed)| Stop {
            antenna: take.antenna as usize,
            from_ms: take.from_ms,
            to_ms: take.to_ms,
            ends_deg,
            is_fixed,
            from_park_ms: OnceCell::new(),
            to_park_ms: OnceCell::new(),
        });
        let stops: Vec<Stop> = stops.collect();
        let longest_ms = antennas.iter().enumerate().map(|(index, antenna)| {
            let own = stops.iter().filter(|stop| stop.antenna == index);
            let widest_ms = antenna.reach.widest_ms(own.flat_map(|stop| stop.ends_deg));
            // The path goes through the park position, or round a barrier.
            let is_round =
                antenna.between_passes == BetweenPasses::Park || antenna.reach.has_barriers();
            let times = if is_round { 2 } else { 1 };
            widest_ms * times + set_up_ms(antenna)
        });
        let longest_ms = longest_ms.collect();
        Self { antennas, takes: stops, longest_ms, found: RefCell::default() }
    }

    /// Returns the min time between two takes of one antenna, with the set-up. Returns `None` if no
    /// path leads from one to the other within the max time of a leg.
    pub(super) fn needs_ms(&self, start: usize, end: usize) -> Option<i64> {
        let (before, after) = (self.takes.get(start)?, self.takes.get(end)?);
        let antenna = self.antennas.get(before.antenna)?;
        // The antenna already takes both, so the leg between them cannot be refused.
        if before.is_fixed && after.is_fixed {
            return Some(0);
        }
        let set_up_ms = set_up_ms(antenna);
        let max_ms = self.longest_ms(before.antenna) - set_up_ms;
        Some(search_ms(antenna, before, after, max_ms)? + set_up_ms)
    }

    /// Returns how long the axes turn between two consecutive takes, milliseconds.
    pub(super) fn turning_ms(&self, start: usize, end: usize) -> i64 {
        let cached = self.known_ms(start, end, i64::MAX);
        cached.or_else(|| self.slew_ms(start, end)).unwrap_or_default()
    }

    /// Does the same as [`search_ms`], but searches only once for each pair of takes past barriers.
    fn known_ms(&self, start: usize, end: usize, max_ms: i64) -> Option<i64> {
        let (before, after) = (self.takes.get(start)?, self.takes.get(end)?);
        let antenna = self.antennas.get(before.antenna)?;
        if !antenna.reach.has_barriers() {
            return search_ms(antenna, before, after, max_ms);
        }
        // The limit is part of the key: a search that ended at the limit found no path.
        if let Some(cached) = self.found.borrow().get(&(start, end, max_ms)) {
            return *cached;
        }
        let found = search_ms(antenna, before, after, max_ms);
        self.found.borrow_mut().insert((start, end, max_ms), found);
        found
    }

    /// Returns `true` if a path leads from the first position of the antenna to a take.
    pub(super) fn is_in_reach(&self, end: usize) -> bool {
        let Some(take) = self.takes.get(end) else { return false };
        let antenna = self.antennas.get(take.antenna);
        let [start_deg, _] = take.ends_deg;
        antenna.is_some_and(|antenna| {
            antenna.stands_deg.is_none_or(|stands_deg| {
                antenna.reach.leg_ms(stands_deg, start_deg, ms(antenna.free_from)).is_some()
            })
        })
    }
}

/// Returns how long the axes turn from one take to another with the antenna's waiting rule, if no
/// longer than `max_ms`.
fn search_ms(antenna: &PlannedAntenna, before: &Stop, after: &Stop, max_ms: i64) -> Option<i64> {
    let by_park = || by_park_ms(antenna, before, after).filter(|ms| *ms <= max_ms);
    let direct = || direct_ms(antenna, before, after, max_ms);
    if antenna.between_passes == BetweenPasses::Park && !(before.is_fixed && after.is_fixed) {
        let gap_ms = after.from_ms - before.to_ms - set_up_ms(antenna);
        // Without time for the park position, the antenna goes straight to the next pass.
        by_park().filter(|ms| *ms <= gap_ms).or_else(direct)
    } else if antenna.reach.has_barriers() {
        direct().or_else(by_park)
    } else {
        direct()
    }
}

/// Returns the time of the path from one take to another that does not use the park position, if no
/// longer than `max_ms`.
fn direct_ms(antenna: &PlannedAntenna, before: &Stop, after: &Stop, max_ms: i64) -> Option<i64> {
    let ([_, end_deg], [start_deg, _]) = (before.ends_deg, after.ends_deg);
    antenna.reach.leg_within_ms(end_deg, start_deg, before.to_ms, max_ms)
}

fn by_park_ms(antenna: &PlannedAntenna, before: &Stop, after: &Stop) -> Option<i64> {
    let reach = &antenna.reach;
    let [start_deg, _] = after.ends_deg;
    let from_park = || reach.leg_ms(reach.park_deg(), start_deg, after.from_ms);
    let [_, end_deg] = before.ends_deg;
    let to_park = || reach.leg_ms(end_deg, reach.park_deg(), before.to_ms);
    let back_ms = (*before.to_park_ms.get_or_init(to_park))?;
    Some(back_ms + (*after.from_park_ms.get_or_init(from_park))?)
}

pub(super) fn set_up_ms(antenna: &PlannedAntenna) -> i64 {
    (antenna.set_up_s * 1000.0).ceil() as i64
}

impl Slews for Legs<'_> {
    fn first_ms(&self, end: usize) -> Option<i64> {
        let take = self.takes.get(end)?;
        if take.is_fixed {
            return Some(0);
        }
        let antenna = self.antennas.get(take.antenna)?;
        let [start_deg, _] = take.ends_deg;
        let free_ms = ms(antenna.free_from);
        let gap_ms = take.from_ms - free_ms - set_up_ms(antenna);
        // The position of the antenna is unknown, so require only the set-up.
        let Some(stands_deg) = antenna.stands_deg else { return (gap_ms >= 0).then_some(0) };
        antenna.reach.leg_within_ms(stands_deg, start_deg, free_ms, gap_ms)
    }

    fn slew_ms(&self, start: usize, end: usize) -> Option<i64> {
        let (before, after) = (self.takes.get(start)?, self.takes.get(end)?);
        let antenna = self.antennas.get(before.antenna)?;
        if before.is_fixed && after.is_fixed {
            return Some(self.known_ms(start, end, i64::MAX).unwrap_or_default());
        }
        let gap_ms = after.from_ms - before.to_ms - set_up_ms(antenna);
        let longest_ms = self.longest_ms(before.antenna) - set_up_ms(antenna);
        let parks = antenna.between_passes == BetweenPasses::Park;
        if gap_ms >= longest_ms && antenna.reach.has_barriers() && !parks {
            // A path leads there in time. Its length only breaks ties, which does not justify a
            // search.
            let [[_, end_deg], [start_deg, _]] = [before.ends_deg, after.ends_deg];
            return Some(antenna.reach.straight_ms(end_deg, start_deg));
        }
        self.known_ms(start, end, if parks { gap_ms } else { gap_ms.min(longest_ms) })
    }

    fn longest_ms(&self, antenna: usize) -> i64 {
        self.longest_ms.get(antenna).copied().unwrap_or_default()
    }
}
