//! Cheapest path of an axis between two bounds, by dynamic programming on a grid of positions and
//! times.

use std::ops::Range;

use super::{Envelope, position_at};

/// Max number of positions of the grid.
const MAX_PLACES: f64 = 240.0;
/// Grid positions by which the axis turns from one time to the next at full rate.
const FULL: usize = 2;
/// Cost of turning by one grid position, so that the axis does not turn needlessly.
const TURN_COST: f64 = 1e-9;
/// Costs of the turns to a grid position, from `FULL` positions below it to `FULL` above.
const TURN_COSTS: [f64; 2 * FULL + 1] =
    [2.0 * TURN_COST, TURN_COST, 0.0, TURN_COST, 2.0 * TURN_COST];

/// Path on the grid.
pub(super) struct Rough {
    /// Positions, one for each interval of the slew, degrees.
    pub(super) places_deg: Vec<f64>,
    /// Grid spacing, degrees.
    pub(super) cell_deg: f64,
}

/// Returns the cheapest path through `slew` of an axis that stands at `before_deg` one interval
/// before the slew and turns by at most `max_deg` per interval.
pub(super) fn find<P, C: Fn(&P) -> f64>(
    bounds: &Envelope,
    slew: &Range<usize>,
    before_deg: f64,
    max_deg: f64,
    prepare: &impl Fn(f64) -> P,
    cost: &impl Fn(usize) -> C,
) -> Rough {
    let low = bounds.low.get(slew.clone()).unwrap_or_default().iter();
    let high = bounds.high.get(slew.clone()).unwrap_or_default().iter();
    let min_deg = low.fold(before_deg, |min, degrees| min.min(*degrees));
    let greatest_deg = high.fold(before_deg, |greatest, degrees| greatest.max(*degrees));
    let finest_deg = (greatest_deg - min_deg) / MAX_PLACES;
    let stride = (finest_deg * FULL as f64 / max_deg).ceil().max(1.0) as usize;
    let cell_deg = max_deg * stride as f64 / FULL as f64;
    let below = ((before_deg - min_deg) / cell_deg).ceil() as usize;
    let places = below + ((greatest_deg - before_deg) / cell_deg).ceil() as usize + 1;
    let place_deg = |place: usize| before_deg + (place as f64 - below as f64) * cell_deg;
    let lowest_deg = place_deg(0);
    let prepared: Vec<P> = (0..places).map(|place| prepare(place_deg(place))).collect();

    // `looks` counts the rows, one per time, with the cost of the cheapest path to each place.
    // Beyond either end, the cost stays infinite.
    let looks = slew.len().div_ceil(stride);
    let width = places + 2 * FULL;
    let mut sums = vec![f64::INFINITY; (looks + 1) * width];
    if let Some(start) = sums.get_mut(below + FULL) {
        *start = 0.0;
    }
    let mut rows = sums.chunks_exact_mut(width);
    let mut before: &[f64] = rows.next().unwrap_or_default();
    for (look, row) in (1..).zip(rows) {
        let index = stride.saturating_mul(look).saturating_add(slew.start).min(slew.end);
        let index = index.saturating_sub(1);
        // The range covers the places between the bounds, widened by a cell.
        let place = |deg: f64| (deg - lowest_deg) / cell_deg;
        let first = (place(position_at(&bounds.low, index)) - 1.0).ceil().max(0.0) as usize;
        let after = (place(position_at(&bounds.high, index)) + 2.0).floor().max(0.0) as usize;
        let reach = first.min(places)..after.min(places);
        if let (Some(sums), Some(prepared)) =
            (row.get_mut(reach.start + FULL..reach.end + FULL), prepared.get(reach.clone()))
        {
            let near = before.get(reach.start..).unwrap_or_default().array_windows();
            for (sum, near) in sums.iter_mut().zip(near) {
                *sum = cheapest_turn(near).1;
            }
            let cost = cost(index);
            for (sum, prepared) in sums.iter_mut().zip(prepared) {
                *sum += cost(prepared);
            }
        }
        before = row;
    }

    let last = before.iter().skip(FULL).take(places).enumerate();
    let last = last.min_by(|a, b| a.1.total_cmp(b.1));
    let mut place = last.map_or(below, |(place, _)| place);
    let mut at_looks = vec![place_deg(place)];
    for before in sums.chunks_exact(width).rev().skip(1) {
        let near = before.get(place..).and_then(|near| near.first_chunk());
        let turn = near.map_or(FULL, |near| cheapest_turn(near).0);
        place = (place + turn).saturating_sub(FULL).min(places.saturating_sub(1));
        at_looks.push(place_deg(place));
    }
    at_looks.reverse();
    let place_at = |interval: usize| {
        let (look, share) = (interval / stride, (interval % stride) as f64 / stride as f64);
        let before = position_at(&at_looks, look);
        before + (at_looks.get(look + 1).copied().unwrap_or(before) - before) * share
    };
    Rough { places_deg: (1..=slew.len()).map(place_at).collect(), cell_deg }
}

/// Returns the cheapest way to a place from the sums of the places `near` it: the index of the
/// previous place, and the sum with the turn.
fn cheapest_turn(near: &[f64; TURN_COSTS.len()]) -> (usize, f64) {
    let turns = near.iter().zip(TURN_COSTS).map(|(sum, cost)| sum + cost).enumerate();
    turns.fold((FULL, f64::INFINITY), |best, turn| if turn.1 < best.1 { turn } else { best })
}
