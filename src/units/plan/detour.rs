//! Detours: routes of both axes round the barriers of an antenna.

use std::{
    cmp::Reverse,
    collections::{BinaryHeap, HashMap},
};

use jiff::Timestamp;

use super::bounds::{Bounds, BoundsAt};

/// Grid spacing of the search, degrees.
const CELL_DEG: f64 = 1.0;
/// Distance of a route from all margins, degrees: more than half the distance to a diagonal
/// neighbour on the grid, so that the route is also outside between the two.
const ROOM_DEG: f64 = 0.75;
/// Maximum number of positions that a search examines: some hundredths of a second for zones
/// with many corners.
const MAX_PLACES: usize = 20_000;
/// Cost of a degree of turn, microseconds: of two routes that take equally long, the
/// straighter one is taken.
const STRAIGHT: f64 = 1000.0;

/// Travel and rates of two axes.
#[derive(Debug, Clone, Copy)]
pub struct AxisLimits {
    /// Ends of both axes, degrees as the mount counts.
    pub(crate) travel_deg: [(f64, f64); 2],
    /// Degrees per second.
    pub(crate) rates_deg_s: [f64; 2],
    /// Distance of the route from all margins, degrees.
    pub(crate) room_deg: f64,
}

impl AxisLimits {
    /// The limits of axes that come to rest within `rests_within_deg` of a commanded position.
    pub fn new(travel_deg: [(f64, f64); 2], rates_deg_s: [f64; 2], rests_within_deg: f64) -> Self {
        Self { travel_deg, rates_deg_s, room_deg: ROOM_DEG + rests_within_deg }
    }

    fn holds(&self, axes_deg: [f64; 2]) -> bool {
        let mut both = self.travel_deg.into_iter().zip(axes_deg);
        both.all(|((from, to), at)| (from..=to).contains(&at))
    }

    /// Time until both axes, which move together, have arrived, seconds.
    pub fn seconds(&self, from_deg: [f64; 2], to_deg: [f64; 2]) -> f64 {
        let each = from_deg.into_iter().zip(to_deg).zip(self.rates_deg_s);
        each.map(|((from, to), rate)| (to - from).abs() / rate).fold(0.0, f64::max)
    }
}

/// A position on the grid, relative to the start.
type Cell = (i32, i32);

const NEIGHBOURS: [Cell; 8] =
    [(1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1)];

/// The quickest route of the axes between two positions that stays outside all barriers at `at`,
/// ends included. `None` if there is no such route, or if an end is not outside.
pub fn between(
    bounds: &Bounds,
    limits: &AxisLimits,
    from_deg: [f64; 2],
    to_deg: [f64; 2],
    at: Timestamp,
) -> Option<Vec<[f64; 2]>> {
    let now = bounds.at(at);
    let room_deg = limits.room_deg * now.max_beam_turn();
    let search = Search { now, limits, room_deg, from_deg, to_deg };
    let way = search.way()?;
    Some(search.pulled_straight(&way))
}

/// The positions of the route through `turns_deg` in steps of at most `step_deg` on either axis,
/// without its start.
pub fn in_steps(turns_deg: &[[f64; 2]], step_deg: f64) -> Vec<[f64; 2]> {
    let mut places = Vec::new();
    for pair in turns_deg.windows(2) {
        let [from, to] = pair else { continue };
        let [first, second] = [to[0] - from[0], to[1] - from[1]];
        let parts = (first.abs().max(second.abs()) / step_deg).ceil().max(1.0);
        places.extend((1..=parts as u32).map(|part| {
            let share = f64::from(part) / parts;
            [from[0] + first * share, from[1] + second * share]
        }));
    }
    places
}

struct Search<'a> {
    now: BoundsAt<'a>,
    limits: &'a AxisLimits,
    /// Distance from all margins, degrees, also of a beam that turns by more than the axes.
    room_deg: f64,
    from_deg: [f64; 2],
    to_deg: [f64; 2],
}

impl Search<'_> {
    fn axes_deg(&self, (first, second): Cell) -> [f64; 2] {
        let [a, b] = self.from_deg;
        [a + f64::from(first) * CELL_DEG, b + f64::from(second) * CELL_DEG]
    }

    fn is_free(&self, axes_deg: [f64; 2], room_deg: f64) -> bool {
        self.limits.holds(axes_deg) && self.now.has_room(axes_deg, room_deg)
    }

    /// In microseconds, because integers are ordered.
    fn cost(&self, from_deg: [f64; 2], to_deg: [f64; 2]) -> u64 {
        let straight_deg = (to_deg[0] - from_deg[0]).hypot(to_deg[1] - from_deg[1]);
        (self.limits.seconds(from_deg, to_deg) * 1e6 + straight_deg * STRAIGHT) as u64
    }

    fn way(&self) -> Option<Vec<[f64; 2]>> {
        let room_deg = self.room_deg;
        // Both ends may touch the edge of the room.
        let ends = [self.from_deg, self.to_deg];
        if !ends.into_iter().all(|end| self.is_free(end, room_deg - CELL_DEG / 2.0)) {
            return None;
        }
        let mut open = BinaryHeap::new();
        // Cost and predecessor of each position; `None` for a position that is not free.
        let mut known: HashMap<Cell, Option<(u64, Cell)>> = HashMap::new();
        known.insert((0, 0), Some((0, (0, 0))));
        open.push((Reverse(self.cost(self.from_deg, self.to_deg)), (0, 0)));
        while let Some((_, place)) = open.pop() {
            let here_deg = self.axes_deg(place);
            let is_there = here_deg
                .into_iter()
                .zip(self.to_deg)
                .all(|(here, to)| (here - to).abs() <= CELL_DEG / 2.0);
            if is_there {
                return Some(self.traced(&known, place));
            }
            if known.len() > MAX_PLACES {
                return None;
            }
            let Some(Some((spent, _))) = known.get(&place).copied() else { continue };
            for (first, second) in NEIGHBOURS {
                let next = (place.0 + first, place.1 + second);
                let next_deg = self.axes_deg(next);
                let cost = spent + self.cost(here_deg, next_deg);
                let before = known.entry(next).or_insert_with(|| {
                    self.is_free(next_deg, room_deg).then_some((u64::MAX, place))
                });
                if let Some(before) = before.as_mut().filter(|before| cost < before.0) {
                    *before = (cost, place);
                    open.push((Reverse(cost + self.cost(next_deg, self.to_deg)), next));
                }
            }
        }
        None
    }

    fn traced(&self, known: &HashMap<Cell, Option<(u64, Cell)>>, end: Cell) -> Vec<[f64; 2]> {
        let before = |place: &Cell| {
            let (_, before) = known.get(place).copied().flatten()?;
            (*place != (0, 0)).then_some(before)
        };
        let places = std::iter::successors(Some(end), before);
        let mut way: Vec<[f64; 2]> = places.map(|place| self.axes_deg(place)).collect();
        way.insert(0, self.to_deg);
        way.reverse();
        way
    }

    /// Keeps only the positions at which the route turns.
    fn pulled_straight(&self, way: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let (Some(first), Some(last)) = (way.first(), way.last()) else { return Vec::new() };
        let mut turns = vec![*first];
        let mut from_deg = *first;
        for pair in way.windows(2) {
            let [before, here] = pair else { continue };
            if !self.is_straight(from_deg, *here) {
                turns.push(*before);
                from_deg = *before;
            }
        }
        turns.push(*last);
        turns
    }

    fn is_straight(&self, from_deg: [f64; 2], to_deg: [f64; 2]) -> bool {
        let places = in_steps(&[from_deg, to_deg], CELL_DEG / 2.0);
        let room_deg = self.room_deg - CELL_DEG / 2.0;
        places.into_iter().all(|place| self.is_free(place, room_deg))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        astro::Angle,
        station::{Antenna, Entered, KeepOut, Station, SunAvoidance},
    };

    fn keep_out(corners_deg: &[(f64, f64)]) -> KeepOut {
        KeepOut {
            name: "mast".to_owned(),
            entered: Entered::GoRound,
            reason: String::new(),
            antenna: None,
            margin_deg: 1.0,
            zone: KeepOut::zone_of(corners_deg).unwrap(),
        }
    }

    fn bounds(keep_outs: Vec<KeepOut>, sun_avoidance: Option<SunAvoidance>) -> Bounds {
        let mut antenna = Antenna::rc2000c("Dish", "memory:1");
        antenna.limits.minimum_elevation_deg = 0.0;
        Bounds::of(&Station { keep_outs, sun_avoidance, ..Station::default() }, &antenna)
    }

    fn noon() -> Timestamp {
        "2026-08-12T10:00:00Z".parse().unwrap()
    }

    fn limits() -> AxisLimits {
        AxisLimits::new([(0.0, 360.0), (0.0, 90.0)], [4.0, 4.0], 0.0)
    }

    fn mast(to_elevation_deg: f64) -> KeepOut {
        keep_out(&[
            (100.0, -5.0),
            (120.0, -5.0),
            (120.0, to_elevation_deg),
            (100.0, to_elevation_deg),
        ])
    }

    fn assert_outside(bounds: &Bounds, way: &[[f64; 2]]) {
        for pair in way.windows(2) {
            let [from, to] = pair else { continue };
            for part in 0..=100 {
                let share = f64::from(part) / 100.0;
                let axes = [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * share);
                let nearest = bounds.at(noon()).nearest(bounds.direction(axes)).unwrap();
                assert!(nearest.angle.degrees() >= -1e-6, "{axes:?} {nearest:?}");
            }
        }
    }

    #[test]
    fn it_leads_over_a_mast_and_stays_outside_of_its_margin() {
        let bounds = bounds(vec![mast(40.0)], None);
        let way = between(&bounds, &limits(), [80.0, 20.0], [140.0, 20.0], noon()).unwrap();
        assert_eq!((way.first(), way.last()), (Some(&[80.0, 20.0]), Some(&[140.0, 20.0])));
        assert_outside(&bounds, &way);
        let highest_deg = way.iter().map(|axes| axes[1]).fold(0.0, f64::max);
        assert!((40.0..55.0).contains(&highest_deg), "{way:?}");
        let seconds: f64 = way.windows(2).map(|pair| limits().seconds(pair[0], pair[1])).sum();
        // The azimuth alone takes 15 s, in which the elevation has time to go up.
        assert!((15.0..22.0).contains(&seconds), "{seconds} {way:?}");
    }

    #[test]
    fn where_nothing_is_in_the_way_it_is_straight() {
        let bounds = bounds(vec![mast(40.0)], None);
        let way = between(&bounds, &limits(), [200.0, 20.0], [240.2, 61.7], noon());
        assert_eq!(way, Some(vec![[200.0, 20.0], [240.2, 61.7]]));
    }

    #[test]
    fn a_wall_up_to_the_zenith_is_gone_round_the_other_way_or_not_at_all() {
        let wall = bounds(vec![mast(89.0)], None);
        let way = between(&wall, &limits(), [80.0, 20.0], [140.0, 20.0], noon());
        // The azimuth axis ends in the north.
        assert_eq!(way, None);
        let over = AxisLimits::new([(-300.0, 360.0), (0.0, 90.0)], [4.0, 4.0], 0.0);
        let way = between(&wall, &over, [80.0, 20.0], [140.0 - 360.0, 20.0], noon()).unwrap();
        assert_outside(&wall, &way);
    }

    #[test]
    fn no_way_begins_or_ends_inside() {
        let bounds = bounds(vec![mast(40.0)], None);
        assert_eq!(between(&bounds, &limits(), [110.0, 20.0], [140.0, 20.0], noon()), None);
        assert_eq!(between(&bounds, &limits(), [80.0, 20.0], [110.0, 20.0], noon()), None);
    }

    #[test]
    fn the_sun_is_gone_round_too() {
        let avoidance = SunAvoidance { radius_deg: 8.0, ahead_min: 5.0 };
        let bounds = bounds(Vec::new(), Some(avoidance));
        let sun = crate::astro::sun_moon::sun(Station::default().site, noon());
        let [azimuth, elevation] = [sun.azimuth_deg(), sun.elevation_deg()];
        assert!(elevation > 20.0 && (30.0..330.0).contains(&azimuth), "{sun:?}");
        let ends = [azimuth - 25.0, azimuth + 25.0].map(|azimuth| [azimuth, elevation]);
        let way = between(&bounds, &limits(), ends[0], ends[1], noon()).unwrap();
        assert_outside(&bounds, &way);
        assert!(way.len() > 2, "{way:?}");
        assert!(bounds.direction(ends[0]).separation(sun) > Angle::from_degrees(8.0));
    }
}
