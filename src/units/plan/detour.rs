//! Detours: routes of both axes round the barriers of an antenna.

use std::{cmp::Reverse, collections::BinaryHeap, ops::RangeInclusive};

use super::bounds::BoundsAt;

/// Grid spacing of the search, degrees.
const CELL_DEG: f64 = 1.0;
/// Distance of a route from all margins, degrees: more than half the distance to a diagonal
/// neighbour on the grid, so that the route also stays outside between the two.
const ROOM_DEG: f64 = 0.75;
/// Max number of positions that a search examines: some hundredths of a second for zones with many
/// corners.
const MAX_PLACES: usize = 20_000;
/// Weight of the remaining distance in a search for any route, which makes the search head for the
/// end.
const GREED: u64 = 4;
/// Max number of grid positions from the start; no travel is longer.
const MAX_CELLS: i32 = 1_000;
/// Cost of a degree of turn, microseconds: of two routes with equal durations, the search takes the
/// straighter one.
const STRAIGHT: f64 = 1000.0;

/// Travel and rates of two axes.
#[derive(Debug, Clone, Copy)]
pub struct AxisLimits {
    /// Ends of both axes, degrees as the mount counts.
    pub(crate) travel_deg: [(f64, f64); 2],
    /// Max rates of both axes, degrees per second.
    pub(crate) rates_deg_s: [f64; 2],
    /// Distance of the route from all margins, degrees.
    pub(crate) room_deg: f64,
}

impl AxisLimits {
    /// Creates the limits of axes that come to rest within `rests_within_deg` of a commanded
    /// position.
    pub fn new(travel_deg: [(f64, f64); 2], rates_deg_s: [f64; 2], rests_within_deg: f64) -> Self {
        Self { travel_deg, rates_deg_s, room_deg: ROOM_DEG + rests_within_deg }
    }

    fn holds(&self, axes_deg: [f64; 2]) -> bool {
        let mut axes = self.travel_deg.into_iter().zip(axes_deg);
        axes.all(|((start, end), degrees)| (start..=end).contains(&degrees))
    }

    /// Returns the time until both axes, which move together, have arrived, seconds.
    pub fn seconds(&self, from_deg: [f64; 2], to_deg: [f64; 2]) -> f64 {
        let axes = from_deg.into_iter().zip(to_deg).zip(self.rates_deg_s);
        axes.map(|((start, end), rate)| (end - start).abs() / rate).fold(0.0, f64::max)
    }
}

/// Position on the grid, relative to the start.
type Cell = (i32, i32);

const NEIGHBOURS: [Cell; 8] =
    [(1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1)];

/// Returns the quickest route of the axes between two positions that stays outside all barriers of
/// `now`, including the ends. Returns `None` without such a route, or if an end is not outside.
pub fn route(
    now: &BoundsAt<'_>,
    limits: &AxisLimits,
    from_deg: [f64; 2],
    to_deg: [f64; 2],
) -> Option<Vec<[f64; 2]>> {
    between_within(now, limits, (from_deg, to_deg), f64::INFINITY)
}

/// Does the same as [`route`], but skips routes that take much more than `max_s` seconds.
pub fn between_within(
    now: &BoundsAt<'_>,
    limits: &AxisLimits,
    (from_deg, to_deg): ([f64; 2], [f64; 2]),
    max_s: f64,
) -> Option<Vec<[f64; 2]>> {
    let search = RouteSearch::new(now, limits, (from_deg, to_deg));
    // The cost includes the length of a route.
    let max = (max_s * 1.1 + 1.0) * 1e6;
    let way = search.way(max as u64, 1)?;
    Some(search.pulled_straight(&way))
}

/// Returns `true` if [`route`] would find a route between the positions.
pub fn leads(
    now: &BoundsAt<'_>,
    limits: &AxisLimits,
    from_deg: [f64; 2],
    to_deg: [f64; 2],
) -> bool {
    RouteSearch::new(now, limits, (from_deg, to_deg)).way(u64::MAX, GREED).is_some()
}

/// Returns the positions of the route through `turns_deg` in steps of at most `step_deg` on either
/// axis, without its start.
pub fn in_steps(turns_deg: &[[f64; 2]], step_deg: f64) -> Vec<[f64; 2]> {
    let mut places = Vec::new();
    for pair in turns_deg.windows(2) {
        let [start, end] = pair else { continue };
        let [first, second] = [end[0] - start[0], end[1] - start[1]];
        let parts = (first.abs().max(second.abs()) / step_deg).ceil().max(1.0);
        places.extend((1..=parts as u32).map(|part| {
            let share = f64::from(part) / parts;
            [start[0] + first * share, start[1] + second * share]
        }));
    }
    places
}

/// State of a position in a search.
#[derive(Debug, Clone, Copy)]
enum Place {
    Unknown,
    /// Blocked position.
    Taken,
    Known {
        spent: u64,
        before: Cell,
    },
}

/// Positions within the travel of both axes.
struct Grid {
    first: RangeInclusive<i32>,
    second: RangeInclusive<i32>,
    places: Vec<Place>,
}

impl Grid {
    fn new(travel_deg: [(f64, f64); 2], from_deg: [f64; 2]) -> Self {
        let range = |(min_deg, max_deg): (f64, f64), from_deg: f64| {
            let cells = |to_deg: f64| ((to_deg - from_deg) / CELL_DEG) as i32;
            cells(min_deg).max(-MAX_CELLS)..=cells(max_deg).min(MAX_CELLS)
        };
        let [first, second] = travel_deg;
        let first = range(first, from_deg[0]);
        let second = range(second, from_deg[1]);
        let count = first.clone().count() * second.clone().count();
        Self { first, second, places: vec![Place::Unknown; count] }
    }

    fn index(&self, (first, second): Cell) -> Option<usize> {
        if !self.first.contains(&first) || !self.second.contains(&second) {
            return None;
        }
        let row = usize::try_from(first - self.first.start()).ok()?;
        let column = usize::try_from(second - self.second.start()).ok()?;
        Some(row * self.second.clone().count() + column)
    }

    fn place(&self, cell: Cell) -> Place {
        let place = self.index(cell).and_then(|index| self.places.get(index));
        place.copied().unwrap_or(Place::Taken)
    }

    fn put(&mut self, cell: Cell, place: Place) {
        let index = self.index(cell);
        if let Some(old) = index.and_then(|index| self.places.get_mut(index)) {
            *old = place;
        }
    }
}

struct RouteSearch<'a> {
    now: &'a BoundsAt<'a>,
    limits: &'a AxisLimits,
    /// Distance from all margins, degrees, also for a beam that turns by more than the axes.
    room_deg: f64,
    from_deg: [f64; 2],
    to_deg: [f64; 2],
}

impl<'a> RouteSearch<'a> {
    fn new(
        now: &'a BoundsAt<'a>,
        limits: &'a AxisLimits,
        (from_deg, to_deg): ([f64; 2], [f64; 2]),
    ) -> Self {
        let room_deg = limits.room_deg * now.max_beam_turn();
        Self { now, limits, room_deg, from_deg, to_deg }
    }

    fn axes_deg(&self, (first, second): Cell) -> [f64; 2] {
        let [a, b] = self.from_deg;
        [a + f64::from(first) * CELL_DEG, b + f64::from(second) * CELL_DEG]
    }

    fn is_free(&self, axes_deg: [f64; 2], room_deg: f64) -> bool {
        self.limits.holds(axes_deg) && self.now.has_room(axes_deg, room_deg)
    }

    /// Returns the cost in microseconds, because integers are ordered.
    fn cost(&self, from_deg: [f64; 2], to_deg: [f64; 2]) -> u64 {
        let straight_deg = (to_deg[0] - from_deg[0]).hypot(to_deg[1] - from_deg[1]);
        (self.limits.seconds(from_deg, to_deg) * 1e6 + straight_deg * STRAIGHT) as u64
    }

    /// Returns a route that costs at most `max`: the cheapest one with a `greed` of 1.
    fn way(&self, max: u64, greed: u64) -> Option<Vec<[f64; 2]>> {
        let room_deg = self.room_deg;
        // Both ends may touch the edge of the room.
        let ends = [self.from_deg, self.to_deg];
        if !ends.into_iter().all(|end| self.is_free(end, room_deg - CELL_DEG / 2.0)) {
            return None;
        }
        let mut open = BinaryHeap::new();
        let mut grid = Grid::new(self.limits.travel_deg, self.from_deg);
        grid.put((0, 0), Place::Known { spent: 0, before: (0, 0) });
        open.push((Reverse(self.cost(self.from_deg, self.to_deg)), (0, 0), 0));
        let steps = NEIGHBOURS.map(|(first, second)| {
            self.cost([0.0; 2], [f64::from(first) * CELL_DEG, f64::from(second) * CELL_DEG])
        });
        let mut count = 1;
        while let Some((_, place, spent)) = open.pop() {
            let is_reached_for_less = match grid.place(place) {
                Place::Known { spent: min, .. } => min < spent,
                Place::Unknown | Place::Taken => true,
            };
            if is_reached_for_less {
                continue;
            }
            let here_deg = self.axes_deg(place);
            if self.is_last(here_deg) {
                return Some(self.traced(&grid, place));
            }
            if count > MAX_PLACES {
                return None;
            }
            for ((first, second), step) in NEIGHBOURS.into_iter().zip(steps) {
                let next = (place.0 + first, place.1 + second);
                let next_deg = self.axes_deg(next);
                let reached = match grid.place(next) {
                    Place::Taken => continue,
                    Place::Known { spent, .. } => Some(spent),
                    Place::Unknown => {
                        count += 1;
                        if !self.is_free(next_deg, room_deg) {
                            grid.put(next, Place::Taken);
                            continue;
                        }
                        None
                    }
                };
                let cost = spent + step;
                // In a search for any route, keep the first route to a place.
                let is_better = reached.is_none_or(|reached| cost < reached && greed == 1);
                if !is_better {
                    continue;
                }
                let whole = cost + greed * self.cost(next_deg, self.to_deg);
                if whole <= max {
                    grid.put(next, Place::Known { spent: cost, before: place });
                    open.push((Reverse(whole), next, cost));
                }
            }
        }
        None
    }

    /// Returns `true` if the route may go straight to the end from here. Beside a margin, the grid
    /// position nearest to the end may not be free.
    fn is_last(&self, here_deg: [f64; 2]) -> bool {
        let is_within = |max_deg| {
            let mut axes = here_deg.into_iter().zip(self.to_deg);
            axes.all(|(here, end)| (here - end).abs() <= max_deg)
        };
        is_within(CELL_DEG / 2.0)
            || is_within(1.5 * CELL_DEG) && self.is_straight(here_deg, self.to_deg)
    }

    fn traced(&self, grid: &Grid, end: Cell) -> Vec<[f64; 2]> {
        let before = |place: &Cell| match grid.place(*place) {
            Place::Known { before, .. } => (*place != (0, 0)).then_some(before),
            Place::Unknown | Place::Taken => None,
        };
        let places = std::iter::successors(Some(end), before);
        let mut way: Vec<[f64; 2]> = places.map(|place| self.axes_deg(place)).collect();
        way.insert(0, self.to_deg);
        way.reverse();
        way
    }

    /// Keeps only the positions at which the route turns. A binary search from each position finds
    /// how far the route can go straight.
    fn pulled_straight(&self, way: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let mut turns = Vec::from_iter(way.first().copied());
        let mut rest = way;
        while let [from_deg, ahead @ ..] = rest
            && !ahead.is_empty()
        {
            let straight = ahead.partition_point(|to_deg| self.is_straight(*from_deg, *to_deg));
            // The next position of the search is straight ahead.
            rest = ahead.get(straight.saturating_sub(1)..).unwrap_or_default();
            turns.extend(rest.first());
        }
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
    use jiff::Timestamp;

    use super::*;
    use crate::{
        astro::Angle,
        plan::Bounds,
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
        Bounds::new(&Station { keep_outs, sun_avoidance, ..Station::default() }, &antenna)
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
            let [start, end] = pair else { continue };
            for part in 0..=100 {
                let share = f64::from(part) / 100.0;
                let axes = [0, 1].map(|axis| start[axis] + (end[axis] - start[axis]) * share);
                let nearest = bounds.at_time(noon()).nearest(bounds.direction(axes)).unwrap();
                assert!(nearest.angle.degrees() >= -1e-6, "{axes:?} {nearest:?}");
            }
        }
    }

    #[test]
    fn it_leads_over_a_mast_and_stays_outside_of_its_margin() {
        let bounds = bounds(vec![mast(40.0)], None);
        let way = route(&bounds.at_time(noon()), &limits(), [80.0, 20.0], [140.0, 20.0]).unwrap();
        assert_eq!((way.first(), way.last()), (Some(&[80.0, 20.0]), Some(&[140.0, 20.0])));
        assert_outside(&bounds, &way);
        let highest_deg = way.iter().map(|axes| axes[1]).fold(0.0, f64::max);
        assert!((40.0..55.0).contains(&highest_deg), "{way:?}");
        let seconds: f64 = way.windows(2).map(|pair| limits().seconds(pair[0], pair[1])).sum();
        // The azimuth alone takes 15 s, during which the elevation has time to rise.
        assert!((15.0..22.0).contains(&seconds), "{seconds} {way:?}");
    }

    #[test]
    fn a_way_ends_beside_a_margin_wherever_it_begins() {
        let bounds = bounds(vec![mast(40.0)], None);
        let now = bounds.at_time(noon());
        for azimuth_deg in [110.0, 110.3, 109.7] {
            let up = (0..200).map(|step| [azimuth_deg, 40.0 + 0.05 * f64::from(step)]);
            // A route needs a quarter of a degree at its end.
            let mut ends = up.filter(|place| now.has_room(*place, ROOM_DEG - CELL_DEG / 2.0));
            let to_deg = ends.next().unwrap();
            for part in 0..100 {
                let (first, second) = (f64::from(part % 10) / 10.0, f64::from(part / 10) / 10.0);
                let from_deg = [80.0 + first, 20.0 + second];
                assert!(leads(&now, &limits(), from_deg, to_deg), "{from_deg:?} {to_deg:?}");
                let way = route(&now, &limits(), from_deg, to_deg).unwrap();
                assert_outside(&bounds, &way);
            }
        }
    }

    #[test]
    fn where_nothing_is_in_the_way_it_is_straight() {
        let bounds = bounds(vec![mast(40.0)], None);
        let way = route(&bounds.at_time(noon()), &limits(), [200.0, 20.0], [240.2, 61.7]);
        assert_eq!(way, Some(vec![[200.0, 20.0], [240.2, 61.7]]));
    }

    #[test]
    fn a_wall_up_to_the_zenith_is_gone_round_the_other_way_or_not_at_all() {
        let wall = bounds(vec![mast(89.0)], None);
        let way = route(&wall.at_time(noon()), &limits(), [80.0, 20.0], [140.0, 20.0]);
        // The azimuth axis ends in the north.
        assert_eq!(way, None);
        let wide_limits = AxisLimits::new([(-300.0, 360.0), (0.0, 90.0)], [4.0, 4.0], 0.0);
        let way = route(&wall.at_time(noon()), &wide_limits, [80.0, 20.0], [140.0 - 360.0, 20.0])
            .unwrap();
        assert_outside(&wall, &way);
    }

    #[test]
    fn no_way_begins_or_ends_inside() {
        let bounds = bounds(vec![mast(40.0)], None);
        assert_eq!(route(&bounds.at_time(noon()), &limits(), [110.0, 20.0], [140.0, 20.0]), None);
        assert_eq!(route(&bounds.at_time(noon()), &limits(), [80.0, 20.0], [110.0, 20.0]), None);
    }

    #[test]
    fn the_sun_is_gone_round_too() {
        let avoidance = SunAvoidance { radius_deg: 8.0, ahead_min: 5.0 };
        let bounds = bounds(Vec::new(), Some(avoidance));
        let sun = crate::astro::sun_moon::sun(Station::default().site, noon());
        let [azimuth, elevation] = [sun.azimuth_deg(), sun.elevation_deg()];
        assert!(elevation > 20.0 && (30.0..330.0).contains(&azimuth), "{sun:?}");
        let ends = [azimuth - 25.0, azimuth + 25.0].map(|azimuth| [azimuth, elevation]);
        let way = route(&bounds.at_time(noon()), &limits(), ends[0], ends[1]).unwrap();
        assert_outside(&bounds, &way);
        assert!(way.len() > 2, "{way:?}");
        assert!(bounds.direction(ends[0]).separation(sun) > Angle::from_degrees(8.0));
    }
}
