//! Axes that turn too slowly, or not at all.

use glam::DVec3;

use super::{ALIKE, Axis, Cause, CauseFit, Evidence, EvidencePoint, FoundCause};
use crate::{
    astro::{Angle, AzEl, time::seconds_between, xy_mount},
    station::Mount,
};

/// Min and max rate of a drive in the search, degrees per second.
const RATES_DEG_S: (f64, f64) = (0.02, 20.0);
/// Number of steps of a search; each search continues between the neighbours of the best value.
const STEPS: usize = 40;
const SEARCHES: usize = 3;

/// Axes that a cause affects.
#[derive(Debug, Clone, Copy)]
struct ChosenAxes([bool; 2]);

const BOTH_AXES: ChosenAxes = ChosenAxes([true, true]);
const SINGLE: [ChosenAxes; 2] = [ChosenAxes([true, false]), ChosenAxes([false, true])];

impl Evidence<'_> {
    /// Returns the rate of slow drives that explains the error best: of one axis, or of both if the
    /// positions need both.
    pub(super) fn slow_drives(&self) -> Option<FoundCause> {
        self.narrowest(|axes| self.slow(axes))
    }

    /// Returns the time at which an axis, or both, stopped.
    pub(super) fn stuck(&self) -> Option<FoundCause> {
        self.narrowest(|axes| self.stuck_axes(axes))
    }

    fn narrowest(&self, found: impl Fn(ChosenAxes) -> Option<FoundCause>) -> Option<FoundCause> {
        let axes = if self.has_elevation { &SINGLE[..] } else { &SINGLE[..1] };
        let single = axes.iter().filter_map(|axes| found(*axes));
        let single = single.min_by(|a, b| a.fit.left.total_cmp(&b.fit.left));
        let found_both = if self.has_elevation { found(BOTH_AXES) } else { None };
        let (Some(single), Some(double)) = (single, found_both) else {
            return single.or(found_both);
        };
        let needs_both = single.fit.left - double.fit.left > ALIKE * double.fit.variance;
        Some(if needs_both { double } else { single })
    }

    fn slow(&self, axes: ChosenAxes) -> Option<FoundCause> {
        let (low, high) = (RATES_DEG_S.0.ln(), RATES_DEG_S.1.ln());
        let rate = |share: f64| (low + (high - low) * share).exp();
        let fit =
            |share: f64| self.fit_of_axes(|points| slow(points, self.mount, axes, rate(share)));
        let (best_share, fit) = searched(fit)?;
        let cause = Cause::SlowDrives { rate_deg_s: rate(best_share), axis: self.axis(axes) };
        Some(FoundCause { cause, partner: None, fit })
    }

    fn stuck_axes(&self, axes: ChosenAxes) -> Option<FoundCause> {
        // Axes that stand in one pass may turn in another.
        let [points] = &self.passes[..] else { return None };
        let place = |share: f64| (points.len() as f64 * share) as usize;
        let fit =
            |share: f64| self.fit_of_axes(|points| stuck(points, self.mount, axes, place(share)));
        let (best_share, fit) = searched(fit)?;
        let start = points.get(place(best_share))?.time;
        Some(FoundCause {
            cause: Cause::Stuck { start, axis: self.axis(axes) },
            partner: None,
            fit,
        })
    }

    fn fit_of_axes(&self, axes_deg: impl Fn(&[EvidencePoint<'_>]) -> Vec<[f64; 2]>) -> CauseFit {
        let left = self.passes.iter().map(|points| {
            let pairs = points.iter().zip(axes_deg(points));
            let left = pairs.map(|(point, axes_deg)| {
                let mut direction = self.mount.direction(axes_deg);
                if !self.has_elevation {
                    direction.elevation = point.satellite.elevation;
                }
                point.error - (direction.to_enu() - point.satellite.to_enu())
            });
            left.collect()
        });
        self.fit_of_residuals(&left.collect::<Vec<Vec<DVec3>>>())
    }

    fn axis(&self, ChosenAxes(axes): ChosenAxes) -> Option<Axis> {
        let names = match self.mount {
            Mount::AzEl { .. } => [Axis::Azimuth, Axis::Elevation],
            Mount::Xy { .. } => [Axis::X, Axis::Y],
        };
        match (axes, names) {
            ([true, false], [first, _]) => Some(first),
            ([false, true], [_, second]) => Some(second),
            _ => None,
        }
    }
}

/// Returns the place from 0 to 1 with the smallest remainder. The search is coarse at first,
/// because the sum has flat parts.
fn searched(fit: impl Fn(f64) -> CauseFit) -> Option<(f64, CauseFit)> {
    let (mut start, mut end) = (0.0, 1.0);
    let mut best: Option<(f64, CauseFit)> = None;
    for _ in 0..SEARCHES {
        let step = (end - start) / STEPS as f64;
        let tried =
            (0..=STEPS).map(|count| start + step * count as f64).map(|place| (place, fit(place)));
        best = tried.chain(best).min_by(|(_, a), (_, b)| a.left.total_cmp(&b.left));
        let (best_place, _) = best?;
        (start, end) = ((best_place - step).max(0.0), (best_place + step).min(1.0));
    }
    best
}

/// Returns the angles of the axes that point at `direction`, degrees as the mount counts.
/// `azimuth_deg`: its azimuth, continued over north.
fn axes_deg(mount: Mount, direction: AzEl, azimuth_deg: f64) -> [f64; 2] {
    match mount {
        Mount::AzEl { .. } => [azimuth_deg, direction.elevation_deg()],
        Mount::Xy { lower_axis_azimuth_deg, .. } => {
            let lower_axis = Angle::from_degrees(lower_axis_azimuth_deg);
            let axes = xy_mount::axes_from_azel(direction, lower_axis);
            [axes.lower, axes.upper].map(|axis| axis.degrees() + 90.0)
        }
    }
}

fn followed_deg(point: &EvidencePoint<'_>, mount: Mount) -> [f64; 2] {
    axes_deg(mount, point.followed, point.azimuth_deg)
}

fn measured_deg(point: &EvidencePoint<'_>, mount: Mount) -> [f64; 2] {
    let deviation = (point.measured.azimuth - point.followed.azimuth).wrapped_180();
    axes_deg(mount, point.measured, point.azimuth_deg + deviation.degrees())
}

/// Returns the angles of axes that follow the satellite from their first position; `axes` turn at
/// most at `rate_deg_s`.
fn slow(
    points: &[EvidencePoint<'_>],
    mount: Mount,
    axes: ChosenAxes,
    rate_deg_s: f64,
) -> Vec<[f64; 2]> {
    let mut before: Option<&EvidencePoint<'_>> = None;
    let mut at_deg = [0.0; 2];
    let errors = points.iter().map(|point| {
        let followed = followed_deg(point, mount);
        let (start, turns_deg) = match before {
            None => (measured_deg(point, mount), 0.0),
            Some(before) => (at_deg, rate_deg_s * seconds_between(before.time, point.time)),
        };
        before = Some(point);
        at_deg = each_axis(axes, followed, start, |followed, start| {
            start + (followed - start).clamp(-turns_deg, turns_deg)
        });
        at_deg
    });
    errors.collect()
}

/// Returns the angles of axes that follow the satellite; `axes` stop at the point at `place`.
fn stuck(
    points: &[EvidencePoint<'_>],
    mount: Mount,
    axes: ChosenAxes,
    place: usize,
) -> Vec<[f64; 2]> {
    // Use the measured angle of the standing axis, which may never have been on its satellite.
    let standing = points.get(place..).unwrap_or_default();
    let count = standing.len().max(1) as f64;
    let sum = standing.iter().fold([0.0; 2], |[first, second], point| {
        let [measured_first, measured_second] = measured_deg(point, mount);
        [first + measured_first, second + measured_second]
    });
    let stands = sum.map(|sum| sum / count);
    let errors = points.iter().enumerate().map(|(index, point)| {
        let followed = followed_deg(point, mount);
        if index < place {
            return followed;
        }
        each_axis(axes, followed, stands, |_, stands| stands)
    });
    errors.collect()
}

/// Computes the angles of `axes` with `turned`; the other axes follow.
fn each_axis(
    ChosenAxes([first, second]): ChosenAxes,
    [followed_first, followed_second]: [f64; 2],
    [at_first, at_second]: [f64; 2],
    turned: impl Fn(f64, f64) -> f64,
) -> [f64; 2] {
    [
        if first { turned(followed_first, at_first) } else { followed_first },
        if second { turned(followed_second, at_second) } else { followed_second },
    ]
}
