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
    let prepared: Vec<P> = (0..places).map(|place| prepare(place_deg(place))).collect();

    let mut sums = vec![f64::INFINITY; places];
    if let Some(start) = sums.get_mut(below) {
        *start = 0.0;
    }
    // The best predecessor of each position, one list per time.
    let mut came: Vec<Vec<usize>> = Vec::new();
    let looks = slew.len().div_ceil(stride);
    for look in 1..=looks {
        let index = look.saturating_mul(stride).saturating_add(slew.start).min(slew.end);
        let index = index.saturating_sub(1);
        let lowest_deg = at(&bounds.low, index) - cell_deg;
        let highest_deg = at(&bounds.high, index) + cell_deg;
        let cost = cost(index);
        let best = |(place, prepared): (usize, &P)| {
            let deg = place_deg(place);
            if deg < lowest_deg || deg > highest_deg {
                return (place, f64::INFINITY);
            }
            let nearby = place.saturating_sub(FULL)..=place + FULL;
            let from = nearby.filter_map(|from| {
                let turn_cost = TURN_COST * from.abs_diff(place) as f64;
                Some((from, sums.get(from)? + turn_cost))
            });
            let (from, sum) =
                from.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((place, f64::INFINITY));
            (from, sum + cost(prepared))
        };
        let (from, next): (Vec<usize>, Vec<f64>) = prepared.iter().enumerate().map(best).unzip();
        came.push(from);
        sums = next;
    }

    let last = sums.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1));
    let mut place = last.map_or(below, |(place, _)| place);
    let mut at_looks = vec![place_deg(place)];
    for from in came.iter().rev() {
        place = from.get(place).copied().unwrap_or(place);
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
