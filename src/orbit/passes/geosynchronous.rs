//! Satellites that keep their place over the ground. A site sees most of them either
//! always or never.

use std::f64::consts::PI;

use super::track::Track;
use crate::{astro::frames::EARTH_RATE_RAD_S, propagator::WGS72_RADIUS_KM, simd::Vector};

use super::local_series::GRAVITY_KM3_S2;

/// Max difference between the rate of the satellite and the Earth's rate, as a share.
const MAX_DRIFT: f64 = 0.05;
const MAX_ECCENTRICITY: f64 = 0.2;
/// Max length of a window for this test, seconds. In longer windows, the pull of the Sun, the Moon
/// and the equator's bulge changes the orbit too much.
const LONGEST_WINDOW_S: f64 = 14.0 * 86_400.0;
/// Effect of these pulls in the longest window, radians.
const MARGIN: f64 = 0.02;

/// Returns `true` if the satellite stays below the horizon for the whole window.
///
/// Let i be the inclination, e the eccentricity and n the mean motion of the state in the middle of
/// the window, and T the length of the window. The point below the satellite then stays within
///
/// 2 i + 4.2 e + |n - earth rate| T / 2
///
/// of its place at that instant: twice the figure of eight, twice the equation of centre, and the
/// drift.
pub(super) fn never_rises(track: &Track<'_>) -> bool {
    let window = track.window;
    if track.propagator.secular().is_some() || window.length_s > LONGEST_WINDOW_S {
        return false;
    }
    let Some(middle) = track.series(0.5 * window.length_s) else { return false };
    let (r, v) = (middle.state.position_km, middle.state.velocity_km_s);
    let radius_km = r.length();
    let axis_km = 1.0 / (2.0 / radius_km - v.length_squared() / GRAVITY_KM3_S2);
    let momentum = r.cross(v);
    let eccentricity =
        (v.cross(momentum) * (1.0 / GRAVITY_KM3_S2) - r * (1.0 / radius_km)).length();
    let drift = (GRAVITY_KM3_S2 / axis_km.powi(3)).sqrt() - EARTH_RATE_RAD_S;
    // The negated test also refuses NaN.
    if !(drift.abs() < MAX_DRIFT * EARTH_RATE_RAD_S && eccentricity < MAX_ECCENTRICITY) {
        return false;
    }
    let inclination = momentum.x.hypot(momentum.y).atan2(momentum.z);
    let excursion =
        2.0 * inclination + 4.2 * eccentricity + drift.abs() * 0.5 * window.length_s + MARGIN;
    let highest_km = axis_km * (1.0 + eccentricity) + 0.01 * WGS72_RADIUS_KM;
    let reach = (window.radius_km * window.floor.cos() / highest_km).acos() - window.floor;
    let site_km = Vector::from(window.site_ecef_km);
    let angle = r.cross(site_km).length().atan2(r.dot(site_km));
    (angle - excursion).min(PI) > reach
}
