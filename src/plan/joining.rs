//! When an antenna that stands somewhere joins a pass.

use jiff::Timestamp;

use super::{MountLimits, Sample};
use crate::{
    astro::{Angle, AzEl, time::seconds_between, xy_mount},
    station::Mount,
};

/// What is left of a pass once the antenna has slewed there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Joining {
    /// From AOS, or from now where the pass has begun, until the antenna is there, seconds.
    pub late_s: f64,
    /// From then to LOS, seconds.
    pub left_s: f64,
}

/// When the axes, which stand at `axes_deg` as the mount counts, meet the pass along `samples`
/// (oldest first) by the straight way. `None` if they do not before LOS.
pub fn joining(
    samples: &[Sample],
    limits: MountLimits,
    axes_deg: [f64; 2],
    now: Timestamp,
) -> Option<Joining> {
    let (first, last) = (samples.first()?, samples.last()?);
    let begins = first.time.max(now);
    let met = samples.iter().find(|sample| {
        let time_s = seconds_between(now, sample.time);
        time_s >= 0.0
            && sample.direction.elevation >= limits.min_elevation
            && limits.mount.reaches(sample.direction)
            && slew_s(limits, axes_deg, sample.direction) <= time_s
    })?;
    Some(Joining {
        late_s: seconds_between(begins, met.time).max(0.0),
        left_s: seconds_between(met.time, last.time),
    })
}

/// Time of the straight way until the satellite is inside the beam, seconds.
fn slew_s(limits: MountLimits, from_deg: [f64; 2], to: AzEl) -> f64 {
    let to_deg = match limits.mount {
        Mount::Xy { lower_axis_azimuth_deg, .. } => {
            let lower_axis = Angle::from_degrees(lower_axis_azimuth_deg);
            let axes = xy_mount::axes_from_azel(to, lower_axis);
            // The mount counts 90 at the zenith.
            [axes.lower, axes.upper].map(|angle| angle.degrees() + 90.0)
        }
        Mount::AzEl { .. } => {
            let [near_deg, elevation_deg] = from_deg;
            let azimuth_deg = limits.mount.axis_azimuth(to.azimuth, Some(near_deg)).degrees();
            let to_deg = if limits.has_elevation { to.elevation_deg() } else { elevation_deg };
            [azimuth_deg, to_deg]
        }
    };
    let ways = from_deg.into_iter().zip(to_deg).map(|(from, to)| (to - from).abs());
    let longest_deg = ways.fold(0.0, f64::max) - limits.half_beam.degrees();
    longest_deg.max(0.0) / limits.maximum_rate_deg_s
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::astro::time::add_seconds;

    const AOS: Timestamp = Timestamp::UNIX_EPOCH;

    /// 100 s at the azimuth of 90 degrees, half-way up.
    fn pass() -> Vec<Sample> {
        let at = |step: i32| add_seconds(AOS, f64::from(step) * 2.0);
        let sample = |step| Sample { time: at(step), direction: AzEl::from_degrees(90.0, 45.0) };
        (0..=50).map(sample).collect()
    }

    fn limits() -> MountLimits {
        MountLimits {
            mount: Mount::AzEl {
                azimuth_from_deg: 0.0,
                azimuth_to_deg: 360.0,
                elevation_from_deg: 0.0,
                elevation_to_deg: 90.0,
            },
            maximum_rate_deg_s: 1.0,
            half_beam: Angle::ZERO,
            has_elevation: true,
            min_elevation: Angle::ZERO,
        }
    }

    fn join(azimuth_deg: f64, now_s: f64) -> Option<Joining> {
        joining(&pass(), limits(), [azimuth_deg, 45.0], add_seconds(AOS, now_s))
    }

    #[test]
    fn the_way_there_is_lost_from_a_pass_under_way() {
        assert_eq!(join(60.0, 20.0), Some(Joining { late_s: 30.0, left_s: 50.0 }));
        assert_eq!(join(90.0, 20.0), Some(Joining { late_s: 0.0, left_s: 80.0 }));
    }

    #[test]
    fn an_antenna_that_sets_out_before_aos_is_late_by_the_rest_of_its_way() {
        assert_eq!(join(60.0, -20.0), Some(Joining { late_s: 10.0, left_s: 90.0 }));
        assert_eq!(join(60.0, -30.0).map(|of| of.late_s), Some(0.0));
    }

    #[test]
    fn an_antenna_that_is_too_far_does_not_join() {
        assert_eq!(join(0.0, 20.0), None);
        assert_eq!(joining(&[], limits(), [0.0; 2], AOS), None);
    }
}
