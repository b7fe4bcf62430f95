//! Trackability of elevation over azimuth: the mount reaches all of the sky. However, the azimuth
//! axis must turn fast overhead and slew a whole turn at its ends, unless the mount can flip.

use super::{Loss, MountLimits, Outside, Sample, Trackability};
use crate::{
    astro::time::seconds_between,
    plan::az_el::{AzElAxes, Flip, Planned, Start},
};

/// Max slew of an axis, degrees.
const TURN_DEG: f64 = 360.0;

pub(super) fn trackability(samples: &[Sample], limits: MountLimits) -> Trackability {
    let [azimuth_deg, elevation_deg] = limits.mount.travel_deg();
    let axes = AzElAxes {
        azimuth_deg,
        elevation_deg: limits.has_elevation.then_some(elevation_deg),
        rates_deg_s: [limits.maximum_rate_deg_s; 2],
    };
    let step_s = samples.iter().zip(samples.iter().skip(1)).next();
    let step_s = step_s.map_or(1.0, |(first, second)| seconds_between(first.time, second.time));
    let along = |flip| {
        let planned = axes.along(samples, step_s, Start::default(), flip);
        lost(samples, limits, axes, &planned)
    };
    let plain = along(Flip::None);
    if plain.0.seconds <= 0.0 {
        return Trackability::Whole;
    }
    let all = std::iter::once(plain).chain(axes.others(samples).map(along));
    let (lost, loss) = all.min_by(|a, b| a.0.seconds.total_cmp(&b.0.seconds)).unwrap_or(plain);
    let whole_s = samples.first().zip(samples.last());
    let whole_s = whole_s.map_or(0.0, |(first, last)| seconds_between(first.time, last.time));
    Trackability::new(lost, whole_s, loss)
}

/// Returns the time outside the beam, and the cause of the loss at its beginning.
fn lost(
    samples: &[Sample],
    limits: MountLimits,
    axes: AzElAxes,
    planned: &Planned,
) -> (Outside, Loss) {
    let [azimuths, elevations] = &planned.axes_deg;
    let (mut lost, mut first) = (Outside::default(), None);
    let axes_deg =
        azimuths.iter().zip(elevations).map(|(azimuth, elevation)| [*azimuth, *elevation]);
    let mut before: Option<(&Sample, bool)> = None;
    for (index, (sample, axes_deg)) in samples.iter().zip(axes_deg).enumerate() {
        let is_off = axes.misalignment(sample.direction, axes_deg) > limits.half_beam;
        // The time between two samples counts only if both are in the beam.
        if let Some((before, was_off)) = before.replace((sample, is_off))
            && (is_off || was_off)
        {
            lost.add(before.time, sample.time);
        }
        first = first.or(is_off.then_some((index, sample.time)));
    }
    let Some((index, start)) = first else { return (lost, Loss::OutOfReach) };
    let near_s = TURN_DEG / limits.maximum_rate_deg_s;
    let is_near = |slew: &Sample| seconds_between(slew.time, start).abs() <= near_s;
    let is_slewing = planned.slews.iter().filter_map(|index| samples.get(*index)).any(is_near);
    let loss = Loss::at_sample(limits.mount, samples, index, is_slewing);
    (lost, loss)
}

#[cfg(test)]
mod tests {
    use jiff::Timestamp;

    use super::*;
    use crate::{
        astro::{Angle, AzEl, time::add_seconds},
        station::Mount,
    };

    /// Returns a pass in a straight line over the ground at 7.5 km/s and a height of 800 km. It
    /// comes within `km` of the site and flies towards `azimuth_deg`.
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

    fn limits(to_deg: f64, maximum_rate_deg_s: f64) -> MountLimits {
        MountLimits {
            mount: Mount::AzEl {
                azimuth_from_deg: 0.0,
                azimuth_to_deg: to_deg,
                elevation_from_deg: 0.0,
                elevation_to_deg: 90.0,
            },
            maximum_rate_deg_s,
            half_beam: Angle::from_degrees(1.0),
            min_elevation: Angle::ZERO,
            has_elevation: true,
        }
    }

    #[test]
    fn a_usual_pass_is_followed_whole() {
        assert_eq!(
            super::trackability(&pass(600.0, 120.0), limits(360.0, 3.0)),
            Trackability::Whole
        );
    }

    #[test]
    fn a_pass_overhead_costs_a_slow_axis_some_seconds() {
        let lost = super::trackability(&pass(20.0, 90.0), limits(450.0, 3.0));
        let Trackability::Loses { seconds, loss: Loss::Overhead, .. } = lost else {
            panic!("{lost:?}")
        };
        assert!((10.0..80.0).contains(&seconds), "{seconds}");
        assert_eq!(
            super::trackability(&pass(20.0, 90.0), limits(450.0, 30.0)),
            Trackability::Whole,
            "a fast one keeps up"
        );
    }

    #[test]
    fn a_pass_through_north_costs_a_slew_where_the_axis_ends_there() {
        // The pass comes from east-north-east through north.
        let through_north = pass(600.0, 275.0);
        let lost = super::trackability(&through_north, limits(360.0, 3.0));
        let Trackability::Loses { seconds, loss: Loss::Slew, .. } = lost else {
            panic!("{lost:?}")
        };
        assert!((50.0..150.0).contains(&seconds), "{seconds}");
        assert_eq!(super::trackability(&through_north, limits(450.0, 3.0)), Trackability::Whole);
    }

    #[test]
    fn a_sector_follows_what_lies_in_it() {
        let east = pass(600.0, 0.0);
        assert_eq!(super::trackability(&east, limits(200.0, 3.0)), Trackability::Whole);
        let west = pass(600.0, 180.0);
        let lost = super::trackability(&west, limits(200.0, 3.0));
        assert!(matches!(lost, Trackability::Nothing | Trackability::Loses { .. }), "{lost:?}");
        assert_ne!(lost, Trackability::Whole);
    }

    /// A high pass that leaves the travel is lost there and not overhead.
    #[test]
    fn beyond_the_travel_a_high_satellite_is_out_of_reach() {
        let lost = super::trackability(&pass(150.0, 75.0), limits(120.0, 30.0));
        let Trackability::Loses { loss, seconds, .. } = lost else { panic!("{lost:?}") };
        assert_eq!(loss, Loss::BeyondAzimuth(Angle::from_degrees(120.0)));
        assert!(seconds > 60.0, "{seconds}");
    }

    #[test]
    fn over_the_zenith_neither_costs_anything() {
        let over_travel = |mut limits: MountLimits| {
            if let Mount::AzEl { elevation_to_deg, .. } = &mut limits.mount {
                *elevation_to_deg = 180.0;
            }
            limits
        };
        let through_north = pass(600.0, 275.0);
        let whole = super::trackability(&through_north, over_travel(limits(360.0, 3.0)));
        assert_eq!(whole, Trackability::Whole);
        let whole = super::trackability(&pass(8.0, 90.0), over_travel(limits(450.0, 3.0)));
        assert_eq!(whole, Trackability::Whole);
        let lost = super::trackability(&pass(8.0, 90.0), limits(450.0, 3.0));
        assert!(matches!(lost, Trackability::Loses { loss: Loss::Overhead, .. }), "{lost:?}");
    }

    #[test]
    fn without_an_elevation_axis_only_the_azimuth_counts() {
        let alone = MountLimits { has_elevation: false, ..limits(360.0, 3.0) };
        assert_eq!(super::trackability(&pass(600.0, 120.0), alone), Trackability::Whole);
        assert_eq!(super::trackability(&[], alone), Trackability::Whole);
    }
}
