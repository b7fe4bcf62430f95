//! Elevation over azimuth: the positions of both axes along a pass. Neither axis exceeds its rate,
//! so the azimuth sets out early for an overhead pass. The elevation then keeps the error as small
//! as possible.
//!
//! An elevation axis that travels over the zenith reaches every direction in two ways, plain and
//! flipped. The planner tries all flips of a pass and takes the best one.

mod flip;
mod view;

use super::{
    Sample,
    azimuth_wrap::{AzimuthRange, AzimuthWrap},
    rate_limited::{Departure, rate_limited},
};
use crate::astro::{Angle, AzEl};
pub(super) use flip::{Flip, FlipChoice};
use view::{ElevationEnds, SinCos, View, sin_cos};

/// Min improvement in pointing for a flip other than the preferred one, degrees. A smaller one does
/// not justify moving the elevation over the zenith.
const WORTH_DEG: f64 = 0.1;
/// Max time in which an axis that reaches its course counts as on it from the beginning, seconds.
const ON_COURSE_S: f64 = 5.0;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AzElAxes {
    /// Ends of the azimuth axis, degrees.
    pub(super) azimuth_deg: (f64, f64),
    /// Usable ends of the elevation axis, degrees, beyond 90 over the zenith; `None` if only the
    /// azimuth turns.
    pub(super) elevation_deg: Option<(f64, f64)>,
    /// Rate of each axis, degrees per second.
    pub(super) rates_deg_s: [f64; 2],
}

/// Positions of both axes, and the time until a pass.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Start {
    /// Axis positions, degrees as the mount counts; `None` if unknown.
    pub(super) axes_deg: [Option<f64>; 2],
    pub(super) lead_s: f64,
    /// `true` if the path begins at a position that the axes can reach by its first sample. If
    /// `false`, it begins on the target, and the axes catch up.
    pub(super) sets_out: bool,
}

impl Start {
    /// Returns the departure of axis 0 or 1; `None` if the axis is on its course `targets` from the
    /// beginning.
    pub(super) fn departure(
        self,
        index: usize,
        targets: &[f64],
        rates_deg_s: [f64; 2],
    ) -> Option<Departure> {
        let at_deg = self.axes_deg.get(index).copied().flatten().filter(|_| self.sets_out)?;
        let (first_deg, rate_deg_s) = (targets.first()?, rates_deg_s.get(index)?);
        let reach_deg = rate_deg_s * self.lead_s;
        let near_deg = reach_deg + rate_deg_s * ON_COURSE_S;
        ((first_deg - at_deg).abs() > near_deg).then_some(Departure { at_deg, reach_deg })
    }
}

/// Planned positions of both axes along a pass.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Planned {
    pub(super) flip: Flip,
    /// Axis positions, degrees as the mount counts, one per sample.
    pub(super) axes_deg: [Vec<f64>; 2],
    /// Samples at which the azimuth axis slews a whole turn, because it is at an end.
    pub(super) slews: Vec<usize>,
    /// `true` if the path contains a detour round a keep-out.
    pub(super) goes_round: bool,
}

impl AzElAxes {
    /// Returns the positions along `samples`, `step_s` seconds apart, with the flip of the smallest
    /// error from the current axis positions. Returns the flip `prefer` if no other is better.
    pub(super) fn best(
        &self,
        samples: &[Sample],
        step_s: f64,
        start: Start,
        prefer: Flip,
    ) -> Planned {
        let mut best = self.along(samples, step_s, start, prefer);
        let flips = std::iter::once(Flip::None).chain(self.others(samples));
        let flips: Vec<Flip> = flips.filter(|flip| *flip != prefer).collect();
        if flips.is_empty() {
            return best;
        }
        let mut best_deg = self.error_deg(samples, step_s, start, &best) - WORTH_DEG;
        if best_deg <= 0.0 {
            return best;
        }
        for flip in flips {
            let planned = self.along(samples, step_s, start, flip);
            let error_deg = self.error_deg(samples, step_s, start, &planned);
            if error_deg < best_deg {
                (best, best_deg) = (planned, error_deg);
            }
        }
        best
    }

    /// Returns the flips other than [`Flip::None`] that the axes can make along `samples`.
    pub(super) fn others(&self, samples: &[Sample]) -> impl Iterator<Item = Flip> + use<> {
        let can_flip = self.elevation_deg.is_some_and(|(_, highest_deg)| highest_deg > 90.0);
        let is_high = samples.iter().any(|sample| view::is_overhead(sample.direction));
        let overhead_flips = [Flip::FromTop, Flip::UntilTop].into_iter().filter(move |_| is_high);
        std::iter::once(Flip::Whole).chain(overhead_flips).filter(move |_| can_flip)
    }

    /// Returns the positions with this `flip` along `samples`, `step_s` seconds apart. The azimuth
    /// axis begins on the wrap that lasts longest, or on the nearest of several. If a direction is
    /// out of travel, the axes wait as near to it as possible.
    pub(super) fn along(
        &self,
        samples: &[Sample],
        step_s: f64,
        start: Start,
        flip: Flip,
    ) -> Planned {
        let [azimuth_max_deg, elevation_max_deg] = self.rates_deg_s.map(|rate| rate * step_s);
        let flipped = flip.flipped(samples);
        let ends = self.elevation_deg.map(ElevationEnds::new);
        // Only an axis that does not keep up needs the sines and cosines.
        let view_at = |index: usize| {
            let (sample, is_flipped) = samples.get(index).zip(flipped.get(index))?;
            Some(View::new(sample.direction, *is_flipped, ends))
        };
        let cost = |index: usize| {
            let view = view_at(index);
            move |azimuth: &SinCos| view.map_or(0.0, |view| view.azimuth_cost(*azimuth))
        };
        // First ignore the ends of the axis. Otherwise a turn of the sky that the axis does not
        // make in time would take it to an end.
        let azimuths_deg = flip::azimuths_deg(samples, &flipped);
        let free = rate_limited(&azimuths_deg, azimuth_max_deg, None, sin_cos, cost);
        let [azimuth_now_deg, _] = start.axes_deg;
        let wrap = AzimuthRange::new(self.azimuth_deg).map_or_else(
            || AzimuthWrap {
                positions_deg: vec![self.azimuth_deg.0; samples.len()],
                ..AzimuthWrap::default()
            },
            |range| AzimuthWrap::along(&free, range, azimuth_now_deg),
        );
        let (from_deg, to_deg) = self.azimuth_deg;
        let departures =
            |index: usize, targets: &[f64]| start.departure(index, targets, self.rates_deg_s);
        let targets = &wrap.positions_deg;
        let azimuths: Vec<f64> =
            rate_limited(targets, azimuth_max_deg, departures(0, targets), sin_cos, cost)
                .into_iter()
                .map(|axis_deg| axis_deg.min(to_deg).max(from_deg))
                .collect();
        let elevations: Vec<f64> = samples
            .iter()
            .zip(&flipped)
            .zip(&azimuths)
            .map(|((sample, is_flipped), azimuth_deg)| {
                View::elevation_deg((sample.direction, *is_flipped), ends, *azimuth_deg)
            })
            .collect();
        let cost = |index: usize| {
            let pair = view_at(index).zip(azimuths.get(index).map(|deg| sin_cos(*deg)));
            move |elevation: &SinCos| {
                pair.map_or(0.0, |(view, azimuth)| view.cost(azimuth, *elevation))
            }
        };
        let departure = departures(1, &elevations);
        let elevations = rate_limited(&elevations, elevation_max_deg, departure, sin_cos, cost);
        Planned { flip, axes_deg: [azimuths, elevations], slews: wrap.slews, goes_round: false }
    }

    /// Returns the root mean square error along `samples` of axes that set out from `start`,
    /// degrees. Samples below the reach of the antenna do not count.
    fn error_deg(&self, samples: &[Sample], step_s: f64, start: Start, planned: &Planned) -> f64 {
        let [azimuths, elevations] = &planned.axes_deg;
        let mut axes_deg = start.axes_deg;
        let (mut sum_deg2, mut count, mut span_s) = (0.0, 0_u32, start.lead_s);
        for ((sample, azimuth_deg), elevation_deg) in samples.iter().zip(azimuths).zip(elevations) {
            let goals_deg = [*azimuth_deg, *elevation_deg];
            for ((axis, goal_deg), rate) in axes_deg.iter_mut().zip(goals_deg).zip(self.rates_deg_s)
            {
                let at_deg = axis.unwrap_or(goal_deg);
                let max_deg = rate * span_s;
                *axis = Some(at_deg + (goal_deg - at_deg).min(max_deg).max(-max_deg));
            }
            span_s = step_s;
            let lowest_deg = self.elevation_deg.map_or(f64::MIN, |(lowest_deg, _)| lowest_deg);
            if sample.direction.elevation_deg() >= lowest_deg {
                let off_deg =
                    self.misalignment(sample.direction, axes_deg.map(Option::unwrap_or_default));
                sum_deg2 += off_deg.degrees().powi(2);
                count += 1;
            }
        }
        (sum_deg2 / f64::from(count.max(1))).sqrt()
    }

    /// Returns the angle between the direction of the axes and `direction`.
    pub(super) fn misalignment(
        &self,
        direction: AzEl,
        [azimuth_deg, elevation_deg]: [f64; 2],
    ) -> Angle {
        if self.elevation_deg.is_some() {
            direction.separation(AzEl::from_degrees(azimuth_deg, elevation_deg))
        } else {
            (Angle::from_degrees(azimuth_deg) - direction.azimuth).wrapped_180().abs()
        }
    }
}

#[cfg(test)]
mod tests;
