//! Elevation over azimuth: all of the sky, but the azimuth axis has to hurry
//! overhead and to go round at its ends.

use super::{Loss, Reach, Sample, Trackability};
use crate::{
    astro::time::seconds_between,
    plan::{AzimuthRange, AzimuthRoute},
    station::Mount,
};

/// Above this elevation a loss is told as one overhead, degrees.
const OVERHEAD_FROM_DEG: f64 = 60.0;
/// After the axis has set out to go round, what is lost is lost by that, seconds.
const SWING_S: f64 = 10.0;

/// See [`super::trackability`].
pub(super) fn trackability(samples: &[Sample], reach: Reach) -> Trackability {
    let Mount::AzEl { azimuth_from_deg, azimuth_to_deg, elevation_from_deg, elevation_to_deg } =
        reach.mount
    else {
        return Trackability::Nothing;
    };
    let Ok(range) = AzimuthRange::new(azimuth_from_deg, azimuth_to_deg) else {
        return Trackability::Nothing;
    };
    let route = AzimuthRoute::along(samples, range, None);
    let wanted = |(sample, azimuth_deg): (&Sample, f64)| {
        let elevation_deg = sample.direction.elevation_deg();
        [azimuth_deg, elevation_deg.clamp(elevation_from_deg, elevation_to_deg)]
    };
    let mut axes_deg = samples.iter().zip(route.positions_deg()).next().map(wanted);
    let (mut lost_s, mut whole_s, mut first) = (0.0, 0.0, None);
    for ((before, sample), azimuth_deg) in
        samples.iter().zip(samples.iter().skip(1)).zip(route.positions_deg().skip(1))
    {
        let (Some(axes_deg), span_s) = (&mut axes_deg, seconds_between(before.time, sample.time))
        else {
            continue;
        };
        if span_s <= 0.0 {
            continue;
        }
        whole_s += span_s;
        let most_deg = reach.maximum_rate_deg_s * span_s;
        for (axis_deg, goal_deg) in axes_deg.iter_mut().zip(wanted((sample, azimuth_deg))) {
            *axis_deg += (goal_deg - *axis_deg).clamp(-most_deg, most_deg);
        }
        if off_deg(*axes_deg, sample, reach) > reach.half_beam.degrees() {
            lost_s += span_s;
            first = first.or_else(|| {
                let is_swing = route
                    .swings()
                    .iter()
                    .any(|swing| (0.0..=SWING_S).contains(&seconds_between(*swing, sample.time)));
                Some(if is_swing {
                    Loss::Swing
                } else if sample.direction.elevation_deg() >= OVERHEAD_FROM_DEG {
                    Loss::Overhead
                } else {
                    Loss::OutOfReach
                })
            });
        }
    }
    Trackability::of(lost_s, whole_s, first.unwrap_or(Loss::OutOfReach))
}

/// How far the axes point beside the sample, degrees.
fn off_deg([azimuth_deg, elevation_deg]: [f64; 2], sample: &Sample, reach: Reach) -> f64 {
    let off = azimuth_deg - sample.direction.azimuth_deg();
    let off = (off + 180.0).rem_euclid(360.0) - 180.0;
    if !reach.has_elevation {
        return off.abs();
    }
    let across = off * sample.direction.elevation.radians().cos();
    across.hypot(elevation_deg - sample.direction.elevation_deg())
}

#[cfg(test)]
mod tests {
    use jiff::Timestamp;

    use super::*;
    use crate::astro::{Angle, AzEl, time::add_seconds};

    /// A pass in a straight line over the ground that comes as near to the site
    /// as `km`, 7.5 km/s fast and 800 km high, flying towards `azimuth_deg`.
    fn pass(km: f64, azimuth_deg: f64) -> Vec<Sample> {
        (-250..=250)
            .map(|second| {
                let along = 7.5 * f64::from(second);
                let direction = AzEl::from_enu(glam::DVec3::new(km, along, 800.0));
                let turned = direction.azimuth + Angle::from_degrees(azimuth_deg);
                Sample {
                    time: add_seconds(Timestamp::UNIX_EPOCH, f64::from(second) + 250.0),
                    direction: AzEl { azimuth: turned.wrapped_360(), ..direction },
                }
            })
            .collect()
    }

    fn reach(to_deg: f64, maximum_rate_deg_s: f64) -> Reach {
        Reach {
            mount: Mount::AzEl {
                azimuth_from_deg: 0.0,
                azimuth_to_deg: to_deg,
                elevation_from_deg: 0.0,
                elevation_to_deg: 90.0,
            },
            maximum_rate_deg_s,
            half_beam: Angle::from_degrees(1.0),
            has_elevation: true,
        }
    }

    #[test]
    fn a_usual_pass_is_followed_whole() {
        assert_eq!(
            super::trackability(&pass(600.0, 120.0), reach(360.0, 3.0)),
            Trackability::Whole
        );
    }

    #[test]
    fn a_pass_overhead_costs_a_slow_axis_some_seconds() {
        let lost = super::trackability(&pass(20.0, 90.0), reach(450.0, 3.0));
        let Trackability::Loses { seconds, at: Loss::Overhead } = lost else { panic!("{lost:?}") };
        assert!((10.0..80.0).contains(&seconds), "{seconds}");
        assert_eq!(
            super::trackability(&pass(20.0, 90.0), reach(450.0, 30.0)),
            Trackability::Whole,
            "a fast one keeps up"
        );
    }

    #[test]
    fn a_pass_through_north_costs_a_swing_where_the_axis_ends_there() {
        // From east-north-east through north.
        let through_north = pass(600.0, 275.0);
        let lost = super::trackability(&through_north, reach(360.0, 3.0));
        let Trackability::Loses { seconds, at: Loss::Swing } = lost else { panic!("{lost:?}") };
        assert!((50.0..150.0).contains(&seconds), "{seconds}");
        assert_eq!(super::trackability(&through_north, reach(450.0, 3.0)), Trackability::Whole);
    }

    #[test]
    fn a_sector_follows_what_lies_in_it() {
        let east = pass(600.0, 0.0);
        assert_eq!(super::trackability(&east, reach(200.0, 3.0)), Trackability::Whole);
        let west = pass(600.0, 180.0);
        let lost = super::trackability(&west, reach(200.0, 3.0));
        assert!(matches!(lost, Trackability::Nothing | Trackability::Loses { .. }), "{lost:?}");
        assert_ne!(lost, Trackability::Whole);
    }

    #[test]
    fn without_an_elevation_axis_only_the_azimuth_counts() {
        let alone = Reach { has_elevation: false, ..reach(360.0, 3.0) };
        assert_eq!(super::trackability(&pass(600.0, 120.0), alone), Trackability::Whole);
        assert_eq!(super::trackability(&[], alone), Trackability::Whole);
    }
}
