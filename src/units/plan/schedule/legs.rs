//! The slews between takes, by the real axes of each antenna.

use std::{cell::RefCell, collections::HashMap};

use super::{
    request::PlannedAntenna,
    solve::{Leg, Slews, Take},
    way::ms,
};
use crate::station::BetweenPasses;

/// Where the axes stand at both ends of a take, degrees as the mount counts.
pub(super) type Ends = [[f64; 2]; 2];

/// The takes of a schedule with the ways between them.
pub(super) struct Legs<'a> {
    antennas: &'a [PlannedAntenna],
    takes: Vec<Stop>,
    longest_ms: Vec<i64>,
    /// Ways past what must not be entered are searched for once.
    found: RefCell<HashMap<(usize, usize), i64>>,
}

struct Stop {
    antenna: usize,
    from_ms: i64,
    to_ms: i64,
    ends_deg: Ends,
    from_park_ms: i64,
    to_park_ms: i64,
    is_fixed: bool,
}

impl<'a> Legs<'a> {
    /// `takes` with the places of the axes at both ends, and whether they are fixed.
    pub(super) fn new(
        antennas: &'a [PlannedAntenna],
        takes: impl Iterator<Item = (Take, Ends, bool)>,
    ) -> Self {
        let mut stops: Vec<Stop> = Vec::new();
        for (take, ends_deg, is_fixed) in takes {
            let index = take.antenna as usize;
            let Take { from_ms, to_ms, .. } = take;
            let park = antennas.get(index).map_or((0, 0), |antenna| {
                let (reach, [start, end]) = (&antenna.reach, ends_deg);
                let there = reach.leg_ms(reach.park_deg(), start, from_ms);
                let back = reach.leg_ms(end, reach.park_deg(), to_ms);
                (
                    there.unwrap_or_else(|| reach.straight_ms(reach.park_deg(), start)),
                    back.unwrap_or_else(|| reach.straight_ms(end, reach.park_deg())),
                )
            });
            let (from_park_ms, to_park_ms) = park;
            let stop = Stop {
                antenna: index,
                from_ms,
                to_ms,
                ends_deg,
                from_park_ms,
                to_park_ms,
                is_fixed,
            };
            stops.push(stop);
        }
        let longest_ms = antennas.iter().enumerate().map(|(index, antenna)| {
            let own = || stops.iter().filter(|stop| stop.antenna == index);
            let by_park = own().map(|stop| stop.from_park_ms).max().unwrap_or_default()
                + own().map(|stop| stop.to_park_ms).max().unwrap_or_default();
            let places = own().flat_map(|stop| stop.ends_deg);
            let direct = antenna.reach.widest_ms(places);
            let parks = antenna.between == BetweenPasses::Park || antenna.reach.has_barriers();
            (if parks { by_park.max(direct) } else { direct }) + set_up_ms(antenna)
        });
        let longest_ms = longest_ms.collect();
        Self { antennas, takes: stops, longest_ms, found: RefCell::default() }
    }

    fn direct_ms(&self, antenna: &PlannedAntenna, from: usize, to: usize) -> i64 {
        let (Some(before), Some(after)) = (self.takes.get(from), self.takes.get(to)) else {
            return 0;
        };
        let (reach, [_, end], [start, _]) = (&antenna.reach, before.ends_deg, after.ends_deg);
        if !reach.has_barriers() {
            return reach.leg_ms(end, start, before.to_ms).unwrap_or_default();
        }
        if let Some(found) = self.found.borrow().get(&(from, to)) {
            return *found;
        }
        let by_park_ms = before.to_park_ms + after.from_park_ms;
        let direct = reach.leg_ms(end, start, before.to_ms);
        let found = direct.map_or(by_park_ms, |direct| direct.min(by_park_ms));
        self.found.borrow_mut().insert((from, to), found);
        found
    }
}

pub(super) fn set_up_ms(antenna: &PlannedAntenna) -> i64 {
    (antenna.set_up_s * 1000.0).ceil() as i64
}

impl Slews for Legs<'_> {
    fn first_ms(&self, to: usize) -> Option<i64> {
        let take = self.takes.get(to)?;
        if take.is_fixed {
            return Some(0);
        }
        let antenna = self.antennas.get(take.antenna)?;
        let (start, _) = (take.ends_deg[0], take.ends_deg[1]);
        let free_ms = ms(antenna.free_from);
        let slew_ms = match antenna.stands_deg {
            None => 0,
            Some(stands) => antenna.reach.leg_ms(stands, start, free_ms)?,
        };
        (free_ms + slew_ms + set_up_ms(antenna) <= take.from_ms).then_some(slew_ms)
    }

    fn between(&self, from: usize, to: usize) -> Leg {
        let none = Leg { needs_ms: 0, slew_ms: 0 };
        let (Some(before), Some(after)) = (self.takes.get(from), self.takes.get(to)) else {
            return none;
        };
        let Some(antenna) = self.antennas.get(before.antenna) else { return none };
        let set_up_ms = set_up_ms(antenna);
        let direct_ms = self.direct_ms(antenna, from, to);
        if before.is_fixed && after.is_fixed {
            return Leg { needs_ms: 0, slew_ms: direct_ms };
        }
        let by_park_ms = before.to_park_ms + after.from_park_ms;
        let parks = antenna.between == BetweenPasses::Park
            && before.to_ms + by_park_ms + set_up_ms <= after.from_ms;
        let slew_ms = if parks { by_park_ms } else { direct_ms };
        Leg { needs_ms: direct_ms + set_up_ms, slew_ms }
    }

    fn longest_ms(&self, antenna: usize) -> i64 {
        self.longest_ms.get(antenna).copied().unwrap_or_default()
    }
}
