//! Search for the first barrier that a range of positions reaches into.
//!
//! A check of the middle of a part settles that part for each barrier beyond the rest of the part.
//! The search checks the other barriers in its halves.

use std::{cell::Cell, rc::Rc};

use super::{
    Angle, AzEl, Barrier, BoundsAt, FINEST_DEG, Mount, Sweep, aim::Aim, near::BarrierName,
};

/// Min size of a part of a range, degrees; a smaller part counts as inside a barrier that may reach
/// into it. A motion that enters by at most half of [`FINEST_DEG`] is free.
const SMALLEST_PART_DEG: f64 = FINEST_DEG / 2.0;

/// Max number of edges that one check may examine. Beyond it, the nearest barrier counts as
/// entered: a path along a ragged edge must not delay the thread that serves all antennas.
const MAX_EDGES: usize = 20_000;
/// Max number of edges that all checks with a shared [`Budget`] may examine.
const MAX_EDGES_IN_ALL: usize = 60_000;
/// Divisor of the remaining edges for one check, so that later checks keep a share.
const LOOKS_PER_BUDGET: usize = 3;
/// Number of remaining edges below which a search ends. Even a check without a share examines each
/// barrier once.
const SPENT: usize = 2_000;
/// Cost of a part of a range besides its edges, in edges.
const EDGES_OF_PART: usize = 20;

/// Remaining budget for the checks of one search, which must not delay the thread that serves all
/// antennas.
#[derive(Debug, Clone)]
pub struct Budget {
    edges: Cell<usize>,
}

impl Default for Budget {
    fn default() -> Self {
        Self { edges: Cell::new(MAX_EDGES_IN_ALL) }
    }
}

impl Budget {
    /// Returns `true` if the rest is too small to continue a search.
    pub fn is_spent(&self) -> bool {
        self.edges.get() < SPENT
    }

    fn of_one_look(&self) -> usize {
        self.edges.get() / LOOKS_PER_BUDGET
    }

    fn spend(&self, edges: usize) {
        self.edges.set(self.edges.get().saturating_sub(edges));
    }
}

/// Barrier that a range of positions reaches into.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Reached {
    pub(super) barrier: Barrier,
    /// Direction inside the barrier.
    pub(super) direction: AzEl,
    /// `false` if the search exhausted its budget first, so the barrier only counts as reached.
    pub(super) is_settled: bool,
}

impl BoundsAt<'_> {
    /// Returns the first barrier that `sweep` reaches into: the barrier at `index`, or any that
    /// refuses motion if `index` is `None`.
    pub(super) fn blocks_from(&self, sweep: Sweep, index: Option<usize>) -> Option<Reached> {
        // The floor is level, and so may be a side of the sweep: halves would never settle that
        // case.
        if let Some(minimum) = self.minimum_elevation
            && index.is_none_or(|index| index == 0)
        {
            let lowest = self.lowest(sweep);
            if lowest.elevation.degrees() < minimum.degrees() - FINEST_DEG {
                let barrier = Barrier::MinimumElevation;
                return Some(Reached { barrier, direction: lowest, is_settled: true });
            }
        }
        let all = self.barriers(self.aim(sweep.middle())).enumerate();
        let barriers = all.filter(|(position, barrier)| {
            let is_floor = matches!(barrier.name, BarrierName::MinimumElevation);
            !is_floor && index.map_or(!barrier.warns_only, |index| *position == index)
        });
        let barriers: Rc<[usize]> = barriers.map(|(index, _)| index).collect();
        let allowed = self.budget.map_or(MAX_EDGES, Budget::of_one_look);
        let mut used = 0;
        let reached = self.first_reached(sweep, barriers, allowed, &mut used);
        if let Some(budget) = self.budget {
            budget.spend(used);
        }
        reached
    }

    /// Returns the first of these barriers that `sweep` reaches into. `allowed`: max number of
    /// edges before the search gives up; `used`: number of examined edges.
    fn first_reached(
        &self,
        sweep: Sweep,
        candidates: Rc<[usize]>,
        allowed: usize,
        used: &mut usize,
    ) -> Option<Reached> {
        let mut open = vec![(sweep, candidates)];
        while let Some((part, barriers)) = open.pop() {
            *used += EDGES_OF_PART;
            let aim = self.aim(part.middle());
            let vectors = aim.to_enu();
            let radius_deg = part.radius_deg() * self.max_beam_turn();
            // Positions on the edge are free, even if the edge covers a whole side of the sweep.
            let limit = Angle::from_degrees(radius_deg - FINEST_DEG);
            // A box of the axes does not bound a beam that points elsewhere.
            let as_box = self.box_of(part).filter(|_| aim.sky.is_none());
            let mut near = Vec::new();
            let mut nearest: Option<(usize, BarrierName<'_>, Angle)> = None;
            for index in barriers.iter().copied() {
                let Some(barrier) = self.barrier(index, aim, vectors) else { continue };
                let Some(angle) = barrier.angle_below(limit) else { continue };
                // Its cap ruled a far zone out without an examination of its edges.
                *used += barrier.cost();
                let of_box = as_box.and_then(|(az, el)| barrier.lower_bound_in_box(az, el));
                if of_box.is_some_and(|of_box| of_box.degrees() >= -FINEST_DEG) {
                    continue;
                }
                near.push(index);
                if nearest.is_none_or(|(_, _, min)| angle < min) {
                    nearest = Some((index, barrier.name, angle));
                }
            }
            let Some((index, name, angle)) = nearest else { continue };
            let is_settled = angle.degrees() < -FINEST_DEG || radius_deg < SMALLEST_PART_DEG;
            if is_settled || *used >= allowed {
                let direction = self.nearest_of(aim, index, angle);
                return Some(Reached { barrier: name.clone_of(), direction, is_settled });
            }
            let near: Rc<[usize]> = near.into();
            open.extend(part.halves().map(|half| (half, Rc::clone(&near))));
        }
        None
    }

    /// Returns the azimuths and elevations of the axis directions in `part`; `None` past the zenith
    /// or for another mount.
    fn box_of(&self, part: Sweep) -> Option<((Angle, Angle), (Angle, Angle))> {
        let Sweep([azimuths, elevations]) = part;
        let is_plain = matches!(self.bounds.mount, Mount::AzEl { .. }) && elevations.1 <= 90.0;
        let angles =
            |(start, end): (f64, f64)| (Angle::from_degrees(start), Angle::from_degrees(end));
        is_plain.then(|| (angles(azimuths), angles(elevations)))
    }

    /// Returns the direction of `aim` whose clearance from the barrier at `index` is `min`.
    fn nearest_of(&self, aim: Aim, index: usize, min: Angle) -> AzEl {
        let is_nearest = |direction: &AzEl| {
            let only = Aim { axes: *direction, sky: None };
            self.barrier(index, only, only.to_enu()).is_some_and(|own| own.angle() <= min)
        };
        aim.directions().find(is_nearest).unwrap_or(aim.axes)
    }
}

#[cfg(test)]
mod tests {
    use super::Budget;
    use crate::{
        plan::{Bounds, Sweep},
        station::{Antenna, Entered, KeepOut, Station},
    };

    /// Returns eight keep-outs all round, each with 49 teeth up to 20 degrees.
    fn saws() -> Vec<KeepOut> {
        let saw = |number: u32| {
            let from_deg = 45.0 * f64::from(number);
            let tooth = |corner: u32| {
                let elevation_deg = if corner.is_multiple_of(2) { 20.0 } else { 19.0 };
                (from_deg + 44.0 - 44.0 * f64::from(corner) / 97.0, elevation_deg)
            };
            let mut corners_deg = vec![(from_deg, 0.0), (from_deg + 44.0, 0.0)];
            corners_deg.extend((0..98).map(tooth));
            KeepOut {
                name: format!("saw {number}"),
                reason: String::new(),
                entered: Entered::Hard,
                antenna: None,
                margin_deg: 1.0,
                zone: KeepOut::zone_of(&corners_deg).unwrap(),
            }
        };
        (0..8).map(saw).collect()
    }

    /// Returns the bounds of an antenna amid the saws, and a turn just above them.
    fn above_saws(tilt_deg: f64, turn_deg: f64) -> (Bounds, Sweep) {
        let station = Station { keep_outs: saws(), ..Station::default() };
        let mut antenna = Antenna::genius("Mast", "memory:1");
        antenna.pointing_model.tilt_east_deg = tilt_deg;
        let half_beam_deg = antenna.beam_width().degrees() / 2.0;
        let lowest_deg = 21.0 + half_beam_deg + tilt_deg + 1.0;
        (Bounds::new(&station, &antenna), Sweep([(0.0, turn_deg), (lowest_deg, 89.0)]))
    }

    fn is_free_above_saws(tilt_deg: f64, turn_deg: f64, budget: Option<&Budget>) -> bool {
        let (bounds, sweep) = above_saws(tilt_deg, turn_deg);
        let now = bounds.at_time("2026-08-12T22:00:00Z".parse().unwrap());
        now.with_budget(budget).blocks(sweep, Sweep::at_position([0.0, 89.0])).is_none()
    }

    #[test]
    fn many_looks_of_one_search_do_less_and_less_work() {
        let budget = Budget::default();
        let is_free = |turn_deg| is_free_above_saws(2.0, turn_deg, Some(&budget));
        assert!(is_free(20.0));
        for _ in 0..10 {
            assert!(!is_free(360.0));
        }
        assert!(!is_free(20.0), "the work is done");
        assert!(is_free(0.1), "a short way needs little");
    }

    #[test]
    fn a_barrier_for_which_the_work_ends_too_early_stays_among_the_bounds() {
        let (bounds, place) = above_saws(2.0, 360.0);
        let now = bounds.at_time("2026-08-12T22:00:00Z".parse().unwrap());
        assert_eq!(now.without_entered(place), bounds, "it is outside of each");
        let budget = Budget::default();
        for _ in 0..40 {
            is_free_above_saws(2.0, 360.0, Some(&budget));
        }
        assert_eq!(now.with_budget(Some(&budget)).without_entered(place), bounds);
    }

    #[test]
    fn a_way_along_ragged_edges_is_free_by_its_axes_and_counts_as_blocked_by_a_tilted_beam() {
        let is_free = |tilt_deg, turn_deg| is_free_above_saws(tilt_deg, turn_deg, None);
        assert!(is_free(0.0, 360.0));
        assert!(is_free(2.0, 20.0));
        // The sweep is free, but the proof would take too long.
        assert!(!is_free(2.0, 360.0));
    }
}
