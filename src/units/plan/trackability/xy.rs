//! Trackability of an X/Y mount: all of the sky except two keyholes at the ends of the lower axis.

use super::{Loss, MountLimits, Outside, Sample, Trackability};
use crate::{
    astro::{Angle, time::seconds_between, xy_mount},
    station::Mount,
};

pub(super) fn trackability(samples: &[Sample], limits: MountLimits) -> Trackability {
    let Mount::Xy { lower_axis_azimuth_deg, travel_from_deg, travel_to_deg } = limits.mount else {
        return Trackability::Nothing;
    };
    let lower_axis = Angle::from_degrees(lower_axis_azimuth_deg);
    let axes = |sample: &Sample| {
        let axes = xy_mount::axes_from_azel(sample.direction, lower_axis);
        // The travel is in degrees as the controller counts: 90 at the zenith.
        [axes.lower.degrees() + 90.0, axes.upper.degrees() + 90.0]
    };
    let mut lost = Outside::default();
    let mut whole_s = 0.0;
    let mut lost_towards = Angle::ZERO;
    for pair in samples.windows(2) {
        let [start, end] = pair else { continue };
        let span_s = seconds_between(start.time, end.time);
        if span_s <= 0.0 {
            continue;
        }
        whole_s += span_s;
        // The time between two samples counts only if both are within the travel.
        let reachable = [start, end].into_iter().flat_map(axes);
        let reachable =
            reachable.into_iter().all(|angle| (travel_from_deg..=travel_to_deg).contains(&angle));
        let keeps_up = axes(start)
            .iter()
            .zip(axes(end))
            .all(|(before, after)| (after - before).abs() <= limits.maximum_rate_deg_s * span_s);
        if !reachable || !keeps_up {
            lost.add(start.time, end.time);
            lost_towards = end.direction.azimuth;
        }
    }
    let deviation = (lost_towards - lower_axis).wrapped_180().abs();
    let far_end = deviation.degrees() > 90.0;
    let keyhole = if far_end { lower_axis + Angle::from_degrees(180.0) } else { lower_axis };
    Trackability::new(lost, whole_s, Loss::Keyhole(keyhole.wrapped_360()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::astro::{AzEl, time::add_seconds};
    use jiff::Timestamp;

    const MOUNT: Mount =
        Mount::Xy { lower_axis_azimuth_deg: 0.0, travel_from_deg: 5.0, travel_to_deg: 175.0 };

    fn limits(maximum_rate_deg_s: f64) -> MountLimits {
        let half_beam = Angle::from_degrees(0.5);
        MountLimits {
            mount: MOUNT,
            maximum_rate_deg_s,
            half_beam,
            has_elevation: true,
            min_elevation: Angle::ZERO,
        }
    }

    /// Returns a pass in a straight line over the ground, `km` beside the site, from north to south
    /// at 7.5 km/s and a height of 800 km.
    fn pass(km: f64, azimuth_turn_deg: f64) -> Vec<Sample> {
        let start: Timestamp = "2026-08-12T00:00:00Z".parse().unwrap();
        (-250..=250)
            .map(|second| {
                let along = -7.5 * f64::from(second);
                let direction = AzEl::from_enu(glam::DVec3::new(km, along, 800.0));
                let turned = direction.azimuth + Angle::from_degrees(azimuth_turn_deg);
                Sample {
                    time: add_seconds(start, f64::from(second)),
                    direction: AzEl { azimuth: turned.wrapped_360(), ..direction },
                }
            })
            .collect()
    }

    #[test]
    fn a_pass_over_the_zenith_costs_an_xy_mount_nothing() {
        assert_eq!(trackability(&pass(1.0, 0.0), limits(3.0)), Trackability::Whole);
    }

    #[test]
    fn a_slow_mount_loses_the_part_near_the_keyhole() {
        let low: Vec<Sample> = pass(600.0, 0.0);
        let Trackability::Loses { seconds, loss: Loss::Keyhole(keyhole_azimuth), .. } =
            trackability(&low, limits(0.4))
        else {
            panic!("{:?}", trackability(&low, limits(0.4)));
        };
        assert!(seconds > 1.0 && seconds < 400.0, "{seconds}");
        assert!(keyhole_azimuth.degrees() < 1.0 || keyhole_azimuth.degrees() > 179.0);
    }

    #[test]
    fn what_lies_in_the_keyhole_cannot_be_followed() {
        let start: Timestamp = "2026-08-12T00:00:00Z".parse().unwrap();
        let still: Vec<Sample> = (0..10)
            .map(|second| Sample {
                time: add_seconds(start, f64::from(second)),
                direction: AzEl::from_degrees(0.0, 2.0),
            })
            .collect();
        assert_eq!(trackability(&still, limits(3.0)), Trackability::Nothing);
    }
}
