//! The cheapest path of an axis between two bounds, by dynamic programming on a grid of
//! positions and times.

use std::ops::Range;

use super::{Envelope, at};

/// Maximum number of positions of the grid.
const MAX_PLACES: f64 = 240.0;
/// Grid positions by which the axis turns from one time to the next at full rate.
const FULL: usize = 2;
/// Cost of turning by one grid position, so that the axis does not turn needlessly.
const TURN_COST: f64 = 1e-9;
/// The grid positions from which a position is reached, counted from `FULL` below it, and the cost
/// of the turn.
const TURNS: [(u64, f64); 2 * FULL + 1] =
    [(0, 2.0 * TURN_COST), (1, TURN_COST), (2, 0.0), (3, TURN_COST), (4, 2.0 * TURN_COST)];

/// A path on the grid.
pub(super) struct Rough {
    /// Positions, one for each interval of the slew, degrees.
    pub(super) places_deg: Vec<f64>,
    /// Grid spacing, degrees.
    pub(super) cell_deg: f64,
}

/// The cheapest path through `slew` of an axis that stands at `before_deg` one interval before the
/// slew and turns by at most `max_deg` per interval.
pub(super) fn between<P, C: Fn(&P) -> f64>(
    bounds: &Envelope,
    slew: &Range<usize>,
    before_deg: f64,
    max_deg: f64,
    prepare: &impl Fn(f64) -> P,
    cost: &impl Fn(usize) -> C,
) -> Rough {
    let low = bounds.low.get(slew.clone()).unwrap_or_default().iter();
    let high = bounds.high.get(slew.clone()).unwrap_or_default().iter();
    let min_deg = low.fold(before_deg, |least, at| least.min(*at));
    let greatest_deg = high.fold(before_deg, |greatest, at| greatest.max(*at));
    let finest_deg = (greatest_deg - min_deg) / MAX_PLACES;
    let stride = (finest_deg * FULL as f64 / max_deg).ceil().max(1.0) as usize;
    let cell_deg = max_deg * stride as f64 / FULL as f64;
    let below = ((before_deg - min_deg) / cell_deg).ceil() as usize;
    let places = below + ((greatest_deg - before_deg) / cell_deg).ceil() as usize + 1;
    let place_deg = |place: usize| before_deg + (place as f64 - below as f64) * cell_deg;
    let lowest_deg = place_deg(0);
    let prepared: Vec<P> = (0..places).map(|place| prepare(place_deg(place))).collect();

    // Beyond either end, nothing is ever cheap.
    let mut sums = vec![f64::INFINITY; places + 2 * FULL];
    let mut next = sums.clone();
    if let Some(start) = sums.get_mut(below + FULL) {
        *start = 0.0;
    }
    // By how many positions the axis turned to come to each, plus `FULL`; one list per time.
    let mut came: Vec<Vec<u64>> = Vec::new();
    let looks = slew.len().div_ceil(stride);
    for look in 1..=looks {
        let index = look.saturating_mul(stride).saturating_add(slew.start).min(slew.end);
        let index = index.saturating_sub(1);
        // The places between the bounds, widened by a cell.
        let place = |deg: f64| (deg - lowest_deg) / cell_deg;
        let first = (place(at(&bounds.low, index)) - 1.0).ceil().max(0.0) as usize;
        let after = (place(at(&bounds.high, index)) + 2.0).floor().max(0.0) as usize;
        let reach = first.min(places)..after.min(places);
        let mut from = vec![FULL as u64; places];
        next.fill(f64::INFINITY);
        if let (Some(least), Some(from), Some(prepared)) = (
            next.get_mut(reach.start + FULL..reach.end + FULL),
            from.get_mut(reach.clone()),
            prepared.get(reach.clone()),
        ) {
            for (turn, turn_cost) in TURNS {
                let before = sums.get(reach.start + turn as usize..).unwrap_or_default();
                for ((least, from), sum) in least.iter_mut().zip(from.iter_mut()).zip(before) {
                    let sum = sum + turn_cost;
                    let is_less = sum < *least;
                    *from = if is_less { turn } else { *from };
                    *least = if is_less { sum } else { *least };
                }
            }
            let cost = cost(index);
            for (sum, prepared) in least.iter_mut().zip(prepared) {
                *sum += cost(prepared);
            }
        }
        came.push(from);
        std::mem::swap(&mut sums, &mut next);
    }

    let last = sums.iter().skip(FULL).take(places).enumerate().min_by(|a, b| a.1.total_cmp(b.1));
    let mut place = last.map_or(below, |(place, _)| place);
    let mut at_looks = vec![place_deg(place)];
    for from in came.iter().rev() {
        let turned = from.get(place).copied().map_or(FULL, |turn| turn as usize);
        place = (place + turned).saturating_sub(FULL).min(places.saturating_sub(1));
        at_looks.push(place_deg(place));
    }
    at_looks.reverse();
    let place_at = |interval: usize| {
        let (look, share) = (interval / stride, (interval % stride) as f64 / stride as f64);
        let before = at(&at_looks, look);
        before + (at_looks.get(look + 1).copied().unwrap_or(before) - before) * share
    };
    Rough { places_deg: (1..=slew.len()).map(place_at).collect(), cell_deg }
}
