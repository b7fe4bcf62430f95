//! The way of an axis that turns only so fast along a course that may be faster,
//! as at the zenith or where the axis has to go round by a turn: it sets out
//! early and comes in late, so that the error in the sky is least.

use std::ops::Range;

/// Between the two bounds of an axis that keeps up, degrees.
const SAME_DEG: f64 = 1e-6;
/// So many beginnings of a swing are tried.
const TRIED: usize = 200;

/// A way along `wanted` (positions of an axis at equal intervals, degrees) that
/// never turns by more than `most_deg` in an interval. Where the course is not
/// faster it is the course itself. `weight` is what an error of the axis counts
/// for in the sky, such as the square of the cosine of the elevation.
pub(super) fn within_rate(wanted: &[f64], weight: &[f64], most_deg: f64) -> Vec<f64> {
    let Bounds { low, high } = Bounds::around(wanted, most_deg);
    let mut way = low.clone();
    for swing in swings(&low, &high) {
        let Some((first, last)) = ends(wanted, &swing) else { continue };
        let slope_deg = most_deg.copysign(last - first);
        let eased = |index: usize, begin: usize| {
            let steps = index as f64 - begin as f64;
            let line = first + slope_deg * steps;
            let (low, high) = (at(&low, index), at(&high, index));
            line.max(low).min(high)
        };
        let cost = |begin: usize| -> f64 {
            let error = |index: usize| {
                let off = (eased(index, begin) - at(wanted, index)).to_radians();
                at(weight, index) * (1.0 - off.cos())
            };
            swing.clone().map(error).sum()
        };
        let stride = swing.len().div_ceil(TRIED).max(1);
        let begins = swing.clone().step_by(stride).map(|begin| (begin, cost(begin)));
        let Some((begin, _)) = begins.min_by(|a, b| a.1.total_cmp(&b.1)) else { continue };
        for index in swing {
            if let Some(place) = way.get_mut(index) {
                *place = eased(index, begin);
            }
        }
    }
    way
}

/// The lowest and the highest way of an axis that keeps to its rate and touches
/// the course where it can. They are the same where the course is slow enough.
struct Bounds {
    low: Vec<f64>,
    high: Vec<f64>,
}

impl Bounds {
    fn around(wanted: &[f64], most_deg: f64) -> Self {
        let negated: Vec<f64> = wanted.iter().map(|place| -place).collect();
        let high = lowest(&negated, most_deg).into_iter().map(|place| -place).collect();
        Self { low: lowest(wanted, most_deg), high }
    }
}

/// The highest way that is nowhere above the course.
fn lowest(wanted: &[f64], most_deg: f64) -> Vec<f64> {
    let mut way = wanted.to_vec();
    let mut before = f64::INFINITY;
    for place in &mut way {
        *place = place.min(before + most_deg);
        before = *place;
    }
    let mut after = f64::INFINITY;
    for place in way.iter_mut().rev() {
        *place = place.min(after + most_deg);
        after = *place;
    }
    way
}

/// The stretches in which the axis does not keep up.
fn swings(low: &[f64], high: &[f64]) -> Vec<Range<usize>> {
    let mut found: Vec<Range<usize>> = Vec::new();
    for (index, (low, high)) in low.iter().zip(high).enumerate() {
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

/// Where the course is before a swing and after it.
fn ends(wanted: &[f64], swing: &Range<usize>) -> Option<(f64, f64)> {
    let last = swing.end.min(wanted.len().checked_sub(1)?);
    Some((*wanted.get(swing.start.saturating_sub(1))?, *wanted.get(last)?))
}

fn at(places: &[f64], index: usize) -> f64 {
    places.get(index).copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fastest(way: &[f64]) -> f64 {
        way.windows(2).map(|two| (two[1] - two[0]).abs()).fold(0.0, f64::max)
    }

    fn cost(way: &[f64], wanted: &[f64], weight: &[f64]) -> f64 {
        let off = |(way, wanted): (&f64, &f64)| 1.0 - (way - wanted).to_radians().cos();
        way.iter().zip(wanted).map(off).zip(weight).map(|(off, weight)| off * weight).sum()
    }

    /// Where an axis would be that goes after the course as fast as it can.
    fn chased(wanted: &[f64], most_deg: f64) -> Vec<f64> {
        let mut place = wanted[0];
        let step = |wanted: &f64| {
            place += (wanted - place).clamp(-most_deg, most_deg);
            place
        };
        wanted.iter().map(step).collect()
    }

    /// Azimuth and weight of a pass straight over the zenith but for `off_deg`,
    /// a second apart.
    fn overhead(off_deg: f64) -> (Vec<f64>, Vec<f64>) {
        let along = (-300..=300).map(|second| f64::from(second) * 0.6);
        let place = |along: f64| along.atan2(off_deg).to_degrees();
        let elevation = |along: f64| (90.0 - along.hypot(off_deg).min(90.0)).to_radians();
        (along.clone().map(place).collect(), along.map(|at| elevation(at).cos().powi(2)).collect())
    }

    #[test]
    fn a_slow_course_is_followed_as_it_is() {
        let wanted: Vec<f64> = (0..100).map(|at| (f64::from(at) * 0.1).sin() * 9.0).collect();
        assert_eq!(within_rate(&wanted, &[1.0; 100], 1.0), wanted);
        assert!(within_rate(&[], &[], 1.0).is_empty());
    }

    #[test]
    fn over_the_zenith_the_swing_begins_early_and_costs_far_less_than_going_after() {
        let (wanted, weight) = overhead(2.0);
        assert!(fastest(&wanted) > 10.0);
        for most_deg in [2.0, 6.0] {
            let way = within_rate(&wanted, &weight, most_deg);
            assert!(fastest(&way) <= most_deg + 1e-9);
            // Half of it is done at the zenith.
            assert!(way[300].abs() < most_deg, "{}", way[300]);
            let (best, after) =
                (cost(&way, &wanted, &weight), cost(&chased(&wanted, most_deg), &wanted, &weight));
            assert!(best < after / 3.0, "{best} {after}");
            assert!((way[0] - wanted[0]).abs() < 1e-9 && (way[600] - wanted[600]).abs() < 1e-9);
        }
    }

    #[test]
    fn no_shift_of_the_swing_is_better() {
        let (wanted, weight) = overhead(3.0);
        let way = within_rate(&wanted, &weight, 3.0);
        let best = cost(&way, &wanted, &weight);
        for shift in [-4_i32, -2, 2, 4] {
            let moved: Vec<f64> = (0..601)
                .map(|at| way[usize::try_from((at + shift).clamp(0, 600)).unwrap()])
                .collect();
            assert!(cost(&moved, &wanted, &weight) >= best, "{shift}");
        }
    }

    #[test]
    fn a_turn_back_is_taken_at_full_rate() {
        let wanted: Vec<f64> = (0..200).map(|at| if at < 100 { 350.0 } else { 5.0 }).collect();
        let way = within_rate(&wanted, &[1.0; 200], 6.0);
        assert!(fastest(&way) <= 6.0 + 1e-9);
        let turning = way.windows(2).filter(|two| (two[0] - two[1]).abs() > 1e-9).count();
        assert_eq!(turning, 58, "345 degrees at 6 degrees");
        assert_eq!((way[0], way[199]), (350.0, 5.0));
    }
}
