//! A simulated pass for the tests of the sky plot.

use glam::DVec3;
use jiff::{SignedDuration, Timestamp};

use super::scene::{SkyScene, Track};
use crate::{
    astro::{Angle, AzEl},
    plan::Sample,
};

/// Returns the time 11:06:12Z.
pub(super) fn now() -> Timestamp {
    "2026-11-14T11:06:12Z".parse().unwrap()
}

/// Returns a pass from south to north over the west, 11:01:53Z to 11:14:45Z, a sample every 4 s.
pub(super) fn pass() -> Vec<Sample> {
    let aos: Timestamp = "2026-11-14T11:01:53Z".parse().unwrap();
    let station_km = DVec3::Z * 6371.0;
    (0..=193)
        .map(|step| {
            let seconds = f64::from(step) * 4.0;
            let turn = (seconds / 772.0 - 0.5) * 54_f64.to_radians();
            let place_km = DVec3::new(-0.04, turn.sin(), turn.cos()).normalize() * 7196.0;
            Sample {
                time: aos + SignedDuration::from_secs(4 * step as i64),
                direction: AzEl::from_enu(place_km - station_km),
            }
        })
        .collect()
}

/// Returns the pass with these samples, at [`now`].
pub(super) fn track(samples: &[Sample]) -> Track<'_> {
    let (first, last) = (*samples.first().unwrap(), *samples.last().unwrap());
    let top = samples
        .iter()
        .max_by(|a, b| a.direction.elevation_deg().total_cmp(&b.direction.elevation_deg()));
    let here = samples.iter().rfind(|sample| sample.time <= now()).unwrap();
    Track {
        catalog_number: 43013,
        name: "NOAA 20",
        samples,
        aos: first,
        tca: *top.unwrap(),
        los: last,
        show_aos: true,
        show_los: true,
        position: Some(here.direction),
    }
}

/// Returns an empty sky.
pub(super) fn empty() -> SkyScene<'static> {
    SkyScene {
        now: now(),
        minimum_elevation: Angle::from_degrees(5.0),
        mask: None,
        keep_outs: &[],
        keyholes: None,
        track: None,
        others: &[],
        sun: None,
        moon: None,
        later: None,
        commanded: None,
        ghost: None,
        beam_width: Angle::from_degrees(0.88),
        measured: None,
        antennas: &[],
        stops: &[],
        bearing: None,
        predicted: None,
        recent_errors: &[],
        marked: None,
        readout: &[],
        description: "Holding at 343.1°, 5.0°.",
    }
}
