//! How long a pass is clear of the horizon mask.

use super::Sample;
use crate::astro::{HorizonMask, time::seconds_between};

/// Seconds for which the track along `samples` (a few seconds apart, oldest first) is above `mask`.
/// The clearance is interpolated linearly between two samples.
pub fn clear_time_s(samples: &[Sample], mask: &HorizonMask) -> f64 {
    let clearance_deg = |sample: &Sample| {
        (sample.direction.elevation - mask.elevation_at(sample.direction.azimuth)).degrees()
    };
    let part = |from_deg: f64, to_deg: f64| match (from_deg > 0.0, to_deg > 0.0) {
        (true, true) => 1.0,
        (false, false) => 0.0,
        _ => from_deg.max(to_deg) / (from_deg - to_deg).abs(),
    };
    let spans = samples.iter().zip(samples.iter().skip(1)).map(|(from, to)| {
        seconds_between(from.time, to.time) * part(clearance_deg(from), clearance_deg(to))
    });
    spans.sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        astro::{Angle, Site, time::add_seconds},
        orbit::{Pass, PassSearch, Propagator, bundled, clear_stretches, passes},
    };
    use jiff::Timestamp;

    #[test]
    fn it_is_that_of_the_stretches_above_the_mask() {
        let start: Timestamp = "2026-08-12T00:00:00Z".parse().unwrap();
        let mask = HorizonMask::from_degrees([(0.0, 8.0), (120.0, 25.0), (240.0, 12.0)]).unwrap();
        let site = Site::new(41.02, 29.17, 30.0).unwrap();
        let search = PassSearch {
            aos_elevation: Angle::from_degrees(5.0),
            ..PassSearch::new(site, start, add_seconds(start, 86_400.0))
        };
        let mut cuts = 0;
        for number in [25_544, 43_013, 54_754, 59_051] {
            let propagator = Propagator::new(bundled().unwrap().get(number).unwrap()).unwrap();
            for pass in passes(&propagator, &search, &|| false) {
                let seconds = (0..).map(|step| f64::from(step) * 2.0);
                let samples: Vec<Sample> = seconds
                    .take_while(|second| *second < pass.duration_s() + 2.0)
                    .map(|second| add_seconds(pass.aos.time, second.min(pass.duration_s())))
                    .map(|time| Sample {
                        time,
                        direction: propagator.look_from(site, time).unwrap().direction,
                    })
                    .collect();
                let stretches = clear_stretches(&propagator, site, &mask, &pass);
                let wanted_s: f64 = stretches.iter().map(Pass::duration_s).sum();
                let found_s = clear_time_s(&samples, &mask);
                assert!((found_s - wanted_s).abs() < 0.5, "{found_s} {wanted_s}");
                cuts += usize::from(wanted_s < pass.duration_s() - 1.0);
            }
        }
        assert!(cuts > 10, "{cuts}");
    }
}
