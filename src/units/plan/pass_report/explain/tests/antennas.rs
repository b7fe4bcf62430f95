//! Antennas that track real satellites with one fault. They share no code with the fit.

use glam::{DQuat, DVec3};
use jiff::Timestamp;

use super::{
    super::{Axis, Cause},
    Flight, STEP_S, deg,
};
use crate::{
    astro::{Angle, AzEl, Site, time::add_seconds},
    orbit::Propagator,
    plan::schedule::testing::Random,
    station::Mount,
};

/// Returns a number from -1 to 1, but not close to zero.
pub(super) fn signed(random: &mut Random) -> f64 {
    let size = 0.15 + 0.85 * f64::from(random.below(10_000)) / 10_000.0;
    if random.below(2) == 0 { size } else { -size }
}

/// Returns a number from an approximate normal distribution.
pub(super) fn normal(random: &mut Random) -> f64 {
    (0..12).map(|_| f64::from(random.below(1_000_000)) / 1e6).sum::<f64>() - 6.0
}

/// Draws one of eight causes of an antenna on an azimuth/elevation mount.
pub(super) fn drawn(random: &mut Random, flight: &Flight) -> (&'static str, Cause) {
    match random.below(8) {
        0 => (
            "late",
            Cause::Late {
                late_s: 2.0 * signed(random).powi(2).max(0.025).copysign(signed(random)),
            },
        ),
        1 => ("azimuth", Cause::AzimuthOffset { offset_deg: signed(random) }),
        2 => ("elevation", Cause::ElevationOffset { offset_deg: signed(random) }),
        3 => ("tilt", Cause::Tilt { north_deg: signed(random), east_deg: signed(random) }),
        4 => ("azimuth scale", Cause::AzimuthScale { per_mille: 5.0 * signed(random) }),
        5 => ("elevation scale", Cause::ElevationScale { per_mille: 20.0 * signed(random) }),
        6 => ("elements", Cause::OtherElements { epoch: flight.elements.epoch() }),
        _ => ("slow drives", Cause::SlowDrives { rate_deg_s: 0.0, axis: None }),
    }
}

/// Returns the angles of the axes of a mount that points at `direction`; `azimuth_deg` continues
/// over north.
pub(super) fn axes_deg(mount: Mount, direction: AzEl, azimuth_deg: f64) -> [f64; 2] {
    match mount {
        Mount::AzEl { .. } => [azimuth_deg, direction.elevation.degrees()],
        Mount::Xy { .. } => {
            let (sin_az, cos_az) = direction.azimuth.radians().sin_cos();
            let (sin_el, cos_el) = direction.elevation.radians().sin_cos();
            let x = (cos_el * sin_az).atan2(sin_el);
            [x.to_degrees(), (cos_el * cos_az).asin().to_degrees()]
        }
    }
}

/// Returns the direction of the axes of a mount.
pub(super) fn pointed(mount: Mount, [first, second]: [f64; 2]) -> AzEl {
    match mount {
        Mount::AzEl { .. } => AzEl { azimuth: deg(first).wrapped_360(), elevation: deg(second) },
        Mount::Xy { .. } => {
            let (sin_x, cos_x) = first.to_radians().sin_cos();
            let (sin_y, cos_y) = second.to_radians().sin_cos();
            let (east, north, up) = (sin_x * cos_y, sin_y, cos_x * cos_y);
            let azimuth = Angle::from_radians(east.atan2(north)).wrapped_360();
            AzEl { azimuth, elevation: Angle::from_radians(up.asin()) }
        }
    }
}

/// Returns the directions that an antenna with this cause measures, without noise.
pub(super) fn measured(
    flight: &Flight,
    mount: Mount,
    cause: &Cause,
    other: &Propagator,
) -> Vec<(Timestamp, AzEl)> {
    let directions: Vec<(Timestamp, AzEl)> =
        flight.times().map(|time| (time, flight.direction_at(time))).collect();
    measured_of(flight, mount, &directions, cause, other)
}

/// Returns `directions` as an antenna with this additional cause would measure them.
pub(super) fn measured_of(
    flight: &Flight,
    mount: Mount,
    directions: &[(Timestamp, AzEl)],
    cause: &Cause,
    other: &Propagator,
) -> Vec<(Timestamp, AzEl)> {
    let mut azimuth_deg = directions[0].1.azimuth.degrees();
    let mut before = directions[0].1.azimuth;
    let mut axes: Option<[f64; 2]> = None;
    let is_of = |axis: Option<Axis>, place: usize| match axis {
        None => true,
        Some(Axis::Azimuth | Axis::X) => place == 0,
        Some(Axis::Elevation | Axis::Y) => place == 1,
    };
    let shifted = directions.iter().map(|(time, position)| {
        azimuth_deg += (position.azimuth - before).wrapped_180().degrees();
        before = position.azimuth;
        let AzEl { azimuth, elevation } = *position;
        let end = axes_deg(mount, *position, azimuth_deg);
        let direction = match *cause {
            Cause::Late { late_s } => flight.direction_at(add_seconds(*time, -late_s)),
            Cause::AzimuthOffset { offset_deg } => {
                AzEl { azimuth: azimuth + deg(offset_deg), elevation }
            }
            Cause::ElevationOffset { offset_deg } => {
                AzEl { azimuth, elevation: elevation + deg(offset_deg) }
            }
            Cause::Tilt { north_deg, east_deg } => {
                let lean = DVec3::new(deg(north_deg).radians(), -deg(east_deg).radians(), 0.0);
                AzEl::from_enu(DQuat::from_scaled_axis(lean) * position.to_enu())
            }
            Cause::AzimuthScale { per_mille } => {
                AzEl { azimuth: azimuth + deg(azimuth_deg * per_mille / 1000.0), elevation }
            }
            Cause::ElevationScale { per_mille } => {
                AzEl { azimuth, elevation: deg(elevation.degrees() * (1.0 + per_mille / 1000.0)) }
            }
            Cause::OtherSite { north_km, east_km } => {
                let site = elsewhere(flight.site, north_km, east_km);
                flight.propagator.look_from(site, *time).unwrap().direction
            }
            Cause::OtherElements { .. } => other.look_from(flight.site, *time).unwrap().direction,
            Cause::Refraction => {
                flight.propagator.look_from(flight.site.airless(), *time).unwrap().direction
            }
            Cause::SlowDrives { rate_deg_s, axis } => {
                let turns = rate_deg_s * STEP_S;
                let start = axes.unwrap_or(end);
                let now = [0, 1].map(|place| {
                    let change = end[place] - start[place];
                    let slow = start[place] + change.clamp(-turns, turns);
                    if is_of(axis, place) { slow } else { end[place] }
                });
                axes = Some(now);
                pointed(mount, now)
            }
            Cause::Stuck { start: begin, axis } => {
                let stood = axes.filter(|_| *time >= begin).unwrap_or(end);
                let now =
                    [0, 1].map(|place| if is_of(axis, place) { stood[place] } else { end[place] });
                axes = Some(if *time < begin { end } else { stood });
                pointed(mount, now)
            }
        };
        (*time, direction)
    });
    shifted.collect()
}

fn elsewhere(site: Site, north_km: f64, east_km: f64) -> Site {
    let metres_per_deg = 40_008_000.0 / 360.0;
    let latitude_deg = site.latitude().degrees() + north_km * 1000.0 / metres_per_deg;
    let shrunk = site.latitude().radians().cos();
    let longitude_deg = site.longitude().degrees() + east_km * 1000.0 / (metres_per_deg * shrunk);
    Site::new(latitude_deg, longitude_deg, site.altitude_m()).unwrap().airless()
}

/// Rotates a direction on the sky by these angles, degrees: to the right and up.
pub(super) fn shaken(direction: AzEl, right_deg: f64, up_deg: f64) -> AzEl {
    let azimuth =
        direction.azimuth + deg(right_deg / direction.elevation.radians().cos().max(0.02));
    AzEl { azimuth: azimuth.wrapped_360(), elevation: direction.elevation + deg(up_deg) }
}
