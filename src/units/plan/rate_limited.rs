//! Positions of a rate-limited axis along a course that may be faster, such as at the zenith or
//! during a slew of a whole turn. The axis sets out early and arrives late, which minimises the
//! pointing error.

mod cheapest;

use std::ops::Range;

/// Max difference between the two bounds of an axis that keeps up, and max turn per interval of an
/// axis that does not turn, degrees.
const SAME_DEG: f64 = 1e-6;

/// Position of an axis that is too far from its course to be on it at the first interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Departure {
    pub(super) at_deg: f64,
    /// Turn of the axis until the first interval, degrees.
    pub(super) reach_deg: f64,
}

/// Returns positions along `targets` (degrees at equal intervals) that never differ by more than
/// `max_deg` between intervals, and that an axis reaches from `departure`. If the course is slow
/// enough, they equal the course; elsewhere they minimise the sum of `cost(interval)(position)`.
/// `prepare` converts each position once for all intervals.
pub(super) fn rate_limited<P, C: Fn(&P) -> f64>(
    targets: &[f64],
    max_deg: f64,
    departure: Option<Departure>,
    prepare: impl Fn(f64) -> P,
    cost: impl Fn(usize) -> C,
) -> Vec<f64> {
    let mut steps = targets.iter().zip(targets.iter().skip(1));
    if departure.is_none() && steps.all(|(start, end)| (end - start).abs() <= max_deg) {
        return targets.to_vec();
    }
    let mut bounds = Envelope::new(targets, max_deg);
    if let Some(departure) = departure {
        bounds.keep_within_reach(departure, max_deg);
    }
    let mut way = bounds.low.clone();
    if max_deg <= SAME_DEG {
        return way;
    }
    for slew in bounds.slews() {
        let mut place = position_at(&bounds.low, slew.start.saturating_sub(1));
        let rough = cheapest::find(&bounds, &slew, place, max_deg, &prepare, &cost);
        for (index, rough_deg) in slew.zip(rough.places_deg) {
            // Within a cell of the grid, the course itself is better.
            let course = position_at(targets, index);
            let is_near = (course - rough_deg).abs() <= rough.cell_deg;
            let way_deg = if is_near { course - place } else { rough_deg - place };
            place += way_deg.min(max_deg).max(-max_deg);
            place =
                place.max(position_at(&bounds.low, index)).min(position_at(&bounds.high, index));
            if let Some(way) = way.get_mut(index) {
                *way = place;
            }
        }
    }
    way
}

/// Lowest and highest path of an axis that keeps to its rate and touches the course if possible.
/// Both are equal if the course is slow enough.
struct Envelope {
    low: Vec<f64>,
    high: Vec<f64>,
}

impl Envelope {
    fn new(targets: &[f64], max_deg: f64) -> Self {
        let mut high = lowest(targets.iter().map(|place| -place).collect(), max_deg);
        for place in &mut high {
            *place = -*place;
        }
        Self { low: lowest(targets.to_vec(), max_deg), high }
    }

    fn keep_within_reach(&mut self, departure: Departure, max_deg: f64) {
        let Departure { at_deg, reach_deg } = departure;
        for (index, (low, high)) in self.low.iter_mut().zip(&mut self.high).enumerate() {
            let turns_deg = reach_deg + max_deg * index as f64;
            for place in [low, high] {
                *place = place.max(at_deg - turns_deg).min(at_deg + turns_deg);
            }
        }
    }

    /// Returns the stretches in which the axis does not keep up.
    fn slews(&self) -> Vec<Range<usize>> {
        let mut found: Vec<Range<usize>> = Vec::new();
        for (index, (low, high)) in self.low.iter().zip(&self.high).enumerate() {
            if high - low <= SAME_DEG {
                continue;
            }
            match found.last_mut() {
                Some(last) if last.end == index => last.end += 1,
                _ => found.push(index..index + 1),
            }
        }
        found
    }
}

/// Returns the highest path of the axis that is nowhere above the course.
fn lowest(mut way: Vec<f64>, max_deg: f64) -> Vec<f64> {
    let mut before = f64::INFINITY;
    for place in &mut way {
        *place = place.min(before + max_deg);
        before = *place;
    }
    let mut after = f64::INFINITY;
    for place in way.iter_mut().rev() {
        *place = place.min(after + max_deg);
        after = *place;
    }
    way
}

fn position_at(places: &[f64], index: usize) -> f64 {
    places.get(index).copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fastest(way: &[f64]) -> f64 {
        way.windows(2).map(|two| (two[1] - two[0]).abs()).fold(0.0, f64::max)
    }

    /// Returns positions along `targets`, with errors weighted by `weight`.
    fn weighted(targets: &[f64], weight: &[f64], max_deg: f64) -> Vec<f64> {
        let cost = |index: usize| {
            move |place: &f64| weight[index] * (1.0 - (place - targets[index]).to_radians().cos())
        };
        rate_limited(targets, max_deg, None, |place| place, cost)
    }

    fn cost(way: &[f64], targets: &[f64], weight: &[f64]) -> f64 {
        let cost_of = |(way, target): (&f64, &f64)| 1.0 - (way - target).to_radians().cos();
        way.iter()
            .zip(targets)
            .map(cost_of)
            .zip(weight)
            .map(|(deviation, weight)| deviation * weight)
            .sum()
    }

    /// Returns the positions of an axis that chases the course as fast as possible.
    fn chased(targets: &[f64], max_deg: f64) -> Vec<f64> {
        let mut place = targets[0];
        let step = |target: &f64| {
            place += (target - place).clamp(-max_deg, max_deg);
            place
        };
        targets.iter().map(step).collect()
    }

    /// Returns azimuth and weight of a pass that misses the zenith by `off_deg`, a second apart.
    fn overhead(off_deg: f64) -> (Vec<f64>, Vec<f64>) {
        let along = (-300..=300).map(|second| f64::from(second) * 0.6);
        let place = |along: f64| along.atan2(off_deg).to_degrees();
        let elevation = |along: f64| (90.0 - along.hypot(off_deg).min(90.0)).to_radians();
        (
            along.clone().map(place).collect(),
            along.map(|index| elevation(index).cos().powi(2)).collect(),
        )
    }

    #[test]
    fn a_slow_course_is_followed_as_it_is() {
        let targets: Vec<f64> =
            (0..100).map(|index| (f64::from(index) * 0.1).sin() * 9.0).collect();
        assert_eq!(weighted(&targets, &[1.0; 100], 1.0), targets);
        assert!(weighted(&[], &[], 1.0).is_empty());
    }

    #[test]
    fn an_axis_that_hardly_turns_stays_where_it_is() {
        let targets: Vec<f64> = (0..100).map(f64::from).collect();
        for max_deg in [0.0, 1e-12, 1e-5] {
            let way = weighted(&targets, &[1.0; 100], max_deg);
            assert!(fastest(&way) <= max_deg + 1e-9, "{max_deg}");
        }
    }

    #[test]
    fn a_course_that_jumps_back_is_crossed_on_the_way() {
        // The course turns like an azimuth that changes sides at the zenith: 2 degrees per
        // interval, of which the axis makes half.
        let targets: Vec<f64> = (-50..50)
            .map(|step| {
                let side = if step < 0 { 0.0 } else { -180.0 };
                (f64::from(step) * 0.1).atan().to_degrees() + 90.0 + side
            })
            .collect();
        let wanted_at = targets.as_slice();
        let cost =
            |index: usize| move |place: &f64| (place - wanted_at[index]).to_radians().sin().powi(2);
        let way = rate_limited(&targets, 4.0, None, |place| place, cost);
        assert!(fastest(&way) <= 4.0 + 1e-9);
        assert!(way.iter().all(|place| place.abs() < 60.0), "{way:?}");
        assert!((way[20] - targets[20]).abs() < 0.1 && (way[80] - targets[80]).abs() < 0.1);
    }

    #[test]
    fn over_the_zenith_the_slew_begins_early_and_costs_far_less_than_going_after() {
        let (targets, weight) = overhead(2.0);
        assert!(fastest(&targets) > 10.0);
        for max_deg in [2.0, 6.0] {
            let way = weighted(&targets, &weight, max_deg);
            assert!(fastest(&way) <= max_deg + 1e-9);
            // The axis has completed half of the turn at the zenith.
            assert!(way[300].abs() < max_deg, "{}", way[300]);
            let (best, after) = (
                cost(&way, &targets, &weight),
                cost(&chased(&targets, max_deg), &targets, &weight),
            );
            assert!(best < after / 3.0, "{best} {after}");
            assert!((way[0] - targets[0]).abs() < 1e-9 && (way[600] - targets[600]).abs() < 1e-9);
        }
    }

    #[test]
    fn no_shift_of_the_slew_is_better() {
        let (targets, weight) = overhead(3.0);
        let way = weighted(&targets, &weight, 3.0);
        let best = cost(&way, &targets, &weight);
        for shift in [-4_i32, -2, 2, 4] {
            let moved: Vec<f64> = (0..601)
                .map(|index| way[usize::try_from((index + shift).clamp(0, 600)).unwrap()])
                .collect();
            assert!(cost(&moved, &targets, &weight) >= best, "{shift}");
        }
    }

    #[test]
    fn a_turn_back_is_taken_at_full_rate() {
        let targets: Vec<f64> =
            (0..200).map(|index| if index < 100 { 350.0 } else { 5.0 }).collect();
        let way = weighted(&targets, &[1.0; 200], 6.0);
        assert!(fastest(&way) <= 6.0 + 1e-9);
        let turning = way.windows(2).filter(|two| (two[0] - two[1]).abs() > 1e-9).count();
        assert_eq!(turning, 58, "345 degrees at 6 degrees");
        assert_eq!((way[0], way[199]), (350.0, 5.0));
    }
}
